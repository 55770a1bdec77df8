// Materials.
//
// PBRT shades reflecting surfaces from both sides: they are wrapped into twoSided. Differences by
// definition:
//  - coateddiffuse: PBRT walks randomly between a dielectric interface and a diffuse base; here it
//    is the rough plastic, which sums the reflections between both exactly for a base that
//    scatters evenly (nonlinear: colours saturate). A medium between the layers is not supported.
//  - conductor with a textured reflectance: that reflectance at every angle, where PBRT's rises to
//    white at grazing ones.
//  - dielectric: one index of refraction, that of the d line; no dispersion.
//  - diffusetransmission scatters alike on both sides; where reflectance and transmittance add up
//    to more than one it is not scaled down (PBRT does not either).
// Surfaces below an alpha of 1e-3 are smooth, as in PBRT.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/io/pbrt/reader.h"

namespace lobelia::io::pbrt {
namespace {

constexpr float kSmoothAlpha = 1.0001e-3f;  // 0.001 as written in files is smooth

const std::vector<std::string>& materialTypes() {
  static const std::vector<std::string> types{
      "diffuse",    "coateddiffuse",  "conductor",           "coatedconductor",
      "dielectric", "thindielectric", "diffusetransmission", "mix",
      "interface",  "hair",           "subsurface",          "measured"};
  return types;
}

// eta and k of a conductor that reflects r at normal incidence, with eta = 1.
Rgb extinctionOf(Rgb r) {
  Rgb k;
  for (int i = 0; i < 3; ++i) {
    const float v = std::clamp(r[i], 0.f, 0.9999f);
    k[i] = 2 * std::sqrt(v) / std::sqrt(1 - v);
  }
  return k;
}

}  // namespace

MaterialHandle Reader::add(Material material) {
  scene_.materials.push_back(std::move(material));
  return {static_cast<uint32_t>(scene_.materials.size() - 1)};
}

void Reader::material(const Token& token) {
  const std::string type = quoted(token, "type");
  Parameters in = parameters(token, "material");
  state_.material = makeMaterial(type, "", in);
  state_.materialName.clear();
}

void Reader::makeNamedMaterial(const Token& token) {
  const std::string name = quoted(token, "name");
  Parameters in = parameters(token, "material");
  const std::optional<std::string> type = in.string("type");
  if (!type)
    throw InputError(token.where, fmt::format("the material '{}' has no \"string type\"", name));
  if (namedMaterials_.contains(name))
    findings_.warn(token.where, fmt::format("the material '{}' is defined again; the last one "
                                            "counts from here on",
                                            name));
  namedMaterials_[name] = makeMaterial(*type, name, in);
}

void Reader::namedMaterial(const Token& token) {
  state_.materialName = quoted(token, "name");
  state_.materialWhere = token.where;
}

MaterialHandle Reader::find(const std::string& name, const Location& where) const {
  const auto found = namedMaterials_.find(name);
  if (found != namedMaterials_.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [other, handle] : namedMaterials_) known.push_back(other);
  throw InputError(where, unknownName("material", name, known));
}

MaterialHandle Reader::makeMaterial(const std::string& type, const std::string& name,
                                    Parameters& in) {
  in.ignore({"type"});
  MaterialHandle handle;
  bool twoSided = true;
  if (type == "mix") {
    handle = mixture(in);
    twoSided = false;
  } else {
    Material m;
    if (type == "diffuse") {
      m.diffuse = colorParam(in, "reflectance", Rgb(0.5f));
    } else if (type == "coateddiffuse") {
      m = coatedDiffuse(in);
    } else if (type == "conductor") {
      m = conductor(in, "");
    } else if (type == "coatedconductor") {
      m = coatedConductor(in);
    } else if (type == "dielectric" || type == "thindielectric") {
      m = dielectric(in, type == "thindielectric");
      twoSided = false;
    } else if (type == "diffusetransmission") {
      m = diffuseTransmission(in);
      twoSided = false;
    } else if (type == "interface" || type.empty()) {
      m.type = MaterialType::null;
      twoSided = false;
    } else if (std::find(materialTypes().begin(), materialTypes().end(), type) !=
               materialTypes().end()) {
      m = standIn(type, in);
    } else {
      throw InputError(in.where(), unknownName("material", type, materialTypes()));
    }
    m.name = name;
    handle = add(std::move(m));
  }
  handle = perturbed(handle, in);
  if (twoSided) {
    Material both;
    both.type = MaterialType::twoSided;
    both.name = name;
    both.a = handle;
    handle = add(std::move(both));
  }
  in.finish(fmt::format("material '{}'", type), findings_);
  return handle;
}

// prefix: "" or "interface." or "conductor.".
Reader::Roughness Reader::roughness(Parameters& in, const std::string& prefix) {
  const FloatParam both = floatParam(in, prefix + "roughness", 0.f);
  Roughness out{optionalFloat(in, prefix + "uroughness").value_or(both),
                optionalFloat(in, prefix + "vroughness").value_or(both)};
  for (const FloatParam& alpha : {out.u, out.v}) {
    if (!alpha.texture.valid() && !(alpha.value >= 0))
      throw InputError(in.where(), fmt::format("a roughness of {}; it is 0 or more", alpha.value));
  }
  if (in.boolean("remaproughness", true)) {
    const auto remapped = [&](const FloatParam& r) {
      if (!r.texture.valid()) return FloatParam(std::sqrt(r.value));
      Texture root;
      root.type = TextureType::power;
      root.a = r.texture;
      root.scale = 0.5f;
      return FloatParam(add(std::move(root)));
    };
    const bool isShared = out.u.texture.valid() && out.u.texture == out.v.texture;
    out.u = remapped(out.u);
    out.v = isShared ? out.u : remapped(out.v);
  }
  out.smooth = !out.u.texture.valid() && !out.v.texture.valid() &&
               std::max(out.u.value, out.v.value) < kSmoothAlpha;
  return out;
}

float Reader::indexOfRefraction(Parameters& in, const std::string& name, float otherwise) {
  const Parameter* p = in.find(name, {"float", "spectrum", "integer", "texture", "rgb"});
  if (!p) return otherwise;
  float value = otherwise;
  if (p->type == "texture") {
    const FloatParam texture = floatParam(in, name, otherwise);
    if (texture.texture.valid())
      findings_.warn(p->where,
                     fmt::format("a textured '{}' is not supported; it is {}", name, otherwise));
    else
      value = texture.value;
  } else if (p->type == "spectrum" && !p->strings.empty() && namedGlass(p->strings[0])) {
    value = *namedGlass(p->strings[0]);
    findings_.inform(p->where, fmt::format("no dispersion: '{}' has the index {} of the d line",
                                           p->strings[0], value));
  } else if (p->type == "spectrum" || p->type == "rgb") {
    value = constantColor(*p, SpectrumUse::unbounded).y;
    if (p->type == "spectrum") {  // a constant spectrum is not grey (io/spectrum.h)
      const Spectrum one{{300, 900}, {1, 1}};
      value /= spectrumToRgb(one, SpectrumUse::unbounded).y;
    }
    findings_.inform(p->where,
                     fmt::format("no dispersion: '{}' is {:.4g} throughout", name, value));
  } else {
    value = in.number(name, otherwise);
  }
  if (!(value > 0) || !std::isfinite(value))
    throw InputError(p->where, fmt::format("an index of refraction of {}; it is above 0", value));
  return value;
}

Material Reader::coatedDiffuse(Parameters& in) {
  Material m;
  const Roughness alpha = roughness(in, "");
  m.type = alpha.smooth ? MaterialType::plastic : MaterialType::roughPlastic;
  m.distribution = Distribution::ggx;
  m.alphaU = alpha.u, m.alphaV = alpha.v;
  m.nonlinear = true;
  m.diffuse = colorParam(in, "reflectance", Rgb(0.5f));
  m.ior = indexOfRefraction(in, "eta", 1.5f);
  if (!alpha.smooth && (alpha.u.texture != alpha.v.texture || alpha.u.value != alpha.v.value)) {
    findings_.warn(in.where(),
                   "an anisotropic coat of coateddiffuse is not supported; its "
                   "uroughness counts for both axes");
    m.alphaV = m.alphaU;
  }
  in.ignore({"thickness", "maxdepth", "nsamples", "twosided"});
  in.unsupported("albedo", "there is no medium between the layers", findings_);
  in.unsupported("g", "there is no medium between the layers", findings_);
  return m;
}

Material Reader::conductor(Parameters& in, const std::string& prefix) {
  Material m;
  const Roughness alpha = roughness(in, prefix);
  m.type = alpha.smooth ? MaterialType::conductor : MaterialType::roughConductor;
  m.distribution = Distribution::ggx;
  m.alphaU = alpha.u, m.alphaV = alpha.v;
  const std::string name = in.has(prefix + "reflectance") ? prefix + "reflectance" : "reflectance";
  if (const auto reflectance = optionalColor(in, name, SpectrumUse::reflectance)) {
    if (in.has(prefix + "eta") || in.has(prefix + "k"))
      throw InputError(in.where(), "both a reflectance and eta or k are given; give one of them");
    if (reflectance->texture.valid()) {
      m.specular = *reflectance;  // over a perfect mirror
    } else {
      m.eta = Rgb(1.f), m.k = extinctionOf(reflectance->value);
    }
    return m;
  }
  m.eta = colorParam(in, prefix + "eta", *namedMetal("metal-Cu-eta"), SpectrumUse::unbounded);
  m.k = colorParam(in, prefix + "k", *namedMetal("metal-Cu-k"), SpectrumUse::unbounded);
  return m;
}

Material Reader::coatedConductor(Parameters& in) {
  Material m = conductor(in, "conductor.");
  m.type = MaterialType::coatedConductor;
  const Roughness coat = roughness(in, "interface.");
  m.coatAlphaU = coat.u, m.coatAlphaV = coat.v;
  if (coat.smooth) m.coatAlphaU = m.coatAlphaV = 0.f;
  m.coatIor = indexOfRefraction(in, "interface.eta", 1.5f);
  in.ignore({"thickness", "maxdepth", "nsamples"});
  in.unsupported("albedo", "there is no medium between the layers", findings_);
  in.unsupported("g", "there is no medium between the layers", findings_);
  return m;
}

Material Reader::dielectric(Parameters& in, bool thin) {
  Material m;
  m.ior = indexOfRefraction(in, "eta", 1.5f);
  m.type = MaterialType::thinDielectric;
  in.ignore({"remaproughness"});
  if (thin) return m;
  const Roughness alpha = roughness(in, "");
  m.type = alpha.smooth ? MaterialType::dielectric : MaterialType::roughDielectric;
  m.distribution = Distribution::ggx;
  m.alphaU = alpha.u, m.alphaV = alpha.v;
  return m;
}

// One material with both lobes, on both sides.
Material Reader::diffuseTransmission(Parameters& in) {
  const ColorParam scale = Rgb(in.number("scale", 1.f));
  Material m;
  m.type = MaterialType::diffuseTransmitter;
  m.diffuse = product(colorParam(in, "reflectance", Rgb(0.25f)), scale);
  m.transmittance = product(colorParam(in, "transmittance", Rgb(0.25f)), scale);
  return m;
}

MaterialHandle Reader::mixture(Parameters& in) {
  const std::vector<std::string> names = in.strings("materials");
  if (names.size() != 2)
    throw InputError(in.where(),
                     fmt::format("a mix has {} \"string materials\"; it takes two", names.size()));
  Material m;
  m.type = MaterialType::blend;
  m.a = find(names[0], in.where());
  m.b = find(names[1], in.where());
  m.weight = floatParam(in, "amount", 0.5f);
  return add(std::move(m));
}

// What is nearest of what there is.
Material Reader::standIn(const std::string& type, Parameters& in) {
  Material m;
  std::string instead;
  if (type == "hair") {
    instead = "a diffuse surface of its colour";
    m.diffuse = optionalColor(in, "reflectance", SpectrumUse::reflectance)
                    .value_or(colorParam(in, "color", Rgb(0.25f, 0.15f, 0.1f)));
  } else if (type == "subsurface") {
    instead = "a diffuse surface under a coat";
    const Roughness alpha = roughness(in, "");
    m.type = alpha.smooth ? MaterialType::plastic : MaterialType::roughPlastic;
    m.distribution = Distribution::ggx;
    m.alphaU = m.alphaV = alpha.u;
    m.nonlinear = true;
    m.diffuse = colorParam(in, "reflectance", Rgb(0.7f));
    m.ior = indexOfRefraction(in, "eta", 1.33f);
  } else {
    instead = "a grey diffuse surface";
  }
  in.ignore({"sigma_a", "sigma_s", "eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha",
             "filename", "mfp", "scale", "g", "name", "color", "reflectance"});
  findings_.warn(in.where(), fmt::format("the material '{}' is not supported; {} stands for it",
                                         type, instead));
  return m;
}

MaterialHandle Reader::perturbed(MaterialHandle base, Parameters& in) {
  const std::optional<std::string> normals = in.string("normalmap");
  const std::optional<FloatParam> displacement = optionalFloat(in, "displacement");
  Material m;
  m.a = base;
  if (normals) {
    Texture t;
    t.type = TextureType::bitmap;
    ImageRequest request;
    request.raw = true;
    t.image = image(*normals, request, in.where());
    t.uvMatrix[1][1] = -1, t.uvMatrix[1][2] = 1;
    m.type = MaterialType::normalMap;
    m.map = add(std::move(t));
    if (displacement)
      findings_.warn(in.where(), "both a normalmap and a displacement; the normalmap counts");
  } else if (displacement && displacement->texture.valid()) {
    m.type = MaterialType::bump;
    m.map = displacement->texture;
  } else {
    return base;
  }
  return add(std::move(m));
}

MaterialHandle Reader::surfaceMaterial(const Location& where,
                                       const std::optional<FloatParam>& alpha) {
  MaterialHandle material = state_.material;
  if (!state_.materialName.empty()) {
    material = find(state_.materialName, state_.materialWhere);
  } else if (!material.valid()) {
    if (!defaultMaterial_.valid()) {
      Material grey, both;
      grey.name = both.name = "default";
      both.type = MaterialType::twoSided;
      both.a = add(std::move(grey));
      defaultMaterial_ = add(std::move(both));
    }
    material = defaultMaterial_;
  }
  material = withMedium(material, where);
  if (!alpha || (!alpha->texture.valid() && alpha->value >= 1)) return material;
  MaterialHandle& mask =
      variants_[fmt::format("{} alpha {} {}", material.index, alpha->texture.index, alpha->value)];
  if (!mask.valid()) {
    Material m;
    m.type = MaterialType::mask;
    m.name = scene_[material].name;
    m.a = material;
    m.opacity = *alpha;
    mask = add(std::move(m));
  }
  return mask;
}

// A surface around an absorbing medium takes its absorption, when it is glass.
MaterialHandle Reader::withMedium(MaterialHandle material, const Location& where) {
  for (const std::string& name : {state_.mediumInside, state_.mediumOutside}) {
    if (name.empty() || media_.contains(name)) continue;
    std::vector<std::string> known;
    for (const auto& [other, medium] : media_) known.push_back(other);
    throw InputError(where, unknownName("medium", name, known));
  }
  if (!state_.mediumOutside.empty() && media_[state_.mediumOutside].isAbsorbing)
    warnOnce(where, fmt::format("the medium '{}' lies outside of surfaces, where media are not "
                                "supported",
                                state_.mediumOutside));
  if (state_.mediumInside.empty() || !media_[state_.mediumInside].isAbsorbing ||
      state_.mediumInside == state_.mediumOutside)
    return material;
  const MaterialType type = scene_[material].type;
  if (type != MaterialType::dielectric && type != MaterialType::roughDielectric) {
    warnOnce(where, fmt::format("the medium '{}' lies inside of a surface that is not glass, where "
                                "media are not supported",
                                state_.mediumInside));
    return material;
  }
  MaterialHandle& filled =
      variants_[fmt::format("{} medium {}", material.index, state_.mediumInside)];
  if (!filled.valid()) {
    Material m = scene_[material];
    m.absorption = media_[state_.mediumInside].absorption;
    filled = add(std::move(m));
  }
  return filled;
}

}  // namespace lobelia::io::pbrt

// Materials (bsdf plugins) of Mitsuba scenes, with the defaults of Mitsuba 3 or, in files of
// version 0.x, of Mitsuba 0.6.
//
// Deviations: principledthin is read as principled with a warning; mixturebsdf becomes a chain of
// blends, its missing weight a black layer; "as" (Ashikhmin-Shirley) is read as phong. Our own:
// difftrans may have a reflectance, closed dielectrics an absorption; extension_bsdfs.cpp.

#include "lobelia/io/mitsuba/reader.h"
#include "lobelia/io/optical_constants.h"

namespace lobelia::io::mitsuba {
namespace {

const std::vector<std::string>& bsdfTypes() {
  static const std::vector<std::string> types{"diffuse",
                                              "conductor",
                                              "roughconductor",
                                              "dielectric",
                                              "thindielectric",
                                              "roughdielectric",
                                              "plastic",
                                              "roughplastic",
                                              "principled",
                                              "principledthin",
                                              "phong",
                                              "ward",
                                              "difftrans",
                                              "twosided",
                                              "mask",
                                              "blendbsdf",
                                              "mixturebsdf",
                                              "bumpmap",
                                              "normalmap",
                                              "null",
                                              "metallicroughness",
                                              "coatedconductor",
                                              "sphericalgaussians",
                                              "measured",
                                              "merl"};
  return types;
}

std::string list(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

MaterialHandle Reader::add(Material material) {
  scene_.materials.push_back(std::move(material));
  return {static_cast<uint32_t>(scene_.materials.size() - 1)};
}

MaterialHandle Reader::material(const Element& element) {
  if (const auto known = materials_.find(&element); known != materials_.end()) {
    return known->second;
  }
  if (element.tag != "bsdf") wrongKind(element, "<bsdf>");
  const ReadingGuard guard(open_, element);
  Object object = open(element);
  object.ignore({"id"});  // the old Blender exporter names materials by a property
  const std::string& type = object.type();
  MaterialHandle handle;
  if (type == "mixturebsdf") {
    handle = mixture(object);
  } else if (type == "twosided" || type == "mask" || type == "blendbsdf" || type == "bumpmap" ||
             type == "normalmap") {
    handle = wrapper(object);
  } else {
    Material m = simpleMaterial(object);
    m.name = object.id();
    handle = add(std::move(m));
  }
  object.finish();
  materials_.emplace(&element, handle);
  return handle;
}

Material Reader::simpleMaterial(Object& object) {
  const std::string& type = object.type();
  Material m;
  const auto specular = [&](float otherwise) {
    m.specular = color(object, "specular_reflectance", Rgb(otherwise));
  };
  const auto diffuse = [&] { m.diffuse = color(object, "diffuse_reflectance", Rgb(0.5f)); };
  if (type == "diffuse") {
    m.type = MaterialType::diffuse;
    // 0.6 takes both names.
    const bool longName = !object.has("reflectance") && object.has("diffuse_reflectance");
    m.diffuse = color(object, longName ? "diffuse_reflectance" : "reflectance", Rgb(0.5f));
  } else if (type == "conductor" || type == "roughconductor") {
    m.type = type == "conductor" ? MaterialType::conductor : MaterialType::roughConductor;
    conductor(object, &m);
    specular(1);
    if (type == "roughconductor") roughness(object, &m);
  } else if (type == "dielectric" || type == "thindielectric" || type == "roughdielectric") {
    m.type = type == "dielectric"       ? MaterialType::dielectric
             : type == "thindielectric" ? MaterialType::thinDielectric
                                        : MaterialType::roughDielectric;
    indexOfRefraction(object, "bk7", &m);
    specular(1);
    m.transmittance = color(object, "specular_transmittance", Rgb(1.f));
    if (type == "roughdielectric") roughness(object, &m);
    if (type != "thindielectric") m.absorption = absorption(object);
  } else if (type == "plastic" || type == "roughplastic") {
    m.type = type == "plastic" ? MaterialType::plastic : MaterialType::roughPlastic;
    indexOfRefraction(object, "polypropylene", &m);
    diffuse();
    specular(1);
    m.nonlinear = object.boolean("nonlinear", false);
    if (type == "roughplastic") roughness(object, &m);
  } else if (type == "phong") {
    m.type = MaterialType::phong;
    m.alphaU = m.alphaV = scalar(object, "exponent", 30);
    diffuse();
    specular(0.2f);
  } else if (type == "ward") {
    m.type = MaterialType::ward;
    const std::string variant = object.string("variant").value_or("balanced");
    const std::vector<std::string> variants{"ward", "ward-duer", "balanced"};
    const auto at = std::find(variants.begin(), variants.end(), variant);
    if (at == variants.end()) {
      throw InputError(object.where(),
                       "the variant of ward is '" + variant + "'; it may be " + list(variants));
    }
    m.wardVariant = static_cast<int>(at - variants.begin());
    const FloatParam alpha = scalar(object, "alpha", 0.1f);
    m.alphaU = object.has("alpha_u") ? scalar(object, "alpha_u", 0) : alpha;
    m.alphaV = object.has("alpha_v") ? scalar(object, "alpha_v", 0) : alpha;
    diffuse();
    specular(0.2f);
  } else if (type == "difftrans") {
    m.type = MaterialType::diffuseTransmitter;
    m.transmittance = color(object, "transmittance", Rgb(0.5f));
    m.diffuse = color(object, "reflectance", Rgb(0.f));
  } else if (type == "principled" || type == "principledthin") {
    m = principled(object);
  } else if (type == "metallicroughness") {
    m = metallicRoughness(object);
  } else if (type == "coatedconductor") {
    m = coatedConductor(object);
  } else if (type == "sphericalgaussians") {
    m = sphericalGaussians(object);
  } else if (type == "measured" || type == "merl") {
    m = measured(object);
  } else if (type == "null") {
    m.type = MaterialType::null;
  } else {
    unknownType(object, bsdfTypes());
  }
  return m;
}

float Reader::namedOrNumber(Object& object, const std::string& name, const std::string& otherwise) {
  const Element* e = object.property(name);
  if (e && e->tag != "string") {
    const float value = scalar(object, name, 1).value;
    if (!(value > 0)) throw InputError(e->where, "'" + name + "' must be above 0");
    return value;
  }
  const std::string material = e ? e->value("value") : otherwise;
  if (const std::optional<float> ior = namedIor(material)) return *ior;
  const std::string hint = suggestion(material, namedIors());
  throw InputError(e ? e->where : object.where(),
                   "no index of refraction is known for '" + material + "'" +
                       (hint.empty() ? "; known are " + list(namedIors()) : hint));
}

void Reader::indexOfRefraction(Object& object, const std::string& defaultInside, Material* out) {
  out->ior =
      namedOrNumber(object, "int_ior", defaultInside) / namedOrNumber(object, "ext_ior", "air");
}

void Reader::conductor(Object& object, Material* out) {
  const std::optional<std::string> given = object.string("material");
  // Mitsuba 3 has no default metal; 0.6 has copper in air.
  const bool own = object.has("eta") || object.has("k");
  const std::string name = given.value_or(object.legacy() ? "Cu" : "none");
  const std::optional<ConductorConstants> constants = namedConductor(name);
  if (!constants) {
    const std::string hint = suggestion(name, namedConductors());
    throw InputError(object.where(),
                     "no optical constants are known for '" + name + "'" +
                         (hint.empty() ? "; known are " + list(namedConductors()) : hint));
  }
  if (own && given && *given != "none") {
    findings_.warn(object.where(), "both material and eta, k are given; eta and k count");
  }
  out->eta = color(object, "eta", constants->eta, SpectrumUse::unbounded);
  out->k = color(object, "k", constants->k, SpectrumUse::unbounded);
  const bool hasExterior = object.has("ext_eta");
  const float exterior =
      hasExterior || object.legacy() ? namedOrNumber(object, "ext_eta", "air") : 1;
  if (out->eta.texture.valid() || out->k.texture.valid()) {
    if (hasExterior) findings_.warn(object.where(), "ext_eta is ignored: eta or k is a texture");
    return;
  }
  // A mirror ("none") stays one in any medium.
  if (name == "none" && !own) return;
  out->eta.value /= exterior;
  out->k.value /= exterior;
}

void Reader::roughness(Object& object, Material* out) {
  const std::string name = object.string("distribution").value_or("beckmann");
  if (name == "beckmann") {
    out->distribution = Distribution::beckmann;
  } else if (name == "ggx") {
    out->distribution = Distribution::ggx;
  } else if (name == "phong" || name == "as") {
    out->distribution = Distribution::phong;
  } else {
    throw InputError(object.where(), "unknown distribution '" + name + "'" +
                                         suggestion(name, {"beckmann", "ggx", "phong", "as"}));
  }
  const bool anisotropic = object.has("alpha_u") || object.has("alpha_v");
  if (anisotropic && object.has("alpha")) {
    throw InputError(object.where(), "both alpha and alpha_u, alpha_v are given; give one");
  }
  out->alphaU = scalar(object, anisotropic ? "alpha_u" : "alpha", 0.1f);
  out->alphaV = anisotropic ? scalar(object, "alpha_v", 0.1f) : out->alphaU;
  object.ignore({"sample_visible"});
}

Material Reader::principled(Object& object) {
  const bool thin = object.type() == "principledthin";
  if (thin) {
    findings_.warn(object.where(),
                   "the bsdf 'principledthin' is not supported; 'principled' stands in for it, "
                   "without diff_trans");
    object.ignore({"diff_trans", "diff_trans_sampling_rate", "spec_reflect_sampling_rate",
                   "spec_trans_sampling_rate", "diffuse_transmittance_sampling_rate",
                   "specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate"});
  }
  Material m;
  m.type = MaterialType::principled;
  m.diffuse = color(object, "base_color", Rgb(0.5f));
  m.roughness = scalar(object, "roughness", 0.5f);
  m.anisotropic = scalar(object, "anisotropic", 0);
  m.metallic = scalar(object, "metallic", 0);
  m.specTrans = scalar(object, "spec_trans", 0);
  m.specTint = scalar(object, "spec_tint", 0);
  m.sheen = scalar(object, "sheen", 0);
  m.sheenTint = scalar(object, "sheen_tint", 0);
  m.flatness = scalar(object, "flatness", 0);
  m.clearcoat = scalar(object, "clearcoat", 0);
  m.clearcoatGloss = scalar(object, "clearcoat_gloss", 0);
  object.ignore({"main_specular_sampling_rate", "clearcoat_sampling_rate",
                 "diffuse_reflectance_sampling_rate"});
  const bool transmits = m.specTrans.texture.valid() || m.specTrans.value > 0;
  const std::optional<double> eta = object.number("eta");
  const std::optional<double> specular = object.number("specular");
  if (eta && specular) {
    throw InputError(object.where(), "both eta and specular are given; give one of them");
  }
  if (eta) {
    if (*eta <= 0) throw InputError(object.where(), "eta must be above 0");
    m.ior = static_cast<float>(transmits && *eta == 1 ? 1.001 : *eta);
  } else {
    // F0 = 0.08 specular, inverted to an index of refraction [Burley 2015].
    double s = specular.value_or(0.5);
    if (s < 0 || s > 12) throw InputError(object.where(), "specular must be between 0 and 1");
    if (transmits && s == 0) s = 1e-3;
    m.ior = static_cast<float>(2 / (1 - std::sqrt(0.08 * s)) - 1);
  }
  return m;
}

MaterialHandle Reader::wrapper(Object& object) {
  const std::string& type = object.type();
  Material m;
  m.name = object.id();
  const std::vector<const Element*> inner = object.nested("bsdf");
  const size_t least = type == "blendbsdf" ? 2 : 1;
  const size_t most = type == "blendbsdf" || type == "twosided" ? 2 : 1;
  if (inner.size() < least || inner.size() > most) {
    throw InputError(object.where(), "the " + type + " holds " + std::to_string(inner.size()) +
                                         " bsdfs; it needs " + std::to_string(least) +
                                         (most > least ? " or " + std::to_string(most) : ""));
  }
  m.a = material(*inner[0]);
  if (inner.size() > 1) m.b = material(*inner[1]);
  if (type == "twosided") {
    m.type = MaterialType::twoSided;
  } else if (type == "mask") {
    m.type = MaterialType::mask;
    m.opacity = scalar(object, "opacity", 0.5f);
  } else if (type == "blendbsdf") {
    m.type = MaterialType::blend;
    if (!object.has("weight")) {
      // Mitsuba accepts a nested texture of any name.
      const std::vector<const Element*> textures = object.nested("texture");
      if (textures.empty()) throw InputError(object.where(), "the blendbsdf has no weight");
      m.weight = texture(*textures[0]);
    } else {
      m.weight = scalar(object, "weight", 0.5f);
    }
  } else {
    const bool bump = type == "bumpmap";
    m.type = bump ? MaterialType::bump : MaterialType::normalMap;
    m.scale = bump ? object.number("scale", 1.f) : 1.f;
    if (!bump) object.ignore({"flip_invalid_normals", "use_shadowing_function"});
    const std::vector<const Element*> textures = object.nested("texture");
    if (textures.size() != 1) {
      throw InputError(object.where(), "the " + type + " holds " + std::to_string(textures.size()) +
                                           " textures; it needs one");
    }
    m.map = texture(*textures[0]);
  }
  return add(std::move(m));
}

// sum w_i f_i as a chain of two-way blends: a (1 - w) + b w.
MaterialHandle Reader::mixture(Object& object) {
  const Element* property = object.property("weights");
  if (!property) throw InputError(object.where(), "the mixturebsdf has no weights");
  std::vector<double> weights = parseNumbers(property->value("value"), *property);
  const std::vector<const Element*> inner = object.nested("bsdf");
  if (inner.empty() || inner.size() != weights.size()) {
    throw InputError(object.where(), "the mixturebsdf has " + std::to_string(weights.size()) +
                                         " weights for " + std::to_string(inner.size()) + " bsdfs");
  }
  double sum = 0;
  for (const double w : weights) {
    if (w < 0) throw InputError(property->where, "a weight of the mixturebsdf is negative");
    sum += w;
  }
  if (sum > 1 + 1e-6) {
    findings_.warn(property->where, "the weights add up to more than 1 and are normalised");
    for (double& w : weights) w /= sum;
    sum = 1;
  }
  const auto blend = [&](MaterialHandle a, MaterialHandle b, double weight) {
    Material m;
    m.type = MaterialType::blend;
    m.name = object.id();
    m.a = a;
    m.b = b;
    m.weight = static_cast<float>(weight);
    return add(std::move(m));
  };
  MaterialHandle chain = material(*inner.back());
  double total = weights.back();
  for (size_t i = inner.size() - 1; i-- > 0;) {
    const MaterialHandle next = material(*inner[i]);
    total += weights[i];
    chain = blend(next, chain, total > 0 ? 1 - weights[i] / total : 0);
  }
  if (sum < 1 - 1e-6) {
    Material black;
    black.diffuse = Rgb(0.f);
    chain = blend(chain, add(std::move(black)), 1 - sum);
  }
  return chain;
}

}  // namespace lobelia::io::mitsuba

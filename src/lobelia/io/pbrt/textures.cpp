// Textures: constant, imagemap, scale, mix, checkerboard; what others there are is replaced by a
// constant near their mean. Named textures are values: constants stay constants.
//
// PBRT's v grows upwards, our images begin at the top: uv matrices of images turn v around. Numbers
// made of colour images are their mean, or their alpha when they have one that is not 1 throughout.
// 8-bit images are sRGB unless `encoding` says otherwise. Lookups are bilinear (without MIP maps,
// which a filter over the pixel makes up for).
#include <fmt/format.h>

#include "lobelia/io/image_io.h"
#include "lobelia/io/pbrt/reader.h"

namespace lobelia::io::pbrt {
namespace {

const std::vector<std::string>& textureTypes() {
  static const std::vector<std::string> types{
      "constant", "imagemap", "scale",  "mix",   "checkerboard", "directionmix", "bilerp",
      "dots",     "fbm",      "marble", "windy", "wrinkled",     "ptex"};
  return types;
}

void makeGrey(Image& image) {
  if (image.channels == 1) return;
  const auto stride = static_cast<size_t>(image.channels);
  const size_t count = image.pixels.size() / stride;
  bool useAlpha = false;
  if (stride == 4)
    for (size_t i = 0; i < count; ++i) useAlpha = useAlpha || image.pixels[i * 4 + 3] != 1;
  std::vector<float> grey(count);
  for (size_t i = 0; i < count; ++i) {
    const float* const p = &image.pixels[i * stride];
    grey[i] = useAlpha ? p[3] : stride < 3 ? p[0] : (p[0] + p[1] + p[2]) / 3;
  }
  image.pixels = std::move(grey);
  image.channels = 1;
}

bool isGrey(Rgb c) { return c.x == c.y && c.y == c.z; }

}  // namespace

void Reader::texture(const Token& token) {
  const std::string name = quoted(token, "name"), kind = quoted(token, "kind"),
                    type = quoted(token, "type");
  if (kind != "spectrum" && kind != "color" && kind != "float")
    throw InputError(token.where, unknownName("kind of texture", kind, {"spectrum", "float"}));
  const bool isColor = kind != "float";
  if (isColor ? colorTextures_.contains(name) : floatTextures_.contains(name))
    findings_.warn(token.where, fmt::format("the texture '{}' is defined again; the last one "
                                            "counts from here on",
                                            name));
  Parameters in = parameters(token, "texture");
  const ColorParam made = makeTexture(type, isColor, in);
  in.finish(fmt::format("texture '{}'", type), findings_);
  if (isColor) {
    colorTextures_[name] = made;
  } else {
    FloatParam number = made.value.x;
    number.texture = made.texture;
    floatTextures_[name] = number;
  }
}

ColorParam Reader::makeTexture(const std::string& type, bool isColor, Parameters& in) {
  if (type == "constant") return value(in, "value", 1, isColor);
  if (type == "imagemap") return imageMap(isColor, in);
  if (type == "checkerboard") return checkerboard(isColor, in);
  if (type == "scale") {
    const ColorParam tex = value(in, "tex", 1, isColor);
    return product(tex, value(in, "scale", 1, false));
  }
  if (type == "mix" || type == "directionmix") {
    const ColorParam a = value(in, "tex1", 0, isColor), b = value(in, "tex2", 1, isColor);
    ColorParam amount = Rgb(0.5f);
    if (type == "mix") {
      amount = value(in, "amount", 0.5f, false);
    } else {
      in.ignore({"dir"});
      findings_.warn(in.where(),
                     "the texture 'directionmix' is not supported; the mean of both stands for it");
    }
    if (!a.texture.valid() && !b.texture.valid() && !amount.texture.valid())
      return a.value * (1 - amount.value.x) + b.value * amount.value.x;
    Texture t;
    t.type = TextureType::mix;
    t.a = asTexture(a), t.b = asTexture(b), t.c = asTexture(amount);
    return add(std::move(t));
  }
  if (std::find(textureTypes().begin(), textureTypes().end(), type) == textureTypes().end())
    throw InputError(in.where(), unknownName("texture", type, textureTypes()));
  findings_.warn(in.where(), fmt::format("the texture '{}' is not supported; a constant stands for "
                                         "it",
                                         type));
  if (type == "bilerp") {
    Rgb sum;
    for (const char* corner : {"v00", "v01", "v10", "v11"}) {
      const bool isOne = corner[2] == '1';
      const ColorParam v = value(in, corner, isOne ? 1.f : 0.f, isColor);
      sum += v.value * 0.25f;
    }
    in.ignore({"mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2"});
    return sum;
  }
  if (type == "dots") {
    const ColorParam outside = value(in, "outside", 0, isColor);
    value(in, "inside", 1, isColor);
    in.ignore({"mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2"});
    return outside;
  }
  in.ignore({"octaves", "roughness", "scale", "variation", "filename", "encoding"});
  return Rgb(0.5f);
}

ColorParam Reader::value(Parameters& in, const std::string& name, float otherwise, bool isColor) {
  if (isColor) return colorParam(in, name, Rgb(otherwise), SpectrumUse::unbounded);
  const FloatParam number = floatParam(in, name, otherwise);
  return number.texture.valid() ? ColorParam(number.texture) : ColorParam(Rgb(number.value));
}

void Reader::uvMapping(Parameters& in, Texture* out) {
  const std::string mapping = in.string("mapping", "uv");
  if (mapping != "uv") {
    findings_.warn(in.where(),
                   fmt::format("the mapping '{}' is not supported; the surface's uv are "
                               "used",
                               mapping));
    in.ignore({"v1", "v2"});
  }
  const float su = in.number("uscale", 1.f), sv = in.number("vscale", 1.f);
  const float du = in.number("udelta", 0.f), dv = in.number("vdelta", 0.f);
  const float matrix[2][3] = {{su, 0, du}, {0, sv, dv}};
  std::copy(&matrix[0][0], &matrix[0][0] + 6, &out->uvMatrix[0][0]);
}

ColorParam Reader::imageMap(bool isColor, Parameters& in) {
  const std::optional<std::string> file = in.string("filename");
  if (!file) throw InputError(in.where(), "the imagemap has no filename");
  Texture t;
  t.type = TextureType::bitmap;
  uvMapping(in, &t);
  t.uvMatrix[1][1] = -t.uvMatrix[1][1];
  t.uvMatrix[1][2] = 1 - t.uvMatrix[1][2];

  const std::string wrap = in.string("wrap", "repeat");
  if (wrap == "black") {
    t.wrapU = t.wrapV = Wrap::zero;
  } else if (wrap == "clamp") {
    t.wrapU = t.wrapV = Wrap::clamp;
  } else if (wrap != "repeat") {
    if (wrap != "octahedralsphere")
      throw InputError(in.where(), unknownName("wrap mode", wrap, {"repeat", "black", "clamp"}));
    findings_.warn(in.where(), "the wrap mode 'octahedralsphere' is not supported; read as clamp");
    t.wrapU = t.wrapV = Wrap::clamp;
  }
  const std::string filter = in.string("filter", "bilinear");
  const std::vector<std::string> filters{"point", "bilinear", "trilinear", "EWA", "ewa"};
  if (std::find(filters.begin(), filters.end(), filter) == filters.end())
    throw InputError(in.where(), unknownName("texture filter", filter, filters));
  if (filter == "point") t.filter = Filter::nearest;

  ImageRequest request;
  request.grey = !isColor;
  request.inverted = in.boolean("invert", false);
  const float scale = in.number("scale", 1.f);
  if (request.inverted) request.scale = scale;
  const std::string encoding = in.string("encoding", "sRGB");
  if (encoding == "linear") {
    request.raw = true;
  } else if (encoding.starts_with("gamma ")) {
    request.gamma = static_cast<float>(parseNumber(encoding.substr(6), in.where()));
    if (!(request.gamma > 0)) throw InputError(in.where(), "the encoding's gamma must be above 0");
  } else if (encoding != "sRGB") {
    throw InputError(in.where(),
                     unknownName("encoding", encoding, {"sRGB", "linear", "gamma 2.2"}));
  }
  in.ignore({"maxanisotropy"});
  t.image = image(*file, request, in.where());
  const ColorParam out = add(std::move(t));
  return scale == 1 || request.inverted ? out : product(out, Rgb(scale));
}

ColorParam Reader::checkerboard(bool isColor, Parameters& in) {
  Texture t;
  t.type = TextureType::checkerboard;
  uvMapping(in, &t);
  // PBRT's squares have side 1, ours side 1/2.
  for (auto& row : t.uvMatrix)
    for (float& entry : row) entry *= 0.5f;
  const ColorParam a = value(in, "tex1", 1, isColor), b = value(in, "tex2", 0, isColor);
  t.a = asTexture(a), t.b = asTexture(b);
  if (in.integer("dimension", 2) != 2)
    findings_.warn(in.where(),
                   "a checkerboard of three dimensions is not supported; it lies in uv");
  return add(std::move(t));
}

ImageHandle Reader::image(const std::string& file, const ImageRequest& request,
                          const Location& where) {
  const std::string path = resolve(file, "image", where);
  const std::string key = fmt::format("{}|{}|{}|{}|{}|{}", path, request.raw, request.gamma,
                                      request.grey, request.inverted, request.scale);
  if (const auto known = images_.find(key); known != images_.end()) return known->second;
  ImageOptions options;
  options.raw = request.raw;
  options.gamma = request.gamma;
  Image read = readImage(path, options, where);
  if (request.grey) makeGrey(read);
  if (request.inverted)
    for (float& v : read.pixels) v = std::max(0.f, 1 - request.scale * v);
  scene_.images.push_back(std::move(read));
  const ImageHandle handle{static_cast<uint32_t>(scene_.images.size() - 1)};
  images_.emplace(key, handle);
  return handle;
}

TextureHandle Reader::add(Texture texture) {
  scene_.textures.push_back(std::move(texture));
  return {static_cast<uint32_t>(scene_.textures.size() - 1)};
}

TextureHandle Reader::asTexture(const ColorParam& param) {
  if (param.texture.valid()) return param.texture;
  Texture t;
  t.value = param.value;
  return add(std::move(t));
}

TextureHandle Reader::asTexture(const FloatParam& param) {
  return param.texture.valid() ? param.texture : asTexture(ColorParam(Rgb(param.value)));
}

ColorParam Reader::product(const ColorParam& a, const ColorParam& b) {
  if (!a.texture.valid() && !b.texture.valid()) return a.value * b.value;
  if (!a.texture.valid()) return product(b, a);
  if (!b.texture.valid() && b.value == Rgb(1.f)) return a;
  Texture t;
  t.a = a.texture;
  if (!b.texture.valid() && isGrey(b.value)) {
    t.type = TextureType::scale;
    t.scale = b.value.x;
  } else {
    t.type = TextureType::product;
    t.b = asTexture(b);
  }
  return add(std::move(t));
}

std::optional<ColorParam> Reader::optionalColor(Parameters& in, const std::string& name,
                                                SpectrumUse use) {
  const Parameter* p = in.find(name, {"rgb", "spectrum", "blackbody", "texture", "color", "float"});
  if (!p) return std::nullopt;
  if (p->type != "texture") return ColorParam(constantColor(*p, use));
  if (p->strings.size() != 1)
    throw InputError(p->where,
                     fmt::format("'{}' names {} textures; it takes one", name, p->strings.size()));
  const auto found = colorTextures_.find(p->strings[0]);
  if (found != colorTextures_.end()) return found->second;
  if (floatTextures_.contains(p->strings[0]))
    throw InputError(p->where, fmt::format("'{}' takes a spectrum texture; '{}' is a float texture",
                                           name, p->strings[0]));
  std::vector<std::string> known;
  for (const auto& [other, texture] : colorTextures_) known.push_back(other);
  throw InputError(p->where, unknownName("spectrum texture", p->strings[0], known));
}

ColorParam Reader::colorParam(Parameters& in, const std::string& name, Rgb otherwise,
                              SpectrumUse use) {
  return optionalColor(in, name, use).value_or(ColorParam(otherwise));
}

std::optional<FloatParam> Reader::optionalFloat(Parameters& in, const std::string& name) {
  const Parameter* p = in.find(name, {"float", "texture", "integer"});
  if (!p) return std::nullopt;
  if (p->type != "texture") return FloatParam(static_cast<float>(*in.number(name)));
  if (p->strings.size() != 1)
    throw InputError(p->where,
                     fmt::format("'{}' names {} textures; it takes one", name, p->strings.size()));
  const auto found = floatTextures_.find(p->strings[0]);
  if (found != floatTextures_.end()) return found->second;
  if (colorTextures_.contains(p->strings[0]))
    throw InputError(p->where, fmt::format("'{}' takes a float texture; '{}' is a spectrum texture",
                                           name, p->strings[0]));
  std::vector<std::string> known;
  for (const auto& [other, texture] : floatTextures_) known.push_back(other);
  throw InputError(p->where, unknownName("float texture", p->strings[0], known));
}

FloatParam Reader::floatParam(Parameters& in, const std::string& name, float otherwise) {
  return optionalFloat(in, name).value_or(FloatParam(otherwise));
}

}  // namespace lobelia::io::pbrt

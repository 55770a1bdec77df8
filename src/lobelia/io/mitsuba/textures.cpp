// Textures of Mitsuba scenes.
//
// Types: bitmap, checkerboard, scale, mesh_attribute (0.6: vertexcolors). The filters "ewa" and
// "trilinear" of 0.6 are read as bilinear: prefiltering changes noise, not the expected image much.
// Our own: product (a b), mix (a (1 - amount) + b amount), power (a^exponent); of a bitmap or mesh
// attribute an integer `channel`, 0 to 3; of a bitmap `attribute`, the vertex attribute that has
// its uv. As in Mitsuba, the alpha channel of an image is dropped unless channel = "a" asks for it.

#include "lobelia/io/image_io.h"
#include "lobelia/io/mitsuba/read_at.h"
#include "lobelia/io/mitsuba/reader.h"

namespace lobelia::io::mitsuba {
namespace {

const std::vector<std::string>& textureTypes() {
  static const std::vector<std::string> types{
      "bitmap",       "checkerboard", "scale", "mesh_attribute",
      "vertexcolors", "product",      "mix",   "power"};
  return types;
}

template <class T>
T choose(const std::string& value, const std::vector<std::pair<std::string, T>>& choices,
         const std::string& property, const Location& where) {
  std::vector<std::string> names;
  for (const auto& [name, result] : choices) {
    if (name == value) return result;
    names.push_back(name);
  }
  std::string hint = suggestion(value, names);
  if (hint.empty()) {
    hint = "; it may be";
    for (const std::string& name : names) hint += (&name == &names.front() ? " " : ", ") + name;
  }
  throw InputError(where, property + " is '" + value + "'" + hint);
}

Wrap wrapMode(const std::string& value, const Location& where) {
  return choose<Wrap>(value,
                      {{"repeat", Wrap::repeat},
                       {"mirror", Wrap::mirror},
                       {"clamp", Wrap::clamp},
                       {"zero", Wrap::zero},
                       {"one", Wrap::one}},
                      "wrap_mode", where);
}

}  // namespace

TextureHandle Reader::add(Texture texture) {
  scene_.textures.push_back(std::move(texture));
  return {static_cast<uint32_t>(scene_.textures.size() - 1)};
}

TextureHandle Reader::texture(const Element& element) {
  if (const auto known = textures_.find(&element); known != textures_.end()) return known->second;
  const ReadingGuard guard(open_, element);
  Object object = open(element);
  const std::string& type = object.type();
  TextureHandle handle;
  if (type == "bitmap") {
    handle = bitmap(object);
  } else if (type == "checkerboard") {
    handle = checkerboard(object);
  } else if (type == "scale") {
    handle = scaleTexture(object);
  } else if (type == "mesh_attribute" || type == "vertexcolors") {
    Texture t;
    t.type = TextureType::meshAttribute;
    t.attribute = object.string("name").value_or(type == "vertexcolors" ? "vertex_color" : "");
    if (t.attribute.rfind("vertex_", 0) != 0 && t.attribute.rfind("face_", 0) != 0) {
      throw InputError(object.where(), "the mesh_attribute's name is '" + t.attribute +
                                           "'; it must begin with vertex_ or face_");
    }
    t.scale = object.number("scale", 1.f);
    channel(object, &t);
    handle = add(std::move(t));
  } else if (type == "product" || type == "mix" || type == "power") {
    handle = combination(object);
  } else {
    unknownType(object, textureTypes());
  }
  object.finish();
  textures_.emplace(&element, handle);
  return handle;
}

TextureHandle Reader::bitmap(Object& object) {
  Texture t;
  t.type = TextureType::bitmap;
  const std::optional<std::string> file = object.string("filename");
  if (!file) throw InputError(object.where(), "the bitmap has no filename");
  t.filter = choose<Filter>(object.string("filter_type").value_or("bilinear"),
                            {{"bilinear", Filter::bilinear},
                             {"nearest", Filter::nearest},
                             {"trilinear", Filter::bilinear},
                             {"ewa", Filter::bilinear}},
                            "filter_type", object.where());
  const std::string wrap = object.string("wrap_mode").value_or("repeat");
  const std::string wrapU = object.string("wrap_mode_u").value_or(wrap);
  const std::string wrapV = object.string("wrap_mode_v").value_or(wrap);
  t.wrapU = wrapMode(wrapU, object.where());
  t.wrapV = wrapMode(wrapV, object.where());
  channel(object, &t);
  t.attribute = object.string("attribute").value_or("");
  if (!t.attribute.empty() && t.attribute.rfind("vertex_", 0) != 0) {
    throw InputError(object.where(), "the bitmap's attribute is '" + t.attribute +
                                         "'; uv are attributes of vertices: vertex_...");
  }
  const bool raw = object.boolean("raw", false);
  const float gamma = object.number("gamma", 0.f);
  object.ignore({"format", "accel", "cache", "max_anisotropy"});
  uvTransform(object, &t);
  const bool linear = raw || gamma == 1;
  t.image = image(*file, linear, linear ? 0 : std::max(gamma, 0.f), object.where());
  return add(std::move(t));
}

// A string as 0.6 has it (r, g, b; a: opacity where the image has it), or our number.
void Reader::channel(Object& object, Texture* out) {
  const Element* e = object.property("channel");
  if (!e) return;
  if (e->tag == "integer") {
    out->channel = object.integer("channel", 0);
    if (out->channel < 0 || out->channel > 3) {
      throw InputError(e->where, "the channel is " + std::to_string(out->channel) +
                                     "; it may be 0 to 3 (r, g, b, alpha)");
    }
    return;
  }
  const std::string name = object.string("channel").value_or("");
  static const std::string kNames = "rgb";
  if (name == "a") {
    out->alphaChannel = true;
  } else if (name.size() == 1 && kNames.find(name) != std::string::npos) {
    out->channel = static_cast<int>(kNames.find(name));
  } else if (!name.empty()) {
    findings_.warn(e->where, "the channel '" + name + "' cannot be chosen; r, g, b and a can");
  }
}

// A texture inside another one, which may be given as a constant.
TextureHandle Reader::part(Object& object, const char* name, float otherwise) {
  const ColorParam param = color(object, name, Rgb(otherwise), SpectrumUse::unbounded);
  if (param.texture.valid()) return param.texture;
  Texture constant;
  constant.value = param.value;
  return add(std::move(constant));
}

TextureHandle Reader::combination(Object& object) {
  const std::string& type = object.type();
  Texture t;
  t.type = type == "product" ? TextureType::product
           : type == "mix"   ? TextureType::mix
                             : TextureType::power;
  t.a = part(object, "a", t.type == TextureType::mix ? 0.f : 1.f);
  if (t.type != TextureType::power) t.b = part(object, "b", 1);
  if (t.type == TextureType::mix) t.c = part(object, "amount", 0.5f);
  if (t.type == TextureType::power) t.scale = object.number("exponent", 1.f);
  return add(std::move(t));
}

TextureHandle Reader::checkerboard(Object& object) {
  Texture t;
  t.type = TextureType::checkerboard;
  t.a = part(object, "color0", 0.4f);
  t.b = part(object, "color1", 0.2f);
  uvTransform(object, &t);
  return add(std::move(t));
}

TextureHandle Reader::scaleTexture(Object& object) {
  Texture t;
  t.type = TextureType::scale;
  const Rgb factor = constantColor(object, "scale", Rgb(1.f), SpectrumUse::unbounded);
  t.scale = factor.x == factor.y && factor.y == factor.z ? factor.x : luminance(factor);
  if (factor.x != factor.y || factor.y != factor.z) {
    findings_.warn(object.where(), "a texture cannot be scaled by a colour; its luminance is used");
  }
  const std::vector<const Element*> inner = object.nested("texture");
  if (inner.size() != 1) {
    throw InputError(object.where(), "the scale texture needs exactly one texture inside it");
  }
  t.a = texture(*inner[0]);
  return add(std::move(t));
}

// to_uv of Mitsuba 3, or offset and scale of 0.6: uv' = uv * scale + offset.
void Reader::uvTransform(Object& object, Texture* out) {
  const float u = object.number("uscale", 1.f), v = object.number("vscale", 1.f);
  const float u0 = object.number("uoffset", 0.f), v0 = object.number("voffset", 0.f);
  const float simple[2][3] = {{u, 0, u0}, {0, v, v0}};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 3; ++j) out->uvMatrix[i][j] = simple[i][j];
  }
  const Element* e = object.property("to_uv");
  if (!e) return;
  if (e->tag != "transform") wrongKind(*e, "<transform>");
  const Mat4 m = parseTransform(*e, true);
  for (size_t i = 0; i < 2; ++i) {
    out->uvMatrix[i][0] = static_cast<float>(m.m[i][0]);
    out->uvMatrix[i][1] = static_cast<float>(m.m[i][1]);
    out->uvMatrix[i][2] = static_cast<float>(m.m[i][3]);
  }
}

ImageHandle Reader::image(const std::string& file, bool raw, float gamma, const Location& where) {
  const std::string path = document_.resolve(file, where);
  const std::string key = path + (raw ? "|raw|" : "|") + std::to_string(gamma);
  if (const auto known = images_.find(key); known != images_.end()) return known->second;
  ImageOptions options;
  options.raw = raw;
  options.gamma = gamma;
  scene_.images.push_back(readAt(where, [&] { return readImage(path, options, where); }));
  const ImageHandle handle{static_cast<uint32_t>(scene_.images.size() - 1)};
  images_.emplace(key, handle);
  return handle;
}

// Mitsuba 2 and 3 (Checkerboard::eval_1) exchange the two colours of a checkerboard that is asked
// for a number; reference images depend on it.
TextureHandle Reader::scalarTexture(TextureHandle handle) {
  if (scene_[handle].type != TextureType::checkerboard) return handle;
  if (const auto known = exchanged_.find(handle.index); known != exchanged_.end()) {
    return known->second;
  }
  Texture exchanged = scene_[handle];
  std::swap(exchanged.a, exchanged.b);
  const TextureHandle result = add(std::move(exchanged));
  exchanged_.emplace(handle.index, result);
  return result;
}

}  // namespace lobelia::io::mitsuba

// The tables follow the manuals of Mitsuba 0.6 and Mitsuba 3 (scene format).

#include "lobelia/io/mitsuba/tags.h"

namespace lobelia::io::mitsuba {

const std::vector<Tag>& knownTags() {
  static const std::vector<std::string> object{"type", "id", "name", "version"};
  static const std::vector<Tag> tags{
      {"scene", true, {"version", "type", "id", "name"}},
      {"bsdf", true, object},
      {"texture", true, object},
      {"emitter", true, object},
      {"shape", true, object},
      {"sensor", true, object},
      {"film", true, object},
      {"sampler", true, object},
      {"integrator", true, object},
      {"rfilter", true, object},
      {"medium", true, object},
      {"phase", true, object},
      {"volume", true, object},
      {"subsurface", true, object},
      {"boolean", false, {"name", "value"}},
      {"integer", false, {"name", "value"}},
      {"float", false, {"name", "value"}},
      {"string", false, {"name", "value"}},
      {"point", false, {"name", "value", "x", "y", "z"}},
      {"vector", false, {"name", "value", "x", "y", "z"}},
      {"rgb", false, {"name", "value", "intent"}},
      {"srgb", false, {"name", "value", "intent"}},
      {"spectrum", false, {"name", "value", "filename", "type", "id", "intent"}},
      {"blackbody", false, {"name", "temperature", "scale"}},
      {"transform", false, {"name", "id", "time"}},
      {"animation", false, {"name", "id"}},
      {"translate", false, {"value", "x", "y", "z"}},
      {"scale", false, {"value", "x", "y", "z"}},
      {"rotate", false, {"angle", "value", "x", "y", "z"}},
      {"lookat", false, {"origin", "target", "up"}},
      {"matrix", false, {"value"}},
      {"ref", false, {"id", "name"}},
      {"include", false, {"filename"}},
      {"default", false, {"name", "value"}},
      {"alias", false, {"id", "as"}},
      {"path", false, {"value"}},
  };
  return tags;
}

const Tag* findTag(std::string_view name) {
  for (const Tag& tag : knownTags()) {
    if (name == tag.name) return &tag;
  }
  return nullptr;
}

std::string normalTag(std::string_view tag) {
  if (tag == "lookAt") return "lookat";
  if (tag == "luminaire") return "emitter";  // before 0.4
  if (tag == "camera") return "sensor";
  return std::string(tag);
}

}  // namespace lobelia::io::mitsuba

// Changes to a scene that has been read (io/design.h). Objects are read into the scene as they
// always are, and then take the places of those that they replace: handles stay valid.
#include "lobelia/io/design.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/io/mitsuba/reader.h"
#include "lobelia/io/mitsuba/writer.h"

namespace lobelia::io {
namespace mitsuba {
namespace {

template <class T>
std::vector<std::string> namesOf(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items)
    if (!item.name.empty() && std::find(names.begin(), names.end(), item.name) == names.end())
      names.push_back(item.name);
  return names;
}

template <class T>
std::string nearest(const std::string& name, const std::vector<T>& items) {
  const std::vector<std::string> names = namesOf(items);
  const std::string hint = suggestion(name, names);
  if (!hint.empty()) return hint;
  if (names.empty()) return "; none of them has a name";
  constexpr size_t kShown = 12;
  std::string list;
  for (size_t i = 0; i < std::min(names.size(), kShown); ++i)
    list += (i == 0 ? "" : ", ") + names[i];
  return "; there are " + list + (names.size() > kShown ? "..." : "");
}

// Is this what an id names? Also as the scene is called when it is written as a file.
bool isCalled(const std::string& name, const std::string& id) {
  return !name.empty() && (name == id || cleanName(name) == id);
}

// Do lights of these types exclude each other?
bool sameRole(EmitterType a, EmitterType b) {
  const auto surrounding = [](EmitterType t) {
    return t == EmitterType::constant || t == EmitterType::environment;
  };
  return (surrounding(a) && surrounding(b)) || (a == EmitterType::sun && b == EmitterType::sun);
}

}  // namespace

void Reader::change() {
  Object root = open(document_.scene);
  for (const char* tag : {"shape", "integrator"})
    for (const Element* e : root.nested(tag))
      throw InputError(e->where, fmt::format("a design has no <{}>; it changes materials, emitters "
                                             "and sensors of a scene",
                                             tag));
  for (const Element* e : root.nested("texture")) texture(*e);
  changeMaterials(root.nested("bsdf"));
  for (const Element* e : root.nested("emitter")) changeEmitter(*e);
  for (const Element* e : root.nested("sensor")) changeSensor(*e);
  root.finish();
}

void Reader::changeMaterials(const std::vector<const Element*>& elements) {
  const std::vector<Material> before = scene_.materials;
  for (const Element* e : elements) {
    const std::string name = e->valueOr("id", "");
    if (name.empty())
      throw InputError(e->where, "the <bsdf> has no id; it names the material that it replaces");
    const MaterialHandle changed = material(*e);
    bool found = false;
    for (size_t i = 0; i < before.size(); ++i) {
      if (!isCalled(before[i].name, name)) continue;
      found = true;
      scene_.materials[i] = scene_[changed];
      scene_.materials[i].name = before[i].name;
    }
    if (!found)
      throw InputError(
          e->where, fmt::format("the scene has no material '{}'{}", name, nearest(name, before)));
  }
}

void Reader::changeEmitter(const Element& element) {
  std::vector<Emitter> before = std::move(scene_.emitters);
  scene_.emitters.clear();
  const bool area = open(element).type() == "area";
  if (area) {
    areaEmitter(element);
  } else {
    emitter(element);
  }
  for (Emitter& changed : scene_.emitters) {
    const auto target = std::find_if(before.begin(), before.end(), [&](const Emitter& e) {
      return sameRole(e.type, changed.type) || isCalled(e.name, changed.name);
    });
    const bool onSurface = target != before.end() && target->type == EmitterType::area;
    if (area && !onSurface)
      throw InputError(element.where, fmt::format("the scene has no area emitter '{}'{}; a design "
                                                  "cannot make surfaces shine that do not",
                                                  changed.name, nearest(changed.name, before)));
    if (!area && onSurface)
      throw InputError(element.where, fmt::format("'{}' is an area emitter of the scene; only one "
                                                  "of type area can take its place",
                                                  changed.name));
    if (target == before.end()) {
      before.push_back(std::move(changed));
    } else {
      *target = std::move(changed);
    }
  }
  scene_.emitters = std::move(before);
}

void Reader::changeSensor(const Element& element) {
  std::vector<Camera> before = std::move(scene_.cameras);
  scene_.cameras.clear();
  const std::string name = element.valueOr("id", "");
  auto target = std::find_if(before.begin(), before.end(),
                             [&](const Camera& c) { return isCalled(c.name, name); });
  if (!before.empty()) film_ = target != before.end() ? *target : before.front();
  sensor(element);
  if (target == before.end()) target = before.insert(before.begin(), Camera{});
  *target = std::move(scene_.cameras.front());
  scene_.cameras = std::move(before);
}

}  // namespace mitsuba

void applyDesign(const std::string& file, const ReadSettings& settings, Scene& scene,
                 Context& context) {
  Findings findings(scene.findings, settings.strict);
  const mitsuba::Document document = mitsuba::loadDocument(file, settings.definitions, findings);
  mitsuba::Reader(document, scene, settings.time, findings, context).change();
}

}  // namespace lobelia::io

// Changes to a scene that has been read (io/design.h). Objects are read into the scene as they
// always are, and then take the places of those that they replace: handles stay valid.
#include "lobelia/io/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "lobelia/io/mitsuba/design_names.h"
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
  if (names.empty()) return items.empty() ? "; it has none" : "; none of them has a name";
  constexpr size_t kShown = 12;
  std::string list;
  for (size_t i = 0; i < std::min(names.size(), kShown); ++i)
    list += (i == 0 ? "" : ", ") + names[i];
  return "; there are " + list + (names.size() > kShown ? "..." : "");
}

// Of plugins: is there one such emitter in a scene?
bool isSurrounding(const std::string& type) {
  return type == "constant" || type == "envmap" || type == "sky" || type == "sunsky";
}
bool isSurrounding(EmitterType type) {
  return type == EmitterType::constant || type == EmitterType::environment;
}

std::vector<Emitter> areaEmittersOf(const std::vector<Emitter>& emitters) {
  std::vector<Emitter> of;
  std::copy_if(emitters.begin(), emitters.end(), std::back_inserter(of),
               [](const Emitter& e) { return e.type == EmitterType::area; });
  return of;
}

// The emitter whose place a changed one takes: what its id says by place; environments and suns
// that of their role, whatever it is called; others that of their name.
std::vector<Emitter>::iterator targetOf(const Emitter& changed, std::vector<Emitter>* emitters) {
  const bool surrounding = isSurrounding(changed.type), sun = changed.type == EmitterType::sun;
  const std::vector<size_t> named = namedInDesign(*emitters, changed.name);
  const auto at = [&](size_t i) { return emitters->begin() + static_cast<ptrdiff_t>(i); };
  if (!named.empty() &&
      (changed.name == placeName("emitter", named.front()) || !(surrounding || sun)))
    return at(named.front());
  return std::find_if(emitters->begin(), emitters->end(), [&](const Emitter& e) {
    return surrounding ? isSurrounding(e.type) : sun && e.type == EmitterType::sun;
  });
}

// Materials of the scene as something that references can name.
std::vector<Element> addMaterials(const Scene& scene, Document& document) {
  const std::vector<std::string> names = designNames(scene.materials);
  std::vector<Element> elements(names.size());
  for (size_t i = 0; i < names.size(); ++i) {
    elements[i].tag = "bsdf";
    document.byId.emplace(names[i], &elements[i]);
  }
  return elements;
}

}  // namespace

DesignParts Reader::change() {
  Object root = open(document_.scene);
  for (const char* tag : {"shape", "integrator"})
    for (const Element* e : root.nested(tag))
      throw InputError(e->where, fmt::format("a design has no <{}>; it changes materials, emitters "
                                             "and sensors of a scene",
                                             tag));
  for (const Element* e : root.nested("texture")) texture(*e);
  const auto materials = root.nested("bsdf"), emitters = root.nested("emitter"),
             sensors = root.nested("sensor");
  changeMaterials(materials);
  const Element* surrounding = nullptr;
  for (const Element* e : emitters) {
    if (isSurrounding(open(*e).type())) {
      const std::string id = e->valueOr("id", "");
      const auto named = namedInDesign(scene_.emitters, id);
      if (!named.empty() && id == placeName("emitter", named.front())) {
        changeEmitter(*e);
        continue;
      }
      if (surrounding != nullptr)
        throw InputError(e->where, "this is a second environment; a design can have one");
      surrounding = e;
    }
    changeEmitter(*e);
  }
  for (const Element* e : sensors) changeSensor(*e);
  root.finish();
  return {!materials.empty(), !emitters.empty(), !sensors.empty()};
}

void Reader::changeMaterials(const std::vector<const Element*>& elements) {
  const std::vector<Material> before = scene_.materials;
  std::map<uint32_t, uint32_t> places;  // of the scene that new ones have taken
  for (const Element* e : elements) {
    const std::string name = e->valueOr("id", "");
    if (name.empty())
      throw InputError(e->where, "the <bsdf> has no id; it names the material that it replaces");
    const MaterialHandle changed = material(*e);
    const std::vector<size_t> named = namedInDesign(before, name);
    for (const size_t i : named) {
      scene_.materials[i] = scene_[changed];
      scene_.materials[i].name = before[i].name;
    }
    if (named.empty())
      throw InputError(
          e->where, fmt::format("the scene has no material '{}'{}", name, nearest(name, before)));
    places.emplace(changed.index, static_cast<uint32_t>(named.front()));
  }
  // What wraps a changed one wraps the scene's, which later changes find.
  for (Material& m : scene_.materials)
    for (MaterialHandle* h : {&m.a, &m.b})
      if (const auto place = places.find(h->index); place != places.end()) h->index = place->second;
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
    const auto target = targetOf(changed, &before);
    const bool onSurface = target != before.end() && target->type == EmitterType::area;
    if (area && !onSurface)
      throw InputError(element.where,
                       fmt::format("the scene has no area emitter '{}'{}; a design "
                                   "cannot make surfaces shine that do not",
                                   changed.name, nearest(changed.name, areaEmittersOf(before))));
    if (!area && onSurface)
      throw InputError(element.where, fmt::format("'{}' is an area emitter of the scene; only one "
                                                  "of type area can take its place",
                                                  changed.name));
    if (target == before.end()) {
      before.push_back(std::move(changed));
    } else {
      if (changed.name == placeName("emitter", static_cast<size_t>(target - before.begin())))
        changed.name = target->name;
      *target = std::move(changed);
    }
  }
  scene_.emitters = std::move(before);
}

void Reader::changeSensor(const Element& element) {
  std::vector<Camera> before = std::move(scene_.cameras);
  scene_.cameras.clear();
  const std::string name = element.valueOr("id", "");
  const std::vector<size_t> named = namedInDesign(before, name);
  auto target =
      named.empty() ? before.end() : before.begin() + static_cast<ptrdiff_t>(named.front());
  const std::string known = named.empty() ? name : target->name;
  if (!before.empty()) film_ = target != before.end() ? *target : before.front();
  sensor(element);
  if (target == before.end()) target = before.insert(before.begin(), Camera{});
  *target = std::move(scene_.cameras.front());
  target->name = known;
  scene_.cameras = std::move(before);
}

}  // namespace mitsuba

DesignParts applyDesign(const std::string& file, const ReadSettings& settings, Scene& scene,
                        Context& context) {
  Findings findings(scene.findings, settings.strict);
  mitsuba::Document document = mitsuba::loadDocument(file, settings.definitions, findings);
  const std::vector<mitsuba::Element> materials = mitsuba::addMaterials(scene, document);
  mitsuba::Reader reader(document, scene, settings.time, findings, context);
  for (uint32_t i = 0; i < materials.size(); ++i) reader.know(materials[i], {i});
  return reader.change();
}

}  // namespace lobelia::io

#include "lobelia/io/mitsuba/design_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "lobelia/io/mitsuba/writer.h"

namespace lobelia::io {
namespace mitsuba {

std::string placeName(const char* kind, size_t index) { return fmt::format("{}[{}]", kind, index); }

}  // namespace mitsuba

namespace {

// Also as the scene is called when it is written as a file.
bool isCalled(const std::string& name, const std::string& id) {
  return !name.empty() && !id.empty() && (name == id || mitsuba::cleanName(name) == id);
}

template <class T>
std::vector<size_t> named(const std::vector<T>& items, const char* kind, const std::string& id) {
  std::vector<size_t> out;
  for (size_t i = 0; i < items.size(); ++i)
    if (isCalled(items[i].name, id)) out.push_back(i);
  if (!out.empty() || !id.starts_with(kind)) return out;
  for (size_t i = 0; i < items.size(); ++i)
    if (mitsuba::placeName(kind, i) == id) return {i};
  return {};
}

// In an attribute of a file: no character that means something there or cannot stand there.
bool isWritable(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' || c == '$';
  });
}

template <class T>
std::vector<std::string> namesOf(const std::vector<T>& items, const char* kind) {
  std::unordered_map<std::string, size_t> called;  // how many
  for (const T& item : items) {
    if (item.name.empty()) continue;
    ++called[item.name];
    if (const std::string clean = mitsuba::cleanName(item.name); clean != item.name)
      ++called[clean];
  }
  std::vector<std::string> names;
  for (size_t i = 0; i < items.size(); ++i) {
    const std::string& name = items[i].name;
    names.push_back(isWritable(name) && called[name] == 1 ? name : mitsuba::placeName(kind, i));
  }
  return names;
}

}  // namespace

std::vector<std::string> designNames(const std::vector<Material>& materials) {
  return namesOf(materials, "material");
}
std::vector<std::string> designNames(const std::vector<Emitter>& emitters) {
  return namesOf(emitters, "emitter");
}
std::string designName(const std::vector<Material>& materials, size_t index) {
  return designNames(materials)[index];
}
std::string designName(const std::vector<Emitter>& emitters, size_t index) {
  return designNames(emitters)[index];
}
std::vector<size_t> namedInDesign(const std::vector<Material>& materials, const std::string& id) {
  return named(materials, "material", id);
}
std::vector<size_t> namedInDesign(const std::vector<Emitter>& emitters, const std::string& id) {
  return named(emitters, "emitter", id);
}
std::vector<size_t> namedInDesign(const std::vector<Camera>& cameras, const std::string& id) {
  return named(cameras, "camera", id);
}

}  // namespace lobelia::io

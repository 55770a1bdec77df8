#include "lobelia/io/mitsuba/design_names.h"

#include <fmt/format.h>

#include <algorithm>

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
std::string nameOf(const std::vector<T>& items, const char* kind, size_t index) {
  const std::string& name = items[index].name;
  return isWritable(name) && named(items, kind, name).size() == 1 ? name
                                                                  : mitsuba::placeName(kind, index);
}

}  // namespace

std::string designName(const std::vector<Material>& materials, size_t index) {
  return nameOf(materials, "material", index);
}
std::string designName(const std::vector<Emitter>& emitters, size_t index) {
  return nameOf(emitters, "emitter", index);
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

// A value of a JSON document together with its path ("meshes[3].primitives[0].mode"), which every
// message names. Missing members are values too, so that paths can be written as a chain; only
// reading one without a fallback is an error.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/base/error.h"
#include "lobelia/base/vec.h"

namespace lobelia::io::gltf {

class Json {
 public:
  // `file` must outlive the value.
  Json(const nlohmann::json* value, std::string path, const std::string& file)
      : value_(value), path_(std::move(path)), file_(&file) {}

  bool exists() const { return value_ != nullptr; }
  bool isObject() const;
  bool isArray() const;
  const std::string& path() const { return path_; }
  Location where() const { return {*file_ + (path_.empty() ? "" : ": ") + path_, 0, 0}; }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(where(), message); }

  Json operator[](std::string_view member) const;  // an object's member; missing of a missing one
  Json at(size_t i) const;                         // an array's item; must be there
  size_t size() const;                             // of an array; 0 of a missing one
  std::vector<std::string> members() const;        // of an object; none of a missing one
  Json extension(std::string_view name) const { return (*this)["extensions"][name]; }

  bool boolean(bool fallback) const;
  double number() const;
  double number(double fallback) const { return exists() ? number() : fallback; }
  double numberWithin(double least, double most, double fallback) const;
  uint64_t count() const;  // an integer, not negative
  uint64_t count(uint64_t fallback) const { return exists() ? count() : fallback; }
  // The index of one of `size` items, which `what` names: "accessors".
  size_t index(size_t size, std::string_view what) const;
  std::string text() const;
  std::string text(std::string_view fallback) const {
    return exists() ? text() : std::string(fallback);
  }
  // An array of exactly n numbers.
  std::vector<double> numbers(size_t n) const;
  Vec3f vector(Vec3f fallback) const;

 private:
  const char* typeName() const;
  const nlohmann::json* value_;
  std::string path_;
  const std::string* file_;
};

}  // namespace lobelia::io::gltf

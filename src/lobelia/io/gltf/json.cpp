#include "lobelia/io/gltf/json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace lobelia::io::gltf {

const char* Json::typeName() const { return exists() ? value_->type_name() : "missing"; }

bool Json::isObject() const { return exists() && value_->is_object(); }
bool Json::isArray() const { return exists() && value_->is_array(); }

Json Json::operator[](std::string_view member) const {
  std::string path = path_;
  if (!path.empty()) path += '.';
  path += member;
  if (!exists()) return {nullptr, std::move(path), *file_};
  if (!value_->is_object()) fail(fmt::format("is of type {}; it must be an object", typeName()));
  const auto found = value_->find(member);
  return {found == value_->end() ? nullptr : &*found, std::move(path), *file_};
}

size_t Json::size() const {
  if (!exists()) return 0;
  if (!value_->is_array()) fail(fmt::format("is of type {}; it must be an array", typeName()));
  return value_->size();
}

Json Json::at(size_t i) const {
  const size_t n = size();
  if (i >= n) fail(fmt::format("there is no item {}; the array has {}", i, n));
  return {&(*value_)[i], fmt::format("{}[{}]", path_, i), *file_};
}

std::vector<std::string> Json::members() const {
  std::vector<std::string> names;
  if (!exists()) return names;
  if (!value_->is_object()) fail(fmt::format("is of type {}; it must be an object", typeName()));
  for (const auto& item : value_->items()) names.push_back(item.key());
  return names;
}

bool Json::boolean(bool fallback) const {
  if (!exists()) return fallback;
  if (!value_->is_boolean())
    fail(fmt::format("is of type {}; it must be true or false", typeName()));
  return value_->get<bool>();
}

double Json::number() const {
  if (!exists()) fail("is missing; it must be a number");
  if (!value_->is_number()) fail(fmt::format("is of type {}; it must be a number", typeName()));
  const double number = value_->get<double>();
  // Numbers that a float cannot hold would become infinite later.
  if (!(std::abs(number) <= 3.4e38)) fail("is too large; it must fit a 32-bit float");
  return number;
}

double Json::numberWithin(double least, double most, double fallback) const {
  const double value = number(fallback);
  if (!(value >= least && value <= most))
    fail(fmt::format("is {}; it must be from {} to {}", value, least, most));
  return value;
}

uint64_t Json::count() const {
  const double value = number();
  if (!(value >= 0) || value > 9e15 || value != std::floor(value))
    fail(fmt::format("is {}; it must be an integer, 0 or more", value));
  return static_cast<uint64_t>(value);
}

size_t Json::index(size_t size, std::string_view what) const {
  const uint64_t i = count();
  if (i >= size)
    fail(fmt::format("{} is out of range; there are {} {} (counted from 0)", i, size, what));
  return static_cast<size_t>(i);
}

std::string Json::text() const {
  if (!exists()) fail("is missing; it must be a string");
  if (!value_->is_string()) fail(fmt::format("is of type {}; it must be a string", typeName()));
  return value_->get<std::string>();
}

std::vector<double> Json::numbers(size_t n) const {
  if (size() != n) fail(fmt::format("has {} items; it must be an array of {} numbers", size(), n));
  std::vector<double> values;
  for (size_t i = 0; i < n; ++i) values.push_back(at(i).number());
  return values;
}

Vec3f Json::vector(Vec3f fallback) const {
  if (!exists()) return fallback;
  const std::vector<double> v = numbers(3);
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace lobelia::io::gltf

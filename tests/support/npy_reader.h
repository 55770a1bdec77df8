// Reads arrays that io/npy.h has written, by the format's rules and not by the writer's habits.
#pragma once

#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace lobelia::test {

struct NpyArray {
  std::string type;
  std::vector<size_t> shape;
  size_t headerBytes = 0;
  std::string bytes;  // of the values

  size_t size() const {
    size_t count = 1;
    for (const size_t side : shape) count *= side;
    return count;
  }
  template <class T>
  std::vector<T> values() const {
    std::vector<T> out(size());
    if (bytes.size() != out.size() * sizeof(T)) throw std::runtime_error("NPY: size of values");
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
};

inline NpyArray readNpy(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(in), {}};
  if (all.size() < 10 || all.substr(0, 8) != std::string("\x93NUMPY\x01\x00", 8))
    throw std::runtime_error(file + ": not NPY 1.0");
  const auto byte = [&](size_t i) {
    return static_cast<size_t>(static_cast<unsigned char>(all[i]));
  };
  NpyArray out;
  out.headerBytes = 10 + byte(8) + 256 * byte(9);
  const std::string header = all.substr(10, out.headerBytes - 10);
  std::smatch found;
  const std::regex form(
      R"(\{'descr': '([<>|][fiu]\d)', 'fortran_order': False, 'shape': \(([0-9, ]*)\), \} *\n)");
  if (!std::regex_match(header, found, form)) throw std::runtime_error(file + ": " + header);
  out.type = found[1];
  const std::string sides = found[2];
  const std::regex number("[0-9]+");
  for (std::sregex_iterator it(sides.begin(), sides.end(), number), end; it != end; ++it)
    out.shape.push_back(std::stoul(it->str()));
  out.bytes = all.substr(out.headerBytes);
  return out;
}

}  // namespace lobelia::test

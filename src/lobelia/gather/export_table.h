// Tables of named columns of numbers: what strategies hand out of their trees and cuts for research
// (--export-trees). How they are written is the application's affair.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::gather {

struct ExportColumn {
  std::string name, meaning;
  char kind = 'f';        // floating; 'i', 'u': integer, with and without sign
  size_t components = 1;  // numbers of a row, four bytes each
  std::vector<std::byte> values;
};

struct ExportTable {
  std::string name, meaning;
  size_t rows = 0;
  std::vector<ExportColumn> columns;

  // value(i), i < rows: a float, an int32_t, a uint32_t, or a vector of floats.
  template <class F>
  void add(const std::string& column, const std::string& text, const F& value) {
    using Value = std::decay_t<decltype(value(size_t{0}))>;
    static_assert(std::is_same_v<Value, float> || std::is_same_v<Value, int32_t> ||
                  std::is_same_v<Value, uint32_t> || std::is_same_v<Value, Vec3f>);
    ExportColumn& out = columns.emplace_back();
    out.name = column, out.meaning = text;
    out.kind = std::is_same_v<Value, int32_t> ? 'i' : std::is_same_v<Value, uint32_t> ? 'u' : 'f';
    out.components = sizeof(Value) / 4;
    out.values.resize(rows * sizeof(Value));
    for (size_t i = 0; i < rows; ++i) {
      const Value v = value(i);
      std::memcpy(out.values.data() + i * sizeof(Value), &v, sizeof(Value));
    }
  }
};

}  // namespace lobelia::gather

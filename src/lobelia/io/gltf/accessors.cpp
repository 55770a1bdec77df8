// Accessors, dense and sparse (glTF 2.0, 3.6.2). Matrices of 8- and 16-bit components, whose
// columns are padded, are not used by anything that is read, and refused.
#include "lobelia/io/gltf/accessors.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace lobelia::io::gltf {
namespace {

// Elements of an accessor without data (all zeros), which costs a file nothing to state.
constexpr uint64_t kMaxZeros = 1u << 24;

enum class Component : uint16_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

Component componentType(const Json& where) {
  const uint64_t type = where.count();
  if (type < 5120 || type > 5126 || type == 5124)
    where.fail(fmt::format("is {}; it must be 5120 to 5123, 5125 or 5126", type));
  return static_cast<Component>(type);
}

size_t sizeOf(Component c) {
  switch (c) {
    case Component::int8:
    case Component::uint8:
      return 1;
    case Component::int16:
    case Component::uint16:
      return 2;
    case Component::uint32:
    case Component::float32:
      break;
  }
  return 4;
}

template <class T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

// glTF 2.0, 3.6.2.2 and KHR_mesh_quantization: what normalised integers stand for.
double decode(const std::byte* at, Component c, bool normalized) {
  switch (c) {
    case Component::int8: {
      const double v = load<int8_t>(at);
      return normalized ? std::max(v / 127, -1.0) : v;
    }
    case Component::uint8: {
      const double v = load<uint8_t>(at);
      return normalized ? v / 255 : v;
    }
    case Component::int16: {
      const double v = load<int16_t>(at);
      return normalized ? std::max(v / 32767, -1.0) : v;
    }
    case Component::uint16: {
      const double v = load<uint16_t>(at);
      return normalized ? v / 65535 : v;
    }
    case Component::uint32: {
      const double v = load<uint32_t>(at);
      return normalized ? v / 4294967295.0 : v;
    }
    case Component::float32:
      return static_cast<double>(load<float>(at));
  }
  return 0;
}

// A checked run of elements in a view.
struct Run {
  Bytes bytes;
  size_t stride = 0;
  Component component = Component::float32;
  size_t components = 1;
  const std::byte* element(size_t i) const { return bytes.data() + i * stride; }
};

Run checkedRun(Document& document, const Json& where, Component component, size_t components,
               uint64_t count) {
  const BufferView view = document.view(where["bufferView"]);
  const uint64_t offset = where["byteOffset"].count(0);
  const size_t element = sizeOf(component) * components;
  const size_t stride = view.stride > 0 ? view.stride : element;
  if (stride < element)
    where["bufferView"].fail(
        fmt::format("its byteStride is {}; elements take {} bytes", stride, element));
  const uint64_t available = view.bytes.size();
  const bool fits =
      offset <= available && (count == 0 || (available - offset >= element &&
                                             (available - offset - element) / stride >= count - 1));
  if (!fits)
    where.fail(
        fmt::format("{} elements of {} bytes (stride {}) from byte {} on need more than "
                    "the {} bytes of the buffer view",
                    count, element, stride, offset, available));
  return {view.bytes.subspan(static_cast<size_t>(offset)), stride, component, components};
}

// Calls store(i, c, value) for each component of each element that the accessor gives.
template <class Store>
void forEachValue(const Run& run, size_t count, bool normalized, const Store& store) {
  const size_t step = sizeOf(run.component);
  for (size_t i = 0; i < count; ++i) {
    const std::byte* const at = run.element(i);
    for (size_t c = 0; c < run.components; ++c)
      store(i, c, decode(at + c * step, run.component, normalized));
  }
}

struct Layout {
  Json where;
  Component component;
  size_t components;
  size_t count;
  bool normalized;
};

Layout layoutOf(const Document& document, const Json& index, std::string_view types) {
  const Json where = document.item("accessors", index);
  const std::string type = where["type"].text();
  // Whole words of `types`.
  bool allowed = false;
  for (size_t at = types.find(type); !type.empty() && at != types.npos && !allowed;
       at = types.find(type, at + 1)) {
    const size_t end = at + type.size();
    allowed = (at == 0 || types[at - 1] == ' ') && (end == types.size() || types[end] == ' ');
  }
  if (!allowed)
    index.fail(fmt::format("{} is of type {}; it must be {}", where.path(), type, types));
  const Component component = componentType(where["componentType"]);
  const size_t components = componentCount(where);
  if (type.starts_with("MAT") && sizeOf(component) != 4)
    where["componentType"].fail("matrices are read as floats only");
  return {where, component, components, static_cast<size_t>(where["count"].count()),
          where["normalized"].boolean(false)};
}

template <class Allocate, class Store>
void readValues(Document& document, const Layout& layout, const Allocate& allocate,
                const Store& store) {
  const Json& where = layout.where;
  if (where["bufferView"].exists()) {
    const Run run = checkedRun(document, where, layout.component, layout.components, layout.count);
    allocate(layout.count * layout.components);
    forEachValue(run, layout.count, layout.normalized, store);
  } else {
    if (layout.count > kMaxZeros)
      where["count"].fail(
          fmt::format("is {}; without a bufferView at most {} are read", layout.count, kMaxZeros));
    allocate(layout.count * layout.components);
  }
  const Json sparse = where["sparse"];
  if (!sparse.exists()) return;
  const size_t count = sparse["count"].index(layout.count + 1, "elements (and one)");
  const Json indices = sparse["indices"], values = sparse["values"];
  const Component component = componentType(indices["componentType"]);
  if (component != Component::uint8 && component != Component::uint16 &&
      component != Component::uint32)
    indices["componentType"].fail("must be an unsigned integer: 5121, 5123 or 5125");
  const Run indexRun = checkedRun(document, indices, component, 1, count);
  const Run valueRun = checkedRun(document, values, layout.component, layout.components, count);
  std::vector<size_t> targets(count);
  forEachValue(indexRun, count, false, [&](size_t i, size_t, double v) {
    if (v >= static_cast<double>(layout.count))
      indices.fail(
          fmt::format("index {} replaces element {}; the accessor has {}", i, v, layout.count));
    targets[i] = static_cast<size_t>(v);
  });
  forEachValue(valueRun, count, layout.normalized,
               [&](size_t i, size_t c, double v) { store(targets[i], c, v); });
}

}  // namespace

size_t componentCount(const Json& accessor) {
  const std::string type = accessor["type"].text();
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  accessor["type"].fail(
      fmt::format("'{}' is unknown; it must be SCALAR, VEC2 to VEC4 or MAT2 to MAT4{}", type,
                  suggestion(type, {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})));
}

FloatArray readFloats(Document& document, const Json& index, std::string_view types) {
  const Layout layout = layoutOf(document, index, types);
  FloatArray out;
  out.count = layout.count, out.components = layout.components;
  readValues(
      document, layout, [&](size_t n) { out.values.resize(n); },
      [&](size_t i, size_t c, double v) {
        if (!std::isfinite(v))
          layout.where.fail(fmt::format("element {} is not finite; all must be", i));
        out.values[i * out.components + c] = static_cast<float>(v);
      });
  return out;
}

std::vector<uint32_t> readIntegers(Document& document, const Json& index, std::string_view type) {
  const Layout layout = layoutOf(document, index, type);
  if (layout.component != Component::uint8 && layout.component != Component::uint16 &&
      layout.component != Component::uint32)
    layout.where["componentType"].fail("must be an unsigned integer: 5121, 5123 or 5125");
  std::vector<uint32_t> out;
  readValues(
      document, layout, [&](size_t n) { out.resize(n); },
      [&](size_t i, size_t c, double v) {
        out[i * layout.components + c] = static_cast<uint32_t>(v);
      });
  return out;
}

}  // namespace lobelia::io::gltf

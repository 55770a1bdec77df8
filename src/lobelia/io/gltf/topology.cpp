#include "lobelia/io/gltf/topology.h"

#include <fmt/format.h>

namespace lobelia::io::gltf {
namespace {

enum Mode : uint64_t { points, lines, lineLoop, lineStrip, triangles, triangleStrip, triangleFan };

}  // namespace

std::vector<Vec3u> trianglesOf(const Import& import, const Json& primitive,
                               const std::vector<uint32_t>& indices, bool areFaces) {
  const uint64_t mode = primitive["mode"].count(triangles);
  if (mode > triangleFan) primitive["mode"].fail(fmt::format("is {}; it must be 0 to 6", mode));
  std::vector<Vec3u> out;
  if (mode < triangles) {
    import.warn(primitive["mode"],
                fmt::format("a primitive of {} is left out: only triangles are rendered",
                            mode == points ? "points" : "lines"));
    return out;
  }
  const size_t n = indices.size();
  if (mode == triangles || areFaces) {
    if (n % 3 != 0)
      import.warn(primitive, fmt::format("{} corners do not make triangles; the last {} are left "
                                         "out",
                                         n, n % 3));
    out.reserve(n / 3);
    for (size_t i = 0; i + 2 < n; i += 3)
      out.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return out;
  }
  for (size_t i = 0; i + 2 < n; ++i) {
    Vec3u t{indices[i], indices[i + 1], indices[i + 2]};
    if (mode == triangleFan) {
      t = {indices[i + 1], indices[i + 2], indices[0]};
    } else if (i % 2 == 1) {
      t = {t.x, t.z, t.y};
    }
    if (t.x != t.y && t.y != t.z && t.x != t.z) out.push_back(t);
  }
  return out;
}

}  // namespace lobelia::io::gltf

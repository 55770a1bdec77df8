// EXT_meshopt_compression: modes ATTRIBUTES, TRIANGLES, INDICES; filters OCTAHEDRAL, QUATERNION,
// EXPONENTIAL (Khronos vendor extension, "Specifying compressed views"). meshoptimizer decodes.
#include <fmt/format.h>
#include <meshoptimizer.h>

#include "lobelia/io/gltf/document.h"

namespace lobelia::io::gltf {
namespace {

void applyFilter(const Json& extension, std::byte* data, size_t count, size_t stride) {
  const std::string filter = extension["filter"].text("NONE");
  const auto requireStride = [&](bool good, const char* which) {
    if (!good)
      extension["byteStride"].fail(fmt::format("is {}; filter {} needs {}", stride, filter, which));
  };
  if (filter == "NONE") return;
  if (filter == "OCTAHEDRAL") {
    requireStride(stride == 4 || stride == 8, "4 or 8");
    meshopt_decodeFilterOct(data, count, stride);
  } else if (filter == "QUATERNION") {
    requireStride(stride == 8, "8");
    meshopt_decodeFilterQuat(data, count, stride);
  } else if (filter == "EXPONENTIAL") {
    requireStride(stride % 4 == 0, "a multiple of 4");
    meshopt_decodeFilterExp(data, count, stride);
  } else {
    extension["filter"].fail(fmt::format(
        "'{}' is unknown; it must be NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL{}", filter,
        suggestion(filter, {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})));
  }
}

}  // namespace

std::vector<std::byte> decodeMeshopt(const Json& extension, Bytes compressed) {
  const std::string mode = extension["mode"].text();
  const uint64_t count = extension["count"].count(), stride = extension["byteStride"].count();
  const auto* data = reinterpret_cast<const unsigned char*>(compressed.data());
  const bool vertices = mode == "ATTRIBUTES";
  if (!vertices && mode != "TRIANGLES" && mode != "INDICES")
    extension["mode"].fail(
        fmt::format("'{}' is unknown; it must be ATTRIBUTES, TRIANGLES or INDICES", mode));
  if (vertices ? stride < 4 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
    extension["byteStride"].fail(fmt::format("is {}; it must be {}", stride,
                                             vertices ? "a multiple of 4 up to 256" : "2 or 4"));
  // The densest codes: two bits for 16 bytes of vertices, a byte for a triangle or for an index.
  const uint64_t most = vertices            ? compressed.size() * 64 / stride + 256
                        : mode == "INDICES" ? compressed.size()
                                            : compressed.size() * 3;
  if (count > most)
    extension["count"].fail(
        fmt::format("is {}; {} compressed bytes cannot hold that many", count, compressed.size()));
  if (mode == "TRIANGLES" && count % 3 != 0)
    extension["count"].fail(fmt::format("is {}; it must be a multiple of 3", count));
  const auto n = static_cast<size_t>(count), size = static_cast<size_t>(stride);
  std::vector<std::byte> out(n * size);
  int failed = 0;
  if (n > 0) {
    if (vertices) {
      failed = meshopt_decodeVertexBuffer(out.data(), n, size, data, compressed.size());
    } else if (mode == "TRIANGLES") {
      failed = meshopt_decodeIndexBuffer(out.data(), n, size, data, compressed.size());
    } else {
      failed = meshopt_decodeIndexSequence(out.data(), n, size, data, compressed.size());
    }
  }
  if (failed != 0) extension.fail("the compressed data are damaged");
  if (vertices) applyFilter(extension, out.data(), n, size);
  return out;
}

}  // namespace lobelia::io::gltf

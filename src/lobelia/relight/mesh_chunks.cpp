#include "lobelia/relight/mesh_chunks.h"

#include <algorithm>
#include <stdexcept>

#include "lobelia/base/error.h"

namespace lobelia::relight {
namespace {

// A triangle with children, and where they begin.
struct StoredSplit {
  uint32_t triangle, firstChild, splitEdges;
};

[[noreturn]] void damaged(const std::string& file, const std::string& what) {
  throw InputError({file}, what + "; make it again with `lobelia precompute`");
}

template <class T>
std::span<const T> spanOf(const std::vector<T>& values) {
  return {values.data(), values.size()};
}

}  // namespace

void addMesh(const SampleMesh& mesh, store::Writer* writer) {
  const size_t roots = mesh.firstTriangle().back();
  std::vector<StoredSplit> splits;
  std::vector<std::array<uint32_t, 3>> children;
  for (uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const SampleTriangle& triangle = mesh.triangles()[t];
    if (triangle.splitEdges != 0) splits.push_back({t, triangle.firstChild, triangle.splitEdges});
    if (t >= roots) children.push_back(triangle.vertex);
  }
  writer->add("positions", mesh.positions());
  writer->add("splits", spanOf(splits));
  writer->add("children", spanOf(children));
}

SampleMesh readMesh(const store::Reader& reader, const std::string& file,
                    const SampleMesh& unsplit) {
  const auto positions = reader.get<Vec3f>("positions");
  const auto splits = reader.get<StoredSplit>("splits");
  std::vector<SampleTriangle> triangles(unsplit.triangles().begin(), unsplit.triangles().end());
  for (const auto& vertex : reader.get<std::array<uint32_t, 3>>("children"))
    triangles.push_back({vertex, 0, 0});
  for (const StoredSplit& split : splits) {
    if (split.triangle >= triangles.size()) damaged(file, "a split triangle is not there");
    triangles[split.triangle].firstChild = split.firstChild;
    triangles[split.triangle].splitEdges = split.splitEdges;
  }
  if (!std::all_of(positions.begin(), positions.end(), isFinite))
    damaged(file, "a vertex's place is not finite");
  try {
    return {positions,
            std::move(triangles),
            {unsplit.firstTriangle().begin(), unsplit.firstTriangle().end()}};
  } catch (const std::invalid_argument& e) {
    damaged(file, e.what());
  }
}

}  // namespace lobelia::relight

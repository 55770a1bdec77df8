#include "lobelia/transfer/ray_cells.h"

#include <gtest/gtest.h>

#include "lobelia/relight/visibility_data.h"
#include "lobelia/transfer/gather_block.h"
#include "small_transfer.h"

namespace lobelia::transfer {
namespace {

TEST(RayCells, CoverTheSphereOnce) {
  const GeodesicGrid directions(2);
  const RaySphere fine(4, directions);
  const RayCells cells(fine, directions);
  std::vector<int> seen(fine.grid.count(), 0);
  double sum = 0;
  for (const float s : cells.solidAngle) sum += double{s};
  EXPECT_NEAR(sum, 4 * 3.14159265, 1e-3);
  for (uint32_t i = 0; i < cells.rayOf.size(); ++i) {
    ++seen[cells.rayOf[i]];
    EXPECT_EQ(fine.grid.directions()[cells.rayOf[i]], cells.coarse.grid.directions()[i]);
  }
  for (const RayCells::Middle& m : cells.middles) {
    ++seen[m.ray];
    const Vec3f a = cells.coarse.grid.directions()[m.a], b = cells.coarse.grid.directions()[m.b];
    EXPECT_LT(length(normalize(a + b) - fine.grid.directions()[m.ray]), 1e-5f);
  }
  for (const int count : seen) ASSERT_EQ(count, 1);
}

// The first bounce on a small scene, by rays and by cells of them.
class Bounce {
 public:
  explicit Bounce(const Scene& scene)
      : tracer_(scene, context_),
        data_(precomputeTransfer(tracer_, settings(), context_)),
        spheres_{{RaySphere(5, directions_)}},
        cells_(spheres_[0], directions_),
        tables_(scene),
        lookup_(scene, data_, tables_),
        faces_(scene, data_.mesh.mesh, relight::leafTriangles(data_.mesh.mesh),
               relight::bothSidesOf(scene)) {
    const auto first = data_.mesh.mesh.firstTriangle();
    for (uint32_t i = 0; i + 1 < first.size(); ++i) instanceOf_.resize(first[i + 1], i);
  }

  SliceRows run(bool inCells) {
    const size_t count = data_.mesh.vertices.size();
    const std::vector<uint8_t> raysOf(count, 0);
    const std::vector<const RayCells*> cellsOf(count, inCells ? &cells_ : nullptr);
    const GatherInput input{tracer_, spheres_, raysOf,  cellsOf,     directions_, tables_,
                            data_,   lookup_,  &faces_, instanceOf_, {},          false};
    BlockRays rays;
    BlockPass direct, bounce;
    BlockCounts counts;
    directBlock(input, 0, count, &rays, &direct, &counts);
    bounceBlock(input, 1, rays, &bounce, &counts);
    return bounce.glossy[0];
  }
  size_t vertexCount() const { return data_.mesh.vertices.size(); }
  size_t directionCount() const { return directions_.count(); }

 private:
  static TransferSettings settings() {
    TransferSettings out = test::coarseTransfer();
    out.bounces = 0;
    return out;
  }
  Context context_;
  const Tracer tracer_;
  const GeodesicGrid directions_{2};
  const TransferData data_;
  const std::vector<RaySphere> spheres_;
  const RayCells cells_;
  const ReflectionTables tables_;
  const SliceLookup lookup_;
  const relight::VertexFaces faces_;
  std::vector<uint32_t> instanceOf_;
};

TEST(RayCells, GatherWhatRaysDo) {
  const Scene scene = test::glossyScene();
  Bounce bounce(scene);
  const SliceRows rays = bounce.run(false), cells = bounce.run(true);
  double energy = 0, difference = 0, axes = 0;
  size_t slices = 0;
  for (size_t v = 0; v < bounce.vertexCount(); ++v)
    for (size_t k = 0; k < bounce.directionCount(); ++k) {
      const SliceRecord *a = rays.find(v, k), *b = cells.find(v, k);
      const TransferLobe one = a ? unpack(*a) : TransferLobe{},
                         two = b ? unpack(*b) : TransferLobe{};
      energy += double{luminance(one.share)};
      difference += double{luminance(two.share) - luminance(one.share)};
      axes += double{length(one.r * luminance(one.share) - two.r * luminance(two.share))};
      slices += a ? 1 : 0;
    }
  ASSERT_GT(slices, 500u);
  EXPECT_NEAR(difference / energy, 0, 0.005);
  EXPECT_LT(axes / energy, 0.06);
  EXPECT_GT(axes, 0) << "the two are not the same code";
}

}  // namespace
}  // namespace lobelia::transfer

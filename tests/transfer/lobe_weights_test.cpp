#include "lobelia/transfer/lobe_weights.h"

#include <gtest/gtest.h>

#include <numeric>

#include "bsdf/lobe_examples.h"
#include "lobelia/transfer/geodesic_grid.h"
#include "lobelia/transfer/reflection.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kChunk = relight::kChunk;

std::vector<uint32_t> allChunks(const DirectionChunks& directions) {
  std::vector<uint32_t> chunks(directions.chunkCount());
  std::iota(chunks.begin(), chunks.end(), 0u);
  return chunks;
}

// In the surface's frame and in one that is turned in the world.
std::vector<Bsdf> turnedToo(const Bsdf& bsdf) {
  Bsdf turned = bsdf;
  turned.frames[0] = frameFromNormalTangent(normalize(Vec3f(1, -2, 0.5f)), Vec3f(0.3f, 1, 1));
  turned.baseNormal = turned.ng = turned.frames[0].n;
  return {bsdf, turned};
}

TEST(LobeWeights, AreLuminancesOfTheBsdf) {
  const GeodesicGrid grid(4);
  const DirectionChunks directions(grid.directions());
  const auto chunks = allChunks(directions);
  relight::AlignedFloats out(chunks.size() * kChunk);
  for (const test::Example& example : test::examples())
    for (const Bsdf& bsdf : turnedToo(example.bsdf))
      for (const Bsdf& part : {glossyPart(bsdf), diffusePart(bsdf)})
        for (const Vec3f local : {test::directionAt(0.9f, 0.4f), test::directionAt(0.2f, 2.f),
                                  test::directionAt(-0.5f, 1.f)}) {
          SCOPED_TRACE(example.name);
          const Vec3f wo = bsdf.frames[0].toWorld(local);
          lobeWeights(directions, part, wo, chunks, out.data());
          float peak = 0, worst = 0;
          for (size_t i = 0; i < grid.count(); ++i) {
            const float exact = luminance(evaluate(part, wo, grid.directions()[i]));
            peak = std::max(peak, exact);
            worst = std::max(worst, std::abs(out[i] - exact) / (exact + 1e-3f * peak + 1e-20f));
          }
          EXPECT_LT(worst, 1e-4f);
          for (size_t i = grid.count(); i < out.size(); ++i) EXPECT_EQ(out[i], 0);
        }
}

TEST(LobeWeights, OfChunksInAnyOrder) {
  const GeodesicGrid grid(3);
  const DirectionChunks directions(grid.directions());
  const Bsdf part = test::single(test::simple(LobeType::phong, 5));
  const Vec3f wo = test::directionAt(0.7f, 1.f);
  const auto last = static_cast<uint32_t>(directions.chunkCount() - 1);
  const std::vector<uint32_t> chunks{last, 3, 3, 0};
  relight::AlignedFloats out(chunks.size() * kChunk, -1.f);
  lobeWeights(directions, part, wo, chunks, out.data());
  for (size_t i = 0; i < out.size(); ++i) {
    const size_t at = chunks[i / kChunk] * kChunk + i % kChunk;
    const float exact =
        at < grid.count() ? luminance(evaluate(part, wo, grid.directions()[at])) : 0.f;
    EXPECT_NEAR(out[i], exact, 1e-5f * exact);
  }
}

// Bumps: a frame that leans away from the surface.
TEST(LobeWeights, KnowTheTerminatorOfBumps) {
  const GeodesicGrid grid(4);
  const DirectionChunks directions(grid.directions());
  const auto chunks = allChunks(directions);
  relight::AlignedFloats out(chunks.size() * kChunk);
  Bsdf part = test::single(test::simple(LobeType::phong, 20));
  part.frames[0] = frameFromNormal(normalize(Vec3f(0.5f, 0, 1)));
  part.frames[0].perturbed = true;
  part.frames[0].bumpAlpha2 = 0.03f;
  const Vec3f wo = test::directionAt(0.6f, 0.5f);
  lobeWeights(directions, part, wo, chunks, out.data());
  size_t dark = 0, dimmed = 0;
  for (size_t i = 0; i < grid.count(); ++i) {
    const Vec3f w = grid.directions()[i];
    const float exact = luminance(evaluate(part, wo, w));
    EXPECT_NEAR(out[i], exact, 1e-4f * exact + 1e-9f);
    if (dot(w, part.frames[0].n) <= 0) continue;
    (w.z < 0 ? dark : dimmed) += 1;
  }
  EXPECT_GT(dark, 10u);
  EXPECT_GT(dimmed, 10u);
}

TEST(LobeChunks, MissNothingToSpeakOf) {
  const GeodesicGrid grid(5);
  const DirectionChunks directions(grid.directions());
  std::vector<uint32_t> chunks;
  for (const test::Example& example : test::examples())
    for (const Bsdf& part : {glossyPart(example.bsdf), diffusePart(example.bsdf)})
      for (const Vec3f wo : {test::directionAt(0.999f, 0.4f), test::directionAt(0.6f, 2.f),
                             test::directionAt(0.1f, 4.f), test::directionAt(-0.5f, 1.f)}) {
        SCOPED_TRACE(example.name + " " + std::to_string(wo.z));
        findChunks(directions, part, wo, &chunks);
        EXPECT_TRUE(std::is_sorted(chunks.begin(), chunks.end()));
        std::vector<bool> listed(directions.chunkCount());
        for (const uint32_t chunk : chunks) listed.at(chunk) = true;
        const Vec3f mirror(-wo.x, -wo.y, wo.z);
        const float peak = luminance(evaluate(part, wo, mirror));
        for (size_t i = 0; i < grid.count(); ++i) {
          if (listed[i / kChunk]) continue;
          ASSERT_LE(luminance(evaluate(part, wo, grid.directions()[i])), 1.001e-3f * peak);
        }
      }
}

// Of a row of 16 directions 2 degrees apart, and a lobe whose e^-9.2 is 22 degrees from its axis.
TEST(LobeChunks, AreFewForSharpLobes) {
  const GeodesicGrid grid(5);
  const DirectionChunks directions(grid.directions());
  std::vector<uint32_t> chunks;
  findChunks(directions, test::single(test::simple(LobeType::phong, 128)),
             test::directionAt(0.7f, 2.f), &chunks);
  EXPECT_LT(static_cast<double>(chunks.size()) / static_cast<double>(directions.chunkCount()), 0.1);
  findChunks(directions, test::single(test::simple(LobeType::lambert)), {0, 0, 1}, &chunks);
  const double half =
      static_cast<double>(chunks.size()) / static_cast<double>(directions.chunkCount());
  EXPECT_GT(half, 0.5);
  EXPECT_LT(half, 0.62);
  findChunks(directions, test::single(test::simple(LobeType::lambert)), {0, 0, -1}, &chunks);
  EXPECT_TRUE(chunks.empty());
}

}  // namespace
}  // namespace lobelia::transfer

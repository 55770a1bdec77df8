// Registers of pixels against the scalar code, number by number.
#include "lobelia/transfer/packet_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/transfer/lobe_sum.h"
#include "lobelia/transfer/reflection_table.h"
#include "lobelia/transfer/resultant.h"
#include "support/box_scene.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kVertices = 40, kLobes = 2;

float between(Rng& rng, float a, float b) { return a + (b - a) * rng.next1D(); }
Rgb colour(Rng& rng) { return {rng.next1D(), rng.next1D(), rng.next1D()}; }
// Near z, so that lobes of neighbours are neighbours.
Vec3f direction(Rng& rng) {
  return normalize(Vec3f(between(rng, -0.3f, 0.3f), between(rng, -0.3f, 0.3f), 1));
}

// Vertices with all there is, and nothing: seen whole, in part, not at all; with bounces and
// without.
struct Vertices {
  std::vector<VisiblePart> parts;
  std::vector<std::array<TransferLobe, kLobes>> lobes;
  std::vector<Vec3f> mirrors;
  std::vector<Rgb> diffuse;
  std::vector<VisibleRow> visibleRows;
  std::vector<LightRow> lightRows;
  std::vector<LobeRow> lobeRows;
  std::vector<uint8_t> hasLobes;

  explicit Vertices(Rng& rng) {
    for (size_t i = 0; i < kVertices; ++i) {
      VisiblePart part;
      if (i % 3 == 1)
        part = visiblePart({colour(rng), direction(rng) * between(rng, 0.5f, 0.999f)},
                           direction(rng) * between(rng, 0.7f, 0.99f));
      if (i % 7 == 2) part = visiblePart({}, direction(rng) * 0.9f);
      parts.push_back(part);
      mirrors.push_back(direction(rng));
      diffuse.push_back(colour(rng));
      std::array<TransferLobe, kLobes> own{};
      if (i % 4 != 0) own[0] = {colour(rng), direction(rng) * between(rng, 0.1f, 0.9999f)};
      if (i % 8 == 1) own[1] = {colour(rng), direction(rng) * between(rng, 0.1f, 0.9999f)};
      lobes.push_back(own);
      visibleRows.emplace_back(part);
      lightRows.push_back({diffuse.back()});
      for (const TransferLobe& lobe : own) lobeRows.emplace_back(lobe, mirrors.back());
      hasLobes.push_back(i % 4 != 0 ? 1 : 0);
    }
  }
  VertexRows rows() const {
    return {visibleRows.data(), lightRows.data(), lobeRows.data(), hasLobes.data(), kLobes};
  }
};

PrefilteredLight someLight(Rng& rng) {
  relight::DistantLight light;
  light.everywhere = Rgb(0.1f, 0.2f, 0.3f);
  for (int i = 0; i < 200; ++i)
    light.powers.push_back({sampleSphereUniform(rng.next2D()), colour(rng)});
  return PrefilteredLight(light);
}

// GGX of roughness .3, as a table of its front.
ReflectionTable someTable(const Scene& scene, MaterialHandle material) {
  return ReflectionTable(
      [&](Vec3f wo) {
        SurfacePoint at;
        at.material = material;
        at.ng = at.frame.n, at.dpdu = at.frame.s, at.dpdv = at.frame.t;
        return makeBsdf(scene, at, wo, 0);
      },
      false);
}

// A packet of `count` pixels anywhere among the vertices.
PixelPacket somePacket(Rng& rng, size_t count) {
  PixelPacket packet;
  packet.count = count;
  for (size_t lane = 0; lane < count; ++lane) {
    const Vec3f n = direction(rng);
    packet.n.set(lane, n);
    packet.wo.set(lane, normalize(n + direction(rng) * 0.8f));
    packet.emitted.set(lane, lane % 5 == 0 ? colour(rng) : Rgb{});
    Vec3f weights = colour(rng);
    weights = weights / (weights.x + weights.y + weights.z);
    // All the lanes of some packets see vertices of which everything is visible, of others nothing.
    for (size_t v = 0; v < 3; ++v) {
      packet.slot[v][lane] = static_cast<uint32_t>(rng.next1D() * kVertices) % kVertices;
      packet.weight[v].at[lane] = weights[static_cast<int>(v)];
    }
  }
  return packet;
}

Rgb expected(const PixelPacket& packet, size_t lane, const ReflectionTable& table,
             const Vertices& vertices, const PrefilteredLight& light, bool direct) {
  Reflection own;
  const Vec3f n = packet.n.get(lane), wo = packet.wo.get(lane);
  table.lookUp(dot(n, wo), n, wo, &own);
  Rgb sum = packet.emitted.get(lane), arriving{};
  VisibleSum visible(own.r);
  LobeSum bounced[kLobes];
  for (size_t v = 0; v < 3; ++v) {
    const size_t slot = packet.slot[v][lane];
    const float weight = packet.weight[v].at[lane];
    arriving += vertices.diffuse[slot] * weight;
    visible.add(weight, vertices.parts[slot]);
    for (size_t c = 0; c < kLobes; ++c)
      bounced[c].add(weight, vertices.lobes[slot][c], vertices.mirrors[slot]);
  }
  sum += own.diffuse * arriving;
  const VisiblePart part = visible.part();
  for (int i = 0; i < own.count && direct; ++i) {
    const ReflectedLobe lobe = visibleOf(own.lobes[static_cast<size_t>(i)], part);
    sum += lobe.alpha * light.lookUp(lobe.axis, lobe.kappa);
  }
  for (const LobeSum& s : bounced) {
    const TransferLobe lobe = s.lobe();
    const float size = length(lobe.r);
    if (!s.empty())
      sum += own.glossy * lobe.share *
             light.lookUp(size > 0 ? lobe.r / size : own.mirror, kappaOfResultant(size));
  }
  return sum;
}

TEST(PacketKernels, ShadeAsTheScalarCode) {
  Rng rng(3);
  Scene scene;
  Material material;
  material.type = MaterialType::roughPlastic;
  material.diffuse = Rgb(0.4f, 0.2f, 0.1f);
  material.alphaU = material.alphaV = 0.2f;
  const ReflectionTable table = someTable(scene, test::addMaterial(scene, material));
  ASSERT_GT(table.rows().lobeCount, 1);
  const PrefilteredLight light = someLight(rng);
  const Vertices vertices(rng);
  for (int i = 0; i < 200; ++i) {
    const size_t count = i % 3 == 0 ? PixelPacket::kSize : 1 + static_cast<size_t>(i) % 15;
    PixelPacket packet = somePacket(rng, count);
    packet.fillUp();
    lookUpReflection(table.rows(), &packet);
    const PacketLight packetLight{
        light.levels(), {Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)}, i % 2 == 0};
    shadePacket(vertices.rows(), packetLight, &packet);
    for (size_t lane = 0; lane < PixelPacket::kSize; ++lane) {
      const Rgb wanted =
          expected(packet, lane < count ? lane : 0, table, vertices, light, packetLight.direct);
      const Rgb found = packet.radiance.get(lane);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / wanted[c], 1, 2e-4) << i << " " << lane;
    }
  }
}

}  // namespace
}  // namespace lobelia::transfer

// Registers of pixels against the scalar code, number by number.
#include "lobelia/transfer/packet_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "lobelia/base/frame.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/transfer/lobe_sum.h"
#include "lobelia/transfer/reflection_table.h"
#include "lobelia/transfer/resultant.h"
#include "support/box_scene.h"
#include "support/simd_targets.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kVertices = 40, kLobes = 2;

float between(Rng& rng, float a, float b) { return a + (b - a) * rng.next1D(); }
Rgb colour(Rng& rng) { return {rng.next1D(), rng.next1D(), rng.next1D()}; }
// Near an axis, so that lobes of neighbours are neighbours.
Vec3f direction(Rng& rng, Vec3f axis) {
  return normalize(axis + sampleSphereUniform(rng.next2D()) * 0.3f);
}

// Which vertices a packet sees: of all kinds, seen whole, in part, not at all.
enum class Seen { mixed, whole, part, nothing };

// Vertices around a direction, with bounced light and without.
struct Vertices {
  std::vector<VisiblePart> parts;
  std::vector<std::array<TransferLobe, kLobes>> lobes;
  std::vector<Vec3f> mirrors;
  std::vector<Rgb> diffuse;
  std::vector<VisibleRow> visibleRows;
  std::vector<LightRow> lightRows;
  std::vector<LobeRow> lobeRows;
  std::vector<uint8_t> hasLobes;

  Vertices(Rng& rng, Vec3f axis, Seen seen, bool bounces) {
    const auto r = [&](float least) { return direction(rng, axis) * between(rng, least, 0.9999f); };
    for (size_t i = 0; i < kVertices; ++i) {
      VisiblePart part;
      if (seen == Seen::part || (seen == Seen::mixed && i % 3 == 1))
        part = visiblePart({colour(rng), r(0.5f)}, r(0.7f));
      if (seen == Seen::nothing || (seen == Seen::mixed && i % 7 == 2))
        part = visiblePart({}, r(0.9f));
      parts.push_back(part);
      mirrors.push_back(direction(rng, axis));
      diffuse.push_back(colour(rng));
      std::array<TransferLobe, kLobes> own{};
      if (bounces && i % 4 != 0) own[0] = {colour(rng), r(0.1f)};
      if (bounces && i % 8 == 1) own[1] = {colour(rng), i % 16 == 1 ? Vec3f{} : r(0.1f)};
      lobes.push_back(own);
      visibleRows.emplace_back(part);
      lightRows.push_back({diffuse.back()});
      for (const TransferLobe& lobe : own) lobeRows.emplace_back(lobe, mirrors.back());
      hasLobes.push_back(bounces && i % 4 != 0 ? 1 : 0);
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

ReflectionTable tableOf(const Scene& scene, MaterialHandle material) {
  return ReflectionTable(
      [&](Vec3f wo) {
        SurfacePoint at;
        at.material = material;
        at.ng = at.frame.n, at.dpdu = at.frame.s, at.dpdv = at.frame.t;
        return makeBsdf(scene, at, wo, 0);
      },
      false);
}

// Several lobes, one, none.
std::vector<ReflectionTable> someTables() {
  Scene scene;
  Material plastic, phong, chalk;
  plastic.type = MaterialType::roughPlastic, plastic.diffuse = Rgb(0.4f, 0.2f, 0.1f);
  plastic.alphaU = plastic.alphaV = 0.2f;
  phong.type = MaterialType::phong, phong.specular = Rgb(0.2f, 0.4f, 0.5f), phong.alphaU = 60.f;
  chalk.type = MaterialType::diffuse, chalk.diffuse = Rgb(0.7f, 0.6f, 0.5f);
  std::vector<ReflectionTable> tables;
  for (const Material& material : {plastic, phong, chalk})
    tables.push_back(tableOf(scene, test::addMaterial(scene, material)));
  return tables;
}

// A packet of `count` pixels anywhere among the vertices, seen at all elevations.
PixelPacket somePacket(Rng& rng, size_t count) {
  PixelPacket packet;
  packet.count = count;
  for (size_t lane = 0; lane < count; ++lane) {
    const Vec3f n = sampleSphereUniform(rng.next2D());
    const Vec3f wo = frameFromNormal(n).toWorld(sampleHemisphereCosine(rng.next2D()));
    packet.n.set(lane, n), packet.wo.set(lane, wo);
    packet.emitted.set(lane, lane % 5 == 0 ? colour(rng) : Rgb{});
    Vec3f weights = colour(rng);
    weights = weights / (weights.x + weights.y + weights.z);
    for (size_t v = 0; v < 3; ++v) {
      packet.slot[v][lane] = static_cast<uint32_t>(rng.next1D() * kVertices) % kVertices;
      packet.weight[v].at[lane] = weights[static_cast<int>(v)];
    }
  }
  packet.fillUp();
  return packet;
}

PacketLight packetLight(const PrefilteredLight& light, const Frame& toLight, bool direct) {
  return {light.levels(), {toLight.s, toLight.t, toLight.n}, direct};
}

// By the scalar code.
struct Oracle {
  const ReflectionTable& table;
  const Vertices& vertices;
  const PrefilteredLight& light;
  Frame toLight;
  bool direct;

  Rgb lookUp(Vec3f axis, float kappa) const { return light.lookUp(toLight.toLocal(axis), kappa); }

  Rgb radiance(const PixelPacket& packet, size_t lane) const {
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
    if (own.count == 0) return sum;
    const VisiblePart part = visible.part();
    for (int i = 0; i < own.count && direct; ++i) {
      const ReflectedLobe lobe = visibleOf(own.lobes[static_cast<size_t>(i)], part);
      sum += lobe.alpha * lookUp(lobe.axis, lobe.kappa);
    }
    for (const LobeSum& s : bounced) {
      const TransferLobe lobe = s.lobe();
      const float size = length(lobe.r);
      if (!s.empty())
        sum += own.glossy * lobe.share *
               lookUp(size > 0 ? lobe.r / size : own.mirror, kappaOfResultant(size));
    }
    return sum;
  }
};

void expectClose(Rgb found, Rgb wanted) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / wanted[c], 1, 3e-4);
}

TEST(PacketKernels, ShadeAsTheScalarCode) {
  Rng rng(3);
  const std::vector<ReflectionTable> tables = someTables();
  ASSERT_EQ(tables[2].rows().lobeCount, 0);
  ASSERT_EQ(tables[1].rows().lobeCount, 1);
  const PrefilteredLight light = someLight(rng);
  for (const int64_t each : test::usableTargets()) {
    const test::OnlyTarget target(each);
    SCOPED_TRACE(hwy::TargetName(each));
    for (int i = 0; i < 240; ++i) {
      const Vec3f axis = sampleSphereUniform(rng.next2D());
      const Vertices vertices(rng, axis, static_cast<Seen>(i % 4), i % 5 != 0);
      const Frame toLight = frameFromNormal(sampleSphereUniform(rng.next2D()));
      const Oracle oracle{tables[static_cast<size_t>(i % 3)], vertices, light, toLight, i % 7 != 0};
      const size_t count = i % 2 == 0 ? PixelPacket::kSize : 1 + static_cast<size_t>(i) % 15;
      PixelPacket packet = somePacket(rng, count);
      lookUpReflection(oracle.table.rows(), &packet);
      shadePacket(vertices.rows(), packetLight(light, toLight, oracle.direct), &packet);
      for (size_t lane = 0; lane < count; ++lane)
        expectClose(packet.radiance.get(lane), oracle.radiance(packet, lane));
    }
  }
}

TEST(PacketKernels, LookUpLightAsTheScalarCode) {
  Rng rng(4);
  const PrefilteredLight light = someLight(rng);
  const Frame toLight = frameFromNormal(normalize(Vec3f(1, -2, 0.5f)));
  for (const int64_t each : test::usableTargets()) {
    const test::OnlyTarget target(each);
    SCOPED_TRACE(hwy::TargetName(each));
    LobePacket packet;
    for (size_t i = 0; i < PixelPacket::kSize; ++i) {
      // From no direction at all to a sharper one than the light's first level.
      const float size = i == 0 ? 0.f : i == 1 ? 1.f : rng.next1D();
      packet.share.set(i, colour(rng));
      packet.r.set(i, sampleSphereUniform(rng.next2D()) * size);
    }
    lookUpLight(packetLight(light, toLight, true), &packet);
    EXPECT_EQ(packet.light.get(0), Rgb{});
    for (size_t i = 1; i < PixelPacket::kSize; ++i) {
      const Vec3f r = packet.r.get(i);
      expectClose(packet.light.get(i),
                  packet.share.get(i) *
                      light.lookUp(toLight.toLocal(r / length(r)), kappaOfResultant(length(r))));
    }
  }
}

// One pixel that is not finite says nothing about those beside it.
TEST(PacketKernels, LanesAreTheirOwn) {
  Rng rng(5);
  const std::vector<ReflectionTable> tables = someTables();
  const PrefilteredLight light = someLight(rng);
  const Vertices vertices(rng, {0, 0, 1}, Seen::mixed, true);
  PixelPacket packet = somePacket(rng, PixelPacket::kSize), broken = packet;
  broken.wo.set(5, Vec3f(std::numeric_limits<float>::quiet_NaN()));
  for (PixelPacket* p : {&packet, &broken}) {
    lookUpReflection(tables[0].rows(), p);
    shadePacket(vertices.rows(), packetLight(light, {}, true), p);
  }
  EXPECT_FALSE(isFinite(broken.radiance.get(5)));
  for (size_t lane = 0; lane < PixelPacket::kSize; ++lane) {
    if (lane == 5) continue;
    EXPECT_EQ(broken.radiance.get(lane), packet.radiance.get(lane)) << lane;
  }
}

}  // namespace
}  // namespace lobelia::transfer

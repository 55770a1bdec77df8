// How tables are made: moments of each lobe by quadrature; its vMF lobes by a fit at each elevation
// that starts from the one before it, from grazing angles, where lobes are most apart, to the
// normal. So they stay the same lobes from one elevation to the next and can be interpolated.
//
// Relative L1 distance to the lobe at 0 / 60 / 75 degrees, and that of one lobe of its first moment
// (the paper's choice): GGX of roughness 0.1, four lobes: .02 / .21 / .38, one: .53 / .79 / 1.1;
// Beckmann 0.2, three lobes: .05 / .09 / .18, one: .05 / .39 / .62.
#include "lobelia/transfer/reflection_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/transfer/interpolation-inl.h"
#include "lobelia/transfer/lobe_fit.h"
#include "lobelia/transfer/lobe_moments.h"
#include "lobelia/transfer/reflected_lobes.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kNodes = 128;
constexpr uint32_t kMomentPoints = 4096, kFitPoints = 1024;
constexpr int kFirstIterations = 60, kIterations = 15;
constexpr float kSteep = 0.7f;  // cosine up to which a lobe is about as wide as long
constexpr size_t kMost = Reflection::kFewLobes;

// At both ends there is a limit, not a value.
float cosineAt(size_t node) {
  const float s = static_cast<float>(node) / static_cast<float>(kNodes - 1);
  return std::clamp(s * s, 1e-5f, 1 - 5e-5f);
}

// Without lobes that do not act for wo.
Bsdf activePart(const Bsdf& bsdf, Vec3f wo) {
  Bsdf part = bsdf;
  part.lobeCount = 0;
  for (int i = 0; i < bsdf.lobeCount; ++i)
    if (isActive(bsdf.lobes[i], wo.z)) part.add(bsdf.lobes[i]);
  return part;
}

// vMF lobes that a kind of lobe is worth.
int lobesFor(const Lobe& lobe) {
  if (lobe.type == LobeType::phong) return 1;
  const bool tailed =
      lobe.distribution == Distribution::ggx || lobe.distribution == Distribution::gtr1;
  return lobe.type == LobeType::microfacetReflection && tailed ? 4 : 3;
}

// Lobes that share vMF lobes: one each, or what is left for the last.
struct Group {
  int firstLobe = 0, lobeCount = 1;
  int places = 1;
};
std::vector<Group> groupsOf(const Bsdf& glossy) {
  std::vector<Group> groups;
  int room = static_cast<int>(kMost);
  for (int i = 0; i < glossy.lobeCount; ++i) {
    const int left = glossy.lobeCount - i;
    if (room == 1 && left > 1) {
      groups.push_back({i, left, 1});
      break;
    }
    const int places = std::min(lobesFor(glossy.lobes[i]), std::max(room / left, 1));
    groups.push_back({i, 1, places});
    room -= places;
  }
  return groups;
}

Vec3d toDouble(Vec3f v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// Co-axial at first, of kappas a factor of four apart about the one of the first moment.
void startFit(Vec3f mirror, const LobeMoments& moments, std::span<FitLobe> lobes) {
  const ReflectedLobe one = reflectedLobe(moments);
  for (size_t j = 0; j < lobes.size(); ++j) {
    const float t = static_cast<float>(j + 1) / static_cast<float>(lobes.size());
    const Vec3f axis = lerp(mirror, one.axis, t);
    const double kappa = static_cast<double>(one.kappa) * 2 * std::pow(4, 1 - static_cast<int>(j));
    lobes[j] = {toDouble(normalize(Vec3f(axis.x, 0, axis.z))),
                std::min(kappa, static_cast<double>(kMostKappa)),
                1 / static_cast<double>(lobes.size())};
  }
}

}  // namespace

// Fills a table, elevation by elevation.
struct ReflectionTable::Builder {
  ReflectionTable& table;
  bool behind;
  std::vector<Group> groups;
  std::array<FitLobe, kMost> fits{};  // of the elevation before

  // What a direction in the plane of incidence has of mirror direction and normal; sine, cosine:
  // of wo.
  static Vec2f parts(Vec3f v, float sine, float cosine) {
    const float mirror = -v.x / sine;
    return {mirror, v.z - mirror * cosine};
  }
  // Seen from the side of wo.
  Vec3f up(Vec3f v) const { return behind ? flipZ(v) : v; }

  void addNode(size_t node, const Bsdf& bsdf, Vec3f wo);
  LobeMoments addGroup(size_t node, const Group& group, size_t place, const Bsdf& glossy, Vec3f wo);
};

// Fits the group's vMF lobes, the table's from `place` on.
LobeMoments ReflectionTable::Builder::addGroup(size_t node, const Group& group, size_t place,
                                               const Bsdf& glossy, Vec3f wo) {
  LobeMoments moments;
  std::vector<LobePoint> points;
  for (int i = 0; i < group.lobeCount; ++i) {
    const Lobe& lobe = glossy.lobes[group.firstLobe + i];
    moments.add(glossyMoments(glossy, lobe, wo, kMomentPoints));
    quadraturePoints(glossy, lobe, wo, kFitPoints, &points);
  }
  moments.first = up({moments.first.x, 0, moments.first.z});
  if (!(luminance(moments.albedo) > 0)) return moments;
  std::vector<FitPoint> fitPoints;
  for (const LobePoint& p : points)
    fitPoints.push_back({toDouble(up(p.w)), static_cast<double>(luminance(p.weight))});
  const auto lobes = std::span(fits).subspan(place, static_cast<size_t>(group.places));
  const float cosine = std::abs(wo.z), sine = std::abs(wo.x);
  const bool first = !(lobes[0].share > 0);
  if (first) startFit({-wo.x, 0, cosine}, moments, lobes);
  fitLobes(fitPoints, first ? kFirstIterations : kIterations, lobes);
  for (size_t j = 0; j < lobes.size(); ++j) {
    const FitLobe& lobe = lobes[j];
    const Vec2f of =
        parts({static_cast<float>(lobe.axis.x), 0, static_cast<float>(lobe.axis.z)}, sine, cosine);
    table.lobes_[node * static_cast<size_t>(table.lobeCount_) + place + j] = {
        of.x, of.y, static_cast<float>(1 / std::sqrt(lobe.kappa)),
        moments.albedo * static_cast<float>(lobe.share)};
  }
  return moments;
}

void ReflectionTable::Builder::addNode(size_t node, const Bsdf& bsdf, Vec3f wo) {
  const Bsdf glossy = activePart(glossyPart(bsdf), wo);
  LobeMoments all;
  size_t place = 0;
  for (const Group& group : groups) {
    all.add(addGroup(node, group, place, glossy, wo));
    place += static_cast<size_t>(group.places);
  }
  Node& to = table.nodes_[node];
  to.diffuse = diffuseAlbedo(bsdf, wo);
  to.glossy = all.albedo;
  const float energy = luminance(all.albedo);
  if (!(energy > 0)) return;
  const Vec2f of = parts(all.first / energy, std::abs(wo.x), std::abs(wo.z));
  to.mirror = of.x, to.normal = of.y;
}

ReflectionTable::ReflectionTable(const std::function<Bsdf(Vec3f wo)>& bsdfFor, bool behind) {
  const auto woAt = [&](size_t node) {
    const float cosine = cosineAt(node);
    return Vec3f(std::sqrt(1 - cosine * cosine), 0, behind ? -cosine : cosine);
  };
  const Vec3f slanting = woAt(kNodes / 2);
  const Bsdf bsdf = activePart(bsdfFor(slanting), slanting);
  const Bsdf glossy = glossyPart(bsdf);
  if (glossy.lobeCount + diffusePart(bsdf).lobeCount == 0) return;
  Builder builder{*this, behind, groupsOf(glossy)};
  for (const Group& group : builder.groups) lobeCount_ += group.places;
  nodes_.resize(kNodes);
  lobes_.resize(kNodes * static_cast<size_t>(lobeCount_));
  for (size_t node = 0; node < kNodes; ++node) {
    const Vec3f wo = woAt(node);
    builder.addNode(node, activePart(bsdfFor(wo), wo), wo);
  }
  fillDark();
  sortByWidth();
}

// Where nothing is reflected (at the horizon) directions are those of the elevation above.
void ReflectionTable::fillDark() {
  const auto count = static_cast<size_t>(lobeCount_);
  for (size_t node = kNodes - 1; node-- > 0;) {
    if (luminance(nodes_[node].glossy) > 0) continue;
    nodes_[node].mirror = nodes_[node + 1].mirror;
    nodes_[node].normal = nodes_[node + 1].normal;
    for (size_t j = 0; j < count; ++j) {
      lobes_[node * count + j] = lobes_[(node + 1) * count + j];
      lobes_[node * count + j].alpha = {};
    }
  }
}

// Wide lobes last, as they are at the normal.
void ReflectionTable::sortByWidth() {
  const auto count = static_cast<size_t>(lobeCount_);
  std::array<size_t, kMost> order{0, 1, 2, 3};
  const LobeNode* const last = lobes_.data() + (kNodes - 1) * count;
  for (size_t i = 1; i < count; ++i)
    for (size_t j = i; j > 0 && last[order[j]].width < last[order[j - 1]].width; --j)
      std::swap(order[j], order[j - 1]);
  for (size_t node = 0; node < kNodes; ++node) {
    std::array<LobeNode, kMost> sorted;
    for (size_t j = 0; j < count; ++j) sorted[j] = lobes_[node * count + order[j]];
    std::copy_n(sorted.begin(), count, lobes_.data() + node * count);
  }
}

float ReflectionTable::sharpest() const {
  const auto count = static_cast<size_t>(lobeCount_);
  float most = 0;
  for (size_t node = 0; node < nodes_.size(); ++node) {
    const float energy = luminance(nodes_[node].glossy);
    if (cosineAt(node) < kSteep || !(energy > 0)) continue;
    for (size_t j = 0; j < count; ++j) {
      const LobeNode& lobe = lobes_[node * count + j];
      if (luminance(lobe.alpha) >= 0.1f * energy) most = std::max(most, 1 / sqr(lobe.width));
    }
  }
  return most;
}

namespace {

core::SummaryBetween<float> summaryOf(const ElevationRows& rows, float cosine, Vec3f n, Vec3f wo,
                                      Reflection* out) {
  const core::SummaryBetween<float> summary =
      core::summaryBetween(rows, cosine, toCore(n), toCore(wo));
  out->n = n;
  out->mirror = fromCore(summary.mirror);
  out->diffuse = fromCore(summary.diffuse);
  out->glossy = fromCore(summary.glossy);
  out->r = fromCore(summary.r);
  out->count = 0;
  return summary;
}

}  // namespace

ElevationRows ReflectionTable::rows() const {
  return {reinterpret_cast<const float*>(nodes_.data()),
          reinterpret_cast<const float*>(lobes_.data()), static_cast<int>(nodes_.size()),
          lobeCount_};
}

void ReflectionTable::summary(float cosine, Vec3f n, Vec3f wo, Reflection* out) const {
  summaryOf(rows(), cosine, n, wo, out);
}

void ReflectionTable::lookUp(float cosine, Vec3f n, Vec3f wo, Reflection* out) const {
  const ElevationRows nodes = rows();
  const core::SummaryBetween<float> summary = summaryOf(nodes, cosine, n, wo, out);
  for (int j = 0; j < lobeCount_; ++j) {
    const core::LobeBetween<float> lobe = core::lobeBetween(nodes, j, summary, toCore(n));
    out->lobes[static_cast<size_t>(j)] = {fromCore(lobe.axis), lobe.kappa, fromCore(lobe.alpha)};
  }
  out->count = lobeCount_;
}

}  // namespace lobelia::transfer

#include "lobelia/transfer/anisotropic_table.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "lobelia/base/parallel.h"
#include "lobelia/transfer/lobe_moments.h"
#include "lobelia/transfer/reflected_lobes.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kElevations = 64, kAzimuths = 48;
constexpr uint32_t kMomentPoints = 2048;

// At both ends there is a limit, not a value.
float cosineAt(size_t elevation) {
  const float s = static_cast<float>(elevation) / static_cast<float>(kElevations - 1);
  return std::clamp(std::sin(0.5f * kPi * s * s), 1e-4f, 1 - 5e-7f);
}

}  // namespace

struct AnisotropicTable::Incidence {
  Vec3f wo, n, mirror, along, across;  // world, unit; n on wo's side
  float cosine = 1;
  float azimuth = 0;  // of wo, about the outside's normal, in [0, 2 pi)

  Incidence(const Frame& frame, Vec3f direction) : wo(direction) {
    const Vec3f o = frame.toLocal(wo);
    cosine = std::min(std::abs(o.z), 1.f);
    const float sine = std::sqrt(o.x * o.x + o.y * o.y);
    const Vec2f x = sine > 0 ? Vec2f{o.x / sine, o.y / sine} : Vec2f{1, 0};
    azimuth = std::atan2(x.y, x.x);
    if (azimuth < 0) azimuth += kTwoPi;
    n = o.z < 0 ? -frame.n : frame.n;
    mirror = n * (2 * cosine) - wo;
    along = frame.s * x.x + frame.t * x.y;
    across = frame.t * x.x - frame.s * x.y;
  }
  // A direction, of any length, as the table keeps it, and back.
  Vec3f partsOf(Vec3f v) const {
    const Vec3f d = v - mirror;
    return {dot(d, along), dot(d, across), dot(d, n)};
  }
  Vec3f direction(Vec3f parts) const {
    return mirror + along * parts.x + across * parts.y + n * parts.z;
  }
};

struct AnisotropicTable::Place {
  std::array<size_t, 4> node;
  std::array<float, 4> weight;
  // member(node): of a type with sums and products.
  template <class F>
  auto sum(const F& member) const {
    auto out = member(node[0]) * weight[0];
    for (size_t k = 1; k < 4; ++k) out += member(node[k]) * weight[k];
    return out;
  }
};

AnisotropicTable::Place AnisotropicTable::placeOf(const Incidence& incidence) {
  const float x =
      std::sqrt(std::asin(incidence.cosine) / (0.5f * kPi)) * static_cast<float>(kElevations - 1);
  const size_t elevation = std::min(static_cast<size_t>(x), kElevations - 2);
  const float u = x - static_cast<float>(elevation);
  const float y = incidence.azimuth / kTwoPi * static_cast<float>(kAzimuths);
  const auto below = static_cast<size_t>(y);
  const float v = y - static_cast<float>(below);
  const size_t first = below % kAzimuths * kElevations + elevation;
  const size_t second = (below + 1) % kAzimuths * kElevations + elevation;
  return {{first, first + 1, second, second + 1},
          {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

bool AnisotropicTable::isServed(const Bsdf& bsdf) { return glossyPart(bsdf).lobeCount == 1; }

AnisotropicTable::AnisotropicTable(const std::function<Bsdf(Vec3f wo)>& bsdfFor, bool behind) {
  std::vector<Node> nodes(kAzimuths * kElevations);
  parallelFor(kAzimuths, 1, [&](size_t azimuth) {
    const float phi = kTwoPi * static_cast<float>(azimuth) / kAzimuths;
    for (size_t elevation = kElevations; elevation-- > 0;) {
      const float cosine = cosineAt(elevation), sine = std::sqrt(1 - cosine * cosine);
      const Vec3f wo(sine * std::cos(phi), sine * std::sin(phi), behind ? -cosine : cosine);
      Node& node = nodes[azimuth * kElevations + elevation];
      node = nodeAt(bsdfFor(wo), Incidence(Frame{}, wo));
      if (luminance(node.glossy) > 0 || elevation + 1 == kElevations) continue;
      // Where nothing is reflected directions are those of the next elevation.
      const Node& above = nodes[azimuth * kElevations + elevation + 1];
      node.r = above.r;
      for (size_t j = 0; j < kLobes; ++j)
        node.lobes[j].axis = above.lobes[j].axis, node.lobes[j].width = above.lobes[j].width;
    }
  });
  const bool any = std::any_of(nodes.begin(), nodes.end(), [](const Node& node) {
    return node.diffuse != Rgb{} || node.glossy != Rgb{};
  });
  if (!any) return;
  for (const Node& node : nodes) lobeCount_ = std::max(lobeCount_, node.count);
  nodes_ = std::move(nodes);
}

AnisotropicTable::Node AnisotropicTable::nodeAt(const Bsdf& bsdf, const Incidence& incidence) {
  Node node;
  node.diffuse = diffuseAlbedo(bsdf, incidence.wo);
  const Bsdf glossy = glossyPart(bsdf);
  if (glossy.lobeCount == 0) return node;
  const Lobe& lobe = glossy.lobes[0];
  const LobeMoments moments = glossyMoments(glossy, lobe, incidence.wo, kMomentPoints);
  const float energy = luminance(moments.albedo);
  if (!(energy > 0)) return node;
  node.glossy = moments.albedo;
  node.r = incidence.partsOf(moments.first / energy);
  std::array<ReflectedLobe, kLobes> lobes;
  node.count = static_cast<size_t>(
      reflectedLobes(glossy, lobe, incidence.wo, moments, lobes, kMomentPoints));
  for (size_t j = 0; j < kLobes && node.count > 0; ++j) {
    const ReflectedLobe& from = lobes[std::min(j, node.count - 1)];
    node.lobes[j] = {incidence.partsOf(from.axis), 1 / std::sqrt(from.kappa),
                     j < node.count ? from.alpha : Rgb{}};
  }
  return node;
}

AnisotropicTable::Place AnisotropicTable::summarize(const Incidence& incidence,
                                                    Reflection* out) const {
  const Place place = placeOf(incidence);
  out->n = incidence.n;
  out->mirror = incidence.mirror;
  out->diffuse = place.sum([&](size_t i) { return nodes_[i].diffuse; });
  out->glossy = place.sum([&](size_t i) { return nodes_[i].glossy; });
  out->r = incidence.direction(place.sum([&](size_t i) { return nodes_[i].r; }));
  out->count = 0;
  return place;
}

void AnisotropicTable::summary(const Frame& frame, Vec3f wo, Reflection* out) const {
  summarize(Incidence(frame, wo), out);
}

void AnisotropicTable::lookUp(const Frame& frame, Vec3f wo, Reflection* out) const {
  const Incidence incidence(frame, wo);
  const Place place = summarize(incidence, out);
  for (size_t j = 0; j < lobeCount_; ++j) {
    const auto lobe = [&](size_t i) -> const LobeNode& { return nodes_[i].lobes[j]; };
    const Vec3f axis = place.sum([&](size_t i) { return lobe(i).axis; });
    const float width = place.sum([&](size_t i) { return lobe(i).width; });
    const Rgb alpha = place.sum([&](size_t i) { return lobe(i).alpha; });
    out->lobes[j] = {normalize(incidence.direction(axis)), 1 / (width * width), alpha};
  }
  out->count = static_cast<int>(lobeCount_);
}

}  // namespace lobelia::transfer

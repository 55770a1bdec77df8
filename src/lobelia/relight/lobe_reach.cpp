#include "lobelia/relight/lobe_reach.h"

#include <algorithm>
#include <cmath>

#include "lobelia/bsdf/lobe_kind.h"

namespace lobelia::relight {
namespace {

constexpr float kNodeOverAlpha = 0.63f;        // radius of nodes that are small enough
constexpr float kMirrorAlpha = 0.008f;         // half a degree of blur
constexpr float kBroadestPhong = 0.70710678f;  // alpha of the exponent 0

bool isGlossy(LobeType type) {
  return type == LobeType::microfacetReflection || type == LobeType::ward ||
         type == LobeType::phong;
}

// Roughness of half vectors along an axis. Phong's exponent is of directions, around the mirror
// direction: sharpness n + 1 [Wang09], that of half vectors four times as much.
float alphaOf(const Lobe& lobe, float parameter) {
  return lobe.type == LobeType::phong ? 1 / std::sqrt(2 * (parameter + 1)) : parameter;
}
float parameterOf(const Lobe& lobe, float alpha) {
  return lobe.type == LobeType::phong ? std::max(0.5f / (alpha * alpha) - 1, 0.f) : alpha;
}

}  // namespace

bool isMirror(const Lobe& lobe) {
  if (lobe.type == LobeType::deltaReflection) return true;
  if (!isGlossy(lobe.type)) return false;
  const float second = lobe.type == LobeType::phong ? lobe.alphaX : lobe.alphaY;
  return std::max(alphaOf(lobe, lobe.alphaX), alphaOf(lobe, second)) < kMirrorAlpha;
}

std::optional<LobeReach> lobeReach(const Lobe& lobe, int levels, Lobe* widened) {
  *widened = lobe;
  if (!isGlossy(lobe.type)) return std::nullopt;
  const bool phong = lobe.type == LobeType::phong;
  const float leafRadius = 2 / std::sqrt(std::ldexp(1.f, levels));
  // Few samples resolve no lobe at all; it is then as broad as its kind can be, not broader.
  const float finest = std::min(leafRadius / kNodeOverAlpha, phong ? kBroadestPhong : 1.f);
  const float x = std::max(alphaOf(lobe, lobe.alphaX), finest);
  const float y = phong ? x : std::max(alphaOf(lobe, lobe.alphaY), finest);
  widened->alphaX = parameterOf(lobe, x);
  if (!phong) widened->alphaY = parameterOf(lobe, y);
  const float nodes = kNodeOverAlpha * std::min(x, y) / leafRadius;  // in leaves' radii
  LobeReach reach;
  reach.level = std::max(0, static_cast<int>(std::floor(2 * std::log2(nodes) + 1e-3f)));
  const bool tailed =
      lobe.type == LobeType::microfacetReflection &&
      (lobe.distribution == Distribution::ggx || lobe.distribution == Distribution::gtr1);
  const float deviation = std::sqrt(2.f) * std::max(x, y);
  reach.radius = std::min((tailed ? 2.5f : 3) * deviation, kPi);
  if (!tailed && 4 * deviation < kPi / 2) reach.end = 4 * deviation;
  return reach;
}

}  // namespace lobelia::relight

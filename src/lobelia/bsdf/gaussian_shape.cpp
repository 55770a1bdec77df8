// Glossy lobes as spherical Gaussians: the paper's single lobe [P000 section 3], and for narrow or
// stretched lobes a row of them (docs/lobes.md, section on fits).
//
// A micro-normal h has slopes of covariance diag(alphaX^2, alphaY^2)/2. Reflection and refraction
// map slopes to directions; their Jacobian in the plane of incidence and across it turns that
// covariance into the lobe's. A round covariance is one Gaussian. A long one is a row of Gaussians
// along its longer axis, as wide as its shorter, each placed through its own half vector, so that
// the row bends as the lobe does.
// Deviation: the weights of the row are corrected once by the exact lobe at the axes, which brings
// in masking, Fresnel and the Jacobian that changes along the row.
#include "lobelia/bsdf/gaussian_shape.h"

#include <cmath>

#include "lobelia/bsdf/gaussian_mixture.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

constexpr float kMaxSharpness = 1e7f;
constexpr float kReach = 2.4f;    // the row ends at so many standard deviations
constexpr float kSpacing = 1.3f;  // distance of axes over the standard deviation of each
constexpr int kMaxRow = 15;
constexpr float kRound = 1.05f;  // ratio of variances up to which a lobe counts as round
constexpr int kCorrections = 2;

// How a lobe turns micro-normals into directions, in the frame of the plane of incidence.
struct Mapping {
  Vec3f wo, in, across;  // unit; in and across span the tangent plane
  bool transmission;
  float eta;           // n(other side) / n(side of wo)
  float jIn, jAcross;  // Jacobian from slopes to directions at h = n

  // Direction for micro-normal slopes; false where there is none or it leaves on the wrong side.
  bool direction(float slopeIn, float slopeAcross, Vec3f* w) const {
    const Vec3f h = normalize(in * slopeIn + across * slopeAcross + Vec3f(0, 0, 1));
    const float c = dot(wo, h);
    if (!(c > 0)) return false;
    if (!transmission) {
      *w = h * (2 * c) - wo;
      return w->z > 0;
    }
    const float cos2 = 1 - (1 - c * c) / (eta * eta);
    if (!(cos2 > 0)) return false;
    *w = h * (c / eta - std::sqrt(cos2)) - wo / eta;
    return w->z < 0;
  }
};

Mapping mappingOf(const Lobe& lobe, Vec3f wo, bool behind) {
  Mapping m{};
  m.wo = wo;
  const float sine = std::sqrt(wo.x * wo.x + wo.y * wo.y);
  m.in = sine > 1e-6f ? Vec3f(wo.x / sine, wo.y / sine, 0) : Vec3f(1, 0, 0);
  m.across = {-m.in.y, m.in.x, 0};
  m.transmission = lobe.type == LobeType::microfacetTransmission;
  m.eta = relativeEta(lobe, behind);
  const float cosine = std::max(wo.z, 0.02f);  // the limit at grazing would be a needle
  m.jIn = 2, m.jAcross = 2 * cosine;
  if (m.transmission) {
    const float cosT = std::sqrt(std::max(1 - (1 - cosine * cosine) / (m.eta * m.eta), 1e-2f));
    const float k = std::max(std::abs(cosT - cosine / m.eta), 1e-3f);
    m.jIn = k / cosT, m.jAcross = k;
  }
  return m;
}

// Principal axes of the covariance of directions: variances long >= thin, axis in (in, across).
struct Spread {
  float longVariance, thinVariance, axisIn, axisAcross;
};
Spread spreadOf(const Lobe& lobe, const Mapping& m) {
  const float vx = 0.5f * sqr(lobe.alphaX), vy = 0.5f * sqr(lobe.alphaY);
  const float c = m.in.x, s = m.in.y;
  const float a = sqr(m.jIn) * (vx * c * c + vy * s * s);
  const float d = sqr(m.jAcross) * (vx * s * s + vy * c * c);
  const float b = m.jIn * m.jAcross * (vy - vx) * c * s;
  const float mean = 0.5f * (a + d), half = std::sqrt(sqr(0.5f * (a - d)) + b * b);
  Spread r{mean + half, std::max(mean - half, 1e-4f * (mean + half)), 1, 0};
  // Eigenvector from the row that does not cancel.
  const float x = a >= d ? r.longVariance - d : b, y = a >= d ? b : r.longVariance - a;
  const float len = std::sqrt(x * x + y * y);
  if (len > 0) r.axisIn = x / len, r.axisAcross = y / len;
  return r;
}

// Number of Gaussians for a spread, odd and at most `limit`, and the variance of each. With fewer
// than needed they are wider, so that no gaps open.
struct Row {
  int count;
  float variance;
};
Row rowFor(const Spread& s, int limit) {
  const Row round{1, std::sqrt(s.longVariance * s.thinVariance)};
  if (s.longVariance < kRound * s.thinVariance) return round;
  const float length = kReach * std::sqrt(s.longVariance - s.thinVariance);
  const int needed = 1 + 2 * static_cast<int>(std::ceil(
                                 std::min(length / (kSpacing * std::sqrt(s.thinVariance)), 100.f)));
  const int count = std::min({needed, kMaxRow, limit - (limit % 2 == 0 ? 1 : 0)});
  if (count <= 1) return round;
  const float steps = kSpacing * static_cast<float>(count - 1) / (2 * kReach);
  const float variance = std::max(s.thinVariance, s.longVariance / (1 + steps * steps));
  return variance < round.variance ? Row{count, variance} : round;
}

void addRow(const Mapping& m, const Spread& s, float scale, float share, int limit,
            std::span<ShapePart> parts, int* count) {
  const Row row = rowFor(s, limit);
  const float variance = row.variance * scale;
  const float sharpness = std::min(1 / variance, kMaxSharpness);
  const float deviation = row.count > 1 ? std::sqrt((s.longVariance - row.variance) * scale) : 0.f;
  const int first = *count;
  float total = 0;
  for (int i = 0; i < row.count; ++i) {
    const float u =
        row.count > 1 ? kReach * (2 * static_cast<float>(i) / static_cast<float>(row.count - 1) - 1)
                      : 0.f;
    const float t = u * deviation;
    Vec3f axis;
    if (!m.direction(s.axisIn * t / m.jIn, s.axisAcross * t / m.jAcross, &axis)) continue;
    const float weight = std::exp(-0.5f * u * u);
    total += weight;
    parts[static_cast<size_t>((*count)++)] = {axis, sharpness, weight};
  }
  for (int i = first; i < *count; ++i) parts[static_cast<size_t>(i)].share *= share / total;
}

// Moves shares towards the exact lobe: each is multiplied by the ratio of the lobe to the sum of
// Gaussians at its axis.
void correctShares(const Lobe& lobe, Vec3f wo, bool behind, std::span<ShapePart> parts) {
  constexpr size_t kMax = kMaxShapeComponents * kMaxRow;
  const size_t n = parts.size();
  std::array<float, kMax> exact, density;
  std::array<float, kMax * kMax> influence;
  float exactTotal = 0;
  for (size_t i = 0; i < n; ++i) {
    const Vec3f w = parts[i].axis;
    const Rgb f = behind ? evaluateLobe(lobe, flipZ(wo), flipZ(w)) : evaluateLobe(lobe, wo, w);
    exactTotal += exact[i] = f.x + f.y + f.z;
    density[i] = 1 / lobes::integral(parts[i].sharpness);
  }
  if (!(exactTotal > 0) || !std::isfinite(exactTotal)) return;
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      influence[i * n + j] =
          density[j] * lobes::gaussian(parts[j].axis, parts[j].sharpness, parts[i].axis);
    }
  }
  for (int round = 0; round < kCorrections; ++round) {
    std::array<float, kMax> ratio;
    float total = 0;
    for (size_t i = 0; i < n; ++i) {
      float sum = 0;
      for (size_t j = 0; j < n; ++j) sum += parts[j].share * influence[i * n + j];
      ratio[i] = sum > 0 ? exact[i] / sum : 0.f;
    }
    for (size_t i = 0; i < n; ++i) total += parts[i].share *= ratio[i];
    for (ShapePart& p : parts) p.share /= total;
  }
}

// cos^n around the mirror direction is a Gaussian of sharpness n + 1; times the cosine to the
// normal it peaks nearer to the normal and is narrower. Peak: sharpness sin(theta - mirror) +
// tan(theta) = 0; curvatures there in the plane of incidence and across it.
ShapePart phongPart(const Lobe& lobe, Vec3f wo) {
  const float sharpness = lobe.alphaX + 1;
  const float sine = std::sqrt(wo.x * wo.x + wo.y * wo.y);
  const float mirror = std::atan2(sine, wo.z);
  float theta = mirror * sharpness / (sharpness + 1);
  for (int i = 0; i < 8; ++i) {
    const float secant = 1 / std::cos(theta);
    const float value = sharpness * std::sin(theta - mirror) + std::tan(theta);
    const float slope = sharpness * std::cos(theta - mirror) + secant * secant;
    theta = std::clamp(theta - value / slope, 0.f, std::min(mirror, 1.55f));
  }
  const float along = sharpness * std::cos(theta - mirror);
  const float kappa = std::sqrt((along + sqr(1 / std::cos(theta))) * (along + 1));
  const Vec3f side =
      sine > 0 ? Vec3f(-wo.x / sine, -wo.y / sine, 0) * std::sin(theta) : Vec3f(0, 0, 0);
  return {side + Vec3f(0, 0, std::cos(theta)), kappa, 1};
}

}  // namespace

int rowShape(const Lobe& lobe, Vec3f wo, bool behind, std::span<ShapePart> parts) {
  const int limit = static_cast<int>(parts.size());
  if (lobe.type == LobeType::phong) {
    parts[0] =
        limit > 1 ? phongPart(lobe, wo) : ShapePart{{-wo.x, -wo.y, wo.z}, lobe.alphaX + 1, 1};
    return 1;
  }
  const Mapping mapping = mappingOf(lobe, wo, behind);
  const Spread spread = spreadOf(lobe, mapping);
  const Distribution distribution =
      lobe.type == LobeType::ward ? Distribution::beckmann : lobe.distribution;
  const ShapeComponents components =
      componentsOf(distribution, std::sqrt(lobe.alphaX * lobe.alphaY), limit);
  int count = 0;
  for (int k = 0; k < components.count; ++k) {
    const ShapeComponent& c = components.parts[static_cast<size_t>(k)];
    const int componentsLeft = components.count - k;
    const int share = (limit - count + componentsLeft - 1) / componentsLeft;
    addRow(mapping, spread, 0.5f / c.width, c.share, share, parts, &count);
  }
  if (count == 0) {
    // Total reflection, or wo at the horizon: the nearest micro-normal that sends light through.
    Vec3f axis;
    for (int i = 1; i <= 64 && count == 0; ++i) {
      const float slope = std::tan(1.5f * static_cast<float>(i) / 64);
      if (!mapping.direction(slope, 0, &axis)) continue;
      const float variance = std::sqrt(spread.longVariance * spread.thinVariance);
      parts[0] = {axis, std::min(1 / variance, kMaxSharpness), 1};
      count = 1;
    }
  }
  if (count > components.count) {
    correctShares(lobe, wo, behind, parts.first(static_cast<size_t>(count)));
  }
  return count;
}

int shapeOf(const Lobe& lobe, Vec3f wo, bool behind, std::span<ShapePart> parts) {
  if (lobe.type == LobeType::thinTransmission) {
    // Its mirror image; the Fresnel factor, which is left out, hardly changes over the lobe.
    Lobe mirrored = lobe;
    mirrored.type = LobeType::microfacetReflection;
    mirrored.fresnel = Fresnel::one;
    mirrored.variant = 0;
    const int count = shapeOf(mirrored, wo, behind, parts);
    for (ShapePart& p : parts.first(static_cast<size_t>(count))) p.axis = flipZ(p.axis);
    return count;
  }
  const int count = behind ? 0 : tabulatedShape(lobe, wo, parts);
  return count > 0 ? count : rowShape(lobe, wo, behind, parts);
}

}  // namespace lobelia

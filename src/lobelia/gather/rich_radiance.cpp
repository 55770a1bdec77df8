#include "lobelia/gather/rich_radiance.h"

#include <algorithm>
#include <cassert>

#include "lobelia/gather/mrcs_kernels.h"
#include "lobelia/gather/rich_cube-inl.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::gather {
namespace {

size_t padded(size_t n) { return (n + kMrcsLanes - 1) / kMrcsLanes * kMrcsLanes; }

core::CubeTaps<float> tapsAlong(Vec3f local, int texels) {
  return core::cubeTaps(core::V3<float>{local.x, local.y, std::max(local.z, 0.f)},
                        static_cast<float>(texels));
}

// f(texel, weight) for the four that a direction is between.
template <class F>
void forTexels(Vec3f local, int texels, const F& f) {
  const core::CubeTaps<float> taps = tapsAlong(local, texels);
  const size_t first = static_cast<size_t>(taps.first), row = static_cast<size_t>(texels);
  f(first, (1 - taps.across) * (1 - taps.down));
  f(first + 1, taps.across * (1 - taps.down));
  f(first + row, (1 - taps.across) * taps.down);
  f(first + row + 1, taps.across * taps.down);
}

// f(texel, d): local directions of a texel's points, evenly spaced on it; not normalised, 1 along
// the face's axis.
template <class F>
void forTexelPoints(int texels, int pointsAcross, const F& f) {
  const float step = 2.f / static_cast<float>(texels), points = static_cast<float>(pointsAcross);
  size_t texel = 0;
  for (int face = 0; face < 5; ++face) {
    const int rows = face == 0 ? texels : texels / 2;
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < texels; ++c, ++texel) {
        for (int k = 0; k < pointsAcross * pointsAcross; ++k) {
          const int across = k % pointsAcross, down = k / pointsAcross;
          const float x = (static_cast<float>(across) + 0.5f) / points;
          const float y = (static_cast<float>(down) + 0.5f) / points;
          const float u = (static_cast<float>(c) + x) * step - 1;
          const float v = (static_cast<float>(r) + y) * step - (face == 0 ? 1.f : 0.f);
          const float sign = face == 1 || face == 3 ? 1.f : -1.f;
          const Vec3f d = face == 0   ? Vec3f{u, v, 1}
                          : face <= 2 ? Vec3f{sign, u, v}
                                      : Vec3f{u, sign, v};
          f(texel, d);
        }
      }
    }
  }
}

std::vector<float> solidAngles(int texels) {
  constexpr int kAcross = 8;
  std::vector<double> sums(RichRadiance::texelCount(texels));
  const double area = 4.0 / (texels * texels * kAcross * kAcross);
  forTexelPoints(texels, kAcross, [&](size_t, Vec3f d) {
    const double length2 = double{lengthSquared(d)};
    const double angle = area / (length2 * std::sqrt(length2));
    forTexels(d, texels, [&](size_t t, float weight) { sums[t] += double{weight} * angle; });
  });
  return {sums.begin(), sums.end()};
}

// The lobe above n with the energy that it has above its own surface. Where little of it is above
// n, its axis is lifted to the horizon.
RichLobe clippedAt(Vec3f n, RichLobe lobe, Vec3f ownNormal) {
  constexpr float kMostGain = 4;
  const float own = lobes::hemisphereIntegral(dot(ownNormal, lobe.axis), lobe.sharpness);
  const auto above = [&] {
    return std::max(lobes::hemisphereIntegral(dot(n, lobe.axis), lobe.sharpness), 0.f);
  };
  if (const float height = dot(n, lobe.axis); height < 0 && own > kMostGain * above()) {
    const Vec3f flat = lobe.axis - n * height;
    lobe.axis = lengthSquared(flat) > 1e-8f ? normalize(flat) : frameFromNormal(n).s;
  }
  const float here = above();
  lobe.amplitude *= here > 0 ? std::max(own, 0.f) / here : 0.f;
  return lobe;
}

// Energies of clipped lobes.
Rgb energyAbove(Vec3f n, const RichLobe& lobe) {
  return lobe.amplitude *
         std::max(lobes::hemisphereIntegral(dot(n, lobe.axis), lobe.sharpness), 0.f);
}

// Clusters of lobes by their moments: far apart at first, then a few rounds of k-means.
class LobeClusters {
 public:
  LobeClusters(Vec3f n, std::span<const RichLobe> lobes, size_t count) {
    for (const RichLobe& lobe : lobes) {
      const float weight = luminance(energyAbove(n, lobe));
      moments_.push_back(lobes::momentOf(lobe.axis, lobe.sharpness, weight));
      means_.push_back(lobe.axis * lobes::meanResultant(lobe.sharpness));
    }
    cluster_.assign(lobes.size(), 0);
    start(count);
    for (int round = 0; round < kRounds; ++round) improve();
  }
  const std::vector<uint32_t>& cluster() const { return cluster_; }
  const std::vector<lobes::Moment>& sums() const { return sums_; }

 private:
  static constexpr int kRounds = 5;

  void start(size_t count) {
    std::vector<float> nearest(means_.size(), 4.f);
    while (centres_.size() < count) {
      size_t best = 0;
      float most = -1;
      for (size_t i = 0; i < means_.size(); ++i) {
        const float far = moments_[i].weight * nearest[i];
        if (far > most) most = far, best = i;
      }
      if (!(most > 0)) break;
      centres_.push_back(means_[best]);
      for (size_t i = 0; i < means_.size(); ++i)
        nearest[i] = std::min(nearest[i], lengthSquared(means_[i] - means_[best]));
    }
    if (centres_.empty()) centres_.push_back(means_[0]);
  }
  void improve() {
    sums_.assign(centres_.size(), {});
    for (size_t i = 0; i < means_.size(); ++i) {
      const auto nearer = [&](Vec3f a, Vec3f b) {
        return lengthSquared(means_[i] - a) < lengthSquared(means_[i] - b);
      };
      cluster_[i] = static_cast<uint32_t>(
          std::min_element(centres_.begin(), centres_.end(), nearer) - centres_.begin());
      sums_[cluster_[i]].add(moments_[i]);
    }
    for (size_t k = 0; k < centres_.size(); ++k)
      if (sums_[k].weight > 0) centres_[k] = sums_[k].first / sums_[k].weight;
  }

  std::vector<lobes::Moment> moments_, sums_;
  std::vector<Vec3f> means_, centres_;
  std::vector<uint32_t> cluster_;
};

}  // namespace

RichRadiance::RichRadiance(RichForm form, size_t lights, int texels, int lobes)
    : form_(form),
      texels_(texels),
      mostLobes_(form == RichForm::vmf ? static_cast<size_t>(lobes) : 0),
      stride_(form == RichForm::cube ? padded(3 * texelCount(texels)) : 0),
      lights_(lights) {
  assert(texels >= 4 && texels % 2 == 0 && lobes >= 1);
  halves_.resize(lights * stride_);
  lobes_.resize(lights * mostLobes_);
  if (form == RichForm::cube) solidAngle_ = solidAngles(texels);
}

void RichRadiance::set(size_t i, Vec3f n, Rgb cosine, std::span<const RichLobe> lobes,
                       std::span<const Vec3f> normals, float leastSquared) {
  lights_[i] = {};
  lights_[i].n = n;
  lights_[i].cosine = cosine;
  lights_[i].leastSquared = leastSquared;
  std::vector<RichLobe> clipped(lobes.size());
  for (size_t k = 0; k < lobes.size(); ++k) clipped[k] = clippedAt(n, lobes[k], normals[k]);
  if (form_ == RichForm::cube) {
    setTexels(i, clipped);
  } else {
    setLobes(i, clipped);
  }
}

void RichRadiance::setTexels(size_t i, std::span<const RichLobe> lobes) {
  const size_t count = texelCount(texels_);
  const Frame frame = frameFromNormal(lights_[i].n);
  // Texels are 2 / n wide in the middle of a face; a lobe's deviation is half of that, at least.
  const float sharpest = static_cast<float>(texels_ * texels_);
  std::vector<Vec3f> directions(count);
  AlignedFloats values(stride_), lobe(count);
  forTexelPoints(texels_, 1, [&](size_t t, Vec3f d) { directions[t] = normalize(d); });
  for (const RichLobe& own : lobes) {
    const Rgb energy = energyAbove(lights_[i].n, own);
    const Vec3f axis = frame.toLocal(own.axis);
    const float sharpness = std::min(own.sharpness, sharpest);
    double sum = 0;
    for (size_t t = 0; t < count; ++t) {
      lobe[t] = lobes::gaussian(axis, sharpness, directions[t]);
      sum += double{lobe[t]} * double{solidAngle_[t]};
    }
    if (!(sum > 1e-30)) continue;
    const Rgb scale = energy / static_cast<float>(sum);
    for (int c = 0; c < 3; ++c)
      for (size_t t = 0; t < count; ++t)
        values[static_cast<size_t>(c) * count + t] += scale[c] * lobe[t];
    lights_[i].hasTexels = true;
  }
  float most = 0;
  for (size_t t = 0; t < count; ++t)
    for (size_t c = 0; c < 3; ++c)
      most = std::max(
          most, values[c * count + t] + lights_[i].cosine[static_cast<int>(c)] * directions[t].z);
  lights_[i].peak = std::max(most, maxComponent(lights_[i].cosine));
  if (!(lights_[i].peak > 1e-30f)) {  // one over it might overflow
    lights_[i].peak = 0;
    return;
  }
  const float inverse = 1 / lights_[i].peak;
  for (float& value : values) value *= inverse;
  packHalves(values.data(), stride_, &halves_[i * stride_]);
}

void RichRadiance::setLobes(size_t i, std::span<const RichLobe> lobes) {
  Light& light = lights_[i];
  RichLobe* out = lobes_.data() + i * mostLobes_;
  if (lobes.size() <= mostLobes_) {
    std::copy(lobes.begin(), lobes.end(), out);
    light.lobeCount = static_cast<uint32_t>(lobes.size());
  } else {
    const LobeClusters clusters(light.n, lobes, mostLobes_);
    std::vector<Rgb> energy(clusters.sums().size());
    std::vector<size_t> members(energy.size()), last(energy.size());
    for (size_t k = 0; k < lobes.size(); ++k) {
      const uint32_t cluster = clusters.cluster()[k];
      energy[cluster] += energyAbove(light.n, lobes[k]);
      ++members[cluster], last[cluster] = k;
    }
    for (size_t c = 0; c < energy.size(); ++c) {
      if (!(maxComponent(energy[c]) > 0)) continue;
      RichLobe& lobe = out[light.lobeCount++];
      if (members[c] == 1) {
        lobe = lobes[last[c]];
        continue;
      }
      const lobes::SphericalGaussian mean = lobes::lobeOf(clusters.sums()[c]);
      lobe.axis = mean.axis;
      lobe.sharpness = mean.sharpness;
      const float above = lobes::hemisphereIntegral(dot(light.n, lobe.axis), lobe.sharpness);
      lobe.amplitude = above > 0 ? energy[c] / above : Rgb{};
    }
  }
  light.peak = maxComponent(light.cosine);
  for (const RichLobe& lobe : this->lobes(i)) {
    const float height = dot(light.n, lobe.axis);
    const Vec3f w = height > 0 ? lobe.axis : lobe.axis - light.n * height;
    if (lengthSquared(w) > 0)
      light.peak = std::max(light.peak, maxComponent(intensity(i, normalize(w))));
  }
}

Rgb RichRadiance::intensity(size_t i, Vec3f w) const {
  const Light& light = lights_[i];
  const float cosine = dot(light.n, w);
  if (cosine <= 0) return {};
  Rgb sum = light.cosine * cosine;
  for (const RichLobe& lobe : lobes(i))
    sum += lobe.amplitude * lobes::gaussian(lobe.axis, lobe.sharpness, w);
  if (!light.hasTexels) return sum;
  AlignedFloats texels(stride_);
  unpackHalves(&halves_[i * stride_], stride_, light.peak, texels.data());
  forTexels(frameFromNormal(light.n).toLocal(w), texels_, [&](size_t t, float weight) {
    for (int c = 0; c < 3; ++c)
      sum[c] += weight * texels[static_cast<size_t>(c) * texelCount(texels_) + t];
  });
  return sum;
}

Rgb RichRadiance::power(size_t i) const {
  const Light& light = lights_[i];
  Rgb sum = light.cosine * kPi;
  for (const RichLobe& lobe : lobes(i)) sum += energyAbove(light.n, lobe);
  if (!light.hasTexels) return sum;
  AlignedFloats texels(stride_);
  unpackHalves(&halves_[i * stride_], stride_, light.peak, texels.data());
  for (int c = 0; c < 3; ++c)
    for (size_t t = 0; t < solidAngle_.size(); ++t)
      sum[c] += solidAngle_[t] * texels[static_cast<size_t>(c) * solidAngle_.size() + t];
  return sum;
}

uint64_t RichRadiance::bytesPerLight(RichForm form, int texels, int lobes) {
  const uint64_t table = form == RichForm::cube ? padded(3 * texelCount(texels)) * sizeof(uint16_t)
                                                : static_cast<uint64_t>(lobes) * sizeof(RichLobe);
  return table + sizeof(Light) + sizeof(DiffuseLight);
}

void RichRadiance::limitDepth(int maxDepth, size_t depths, std::vector<float> shares) {
  assert(shares.size() == depths * lights_.size());
  maxDepth_ = maxDepth, depths_ = depths, shares_ = std::move(shares);
}

float RichRadiance::share(size_t i, int receiverDepth) const {
  const int most = maxDepth_ - 1 - receiverDepth;
  if (most < 0) return 0;
  return shares_[i * depths_ + std::min(static_cast<size_t>(most), depths_ - 1)];
}

void RichRadiance::unpack(LightBlock* block) const {
  block->rich = this;
  if (form_ != RichForm::cube) return;
  block->richTexels.resize(kBlockLights * stride_);
  block->richStride = stride_;
  for (size_t l = 0; l < static_cast<size_t>(block->count); ++l) {
    const uint32_t i = block->index[l];
    if (lights_[i].hasTexels)
      unpackHalves(&halves_[i * stride_], stride_, lights_[i].peak,
                   &block->richTexels[l * stride_]);
  }
}

}  // namespace lobelia::gather

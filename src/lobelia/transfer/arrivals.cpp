#include "lobelia/transfer/arrivals.h"

#include <algorithm>
#include <bit>

#include "lobelia/transfer/lobe_moments.h"

namespace lobelia::transfer {
namespace {

// Cosine below which an interpolated normal may face away where its surface does not.
constexpr float kGrazing = 0.02f;

constexpr size_t kLanes = relight::kChunk;

void addTo(LobeMoment* to, const LobeMoment& m) { to->alpha += m.alpha, to->first += m.first; }

void addTo(Incoming* to, float weight, const Incoming& in) {
  transfer::addTo(&to->narrow, weight, in.narrow);
  transfer::addTo(&to->broad, weight, in.broad);
}

Incoming scaled(const Incoming& in, float weight) {
  Incoming out;
  out.narrowClass = in.narrowClass;
  addTo(&out, weight, in);
  return out;
}

}  // namespace

Arrivals::Arrivals(const GatherInput& input, size_t pass)
    : input_(input), scene_(input.tracer.scene()), before_(pass - 1) {}

void Arrivals::gather(const RaysOfVertex& rays) {
  rays_ = rays;
  sphere_ = &input_.rays[input_.raysOf[rays.vertex]];
  any_ = false;
  incoming_.clear();
  hitsBefore_.clear();
  uint32_t before = 0;
  for (const uint64_t word : rays.blocked) {
    hitsBefore_.push_back(before);
    before += static_cast<uint32_t>(std::popcount(word));
  }
  const RayCells* const cells = input_.cellsOf[rays.vertex];
  directions_ = cells ? &cells->coarse.chunks : &sphere_->chunks;
  lanes_.assign(directions_->chunkCount(), 0), first_.resize(directions_->chunkCount());
  if (cells)
    gatherCells(*cells);
  else
    gatherRays();
}

void Arrivals::gatherRays() {
  for (size_t c = 0; c < lanes_.size(); ++c) {
    first_[c] = static_cast<uint32_t>(incoming_.size());
    const size_t end = std::min(sphere_->grid.count(), (c + 1) * kLanes);
    for (size_t ray = c * kLanes; ray < end; ++ray) {
      if (!isBlocked(ray)) continue;
      lanes_[c] |= 1u << ray % kLanes;
      incoming_.push_back(scaled(alongRay(ray), sphere_->solidAngle[ray]));
    }
  }
}

void Arrivals::gatherCells(const RayCells& cells) {
  const size_t count = cells.rayOf.size();
  middle_.resize(count), instance_.resize(count), position_.resize(count);
  sums_.resize(count), has_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const uint32_t ray = cells.rayOf[i];
    sums_[i] = {};
    instance_[i] = 0;
    has_[i] = isBlocked(ray) ? 1 : 0;
    if (has_[i] == 0) continue;
    instance_[i] = input_.instanceOf[hitOf(ray).triangle] + 1;
    position_[i] = positionOf(hitOf(ray));
    middle_[i] = alongRay(ray);
    addTo(&sums_[i], sphere_->solidAngle[ray], middle_[i]);
  }
  for (const RayCells::Middle& m : cells.middles) {
    if (!isBlocked(m.ray)) continue;
    const float half = 0.5f * sphere_->solidAngle[m.ray];
    has_[m.a] = has_[m.b] = 1;
    if (isBetween(m.a, m.b, hitOf(m.ray))) {
      for (const uint32_t from : {m.a, m.b})
        for (const uint32_t to : {m.a, m.b}) addTo(&sums_[to], 0.5f * half, middle_[from]);
    } else {
      const Incoming in = alongRay(m.ray);
      addTo(&sums_[m.a], half, in), addTo(&sums_[m.b], half, in);
    }
  }
  for (size_t c = 0; c < lanes_.size(); ++c) {
    first_[c] = static_cast<uint32_t>(incoming_.size());
    for (size_t i = c * kLanes; i < std::min(count, (c + 1) * kLanes); ++i) {
      if (has_[i] == 0) continue;
      lanes_[c] |= 1u << i % kLanes;
      incoming_.push_back(sums_[i]);
    }
  }
}

const RayHit& Arrivals::hitOf(size_t ray) const {
  const uint64_t below = (uint64_t{1} << ray % 64) - 1;
  return rays_.hits[hitsBefore_[ray / 64] +
                    static_cast<size_t>(std::popcount(rays_.blocked[ray / 64] & below))];
}

Vec3f Arrivals::positionOf(const RayHit& hit) const {
  const relight::SampleMesh& mesh = input_.data.mesh.mesh;
  const auto& v = mesh.triangles()[hit.triangle].vertex;
  const Hit at = hit.at(0, 0);
  return mesh.positions()[v[0]] * (1 - at.b1 - at.b2) + mesh.positions()[v[1]] * at.b1 +
         mesh.positions()[v[2]] * at.b2;
}

// Do the rays of two cells and one between end at one surface, as far as three places can tell?
bool Arrivals::isBetween(size_t a, size_t b, const RayHit& hit) const {
  const uint32_t instance = input_.instanceOf[hit.triangle] + 1;
  if (instance_[a] != instance || instance_[b] != instance) return false;
  const Vec3f half = (position_[b] - position_[a]) * 0.5f;
  return lengthSquared(positionOf(hit) - position_[a] - half) < 0.25f * lengthSquared(half);
}

Incoming Arrivals::alongRay(size_t ray) {
  const RayHit& hit = hitOf(ray);
  Incoming in;
  LobeMoment narrow, broad;
  const uint32_t instance = input_.instanceOf[hit.triangle];
  const MaterialHandle material = scene_.instances[instance].material;
  in.narrowClass = classOf(material, input_.data.classCount);
  const Hit place =
      hit.at(instance, hit.triangle - input_.data.mesh.mesh.firstTriangle()[instance]);
  const relight::SurroundingVertices around = input_.data.mesh.around(place);
  const Vec3f wo = -sphere_->grid.directions()[ray];
  const Side side = input_.lookup.sideOf(place, wo);
  const Reflection own = ownOf(material, around, place, wo);
  const bool tabulated = input_.tables.has(material);
  if (luminance(own.glossy) > 0 || !tabulated) {
    std::array<LobeMoment, kMostClasses + 1> byClass{};
    PlaceView view = input_.lookup.view(around, own, wo, side, sphere_->back[ray]);
    if (!tabulated) {
      const TransferLobe lobe = input_.lookup.ownLobe(view);
      view.own.glossy = lobe.share, view.own.r = lobe.r;
    }
    const auto& glossy = input_.data.passes[before_].glossy;
    input_.lookup.glossy(view, before_, {byClass.data(), glossy.size()});
    for (size_t c = 0; c < glossy.size(); ++c)
      addTo(before_ > 0 && c + 1 == glossy.size() ? &broad : &narrow, byClass[c]);
  }
  if (luminance(own.diffuse) > 0 && !input_.diffuseBefore.empty())
    addTo(&broad, diffuseOf(around, side, own.diffuse));
  if (narrow.alpha != Rgb{} || broad.alpha != Rgb{}) any_ = true;
  in.narrow = numbersOf(narrow), in.broad = numbersOf(broad);
  return in;
}

LobeMoment Arrivals::diffuseOf(const relight::SurroundingVertices& around, Side side,
                               Rgb albedo) const {
  LobeMoment all;
  for (size_t i = 0; i < 3; ++i) {
    const size_t at = input_.data.diffuseSides.find(around.vertex[i], side);
    if (at == DiffuseSides::kNone) continue;
    const LobeMoment& m = input_.diffuseBefore[at];
    all.alpha += m.alpha * around.weight[i], all.first += m.first * around.weight[i];
  }
  const float energy = luminance(all.alpha);
  if (energy <= 0) return {};
  const Rgb alpha = all.alpha * albedo;
  return {alpha, all.first * (luminance(alpha) / energy)};
}

// Between the vertices: tables by the mean of normals; else what diffuse lobes reflect at the place
// itself, without the glossy ones (SliceLookup::ownLobe()).
Reflection Arrivals::ownOf(MaterialHandle material, const relight::SurroundingVertices& around,
                           const Hit& hit, Vec3f wo) const {
  Reflection own;
  if (input_.tables.has(material)) {
    Vec3f n{};
    for (size_t i = 0; i < 3; ++i)
      n += input_.data.mesh.vertices[around.vertex[i]].n * around.weight[i];
    const float size = length(n);
    if (size > 0 && dot(n, wo) < kGrazing * size)
      wo = aboveHorizon(wo, surfaceNormals(scene_, hit));
    if (!(size > 0) || !input_.tables.summary(material, n / size, wo, &own)) return {};
    return own;
  }
  const SurfacePoint at = surfacePoint(scene_, hit);
  wo = aboveHorizon(wo, {at.ng, at.frame.n});
  own.diffuse = diffuseAlbedo(makeBsdf(scene_, at, wo, 0), wo);
  return own;
}

}  // namespace lobelia::transfer

#include "lobelia/transfer/slice_lookup.h"

#include "lobelia/relight/visibility_data.h"

namespace lobelia::transfer {
namespace {

// Cosine to the normal above which the eye is taken to be.
constexpr float kHorizon = 0.01f;

Vec3f mirrored(Vec3f d, Vec3f n) { return n * (2 * dot(n, d)) - d; }

Vec3f lifted(Vec3f wo, Vec3f n) { return normalize(wo + n * (kHorizon - dot(n, wo))); }

}  // namespace

Vec3f aboveHorizon(Vec3f wo, const SurfaceNormals& at) {
  const float side = dot(at.ng, wo) < 0 ? -1.f : 1.f;
  const Vec3f n = at.n * side;
  return dot(n, wo) < kHorizon && dot(at.n, at.ng) > 0 ? lifted(wo, n) : wo;
}

SliceLookup::SliceLookup(const Scene& scene, const TransferData& data,
                         const ReflectionTables& tables)
    : scene_(scene), data_(data), tables_(tables), grid_(data.directionLevel) {
  for (uint32_t i = 0; i < scene.materials.size(); ++i)
    reflectsBehind_.push_back(relight::scattersBehind(scene, {i}) ? 1 : 0);
}

Side SliceLookup::sideOf(const Hit& hit, Vec3f wo) const {
  const MaterialHandle material = scene_.instances[hit.instance].material;
  if (!reflectsBehind(material)) return Side::front;
  return sideOf(material, surfaceNormals(scene_, hit).ng, wo);
}

VertexView SliceLookup::view(uint32_t vertex, Vec3f wo, Side side, const GridPlace& place) const {
  const TransferVertex& at = data_.mesh.vertices[vertex];
  VertexView out;
  out.vertex = vertex;
  out.material = scene_.instances[at.instance].material;
  out.n = side == Side::back && reflectsBehind(out.material) ? -at.n : at.n;
  out.wo = wo;
  out.place = place;
  if (dot(out.n, wo) < kHorizon) {
    out.wo = lifted(wo, out.n);
    out.place = grid_.locate(out.wo);
  }
  out.mirror = mirrored(out.wo, out.n);
  // wo lies between the three, so that one at least is in front.
  float sum = 0;
  for (size_t k = 0; k < 3; ++k) {
    float& weight = out.place.weight[k];
    if (dot(out.n, grid_.directions()[out.place.index[k]]) <= 0) weight = 0;
    sum += weight;
  }
  for (float& weight : out.place.weight) weight /= sum;
  return out;
}

PlaceView SliceLookup::view(const relight::SurroundingVertices& around, const Reflection& own,
                            Vec3f wo, Side side, const GridPlace& place) const {
  PlaceView out;
  for (size_t v = 0; v < 3; ++v) out.vertices[v] = view(around.vertex[v], wo, side, place);
  out.weight = around.weight;
  out.own = own;
  return out;
}

Vec3f SliceLookup::ownResultant(const VertexView& view, size_t k) const {
  const Vec3f wo = grid_.directions()[view.place.index[k]];
  if (tables_.has(view.material)) {
    Reflection own;
    // The tables want the outside's normal, of which view.n may be the opposite.
    const Vec3f n = data_.mesh.vertices[view.vertex].n;
    return tables_.summary(view.material, n, wo, &own) ? own.r : Vec3f{};
  }
  const SliceRecord* const record = data_.reflection.find(view.vertex, view.place.index[k]);
  return record ? unpack(*record).r : Vec3f{};
}

Vec3f SliceLookup::ownResultant(const VertexView& view) const {
  if (tables_.has(view.material)) {
    Reflection own;
    const Vec3f n = data_.mesh.vertices[view.vertex].n;
    return tables_.summary(view.material, n, view.wo, &own) ? own.r : Vec3f{};
  }
  return ownLobe(view).r;
}

TransferLobe SliceLookup::ownLobe(const VertexView& view) const {
  LobeSum sum;
  for (size_t k = 0; k < 3; ++k) {
    const SliceRecord* const record = data_.reflection.find(view.vertex, view.place.index[k]);
    if (!record || view.place.weight[k] <= 0) continue;
    TransferLobe lobe = unpack(*record);
    lobe.r = turned(lobe.r, mirrored(grid_.directions()[view.place.index[k]], view.n), view.mirror);
    sum.add(view.place.weight[k], lobe, view.mirror);
  }
  return sum.lobe();
}

TransferLobe SliceLookup::ownLobe(const PlaceView& view) const {
  LobeSum sum;
  for (size_t v = 0; v < 3; ++v)
    if (view.weight[v] > 0)
      sum.add(view.weight[v], ownLobe(view.vertices[v]), view.vertices[v].mirror);
  return sum.lobe();
}

VisiblePart SliceLookup::visible(const VertexView& view) const {
  const SliceRecord* records[3];
  bool whole = true;
  for (size_t k = 0; k < 3; ++k) {
    records[k] = view.place.weight[k] > 0 ? find(view, 0, 0, k) : nullptr;
    whole = whole && !records[k];
  }
  if (whole) return {};
  VisibleSum sum(ownResultant(view));
  for (size_t k = 0; k < 3; ++k)
    sum.add(view.place.weight[k],
            records[k] ? visiblePart(unpack(*records[k]), ownResultant(view, k)) : VisiblePart{});
  return sum.part();
}

TransferLobe SliceLookup::glossy(const VertexView& view, size_t pass, size_t lobeClass) const {
  LobeSum sum;
  for (size_t k = 0; k < 3; ++k) {
    const float weight = view.place.weight[k];
    const SliceRecord* const record = weight > 0 ? find(view, pass, lobeClass, k) : nullptr;
    if (!record) continue;
    sum.add(weight, unpack(*record), mirrored(grid_.directions()[view.place.index[k]], view.n));
  }
  return sum.lobe();
}

void SliceLookup::glossy(const PlaceView& view, size_t pass, std::span<LobeMoment> byClass) const {
  const Rgb albedo = view.own.glossy;
  if (pass == 0) {
    VisibleSum sum(view.own.r);
    for (size_t v = 0; v < 3; ++v) sum.add(view.weight[v], visible(view.vertices[v]));
    byClass[0] = visibleOf(view.own, sum.part());
    return;
  }
  for (size_t c = 0; c < byClass.size(); ++c) {
    LobeSum sum;
    for (size_t v = 0; v < 3; ++v)
      sum.add(view.weight[v], glossy(view.vertices[v], pass, c), view.vertices[v].mirror);
    const TransferLobe lobe = sum.lobe();
    byClass[c].alpha = albedo * lobe.share;
    byClass[c].first = lobe.r * luminance(byClass[c].alpha);
  }
}

std::array<LobeMoment, kOctants> SliceLookup::diffuse(const relight::SurroundingVertices& around,
                                                      Side side, size_t pass, Rgb albedo) const {
  std::array<LobeMoment, kOctants> out;
  const std::vector<DiffuseLobes>& lobes = data_.passes[pass].diffuse;
  if (lobes.empty()) return out;
  for (size_t v = 0; v < 3; ++v) {
    const size_t number = data_.diffuseSides.find(around.vertex[v], side);
    if (number == DiffuseSides::kNone) continue;
    for (size_t octant = 0; octant < kOctants; ++octant) {
      const TransferLobe lobe = unpack(lobes[number][octant]);
      const Rgb alpha = albedo * lobe.share * around.weight[v];
      out[octant].alpha += alpha;
      out[octant].first += lobe.r * luminance(alpha);
    }
  }
  return out;
}

}  // namespace lobelia::transfer

// What the direct pass and passes of bounces share of a vertex (direct_block.cpp,
// bounce_block.cpp).
#pragma once

#include "lobelia/transfer/gather_block.h"
#include "lobelia/transfer/lobe_weights.h"

namespace lobelia::transfer {

inline constexpr size_t kLanes = relight::kChunk;

// Sums of what arrives along rays, for the lobe that it becomes.
struct LobeTotal {
  Rgb alpha{};
  Vec3f first{};
  void add(float weight, const LobeMoment& m) {
    alpha += m.alpha * weight, first += m.first * weight;
  }
  // total: of the weights of all rays.
  TransferLobe lobe(float total) const {
    const float energy = luminance(alpha);
    return {alpha / total, energy > 0 ? first / energy : Vec3f()};
  }
};

// Weights of directions in a lobe, with their memory.
class LobeWeights {
 public:
  void setDirections(const DirectionChunks& directions) { directions_ = &directions; }
  std::span<const uint32_t> find(const Bsdf& part, Vec3f wo) {
    findChunks(*directions_, part, wo, &chunks_);
    return chunks_;
  }
  // kChunk weights for each of the chunks; good until the next call.
  const float* evaluate(const Bsdf& part, Vec3f wo, std::span<const uint32_t> chunks) {
    if (values_.size() < chunks.size() * kLanes) values_.resize(chunks.size() * kLanes);
    lobeWeights(*directions_, part, wo, chunks, values_.data());
    return values_.data();
  }

 private:
  const DirectionChunks* directions_ = nullptr;
  std::vector<uint32_t> chunks_;
  relight::AlignedFloats values_;
};

// A vertex and the parts of its Bsdf; for one side of it at a time.
class Vertex {
 public:
  Vertex(const GatherInput& input, size_t index)
      : input_(input),
        index_(index),
        at_(surfacePoint(input.tracer.scene(), input.data.mesh.vertices[index].hit())) {}

  MaterialHandle material() const { return at_.material; }
  Bsdf bsdf(Vec3f wo) const { return makeBsdf(input_.tracer.scene(), at_, wo, 0); }
  // False: nothing is reflected towards wo.
  bool reflection(Vec3f wo, Reflection* out) const {
    const Vec3f n = input_.data.mesh.vertices[index_].n;
    if (input_.tables.has(material())) return input_.tables.summary(material(), n, wo, out);
    *out = input_.tables.summary(input_.tracer.scene(), at_, wo);
    return luminance(out->glossy) > 0 || out->diffuse != Rgb{};
  }
  Vec3f normal() const { return input_.data.mesh.vertices[index_].n; }
  // f(wo) for the sides whose diffuse light is kept; wo: their normal.
  template <class F>
  void forDiffuseSides(const F& f) const {
    if (!input_.anyDiffuse) return;
    f(normal());
    if (input_.data.diffuseSides.hasBack(index_)) f(-normal());
  }

 private:
  const GatherInput& input_;
  size_t index_;
  SurfacePoint at_;
};

}  // namespace lobelia::transfer

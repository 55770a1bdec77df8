// What every material needs to add its lobes to a Bsdf.
#pragma once

#include <cmath>

#include "lobelia/scene/material_lobes.h"
#include "lobelia/scene/shading.h"

namespace lobelia {

inline constexpr float kMinAlpha = 1e-4f;  // as Mitsuba

inline float mean(Rgb c) { return (c.x + c.y + c.z) / 3; }

// One material at one point: its lobes are added to `bsdf`.
struct Builder {
  const Scene& scene;
  const Material& material;
  const TextureContext& at;
  uint8_t frame;    // of its lobes, in bsdf.frames
  float cosThetaO;  // of wo in that frame: sampling shares are for it
  float weight;     // scales everything
  bool twoSided;    // inside a two-sided material
  Bsdf& bsdf;
  // A clearcoat's frame with its cosine, where it has one of its own.
  const ShadingFrame* coatFrame = nullptr;
  float coatCosThetaO = 0;

  Rgb color(const ColorParam& param) const {
    return max(evaluate(scene, param, at), Rgb(0.f)) * weight;
  }
  float alpha(const FloatParam& param) const {
    return std::max(evaluate(scene, param, at), kMinAlpha);
  }
  float unit(const FloatParam& param) const {
    return std::clamp(evaluate(scene, param, at), 0.f, 1.f);
  }
  Lobe lobe(LobeType type) const {
    Lobe l;
    l.type = type;
    l.frame = frame;
    l.twoSided = twoSided;
    return l;
  }
  Lobe microfacets(LobeType type) const {
    Lobe l = lobe(type);
    l.distribution = material.distribution;
    l.alphaX = alpha(material.alphaU), l.alphaY = alpha(material.alphaV);
    return l;
  }
  // Black lobes are left out: nothing would ever come of them.
  void add(Lobe l, Rgb value, float selection) const {
    if (!(maxComponent(value) > 0) || !(selection > 0)) return;
    l.weight = value;
    l.selection = selection;
    bsdf.add(l);
  }
  void addStraight(Rgb value) const {
    Lobe l = lobe(LobeType::null);
    l.twoSided = true;
    add(l, value, weight);
  }
};

}  // namespace lobelia

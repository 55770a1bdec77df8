// Lobes of the materials that scatter themselves (those that wrap others: make_bsdf.cpp).
#pragma once

#include "lobelia/bsdf/lobe.h"
#include "lobelia/scene/shading.h"

namespace lobelia {

// Materials that may lie inside each other (of a broken scene, in a cycle); deeper ones are left
// out, which validate() reports.
inline constexpr int kMaxNesting = 32;

// Adds the lobes of a material to the BSDF, scaled by `weight`, with sampling shares for directions
// with this cosine of wo to bsdf.frame.n. twoSided: inside a two-sided material.
void addLobes(const Scene& scene, const Material& material, const TextureContext& at,
              float cosThetaO, float weight, bool twoSided, Bsdf& bsdf);

// The principled material (material_principled.cpp).
void addPrincipledLobes(const Scene& scene, const Material& material, const TextureContext& at,
                        float weight, bool twoSided, Bsdf& bsdf);
// Captured reflectance (material_captured.cpp).
void addCapturedLobes(const Scene& scene, const Material& material, const TextureContext& at,
                      float cosThetaO, float weight, bool twoSided, Bsdf& bsdf);

struct Builder;  // scene/lobe_builder.h
// glTF's material (material_metallic.cpp), metal under a dielectric coat (material_coated.cpp).
void addMetallicRoughnessLobes(const Builder& b);
void addCoatedConductorLobes(const Builder& b);

}  // namespace lobelia

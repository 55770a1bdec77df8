// Lobes of the materials that scatter themselves (those that wrap others: make_bsdf.cpp).
#pragma once

namespace lobelia {

// Materials that may lie inside each other (of a broken scene, in a cycle); deeper ones are left
// out, which validate() reports.
inline constexpr int kMaxNesting = 32;

// Adds the lobes of a material to a BSDF; scene/lobe_builder.h says what of it.
struct Builder;
void addLobes(const Builder& b);

// The principled material (material_principled.cpp), captured reflectance (material_captured.cpp),
// glTF's material (material_metallic.cpp), metal under a dielectric coat (material_coated.cpp).
void addPrincipledLobes(const Builder& b);
void addCapturedLobes(const Builder& b);
void addMetallicRoughnessLobes(const Builder& b);
void addCoatedConductorLobes(const Builder& b);

}  // namespace lobelia

// What surfaces reflect where nothing is in the way: the BRDF's slices as vMF lobes
// [P002 section 4; methods.md 0.5], from tables by elevation for each material, or from a Bsdf.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/scene/shading.h"
#include "lobelia/transfer/elevation_rows.h"

namespace lobelia::transfer {

// alpha: hemispherical integral of f cos over the lobe's directions.
struct ReflectedLobe {
  Vec3f axis{0, 0, 1};  // unit, world
  float kappa = 1;
  Rgb alpha{};
};

struct Reflection {
  static constexpr int kMostLobes = 12;  // of a streak
  static constexpr int kFewLobes = 4;    // of other materials
  Rgb diffuse{};                         // albedo of the diffuse lobes towards wo
  Rgb glossy{};                          // of all glossy ones: the sum of the lobes' alpha
  Vec3f n{0, 0, 1};                      // unit, on wo's side
  Vec3f mirror{};                        // unit: wo reflected about n
  Vec3f r{};  // mean of the glossy lobes' directions, by luminance; world, length < 1
  int count = 0;
  std::array<ReflectedLobe, kMostLobes> lobes;  // wide ones last
};

// The parts of a Bsdf that transfer knows: lobes that reflect. Delta lobes, and such as are sharper
// than kMostKappa (slice_record.h), become microfacets of about that; transmission is left out.
Bsdf diffusePart(const Bsdf& bsdf);
Bsdf glossyPart(const Bsdf& bsdf);
Reflection reflectionOf(const Bsdf& bsdf, Vec3f wo);
// The same without lobes, for sums of many: a fraction of the time.
Reflection summaryOf(const Bsdf& bsdf, Vec3f wo);

// Tables of a scene's materials. What is looked up is within .3 % of a Bsdf's albedos and .1 degree
// of its mean directions; lobes are closer to it than those of reflectionOf() (reflection_table.h).
class ReflectionTables {
 public:
  // Tables of all isotropic materials without textures that an instance has; others have none.
  // Up to half a second each, in parallel.
  explicit ReflectionTables(const Scene& scene);
  ~ReflectionTables();
  bool has(MaterialHandle material) const;
  // Of a material that has a table. n: unit, outside; wo: unit. False where the material reflects
  // nothing on wo's side.
  bool at(MaterialHandle material, Vec3f n, Vec3f wo, Reflection* out) const;
  // The same without lobes, for sums of many.
  bool summary(MaterialHandle material, Vec3f n, Vec3f wo, Reflection* out) const;
  // At a point of a material without such a table: from one by elevation and azimuth, where the
  // material is anisotropic, has one glossy lobe and no textures, else from its Bsdf.
  Reflection reflection(const Scene& scene, const SurfacePoint& at, Vec3f wo) const;
  Reflection summary(const Scene& scene, const SurfacePoint& at, Vec3f wo) const;
  // Tables by number, for registers of pixels: two for each material of the scene, behind last.
  size_t tableCount() const;
  static size_t numberOf(MaterialHandle material, bool behind) {
    return 2 * size_t{material.index} + (behind ? 1 : 0);
  }
  // Without nodes: that side reflects nothing. Of a material that has a table.
  ElevationRows rows(size_t number) const;
  // kappa of a material's sharpest glossy lobe, for directions of wo up to 45 degrees from the
  // normal; of one without table where some triangles have their middles. 0: there is none.
  float sharpest(MaterialHandle material) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Turns v by the smallest rotation that takes `from` to `to`; both unit.
Vec3f turned(Vec3f v, Vec3f from, Vec3f to);

}  // namespace lobelia::transfer

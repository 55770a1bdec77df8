// Tables of a scene's materials (reflection.h): for each that an instance uses, at a point made up
// for it, since without textures all points are alike.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lobelia/base/parallel.h"
#include "lobelia/transfer/anisotropic_table.h"
#include "lobelia/transfer/reflection_table.h"
#include "lobelia/transfer/transfer_mesh.h"

namespace lobelia::transfer {
namespace {

constexpr uint32_t kMostTriangles =
    64;  // of an instance, at which textured materials are looked at

using Sides = std::array<ReflectionTable, 2>;  // in front, behind

// The Bsdf of an instance at a triangle, in the frame z = normal.
Bsdf bsdfAt(const Scene& scene, uint32_t instance, uint32_t triangle, Vec3f wo) {
  SurfacePoint point = surfacePoint(scene, {0, 1.f / 3, 1.f / 3, instance, triangle});
  point.frame = Frame{};
  point.ng = point.frame.n, point.dpdu = point.frame.s, point.dpdv = point.frame.t;
  return makeBsdf(scene, point, wo, 0);
}

bool isIsotropic(const Bsdf& bsdf) {
  const Bsdf glossy = glossyPart(bsdf);
  for (int i = 0; i < glossy.lobeCount; ++i)
    if (glossy.lobes[i].type != LobeType::phong && glossy.lobes[i].alphaX != glossy.lobes[i].alphaY)
      return false;
  return true;
}

using AnisotropicSides = std::array<AnisotropicTable, 2>;

// One of the two, or none.
struct Tables {
  std::unique_ptr<Sides> byElevation;
  std::unique_ptr<AnisotropicSides> byDirection;
};
Tables tablesOf(const Scene& scene, uint32_t instance) {
  const auto at = [&](Vec3f wo) { return bsdfAt(scene, instance, 0, wo); };
  bool isotropic = true, served = true;
  for (const float side : {1.f, -1.f}) {
    const Bsdf bsdf = at({0.6f, 0, 0.8f * side});
    isotropic = isotropic && isIsotropic(bsdf);
    served = served && (AnisotropicTable::isServed(bsdf) || glossyPart(bsdf).lobeCount == 0);
  }
  if (isotropic)
    return {std::make_unique<Sides>(Sides{ReflectionTable(at, false), ReflectionTable(at, true)}),
            nullptr};
  if (!served) return {};
  return {nullptr, std::make_unique<AnisotropicSides>(
                       AnisotropicSides{AnisotropicTable(at, false), AnisotropicTable(at, true)})};
}

// Of an instance whose material has no table.
float sharpestOf(const Scene& scene, uint32_t instance) {
  float sharpest = 0;
  const size_t triangles = scene[scene.instances[instance].mesh].triangles.size();
  const size_t looks = std::min<size_t>(triangles, kMostTriangles);
  for (size_t i = 0; i < looks; ++i)
    for (const float side : {1.f, -1.f}) {
      const auto triangle = static_cast<uint32_t>(i * triangles / looks);
      const Vec3f wo(0.05f, 0, side);
      const Reflection r =
          reflectionOf(bsdfAt(scene, instance, triangle, normalize(wo)), normalize(wo));
      if (r.count > 0) sharpest = std::max(sharpest, r.lobes[0].kappa);
    }
  return sharpest;
}

}  // namespace

struct ReflectionTables::Impl {
  // By material.
  std::vector<std::unique_ptr<Sides>> tables;
  std::vector<std::unique_ptr<AnisotropicSides>> anisotropic;
  std::vector<float> sharpest;

  const AnisotropicTable* anisotropicAt(const SurfacePoint& at, Vec3f wo) const {
    const AnisotropicSides* const sides =
        at.material.valid() ? anisotropic[at.material.index].get() : nullptr;
    return sides ? &(*sides)[dot(at.frame.n, wo) < 0 ? 1 : 0] : nullptr;
  }
};

ReflectionTables::ReflectionTables(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  impl_->tables.resize(scene.materials.size());
  impl_->anisotropic.resize(scene.materials.size());
  std::vector<std::optional<uint32_t>> users(scene.materials.size());  // an instance each
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (instance.material.valid() && !scene[instance.mesh].triangles.empty())
      users[instance.material.index] = i;
  }
  parallelFor(users.size(), 1, [&](size_t i) {
    const MaterialHandle material{static_cast<uint32_t>(i)};
    if (!users[i] || isTextured(scene, material)) return;
    Tables tables = tablesOf(scene, *users[i]);
    impl_->tables[i] = std::move(tables.byElevation);
    impl_->anisotropic[i] = std::move(tables.byDirection);
  });
  std::vector<float> found(scene.instances.size());
  parallelFor(scene.instances.size(), 1, [&](size_t i) {
    const MaterialHandle material = scene.instances[i].material;
    if (material.valid() && !has(material)) found[i] = sharpestOf(scene, static_cast<uint32_t>(i));
  });
  impl_->sharpest.resize(scene.materials.size(), 0);
  for (size_t i = 0; i < found.size(); ++i)
    if (const MaterialHandle m = scene.instances[i].material; m.valid())
      impl_->sharpest[m.index] = std::max(impl_->sharpest[m.index], found[i]);
  for (size_t m = 0; m < impl_->tables.size(); ++m)
    if (impl_->tables[m])
      for (const ReflectionTable& table : *impl_->tables[m])
        impl_->sharpest[m] = std::max(impl_->sharpest[m], table.sharpest());
}

ReflectionTables::~ReflectionTables() = default;

bool ReflectionTables::has(MaterialHandle material) const {
  return material.index < impl_->tables.size() && impl_->tables[material.index] != nullptr;
}

bool ReflectionTables::at(MaterialHandle material, Vec3f n, Vec3f wo, Reflection* out) const {
  const float cosine = dot(n, wo);
  const ReflectionTable& table = (*impl_->tables[material.index])[cosine < 0 ? 1 : 0];
  if (!table.reflects()) return false;
  table.lookUp(std::abs(cosine), cosine < 0 ? -n : n, wo, out);
  return true;
}

bool ReflectionTables::summary(MaterialHandle material, Vec3f n, Vec3f wo, Reflection* out) const {
  const float cosine = dot(n, wo);
  const ReflectionTable& table = (*impl_->tables[material.index])[cosine < 0 ? 1 : 0];
  if (!table.reflects()) return false;
  table.summary(std::abs(cosine), cosine < 0 ? -n : n, wo, out);
  return true;
}

Reflection ReflectionTables::reflection(const Scene& scene, const SurfacePoint& at,
                                        Vec3f wo) const {
  const AnisotropicTable* const table = impl_->anisotropicAt(at, wo);
  if (!table) return reflectionOf(makeBsdf(scene, at, wo, 0), wo);
  Reflection out;
  if (table->reflects()) table->lookUp(at.frame, wo, &out);
  return out;
}

Reflection ReflectionTables::summary(const Scene& scene, const SurfacePoint& at, Vec3f wo) const {
  const AnisotropicTable* const table = impl_->anisotropicAt(at, wo);
  if (!table) return summaryOf(makeBsdf(scene, at, wo, 0), wo);
  Reflection out;
  if (table->reflects()) table->summary(at.frame, wo, &out);
  return out;
}

size_t ReflectionTables::tableCount() const { return 2 * impl_->tables.size(); }

ElevationRows ReflectionTables::rows(size_t number) const {
  const ReflectionTable& table = (*impl_->tables[number / 2])[number % 2];
  return table.reflects() ? table.rows() : ElevationRows{};
}

float ReflectionTables::sharpest(MaterialHandle material) const {
  return material.valid() ? impl_->sharpest[material.index] : 0.f;
}

}  // namespace lobelia::transfer

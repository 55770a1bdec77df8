// A material's reflection by elevation of wo, on one side of it.
#pragma once

#include <functional>
#include <vector>

#include "lobelia/transfer/elevation_rows.h"
#include "lobelia/transfer/reflection.h"

namespace lobelia::transfer {

// Directions are kept as what they have of the mirror direction and of the normal: both change
// little between elevations, at the normal, too, where mirror direction and normal are one.
// 128 elevations, evenly spaced in the square root of the cosine, for grazing angles.
class ReflectionTable {
 public:
  // bsdfFor(wo): the material's Bsdf in the frame z = normal, as seen from wo with y = 0. behind:
  // wo is below. The material has to be isotropic and without bumps.
  ReflectionTable(const std::function<Bsdf(Vec3f wo)>& bsdfFor, bool behind);

  bool reflects() const { return !nodes_.empty(); }
  // Of lobes that have a tenth of the energy, up to 45 degrees from the normal: towards grazing
  // angles lobes get long and thin, without end. 0: there is none.
  float sharpest() const;

  // For registers of pixels; nothing of it unless it reflects.
  ElevationRows rows() const;

  // cosine: between n, on wo's side, and wo; > 0.
  void summary(float cosine, Vec3f n, Vec3f wo, Reflection* out) const;
  // The same with lobes.
  void lookUp(float cosine, Vec3f n, Vec3f wo, Reflection* out) const;

 private:
  struct Node {
    Rgb diffuse{}, glossy{};
    float mirror = 0, normal = 0;  // of r
  };
  struct LobeNode {
    float mirror = 0, normal = 1;  // of the axis, of any length
    float width = 1;               // 1 / sqrt(kappa)
    Rgb alpha{};
  };
  static_assert(sizeof(Node) == ElevationRows::kNodeStride * sizeof(float));
  static_assert(sizeof(LobeNode) == ElevationRows::kLobeStride * sizeof(float));
  struct Builder;
  void fillDark();
  void sortByWidth();
  std::vector<Node> nodes_;
  int lobeCount_ = 0;
  std::vector<LobeNode> lobes_;  // lobeCount_ for each node
};

}  // namespace lobelia::transfer

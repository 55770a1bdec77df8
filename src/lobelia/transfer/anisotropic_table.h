// An anisotropic material's reflection by elevation and azimuth of wo, on one side of it.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "lobelia/transfer/reflection.h"

namespace lobelia::transfer {

// Directions are kept as what leads to them from the mirror direction, along the plane of
// incidence, across it and along the normal: it changes little from one direction of wo to the
// next, at the normal, too, about which a streak stays where it is. 64 elevations, evenly spaced in
// the square root of the angle from the horizon, by 48 azimuths.
class AnisotropicTable {
 public:
  // bsdfFor(wo): the material's Bsdf in the frame s, t, n = x, y, z. behind: wo is below. The
  // material has to be without bumps and textures, and isServed().
  AnisotropicTable(const std::function<Bsdf(Vec3f wo)>& bsdfFor, bool behind);
  // Has it one glossy lobe, so that its row of vMF lobes (reflected_lobes.h) is the same row from
  // one direction to the next?
  static bool isServed(const Bsdf& bsdf);

  bool reflects() const { return !nodes_.empty(); }
  // frame: of the surface, n outside; wo: on the table's side.
  void summary(const Frame& frame, Vec3f wo, Reflection* out) const;
  // The same with lobes.
  void lookUp(const Frame& frame, Vec3f wo, Reflection* out) const;

 private:
  static constexpr size_t kLobes = Reflection::kMostLobes;
  struct LobeNode {
    Vec3f axis{};
    float width = 1;  // 1 / sqrt(kappa)
    Rgb alpha{};
  };
  struct Node {
    Rgb diffuse{}, glossy{};
    Vec3f r{};
    std::array<LobeNode, kLobes> lobes;
    size_t count = 0;
  };
  struct Incidence;  // the directions that parts are of
  struct Place;      // four nodes and their weights
  static Place placeOf(const Incidence& incidence);
  static Node nodeAt(const Bsdf& bsdf, const Incidence& incidence);
  Place summarize(const Incidence& incidence, Reflection* out) const;

  std::vector<Node> nodes_;  // azimuth by azimuth
  size_t lobeCount_ = 0;     // of each, with such as have no energy
};

}  // namespace lobelia::transfer

#include "lobelia/builtin/foliage.h"

#include <cmath>

#include "lobelia/builtin/mesh_edit.h"

namespace lobelia::builtin {

Mesh leaf(const Leaf& shape, int along, int across) {
  // t^p (1 - t) is largest at p / (p + 1); the square root rounds base and tip.
  const float power = shape.widest / (1 - shape.widest);
  const auto outline = [power](float t) { return std::pow(t, power) * (1 - t); };
  const float most = outline(shape.widest);
  Mesh mesh;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= across; ++j) {
      const float t = fraction(i, along), side = 2 * fraction(j, across) - 1;
      const float half = 0.5f * shape.width * std::sqrt(std::max(outline(t) / most, 0.f));
      const float rise = shape.fold * half * std::abs(side) +
                         shape.wave * half * sqr(side) * std::sin(14 * t + 2 * side);
      mesh.positions.push_back(
          {t, 0.3f * shape.bend * t - 1.3f * shape.bend * t * t + rise, half * side});
      mesh.uvs.push_back({t, fraction(j, across)});
    }
  // Rows run along x and columns along z: seen from below, so the other way around.
  addGrid(mesh, 0, along, across);
  mesh = creased(std::move(mesh), -1);
  return mesh.normals[mesh.normals.size() / 2].y < 0 ? turnedInsideOut(std::move(mesh)) : mesh;
}

void Foliage::addLeaf(const Mesh& leaf, Vec3f at, float azimuth, float elevation, float roll,
                      float size) {
  leaves_.push_back(
      transformed(leaf, moving(at) * rotation({0, 1, 0}, static_cast<double>(azimuth)) *
                            rotation({0, 0, 1}, static_cast<double>(elevation)) *
                            rotation({1, 0, 0}, static_cast<double>(roll)) *
                            scaling(Vec3d(static_cast<double>(size)))));
}

void Foliage::addStem(const Curve& curve, float radius, int along, int around) {
  SweepOptions options;
  options.scale = [](float t) { return 1 - 0.65f * t; };
  stems_.push_back(tube(curve, radius, along, around, options));
}

Curve Foliage::arch(Vec3f from, float azimuth, float elevation, float length, float droop) {
  const float a = azimuth * kPi / 180, e = elevation * kPi / 180;
  const Vec3f ahead{std::cos(e) * std::cos(a), std::sin(e), -std::cos(e) * std::sin(a)};
  return [=](float t) { return from + ahead * (length * t) - Vec3f(0, droop * length * t * t, 0); };
}

Mesh Foliage::leaves() const { return merged(leaves_); }
Mesh Foliage::stems() const { return merged(stems_); }

}  // namespace lobelia::builtin

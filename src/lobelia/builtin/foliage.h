// Leaves, and shoots that carry them (internal to this room). Metres, y up; angles in degrees:
// azimuths from +x towards -z, elevations above the horizon.
#pragma once

#include <vector>

#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin {

// A thin leaf along +x from 0 to 1, its upper side up; uv = (along, across).
struct Leaf {
  float width = 0.5f;   // of both halves together
  float widest = 0.4f;  // where, 0 to 1
  float bend = 0.4f;    // how far the tip hangs down
  float fold = 0.15f;   // how far the edges rise above the midrib
  float wave = 0;       // of the edges, up and down
};
Mesh leaf(const Leaf& shape, int along, int across);

// A plant: what is green in one mesh, what is wood in another.
class Foliage {
 public:
  // `size` long, from `at`, turned about its own axis by `roll`.
  void addLeaf(const Mesh& leaf, Vec3f at, float azimuth, float elevation, float roll, float size);
  void addStem(const Curve& curve, float radius, int along, int around);
  // A curve that leaves `from` and bends down by `droop` over its length.
  static Curve arch(Vec3f from, float azimuth, float elevation, float length, float droop);

  Mesh leaves() const;
  Mesh stems() const;

 private:
  std::vector<Mesh> leaves_, stems_;
};

}  // namespace lobelia::builtin

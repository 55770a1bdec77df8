// A heap of things: where they come to rest (internal to this room).
#pragma once

#include <functional>
#include <vector>

#include "lobelia/base/random.h"
#include "lobelia/base/transform.h"

namespace lobelia::builtin {

// The height of the heap over a square of the ground, on a grid, raised by what is put onto it.
class Pile {
 public:
  Pile(float halfSize, int cells, const std::function<float(Vec2f)>& ground);
  float heightAt(Vec2f at) const;
  float meanHeight(Vec2f at, float radius) const;

  // A disc falls at `at`: it takes the slope of what is under it, tilts a little at random and
  // touches it from above. Returns the placement of a disc around y = 0 of the given radius and
  // half thickness.
  Mat4 settle(Vec2f at, float radius, float halfThickness, float randomTilt, Rng& rng);
  // Keeps settling things away from a disc.
  void block(Vec2f at, float radius);
  bool isBlocked(Vec2f at) const;

 private:
  template <class F>
  void forCellsIn(Vec2f at, float radius, const F& f) const;
  size_t cellOf(Vec2f at) const;
  Vec2f centreOf(int x, int y) const;
  float half_, size_;
  int cells_;
  std::vector<float> height_;
  std::vector<bool> blocked_;
};

}  // namespace lobelia::builtin

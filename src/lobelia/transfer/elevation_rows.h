// A material's reflection by elevation as rows of floats (reflection_table.h, interpolation-inl.h).
#pragma once

namespace lobelia::transfer {

struct ElevationRows {
  static constexpr int kNodeStride = 8, kLobeStride = 6;
  // By node: diffuse and glossy albedo, then what the mean direction has of mirror direction and
  // normal.
  const float* nodes = nullptr;
  // lobeCount for each node: what the axis has of mirror direction and normal, 1 / sqrt(kappa),
  // alpha.
  const float* lobes = nullptr;
  int nodeCount = 0, lobeCount = 0;
};

}  // namespace lobelia::transfer

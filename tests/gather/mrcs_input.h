// Rows and columns for the tests of matrix row-column sampling.
#pragma once

#include "gather/random_input.h"
#include "lobelia/gather/mrcs.h"

namespace lobelia::test {

// Of some pixels only.
inline Receivers receiversOf(const Receivers& all, const PixelSet& set) {
  Receivers part;
  for (const ReceiverPoint& point : all.points) {
    if (!std::binary_search(set.pixels.begin(), set.pixels.end(), point.pixel)) continue;
    part.points.push_back(point);
    part.points.back().firstLobe = static_cast<uint32_t>(part.lobes.size());
    for (size_t l = 0; l < point.lobeCount; ++l)
      part.lobes.push_back(all.lobes[point.firstLobe + l]);
  }
  return part;
}

inline gather::Rows rowsOf(const Receivers& all, int width, int height, size_t rows,
                           uint64_t seed) {
  const gather::RowPixels chosen = gather::chooseRowPixels(width, height, {}, rows, seed);
  return gather::makeRows(chosen, receiversOf(all, chosen.pixels), width);
}

// A matrix of columns made by hand, kept whole: the first `dims` values of each are rows, 16 more
// check rows.
inline gather::LightColumns columnsFrom(const std::vector<std::vector<float>>& vectors,
                                        double unseen) {
  gather::LightColumns columns;
  columns.count = vectors.size();
  columns.checkDims = 16;
  columns.dims = vectors[0].size() - columns.checkDims;
  columns.unseen = unseen;
  std::vector<double> total(vectors[0].size(), 0.0);
  for (const std::vector<float>& v : vectors) {
    double squared = unseen;
    for (size_t d = 0; d < v.size(); ++d) {
      total[d] += double{v[d]};
      if (d < columns.dims) squared += double{v[d]} * double{v[d]};
    }
    columns.weight.push_back(static_cast<float>(std::sqrt(squared)));
    columns.scale.push_back(1 / columns.weight.back());
    columns.whole.insert(columns.whole.end(), v.begin(), v.end());
  }
  for (size_t d = 0; d < total.size(); ++d)
    (d < columns.dims ? columns.rowNorm : columns.checkNorm) += total[d] * total[d];
  columns.rowNorm = std::sqrt(columns.rowNorm);
  columns.checkNorm = std::sqrt(columns.checkNorm);
  return columns;
}

// Columns about some random directions, of lengths that differ widely.
inline std::vector<std::vector<float>> scatteredVectors(size_t count, size_t dims, size_t groups,
                                                        uint64_t seed) {
  Rng rng(seed);
  std::vector<std::vector<float>> centres(groups, std::vector<float>(dims + 16));
  for (auto& centre : centres)
    for (float& x : centre) x = std::max(rng.next1D() - 0.6f, 0.f);
  std::vector<std::vector<float>> vectors;
  for (size_t i = 0; i < count; ++i) {
    const auto& centre = centres[rng.nextUint() % groups];
    const float length = std::pow(30.f, rng.next1D());
    std::vector<float> v;
    for (const float x : centre) v.push_back(length * x * (0.6f + 0.8f * rng.next1D()));
    vectors.push_back(std::move(v));
  }
  return vectors;
}

}  // namespace lobelia::test

// Table over (cosine, alpha) with cubic interpolation, for directional albedos.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lobelia {

// Width values per entry. Nodes are uniform in sqrt(cosine) over [0, 1], which resolves the grazing
// angles where shadowing sets in, and in log(alpha).
template <int Width>
class AlbedoGrid {
 public:
  using Entry = std::array<float, Width>;
  // integrate(cosine, alpha) gives an entry; cosine > 0.
  template <class F>
  AlbedoGrid(int cosines, int alphas, float alphaMin, float alphaMax, const F& integrate)
      : cosines_(cosines),
        alphas_(alphas),
        logMin_(std::log(alphaMin)),
        logStep_((std::log(alphaMax) - std::log(alphaMin)) / static_cast<float>(alphas - 1)) {
    entries_.reserve(static_cast<size_t>(cosines) * static_cast<size_t>(alphas));
    for (int a = 0; a < alphas; ++a) {
      const float alpha = std::exp(logMin_ + logStep_ * static_cast<float>(a));
      for (int c = 0; c < cosines; ++c) {
        const float s = static_cast<float>(c) / static_cast<float>(cosines - 1);
        entries_.push_back(integrate(std::max(s * s, 1e-5f), alpha));
      }
    }
  }

  Entry lookUp(float cosine, float alpha) const {
    const Stencil c =
        stencil(std::sqrt(std::max(cosine, 0.f)) * static_cast<float>(cosines_ - 1), cosines_);
    const Stencil a = stencil((std::log(std::max(alpha, 1e-8f)) - logMin_) / logStep_, alphas_);
    Entry result{};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const float w = a.weights[i] * c.weights[j];
        const Entry& e = entries_[static_cast<size_t>(a.index[i] * cosines_ + c.index[j])];
        for (int k = 0; k < Width; ++k)
          result[static_cast<size_t>(k)] += w * e[static_cast<size_t>(k)];
      }
    }
    return result;
  }

 private:
  struct Stencil {
    int index[4];
    float weights[4];
  };
  // Catmull-Rom; beyond the ends the table goes on straight.
  static Stencil stencil(float x, int count) {
    x = std::clamp(x, 0.f, static_cast<float>(count - 1));
    const int i = std::min(static_cast<int>(x), count - 2);
    const float t = x - static_cast<float>(i), t2 = t * t, t3 = t2 * t;
    Stencil s{{i - 1, i, i + 1, i + 2},
              {0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2 + 2),
               0.5f * (-3 * t3 + 4 * t2 + t), 0.5f * (t3 - t2)}};
    if (i == 0) {
      s.weights[1] += 2 * s.weights[0], s.weights[2] -= s.weights[0];
      s.index[0] = 0, s.weights[0] = 0;
    }
    if (i + 2 == count) {
      s.weights[2] += 2 * s.weights[3], s.weights[1] -= s.weights[3];
      s.index[3] = i, s.weights[3] = 0;
    }
    return s;
  }

  int cosines_, alphas_;
  float logMin_, logStep_;
  std::vector<Entry> entries_;
};

}  // namespace lobelia

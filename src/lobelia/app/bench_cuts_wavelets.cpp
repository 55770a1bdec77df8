// Figure 8 (a) of [P004]: how many terms Haar wavelets and cuts take for visibility on a cube map.
//
// The paper compares averages over vertices, of terms and of errors, wavelets bounded by the error
// of a whole function and cuts by that of each node. Here each cut's terms stand beside those that
// wavelets take for the very error of that cut, vertex by vertex. Texels count alike, whatever
// their solid angle; behind a vertex' faces nothing is visible, and that counts, too. Cuts have
// neither a limit of their size nor rounded means.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "lobelia/app/bench_cuts_vertices.h"
#include "lobelia/app/bench_plot.h"
#include "lobelia/app/haar.h"
#include "lobelia/app/study_tree.h"

namespace lobelia::app {
namespace {

constexpr double kSigmas[] = {16, 8, 4, 2, 1, 0};
constexpr double kWaveletRms[] = {0.3, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035, 0.025, 0.01};
constexpr float kBetas[] = {1, 0.5f, 0};
constexpr const char* kTrees[] = {"quad tree", "binary tree", "geometric", "mixed", "data-driven"};

// Unit directions through the middles of texels, (face * side + y) * side + x, and the solid angle
// that each stands for here.
relight::LightSamples cubeDirections(uint32_t side) {
  relight::LightSamples out;
  const uint32_t count = 6 * side * side;
  out.p.reserve(count);
  for (uint32_t face = 0; face < 6; ++face)
    for (uint32_t y = 0; y < side; ++y)
      for (uint32_t x = 0; x < side; ++x) {
        const auto at = [&](uint32_t i) {
          return (2 * static_cast<float>(i) + 1) / static_cast<float>(side) - 1;
        };
        const float end = face % 2 == 0 ? 1.f : -1.f;
        const Vec3f d = face / 2 == 0   ? Vec3f(end, at(y), at(x))
                        : face / 2 == 1 ? Vec3f(at(x), end, at(y))
                                        : Vec3f(at(x), at(y), end);
        out.p.push_back(normalize(d));
      }
  out.measure.assign(count, 4 * kPi / static_cast<float>(count));
  return out;
}

// The largest cube map of at most four texels to a direction: 128 for 32,768.
uint32_t cubeSide(size_t directions) {
  uint32_t side = 2;
  while (24 * size_t{side} * side <= 4 * directions) side *= 2;
  return side;
}

// A vertex' function: what each of the cuts and each bound of the wavelets took.
struct Terms {
  double terms = 0, rms = 0;
  double wavelets = 0;  // of as small an error
  Terms& operator+=(const Terms& o) {
    terms += o.terms, rms += o.rms, wavelets += o.wavelets;
    return *this;
  }
};
struct VertexTerms {
  std::array<std::array<Terms, std::size(kSigmas)>, std::size(kTrees)> cuts;
  std::array<Terms, std::size(kWaveletRms)> wavelets;
};

// One thread's work on vertex after vertex.
class TermCounter {
 public:
  TermCounter(uint32_t side, std::span<const StudyTree> trees)
      : side_(side), transform_(side), coefficients_(6 * size_t{side} * side) {
    for (const StudyTree& tree : trees) counters_.emplace_back(tree);
  }

  VertexTerms count(const relight::LeafBits& bits) {
    const CoefficientCounts wavelets = transformed(bits);
    const auto texels = static_cast<double>(coefficients_.size());
    VertexTerms out;
    for (size_t i = 0; i < std::size(kWaveletRms); ++i) {
      const size_t terms = wavelets.terms(kWaveletRms[i] * kWaveletRms[i] * texels);
      const double count = static_cast<double>(terms);
      out.wavelets[i] = {count, std::sqrt(wavelets.squaredError(terms) / texels), count};
    }
    for (size_t t = 0; t < counters_.size(); ++t) {
      counters_[t].set(bits.visible, {});
      for (size_t s = 0; s < std::size(kSigmas); ++s) {
        const CutCost cost = counters_[t].cost(kSigmas[s]);
        out.cuts[t][s] = {static_cast<double>(cost.nodes), std::sqrt(cost.squaredError / texels),
                          static_cast<double>(wavelets.terms(cost.squaredError))};
      }
    }
    return out;
  }

 private:
  CoefficientCounts transformed(const relight::LeafBits& bits) {
    for (size_t i = 0; i < coefficients_.size(); ++i)
      coefficients_[i] = static_cast<float>(bits.visible[i / 64] >> (i % 64) & 1);
    const size_t texels = size_t{side_} * side_;
    for (size_t face = 0; face < 6; ++face)
      transform_.forward(std::span(coefficients_).subspan(face * texels, texels));
    return CoefficientCounts(coefficients_);
  }

  const uint32_t side_;
  HaarTransform transform_;
  std::vector<float> coefficients_;
  std::vector<CutCounter> counters_;
};

std::vector<StudyTree> treesOf(const StudyVertices& vertices, const relight::LightSamples& texels,
                               uint32_t side) {
  std::vector<StudyTree> trees{cubeQuadTree(side), cubeBinaryTree(side)};
  for (std::vector<uint32_t>& order : vertices.treeOrders(texels, kBetas))
    trees.push_back(halvedTree(std::move(order)));
  return trees;
}

// Means over vertices, in their order.
VertexTerms meanTerms(std::span<const VertexTerms> vertices) {
  VertexTerms sum;
  for (const VertexTerms& v : vertices) {
    for (size_t i = 0; i < sum.wavelets.size(); ++i) sum.wavelets[i] += v.wavelets[i];
    for (size_t t = 0; t < sum.cuts.size(); ++t)
      for (size_t s = 0; s < sum.cuts[t].size(); ++s) sum.cuts[t][s] += v.cuts[t][s];
  }
  const auto divide = [&](Terms& terms) {
    const auto n = static_cast<double>(vertices.size());
    terms = {terms.terms / n, terms.rms / n, terms.wavelets / n};
  };
  for (Terms& terms : sum.wavelets) divide(terms);
  for (auto& tree : sum.cuts) std::for_each(tree.begin(), tree.end(), divide);
  return sum;
}

BenchTable& tableOf(const CutsStudy& study, uint32_t side, size_t vertices) {
  return study.report.table(
      {"figure8a",
       "Figure 8 (a): terms of cuts and of Haar wavelets",
       {{"scene", "scene"},
        {"tree", "tree"},
        {"sigma", "sigma", "{:.0f}"},
        {"terms", "terms", "{:.0f}"},
        {"rms", "RMS", "{:.4f}"},
        {"wavelets", "wavelets' terms", "{:.0f}"},
        {"more", "more terms", "{:.2f}"},
        {"more_means", "by means", "{:.2f}"}},
       {},
       {fmt::format("Visibility of {} vertices on a cube map of 6x{}x{} texels, means over the "
                    "vertices. Wavelets' terms: of the same error, vertex by vertex. By means: the "
                    "same with "
                    "wavelets of one error for all vertices, at equal mean RMS, as the paper "
                    "compares. Trees: of the "
                    "cube map, or of its texels by the metric of places (beta 1), of both (0.5) "
                    "and of pilot visibility (0).",
                    vertices, side, side)}});
}

void report(const std::string& scene, uint32_t side, size_t vertices, const VertexTerms& means,
            const CutsStudy& study) {
  BenchTable& table = tableOf(study, side, vertices);
  PlotCurve wavelets{"wavelets", {}};
  std::vector<std::pair<double, double>> termsByRms;
  for (const Terms& t : means.wavelets) {
    wavelets.points.emplace_back(t.terms, t.rms);
    termsByRms.emplace_back(t.rms, t.terms);
  }
  std::vector<PlotCurve> curves{wavelets};
  for (size_t t = 0; t < std::size(kTrees); ++t) {
    curves.push_back({kTrees[t], {}});
    for (size_t s = 0; s < std::size(kSigmas); ++s) {
      const Terms& cut = means.cuts[t][s];
      table.rows.push_back({scene, std::string(kTrees[t]), kSigmas[s], cut.terms, cut.rms,
                            cut.wavelets, cut.terms / cut.wavelets - 1,
                            cut.terms / interpolated(termsByRms, cut.rms) - 1});
      curves.back().points.emplace_back(cut.terms, cut.rms);
    }
  }
  study.report.show("figure8a", scene,
                    {{"RMS over terms", study.report.drawing(fmt::format("figure8a-{}", scene),
                                                             logLogPlot("terms", "RMS", curves))}});
}

}  // namespace

void cutsWavelets(const std::string& scene, const StudyVertices& vertices, const CutsStudy& study) {
  study.progress(scene, "wavelets");
  const uint32_t side = cubeSide(study.sampleCount());
  const relight::LightSamples texels = cubeDirections(side);
  const std::vector<StudyTree> trees = treesOf(vertices, texels, side);
  std::vector<VertexTerms> terms(vertices.count());
  vertices.trace(texels, [&] {
    return
        [counter = std::make_shared<TermCounter>(side, trees), &terms](
            size_t vertex, const relight::LeafBits& bits) { terms[vertex] = counter->count(bits); };
  });
  report(scene, side, vertices.count(), meanTerms(terms), study);
}

}  // namespace lobelia::app

// Figures 5 and 8 (b) of [P004]: light samples clustered by the three metrics, as a picture of the
// sphere of directions and in numbers, and the size of cuts over the bound of their nodes.
//
// Cuts are those of some vertices, without a limit of their size and with exact means. What lies
// behind all faces of a vertex is not visible and counts, as in the paper; the cuts that leave it
// out, as `lobelia precompute` does, stand beside.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>

#include "lobelia/app/bench_cuts_vertices.h"
#include "lobelia/app/bench_plot.h"
#include "lobelia/app/study_tree.h"
#include "lobelia/base/random.h"
#include "lobelia/relight/light_cut.h"

namespace lobelia::app {
namespace {

struct Metric {
  const char* name;
  float beta;
};
constexpr Metric kMetrics[] = {{"geometric", 1}, {"mixed", 0.5f}, {"data-driven", 0}};
constexpr float kBetas[] = {1, 0.5f, 0};
constexpr double kSigmas[] = {1.5, 2, 3, 4};  // the paper's range, and one more
constexpr size_t kMiddle = 1;                 // of figure 5
constexpr int kDepth = 9;                     // of the clusters shown: 512 of them
constexpr size_t kLightNodes = 512;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Clusters of samples in the order of a tree, `size` each.
size_t clusterSize(size_t samples) { return std::max<size_t>(samples >> kDepth, 4); }

// Root of the mean squared angle between directions and the mean of their cluster, in degrees.
double spreadOf(std::span<const Vec3f> directions, size_t size) {
  double sum = 0;
  for (size_t begin = 0; begin < directions.size(); begin += size) {
    const auto cluster = directions.subspan(begin, size);
    Vec3f mean(0.f);
    for (const Vec3f& d : cluster) mean += d;
    const float scale = std::max(length(mean), 1e-20f);
    for (const Vec3f& d : cluster) {
      const double cosine = static_cast<double>(std::clamp(dot(d, mean) / scale, -1.f, 1.f));
      sum += std::acos(cosine) * std::acos(cosine);
    }
  }
  constexpr double kDegrees = 57.29577951308232;
  return kDegrees * std::sqrt(sum / static_cast<double>(directions.size()));
}

// Of the scene's light from infinity, as a light cut of the tree has it: root of the squared
// difference from the samples' own over their squares.
double lightError(const Scene& scene, const relight::LightSamples& samples) {
  const relight::DirectionLookup lookup(samples.p);
  const relight::LightSums sums =
      relight::lightSums(relight::distantLight(scene), Mat4{}, samples, lookup);
  const relight::LightCut cut = relight::selectLightCut(sums, {.nodeCount = kLightNodes});
  const auto power = [&](size_t node) { return static_cast<double>(luminance(sums.power(node))); };
  double difference = 0, all = 0;
  for (size_t i = 0; i < cut.count; ++i) {
    const uint32_t begin = cut.begin[i], end = cut.begin[i + 1];
    const double mean = power(cut.heap[i]) / (end - begin);
    for (uint32_t leaf = begin; leaf < end; ++leaf) {
      const double own = power(samples.count() + leaf);
      difference += (own - mean) * (own - mean), all += own * own;
    }
  }
  return all > 0 ? std::sqrt(difference / all) : kNone;
}

// Two discs of the same area as their hemispheres: seen from +y, and from -y.
std::vector<uint8_t> spherePicture(const relight::LightSamples& samples, size_t size, Film* shape) {
  constexpr int kSide = 400;
  const relight::DirectionLookup lookup(samples.p);
  shape->fullWidth = shape->width = 2 * kSide, shape->fullHeight = shape->height = kSide;
  std::vector<uint8_t> pixels;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < 2 * kSide; ++x) {
      constexpr float kRadius = 0.48f * kSide;
      const float u = (static_cast<float>(x % kSide) + 0.5f - 0.5f * kSide) / kRadius;
      const float v = (static_cast<float>(y) + 0.5f - 0.5f * kSide) / kRadius;
      const float r2 = u * u + v * v;
      uint64_t color = 0xffffff;
      if (r2 < 1) {
        const float sine = std::sqrt(2 - r2);  // over the radius
        const Vec3f d{u * sine, x < kSide ? 1 - r2 : r2 - 1, v * sine};
        color = mixBits(lookup.nearest(d) / size + 1) | 0x404040;
      }
      for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<uint8_t>(color >> (8 * c)));
    }
  return pixels;
}

struct MetricCost {
  std::array<CutCost, std::size(kSigmas)> all, front;  // samples that count
  double clusters = 0;                                 // squared error of the clusters' means
  double frontSamples = 0;

  void add(const MetricCost& o) {
    for (size_t s = 0; s < std::size(kSigmas); ++s)
      for (auto costs : {&MetricCost::all, &MetricCost::front}) {
        (this->*costs)[s].nodes += (o.*costs)[s].nodes;
        (this->*costs)[s].squaredError += (o.*costs)[s].squaredError;
      }
    clusters += o.clusters, frontSamples += o.frontSamples;
  }
};
using VertexCost = std::array<MetricCost, std::size(kMetrics)>;

MetricCost costOf(const relight::LeafBits& bits, size_t samples, CutCounter* counter) {
  MetricCost out;
  counter->set(bits.visible, {});
  for (size_t s = 0; s < std::size(kSigmas); ++s) out.all[s] = counter->cost(kSigmas[s]);
  const size_t size = clusterSize(samples);
  for (size_t begin = 0; begin < samples; begin += size)
    out.clusters +=
        counter->squaredError(static_cast<uint32_t>(begin), static_cast<uint32_t>(begin + size));
  counter->set(bits.visible, bits.matters);
  for (size_t s = 0; s < std::size(kSigmas); ++s) out.front[s] = counter->cost(kSigmas[s]);
  for (const uint64_t word : bits.matters) out.frontSamples += std::popcount(word);
  return out;
}

VertexCost costsOf(const StudyVertices& vertices, const relight::LightSamples& samples,
                   std::span<const StudyTree> trees) {
  std::vector<VertexCost> costs(vertices.count());
  vertices.trace(samples, [&]() -> StudyVertices::Use {
    std::vector<CutCounter> counters(trees.begin(), trees.end());
    return [&, counters](size_t vertex, const relight::LeafBits& bits) mutable {
      for (size_t m = 0; m < counters.size(); ++m)
        costs[vertex][m] = costOf(bits, samples.count(), &counters[m]);
    };
  });
  VertexCost sum;
  for (const VertexCost& cost : costs)
    for (size_t m = 0; m < sum.size(); ++m) sum[m].add(cost[m]);
  return sum;
}

class ClusterStudy {
 public:
  ClusterStudy(const std::string& scene, const Tracer& tracer, const StudyVertices& vertices,
               const CutsStudy& study)
      : name_(scene),
        tracer_(tracer),
        study_(study),
        vertexCount_(static_cast<double>(vertices.count())),
        samples_(relight::environmentSamples(study.sampleCount(), study.options.seed)),
        orders_(vertices.treeOrders(samples_, kBetas)) {
    std::vector<StudyTree> trees;
    for (const std::vector<uint32_t>& order : orders_) trees.push_back(halvedTree(order));
    costs_ = costsOf(vertices, samples_, trees);
  }

  void addFigure5() {
    BenchTable& table = study_.report.table(
        {"figure5",
         "Figure 5: directions clustered by three metrics",
         {{"scene", "scene"},
          {"metric", "metric"},
          {"beta", "beta", "{:.1f}"},
          {"spread", "spread in degrees", "{:.2f}"},
          {"visibility", "RMS within clusters", "{:.3f}"},
          {"cut", "cut", "{:.0f}"},
          {"rms", "RMS of cuts", "{:.3f}"},
          {"light", "error of the light cut", "{:.3f}"}},
         {},
         {fmt::format(
             "{} clusters of {} directions each. Spread: root of the mean squared angle from a "
             "cluster's mean. RMS within clusters: of visibility of {:.0f} vertices from the "
             "clusters' means. Cuts: sigma {}. The light cut has at most {} nodes; its error is "
             "that of the scene's light at the samples, relative l2.",
             samples_.count() / clusterSize(samples_.count()), clusterSize(samples_.count()),
             vertexCount_, kSigmas[kMiddle], kLightNodes)}});
    std::vector<FigurePicture> pictures;
    for (size_t m = 0; m < std::size(kMetrics); ++m) {
      const relight::LightSamples ordered = relight::reordered(samples_, orders_[m]);
      const MetricCost& cost = costs_[m];
      const CutCost& cut = cost.all[kMiddle];
      table.rows.push_back(
          {name_, std::string(kMetrics[m].name), double{kMetrics[m].beta},
           spreadOf(ordered.p, clusterSize(ordered.count())), rms(cost.clusters, allSamples()),
           size(cut), rms(cut.squaredError, allSamples()), lightError(tracer_.scene(), ordered)});
      Film shape;
      const std::vector<uint8_t> pixels =
          spherePicture(ordered, clusterSize(ordered.count()), &shape);
      pictures.push_back(
          {kMetrics[m].name,
           study_.report.picture(fmt::format("figure5-{}-{}", name_, kMetrics[m].name), pixels,
                                 shape)});
    }
    study_.report.show("figure5", name_ + ", directions seen from +y and from -y", pictures);
  }

  void addFigure8() {
    BenchTable& table = study_.report.table(
        {"figure8b",
         "Figure 8 (b): size of cuts by three metrics",
         {{"scene", "scene"},
          {"metric", "metric"},
          {"sigma", "sigma", "{:.1f}"},
          {"cut", "cut", "{:.0f}"},
          {"rms", "RMS", "{:.3f}"},
          {"gain", "gain", "{:.2f}"},
          {"gain_rms", "at equal RMS", "{:.2f}"},
          {"cut_front", "cut, in front", "{:.0f}"},
          {"rms_front", "RMS, in front", "{:.3f}"},
          {"gain_front", "gain, in front", "{:.2f}"}},
         {},
         {fmt::format("{} directions, {:.0f} vertices; gain: part of the geometric tree's nodes "
                      "that is saved, at equal sigma and (interpolated) at equal RMS. In front: "
                      "only samples in front of one of a vertex' faces "
                      "count, else all.",
                      samples_.count(), vertexCount_)}});
    for (size_t s = 0; s < std::size(kSigmas); ++s)
      for (size_t m = 0; m < std::size(kMetrics); ++m) {
        const MetricCost &cost = costs_[m], &geometric = costs_[0];
        const auto gain = [&](const CutCost& cut, const CutCost& other) {
          return m == 0 ? kNone : 1 - size(cut) / size(other);
        };
        table.rows.push_back({name_, std::string(kMetrics[m].name), kSigmas[s], size(cost.all[s]),
                              rms(cost.all[s].squaredError, allSamples()),
                              gain(cost.all[s], geometric.all[s]),
                              m == 0 ? kNone : gainAtEqualRms(m, s), size(cost.front[s]),
                              rms(cost.front[s].squaredError, cost.frontSamples),
                              gain(cost.front[s], geometric.front[s])});
      }
  }

 private:
  double allSamples() const { return vertexCount_ * static_cast<double>(samples_.count()); }
  // Of the metric m over the geometric one, at the error of the latter for sigma s.
  double gainAtEqualRms(size_t m, size_t s) const {
    std::vector<std::pair<double, double>> sizes;
    for (const CutCost& cut : costs_[m].all)
      sizes.emplace_back(rms(cut.squaredError, allSamples()), size(cut));
    const CutCost& geometric = costs_[0].all[s];
    return 1 - interpolated(sizes, rms(geometric.squaredError, allSamples())) / size(geometric);
  }
  double size(const CutCost& cut) const { return static_cast<double>(cut.nodes) / vertexCount_; }
  static double rms(double squares, double count) { return std::sqrt(squares / count); }

  const std::string name_;
  const Tracer& tracer_;
  const CutsStudy& study_;
  const double vertexCount_;
  const relight::LightSamples samples_;
  const std::vector<std::vector<uint32_t>> orders_;  // by metric
  VertexCost costs_;
};

}  // namespace

void cutsClusters(const std::string& scene, const Tracer& tracer, const StudyVertices& vertices,
                  bool figure5, bool figure8, const CutsStudy& study) {
  study.progress(scene, "clusters of directions");
  ClusterStudy clusters(scene, tracer, vertices, study);
  if (figure5) clusters.addFigure5();
  if (figure8) clusters.addFigure8();
}

}  // namespace lobelia::app

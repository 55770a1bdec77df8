// Clustering: costs against the variance that draws of representatives have, phases against each
// other, the assignment's kernel against plain loops.
#include <gtest/gtest.h>

#include <numeric>

#include "gather/mrcs_input.h"
#include "lobelia/base/parallel.h"
#include "lobelia/gather/mrcs_sampling.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

using Vectors = std::vector<std::vector<float>>;

TEST(MrcsKernels, NearestCentreEqualsPlainLoops) {
  constexpr size_t kDims = 48;
  Rng rng(3);
  for (const size_t centres : {1, 5, 16, 37, 1000}) {
    SCOPED_TRACE(centres);
    const auto randomVector = [&] {
      AlignedFloats v(kDims);
      for (float& x : v) x = rng.next1D() - 0.5f;
      return v;
    };
    CentreTable table(centres, kDims);
    std::vector<AlignedFloats> vectors;
    std::vector<float> gains;
    for (size_t k = 0; k < centres; ++k) {
      vectors.push_back(randomVector());
      gains.push_back(0.1f + rng.next1D());
      table.set(k, vectors[k].data(), dotProduct(vectors[k].data(), vectors[k].data(), kDims),
                gains[k]);
    }
    constexpr size_t kLights = 101;
    AlignedFloats lights;
    std::vector<float> squares;
    for (size_t i = 0; i < kLights; ++i) {
      const AlignedFloats v = randomVector();
      lights.insert(lights.end(), v.begin(), v.end());
      squares.push_back(dotProduct(v.data(), v.data(), kDims));
    }
    std::vector<uint32_t> best(kLights);
    nearestCentres(lights.data(), squares.data(), kLights, table, best.data());
    for (size_t i = 0; i < kLights; ++i) {
      std::vector<double> scores;
      for (size_t k = 0; k < centres; ++k) {
        double distance = 0;
        for (size_t d = 0; d < kDims; ++d)
          distance += std::pow(double{lights[i * kDims + d]} - double{vectors[k][d]}, 2);
        scores.push_back(distance * double{gains[k]});
      }
      const double least = *std::min_element(scores.begin(), scores.end());
      ASSERT_LT(best[i], centres);
      EXPECT_NEAR(scores[best[i]], least, 1e-5);
    }
  }
}

TEST(MrcsKernels, HalvesComeBack) {
  AlignedFloats values(32), back(32);
  Rng rng(4);
  for (float& x : values) x = 4 * (rng.next1D() - 0.5f);
  values[0] = 0;
  std::vector<uint16_t> halves(32);
  packHalves(values.data(), 32, halves.data());
  unpackHalves(halves.data(), 32, 2.f, back.data());
  for (size_t i = 0; i < 32; ++i) EXPECT_NEAR(back[i], 2 * values[i], 0.001f * std::abs(values[i]));
}

void expectPartition(const Clustering& clustering, size_t lights) {
  std::vector<uint32_t> sorted = clustering.order;
  std::sort(sorted.begin(), sorted.end());
  std::vector<uint32_t> all(lights);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(sorted, all);
  size_t covered = 0;
  for (const LightCluster& cluster : clustering.clusters) {
    EXPECT_LT(cluster.begin, cluster.end);
    covered += cluster.size();
  }
  EXPECT_EQ(covered, lights);
}

// Mean over many draws of the squared error of the sum in values [begin, end) of the vectors.
double measuredVariance(const Vectors& vectors, const LightColumns& columns,
                        const Clustering& clustering, size_t begin, size_t end, int draws) {
  std::vector<double> exact(end - begin, 0.0);
  for (const auto& v : vectors)
    for (size_t d = begin; d < end; ++d) exact[d - begin] += double{v[d]};
  double sum = 0;
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<double> error(end - begin, 0.0);
    for (size_t d = 0; d < error.size(); ++d) error[d] = -exact[d];
    for (const Representative& r :
         drawRepresentatives(columns, clustering, 1000 + static_cast<uint64_t>(draw)))
      for (size_t d = begin; d < end; ++d)
        error[d - begin] += double{r.scale.x} * double{vectors[r.light][d]};
    for (const double e : error) sum += e * e;
  }
  return sum / draws;
}

TEST(MrcsClusters, PredictedCostIsTheVarianceOfDraws) {
  const Vectors vectors = scatteredVectors(400, 96, 12, 7);
  double squares = 0;
  for (const auto& v : vectors)
    for (const float x : v) squares += double{x} * double{x};
  for (const double unseen : {0.0, 0.1 * squares / 400}) {
    const LightColumns columns = columnsFrom(vectors, unseen);
    Context context;
    ClusterSettings settings;
    settings.count = 25;
    const Clustering clustering = clusterLights(columns, settings, context);
    expectPartition(clustering, 400);
    ASSERT_EQ(clustering.clusters.size(), 25u);
    const size_t dims = columns.dims, all = columns.stride();
    EXPECT_NEAR(measuredVariance(vectors, columns, clustering, 0, dims, 4000) / clustering.rowCost,
                1, 0.05);
    EXPECT_NEAR(
        measuredVariance(vectors, columns, clustering, dims, all, 4000) / clustering.checkCost, 1,
        0.05);
  }
}

double totalCost(const LightColumns& columns, size_t count, double sampledShare, uint64_t seed) {
  Context context;
  ClusterSettings settings;
  settings.count = count;
  settings.sampledShare = sampledShare;
  settings.seed = seed;
  return clusterLights(columns, settings, context).cost;
}

TEST(MrcsClusters, BeatRandomOnesAndBothPhasesAreNeeded) {
  const LightColumns columns = columnsFrom(scatteredVectors(3000, 96, 40, 9), 0);
  for (const size_t count : {20, 60}) {
    double random = 0, both = 0, sampling = 0, splitting = 0;
    for (uint64_t seed = 0; seed < 6; ++seed) {
      Rng rng(seed, 77);
      std::vector<std::vector<uint32_t>> clusters(count);
      for (uint32_t i = 0; i < columns.count; ++i) clusters[rng.nextUint() % count].push_back(i);
      for (const auto& cluster : clusters)
        random += measureCluster(columns, cluster, 0, cluster.size()).cost;
      both += totalCost(columns, count, 2.0 / 3, seed);
      sampling += totalCost(columns, count, 1, seed);
      splitting += totalCost(columns, count, 0, seed);
    }
    SCOPED_TRACE(testing::Message()
                 << count << " clusters, of random: both " << both / random << ", sampling "
                 << sampling / random << ", splitting " << splitting / random);
    EXPECT_LT(both, 0.7 * random);
    EXPECT_LT(both, 1.05 * sampling);
    EXPECT_LT(both, 1.05 * splitting);
    RecordProperty("both_" + std::to_string(count), std::to_string(both / random));
    RecordProperty("sampling_" + std::to_string(count), std::to_string(sampling / random));
    RecordProperty("splitting_" + std::to_string(count), std::to_string(splitting / random));
  }
}

TEST(MrcsClusters, ErrorLimitDecidesTheirNumber) {
  const LightColumns columns = columnsFrom(scatteredVectors(3000, 96, 40, 9), 0);
  Context context;
  ClusterSettings settings;
  settings.count = 3000;
  size_t before = 0;
  for (const double limit : {0.05, 0.02, 0.01}) {
    settings.errorLimit = limit;
    const Clustering clustering = clusterLights(columns, settings, context);
    expectPartition(clustering, 3000);
    EXPECT_LE(clustering.checkError(columns), limit);
    EXPECT_GT(clustering.checkError(columns), 0.3 * limit) << "too many";
    EXPECT_GT(clustering.clusters.size(), before);
    before = clustering.clusters.size();
  }
  settings.count = 30;  // a limit that cannot be met
  EXPECT_EQ(clusterLights(columns, settings, context).clusters.size(), 30u);
}

TEST(MrcsClusters, SameBitsForAnyNumberOfThreads) {
  const LightColumns columns = columnsFrom(scatteredVectors(5000, 64, 30, 10), 0.1);
  std::vector<Clustering> results;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    Context context;
    ClusterSettings settings;
    settings.count = 300;
    results.push_back(clusterLights(columns, settings, context));
  }
  for (size_t i = 1; i < results.size(); ++i) {
    EXPECT_EQ(results[i].order, results[0].order);
    EXPECT_EQ(results[i].cost, results[0].cost);
    for (size_t k = 0; k < results[0].clusters.size(); ++k)
      EXPECT_EQ(results[i].clusters[k].end, results[0].clusters[k].end);
  }
}

// Lights that no row sees share the columns by their number, as their unseen parts cost.
TEST(MrcsClusters, UnseenLightsAreSplitEvenly) {
  const LightColumns columns = columnsFrom(Vectors(1000, std::vector<float>(48, 0.f)), 2.0);
  Context context;
  ClusterSettings settings;
  settings.count = 16;
  settings.sampledShare = 0;
  const Clustering clustering = clusterLights(columns, settings, context);
  expectPartition(clustering, 1000);
  ASSERT_EQ(clustering.clusters.size(), 16u);
  for (const LightCluster& cluster : clustering.clusters) {
    EXPECT_NEAR(static_cast<double>(cluster.size()), 62.5, 1.0);
    const double n = static_cast<double>(cluster.size());
    EXPECT_NEAR(cluster.cost, 2 * n * (n - 1), 1e-3 * cluster.cost);
  }
}

}  // namespace
}  // namespace lobelia

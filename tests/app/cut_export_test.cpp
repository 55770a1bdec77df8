// `render --export-trees`: what is written of light trees and cuts agrees with itself, with the
// lights and with the statistics; the picture stays as it is.
#include <cmath>
#include <map>
#include <optional>

#include "app/render_test.h"
#include "support/npy_reader.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::NpyArray;

// A table of the description with its files.
class Table {
 public:
  Table(const std::string& folder, const json& description) : rows(description["rows"]) {
    for (const json& column : description["columns"]) {
      const std::string name = column["name"], file = column["file"];
      const NpyArray array = test::readNpy(folder + "/" + file);
      EXPECT_EQ(array.type, column["dtype"]) << name;
      EXPECT_EQ(array.shape, column["shape"].get<std::vector<size_t>>()) << name;
      EXPECT_EQ(array.shape.at(0), rows) << name;
      EXPECT_FALSE(column["meaning"].get<std::string>().empty()) << name;
      columns_[name] = array;
    }
  }
  template <class T>
  std::vector<T> get(const std::string& name) const {
    EXPECT_EQ(columns_.at(name).type.back(), '4') << name;
    return columns_.at(name).values<T>();
  }
  bool has(const std::string& name) const { return columns_.contains(name); }
  const size_t rows;

 private:
  std::map<std::string, NpyArray> columns_;
};

struct Tree {
  Table nodes, lights;
  std::vector<int32_t> parent, left, right, first, count;
  Tree(const std::string& folder, const json& description)
      : nodes(folder, description["nodes"]),
        lights(folder, description["lights"]),
        parent(nodes.get<int32_t>("parent")),
        left(nodes.get<int32_t>("left")),
        right(nodes.get<int32_t>("right")),
        first(nodes.get<int32_t>("first")),
        count(nodes.get<int32_t>("count")) {}
};

float distance(const std::vector<float>& points, size_t a, size_t b) {
  double sum = 0;
  for (size_t d = 0; d < 3; ++d) sum += std::pow(double{points[3 * a + d]} - points[3 * b + d], 2);
  return static_cast<float>(std::sqrt(sum));
}

void expectShape(const Tree& tree) {
  std::vector<int> leaves(tree.lights.rows, 0);
  if (tree.nodes.rows == 0) {
    EXPECT_EQ(tree.lights.rows, 0u);
    return;
  }
  EXPECT_EQ(tree.parent[0], -1);
  EXPECT_EQ(static_cast<size_t>(tree.count[0]), tree.lights.rows);
  for (size_t i = 0; i < tree.nodes.rows; ++i) {
    if (tree.left[i] < 0) {
      EXPECT_EQ(tree.right[i], -1);
      EXPECT_EQ(tree.count[i], 1);
      ++leaves.at(static_cast<size_t>(tree.first[i]));
      continue;
    }
    const size_t l = static_cast<size_t>(tree.left[i]), r = static_cast<size_t>(tree.right[i]);
    EXPECT_EQ(tree.parent.at(l), static_cast<int32_t>(i));
    EXPECT_EQ(tree.parent.at(r), static_cast<int32_t>(i));
    EXPECT_EQ(tree.count[i], tree.count[l] + tree.count[r]);
    EXPECT_EQ(tree.first[l], tree.first[i]);
    EXPECT_EQ(tree.first[r], tree.first[i] + tree.count[l]);
  }
  for (const int n : leaves) EXPECT_EQ(n, 1) << "every light is one leaf";
  // Lights of a class are told apart.
  const auto lightClass = tree.lights.get<uint32_t>("class"),
             index = tree.lights.get<uint32_t>("index");
  std::map<std::pair<uint32_t, uint32_t>, int> seen;
  for (size_t i = 0; i < tree.lights.rows; ++i) {
    const int times = ++seen[{lightClass[i], index[i]}];
    EXPECT_EQ(times, 1);
  }
}

void expectSums(const Tree& tree, const std::string& column, size_t components) {
  if (!tree.nodes.has(column)) return;
  const auto values = tree.nodes.get<float>(column);
  for (size_t i = 0; i < tree.nodes.rows; ++i) {
    if (tree.left[i] < 0) continue;
    for (size_t c = 0; c < components; ++c) {
      const float sum = values[static_cast<size_t>(tree.left[i]) * components + c] +
                        values[static_cast<size_t>(tree.right[i]) * components + c];
      EXPECT_NEAR(values[i * components + c], sum, 1e-5f * sum) << column << " of node " << i;
    }
  }
}

// Children lie within their parent.
void expectBounds(const Tree& tree) {
  const auto centre = tree.nodes.get<float>("centre"), radius = tree.nodes.get<float>("radius");
  std::vector<float> low, high;
  if (tree.nodes.has("low"))
    low = tree.nodes.get<float>("low"), high = tree.nodes.get<float>("high");
  const auto sharpest = tree.nodes.has("most_sharpness") ? tree.nodes.get<float>("most_sharpness")
                                                         : std::vector<float>();
  for (size_t i = 1; i < tree.nodes.rows; ++i) {
    const size_t parent = static_cast<size_t>(tree.parent[i]);
    for (size_t d = 0; d < 3 && !low.empty(); ++d) {
      EXPECT_GE(low[3 * i + d], low[3 * parent + d]) << "node " << i;
      EXPECT_LE(high[3 * i + d], high[3 * parent + d]) << "node " << i;
    }
    if (!sharpest.empty()) {
      EXPECT_LE(sharpest[i], sharpest[parent]) << "node " << i;
    }
    if (tree.left[i] >= 0) continue;
    for (int32_t above = tree.parent[i]; above >= 0;
         above = tree.parent[static_cast<size_t>(above)]) {
      const size_t node = static_cast<size_t>(above);
      EXPECT_LE(distance(centre, i, node), radius[node] * 1.0001f + 1e-5f) << i << " in " << node;
    }
  }
}

class CutExport : public test::RenderTest {
 protected:
  struct Part {
    std::vector<Tree> trees;
    std::map<std::string, Table> cuts;
  };

  json exported(const std::string& options) {
    const Film film = render(options + " --export-trees " + (folder_ / "trees"), "exported");
    const Film plain = render(options, "plain");
    EXPECT_EQ(film.layers.at("").values, plain.layers.at("").values) << options;
    for (const char* count : {"shadow_rays", "node_pairs_visited", "node_pairs_shaded"})
      EXPECT_EQ(statistics("exported")["counts"][count], statistics("plain")["counts"][count]);
    return json::parse(test::readText(folder_ / "trees/description.json"));
  }
  Part partOf(const json& description) {
    Part part;
    for (const json& tree : description["trees"]) part.trees.emplace_back(folder_ / "trees", tree);
    for (const json& table : description["cuts"])
      part.cuts.emplace(table["name"], Table(folder_ / "trees", table));
    return part;
  }
  // Trees by themselves. Returns the number of their lights.
  size_t expectTrees(const Part& part) {
    size_t lights = 0;
    for (const Tree& tree : part.trees) {
      expectShape(tree);
      for (const char* column : {"diffuse", "glossy", "cosine", "peak", "energy"})
        expectSums(tree, column, 1);
      expectSums(tree, "power", 3);
      expectBounds(tree);
      lights += tree.lights.rows;
    }
    return lights;
  }
  size_t lightsOfStatistics() {
    size_t lights = 0;
    for (const char* kind : {"omni", "directional", "diffuse", "glossy", "spherical"})
      lights += statistics("exported")["lights"][kind].get<size_t>();
    return lights;
  }
};

// Of one cut: how often each light of each tree is below a node of it.
class Coverage {
 public:
  explicit Coverage(const std::vector<Tree>& trees) : trees_(trees) {
    for (const Tree& tree : trees) seen_.emplace_back(tree.lights.rows, 0);
  }
  void add(uint32_t tree, uint32_t node) {
    const Tree& t = trees_.at(tree);
    for (int32_t i = 0; i < t.count.at(node); ++i)
      ++seen_[tree].at(static_cast<size_t>(t.first[node] + i));
  }
  bool holds(uint32_t tree, uint32_t node, int32_t light) const {
    const Tree& t = trees_.at(tree);
    return light >= t.first.at(node) && light < t.first[node] + t.count[node];
  }
  void expectOnce() const {
    for (const std::vector<int>& tree : seen_)
      for (const int n : tree) ASSERT_EQ(n, 1);
  }

 private:
  const std::vector<Tree>& trees_;
  std::vector<std::vector<int>> seen_;
};

// What a part's cuts have.
struct Gathered {
  size_t lights = 0, rays = 0;
};

Gathered expectCuts(const std::vector<Tree>& trees, const std::map<std::string, Table>& cuts) {
  Gathered sum;
  const Table &receivers = cuts.at("receivers"), &clusters = cuts.at("clusters"),
              &nodes = cuts.at("nodes");
  const auto x = receivers.get<int32_t>("x"), y = receivers.get<int32_t>("y");
  for (size_t i = 0; i < receivers.rows; ++i)
    EXPECT_TRUE(x[i] >= 1 && x[i] < 11 && y[i] >= 2 && y[i] < 9) << x[i] << "," << y[i];
  for (const uint32_t rays : receivers.get<uint32_t>("rays")) sum.rays += rays;
  const auto member = cuts.at("members").get<uint32_t>("receiver");
  const auto firstMember = clusters.get<uint32_t>("first_member"),
             memberCount = clusters.get<uint32_t>("member_count"),
             firstNode = clusters.get<uint32_t>("first_node"),
             nodeCount = clusters.get<uint32_t>("node_count");
  const auto tree = nodes.get<uint32_t>("tree"), node = nodes.get<uint32_t>("node"),
             beside = nodes.get<uint32_t>("beside");
  const auto light = nodes.get<int32_t>("light");
  const auto weight = nodes.get<float>("weight"), estimate = nodes.get<float>("estimate"),
             bound = nodes.get<float>("bound");
  std::vector<int> clustersOf(receivers.rows, 0);
  for (size_t c = 0; c < clusters.rows; ++c) {
    for (uint32_t m = 0; m < memberCount[c]; ++m) ++clustersOf.at(member.at(firstMember[c] + m));
    Coverage coverage(trees);
    for (uint32_t i = firstNode[c]; i < firstNode[c] + nodeCount[c]; ++i) {
      if (beside.at(i) == 0) coverage.add(tree[i], node[i]);
      EXPECT_EQ(light[i] >= 0, weight[i] > 0);
      if (light[i] < 0) continue;
      ++sum.lights;
      EXPECT_TRUE(coverage.holds(tree[i], node[i], light[i]));
      EXPECT_GE(weight[i], 0.9999f) << "over a probability";
      if (bound[i] > 0) {
        EXPECT_LE(estimate[i], bound[i] * 1.001f);
      }
    }
    coverage.expectOnce();
  }
  for (const int n : clustersOf) EXPECT_LE(n, 1);
  EXPECT_GT(sum.lights, clusters.rows);
  return sum;
}

TEST_F(CutExport, OfSharedAndOwnCuts) {
  const std::string base = "--size 12x9 --crop 1,2,11,9 --spp 1 --direct lights --near-lights 0 ";
  std::optional<size_t> othersBefore;
  for (const std::string& options :
       {base + "--num-lights 300 --gather sglc --cut-size 30",
        base + "--num-lights 300 --lights vsl --gather sglc --sglc-mode unbiased --cut-size 30",
        base + "--num-lights 200 --gather lightcuts --threshold 0.1"}) {
    SCOPED_TRACE(options);
    const json description = exported(options);
    EXPECT_EQ(description["crop"], json({1, 2, 11, 9}));
    ASSERT_EQ(description["parts"].size(), 2u);
    size_t lights = 0;
    Gathered sum;
    for (const json& text : description["parts"]) {
      const Part part = partOf(text);
      lights += expectTrees(part);
      const Gathered gathered = expectCuts(part.trees, part.cuts);
      sum.lights += gathered.lights, sum.rays += gathered.rays;
    }
    EXPECT_EQ(lights, lightsOfStatistics());
    const json counts = statistics("exported")["counts"];
    // The rest are the eye pass's: as many for any strategy.
    const size_t others = counts["shadow_rays"].get<size_t>() - sum.rays;
    EXPECT_EQ(others, othersBefore.value_or(others));
    EXPECT_LT(others, 30u);
    othersBefore = others;
    EXPECT_NEAR(static_cast<double>(sum.lights), counts["cut_nodes_per_pixel"].get<double>() * 70,
                1e-6);
  }
}

// Every lobe of a receiver meets every light once, whichever node of receivers it is paired in.
TEST_F(CutExport, OfPairsOfNodes) {
  const json description = exported(
      "--size 8x6 --spp 1 --component indirect --max-depth 4 --num-lights 150 --gather sglc "
      "--sglc-mode paper");
  EXPECT_EQ(description["mode"], "paper");
  const Part part = partOf(description["parts"].at(0));
  EXPECT_GE(expectTrees(part), lightsOfStatistics()) << "receivers of some depths have fewer";
  const Table &clusters = part.cuts.at("clusters"), &nodes = part.cuts.at("nodes");
  const auto member = part.cuts.at("members").get<uint32_t>("receiver");
  const auto firstMember = clusters.get<uint32_t>("first_member"),
             memberCount = clusters.get<uint32_t>("member_count"),
             firstNode = clusters.get<uint32_t>("first_node"),
             nodeCount = clusters.get<uint32_t>("node_count"),
             lobes = clusters.get<uint32_t>("lobes");
  const auto tree = nodes.get<uint32_t>("tree"), node = nodes.get<uint32_t>("node");
  // By receiver and lobes; a receiver may have several lobes of a kind.
  std::map<std::pair<uint32_t, uint32_t>, std::vector<std::vector<int>>> seen;
  size_t pairs = 0;
  for (size_t c = 0; c < clusters.rows; ++c) {
    EXPECT_NE(lobes[c], 0u);
    pairs += size_t{memberCount[c]} * nodeCount[c];
    for (uint32_t m = 0; m < memberCount[c]; ++m) {
      auto& lights = seen[{member.at(firstMember[c] + m), lobes[c]}];
      lights.resize(part.trees.size());
      for (uint32_t k = firstNode[c]; k < firstNode[c] + nodeCount[c]; ++k) {
        const Tree& t = part.trees.at(tree[k]);
        lights[tree[k]].resize(t.lights.rows);
        for (int32_t i = 0; i < t.count.at(node[k]); ++i)
          ++lights[tree[k]][static_cast<size_t>(t.first[node[k]] + i)];
      }
    }
  }
  EXPECT_NEAR(static_cast<double>(pairs),
              statistics("exported")["counts"]["cut_nodes_per_pixel"].get<double>() * 48, 1e-6);
  ASSERT_FALSE(seen.empty());
  for (const auto& [lobe, trees] : seen) {
    // As many times as it has lobes of the kind.
    int times = 0;
    for (const std::vector<int>& lights : trees)
      if (!lights.empty()) times = lights[0];
    EXPECT_GE(times, 1);
    for (const std::vector<int>& lights : trees)
      for (const int n : lights) ASSERT_EQ(n, times) << "receiver " << lobe.first;
  }
}

TEST_F(CutExport, IsWrittenWholeOrRefused) {
  const std::string trees = " --export-trees " + (folder_ / "trees ");
  expectError("--gather all" + trees, "sglc, lightcuts");
  expectError("--gather mrcs" + trees, "sglc, lightcuts");
  expectError("--lights photon --gather sglc" + trees, "no virtual lights");
  expectError("--gather sglc --frames 2" + trees, "one picture");
  expectError("--gather sglc --checkpoint " + (folder_ / "c") + trees, "--checkpoint");
  expectError("--gather sglc --export-trees /proc/trees", "cannot write");
  test::writeText(folder_ / "file", "");
  expectError("--gather sglc --export-trees " + (folder_ / "file"), "is not a folder");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "trees"));
  // Of a render that is not finished, the description of an earlier one goes on being true.
  const std::string options = "--size 8x6 --num-lights 50 --gather sglc" + trees;
  render(options, "a");
  const std::string before = test::readText(folder_ / "trees/description.json");
  render(options + "--seed 3 --time-limit 1e-9 --spp 2", "b");
  EXPECT_EQ(test::readText(folder_ / "trees/description.json"), before);
  // Tables of more trees than the next render has go; what is not a table stays.
  const std::vector<std::string> old{"trees/direct.tree9.nodes.axis.npy",
                                     "trees/indirect.cuts.former.npy"};
  for (const std::string& file : old) test::writeText(folder_ / file, "old");
  test::writeText(folder_ / "trees/direct.notes.npy", "mine");
  render(options, "a");
  for (const std::string& file : old) EXPECT_FALSE(std::filesystem::exists(folder_ / file)) << file;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "trees/direct.notes.npy"));
  EXPECT_EQ(test::readText(folder_ / "trees/description.json"), before);
}

}  // namespace
}  // namespace lobelia

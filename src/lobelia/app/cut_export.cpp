#include "lobelia/app/cut_export.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/gather_options.h"
#include "lobelia/base/file.h"
#include "lobelia/io/npy.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

using gather::ExportTable;
using Json = nlohmann::ordered_json;

constexpr const char* kDescription = "description.json";

// Writes a table's columns as FOLDER/PREFIX.COLUMN.npy.
Json writeTable(const ExportTable& table, const std::string& folder, const std::string& prefix) {
  Json columns = Json::array();
  for (const gather::ExportColumn& column : table.columns) {
    const std::string file = fmt::format("{}.{}.npy", prefix, column.name);
    const std::string type = io::npyType(column.kind, 4);
    std::vector<size_t> shape{table.rows};
    if (column.components > 1) shape.push_back(column.components);
    io::writeNpy((std::filesystem::path(folder) / file).string(), type, shape, column.values);
    columns.push_back({{"name", column.name},
                       {"file", file},
                       {"dtype", type},
                       {"shape", shape},
                       {"meaning", column.meaning}});
  }
  return {
      {"name", table.name}, {"meaning", table.meaning}, {"rows", table.rows}, {"columns", columns}};
}

// What RecordedCut::Node::estimate is.
std::string estimateText(const RenderOptions& options) {
  if (gathersPairs(options)) return "0: pairs of nodes are chosen by their errors";
  if (options.gather == "lightcuts")
    return "luminance that the receiver reflects of the node by the light that stands for it, with "
           "visibility";
  return "share of what the cut's nodes give the cluster, by estimates without visibility; beside "
         "the cut: of what its lights give";
}

// Of an earlier render, which may have had more trees: every file whose name is one of a table's.
void removeTables(const std::string& folder) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const size_t dot = name.find('.');
    const std::string part = name.substr(0, dot);
    if (dot == std::string::npos || (part != "direct" && part != "indirect")) continue;
    const std::string rest = name.substr(dot + 1);
    if ((rest.starts_with("tree") || rest.starts_with("cuts.")) && rest.ends_with(".npy"))
      std::filesystem::remove(entry.path(), ignored);
  }
}

}  // namespace

void requireCutExport(const RenderOptions& options) {
  if (options.exportTrees.empty()) return;
  if (options.lights == "photon")
    throw UsageError(
        "--export-trees: --lights photon has no virtual lights; use vpl, glossy, vsl or vsgl");
  if (options.frames > 0 || options.turntable)
    throw UsageError("--export-trees is for one picture: leave out --frames and --turntable");
  if (!options.checkpoint.empty() || !options.resume.empty())
    throw UsageError(
        "--export-trees: a checkpoint does not keep cuts; leave out --checkpoint and --resume");
  if (options.replay.empty()) requireWritableFolder(options.exportTrees);
}

void CutExport::add(const Receivers& run, const LightGather::Light& light) {
  if (light.layers[0]) add(run, *light.layers[0], &direct_);
  if (light.layers[2]) add(run, *light.layers[2], &indirect_);
}

void CutExport::add(const Receivers& run, const GatherParts& parts, Part* part) {
  const size_t first = part->receivers.size();
  for (size_t i = 0; i < run.points.size(); ++i) {
    const ReceiverPoint& point = run.points[i];
    part->receivers.push_back(
        {point.pixel, point.p, point.frame.n, point.weight, point.depth, parts.rays.at(i)});
  }
  for (const RecordedCut& cut : parts.cuts) {
    if (cut.receivers.empty() || cut.nodes.empty()) continue;
    part->clusters.push_back({static_cast<uint32_t>(part->members.size()),
                              static_cast<uint32_t>(cut.receivers.size()),
                              static_cast<uint32_t>(part->nodes.size()),
                              static_cast<uint32_t>(cut.nodes.size()), cut.lobes});
    for (const uint32_t receiver : cut.receivers)
      part->members.push_back(static_cast<uint32_t>(first + receiver));
    part->nodes.insert(part->nodes.end(), cut.nodes.begin(), cut.nodes.end());
    constexpr size_t kMost = size_t{1} << 31;
    if (part->nodes.size() > kMost || part->members.size() > kMost)
      throw RuntimeError(
          "--export-trees: the cuts have more than 2^31 nodes; export a part of the picture by "
          "--crop or --pixels");
  }
}

void CutExport::addTrees(const LightGather& lights) {
  direct_.trees = lights.exportTrees(true);
  indirect_.trees = lights.exportTrees(false);
  complete_ = true;
}

std::vector<ExportTable> CutExport::tables(const Part& part, const Film& film,
                                           const std::string& estimate) {
  const uint32_t width = static_cast<uint32_t>(film.width);
  std::vector<ExportTable> out;
  ExportTable& receivers = out.emplace_back();
  receivers = {"receivers", "points that gather light", part.receivers.size(), {}};
  const std::vector<Receiver>& r = part.receivers;
  receivers.add("x", "column of its pixel in the full picture",
                [&](size_t i) { return static_cast<int32_t>(r[i].pixel % width) + film.x0; });
  receivers.add("y", "row of its pixel in the full picture, the topmost 0",
                [&](size_t i) { return static_cast<int32_t>(r[i].pixel / width) + film.y0; });
  receivers.add("place", "where it is", [&](size_t i) { return r[i].p; });
  receivers.add("normal", "shading normal", [&](size_t i) { return r[i].n; });
  receivers.add("weight", "R, G, B: factor of its light in the pixel's value",
                [&](size_t i) { return r[i].weight; });
  receivers.add("depth", "edges of its path from the camera", [&](size_t i) { return r[i].depth; });
  receivers.add("rays", "shadow rays traced for it (a ray for several counts at one of them)",
                [&](size_t i) { return r[i].rays; });

  ExportTable& clusters = out.emplace_back();
  clusters = {"clusters", "receivers that share nodes, and the nodes", part.clusters.size(), {}};
  const std::vector<Cluster>& c = part.clusters;
  clusters.add("first_member", "its first row of members",
               [&](size_t i) { return c[i].firstMember; });
  clusters.add("member_count", "and how many", [&](size_t i) { return c[i].memberCount; });
  clusters.add("first_node", "its first row of nodes", [&](size_t i) { return c[i].firstNode; });
  clusters.add("node_count", "and how many", [&](size_t i) { return c[i].nodeCount; });
  clusters.add("lobes", "of the receivers: 0 all, 1 diffuse, 2 glossy",
               [&](size_t i) { return static_cast<uint32_t>(c[i].lobes); });

  ExportTable& members = out.emplace_back();
  members = {"members", "receivers of the clusters", part.members.size(), {}};
  members.add("receiver", "row of receivers", [&](size_t i) { return part.members[i]; });

  ExportTable& nodes = out.emplace_back();
  nodes = {"nodes",
           "nodes of the clusters' cuts: every light is below one of a cluster's (mode paper: of "
           "all clusters that have the receiver with these lobes), but for those beside the cut",
           part.nodes.size(),
           {}};
  const std::vector<RecordedCut::Node>& n = part.nodes;
  nodes.add("tree", "number of the tree", [&](size_t i) { return n[i].tree; });
  nodes.add("node", "row of the tree's nodes", [&](size_t i) { return n[i].node; });
  nodes.add("light", "row of the tree's lights that stands for it; -1: none of them does",
            [&](size_t i) { return n[i].light; });
  nodes.add("weight", "factor of that light (over its probability; 0: the node gives nothing)",
            [&](size_t i) { return n[i].weight; });
  nodes.add("estimate", estimate, [&](size_t i) { return n[i].estimate; });
  nodes.add("bound", "upper bound of the estimate (0: exact); -1: has none",
            [&](size_t i) { return n[i].bound; });
  nodes.add("beside", "1: a light gathered beside the cut, in which its node has it, too",
            [&](size_t i) { return n[i].beside; });
  return out;
}

void CutExport::write(const RenderOptions& options, const Scene& scene, const Film& film,
                      const std::string& commandLine, Context& context) const {
  if (!complete_) {
    context.warning(
        "--export-trees: stopped before the first sample was complete; none is written");
    return;
  }
  namespace fs = std::filesystem;
  const std::string& folder = options.exportTrees;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RuntimeError(fmt::format("cannot make folder {}: {}", folder, error.message()));
  const std::string description = (fs::path(folder) / kDescription).string();
  fs::remove(description, error);  // of an earlier render: it no longer tells what is there
  removeTables(folder);

  Json parts = Json::array();
  for (const auto& [name, part] : {std::pair{"direct", &direct_}, {"indirect", &indirect_}}) {
    if (part->trees.empty()) continue;
    Json trees = Json::array(), cuts = Json::array();
    for (size_t t = 0; t < part->trees.size(); ++t) {
      const gather::ExportedTree& tree = part->trees[t];
      const std::string prefix = fmt::format("{}.tree{}.", name, t);
      trees.push_back({{"meaning", tree.meaning},
                       {"nodes", writeTable(tree.nodes, folder, prefix + "nodes")},
                       {"lights", writeTable(tree.lights, folder, prefix + "lights")}});
    }
    for (const ExportTable& table : tables(*part, film, estimateText(options)))
      cuts.push_back(writeTable(table, folder, fmt::format("{}.cuts.{}", name, table.name)));
    parts.push_back({{"name", name}, {"trees", trees}, {"cuts", cuts}});
  }
  const Json json = {{"format", "lobelia trees"},
                     {"format_version", 1},
                     {"version", kVersion},
                     {"command", commandLine},
                     {"scene", scene.file.empty() ? scene.name : scene.file},
                     {"seed", options.seed},
                     {"lights", options.lights},
                     {"gather", options.gather},
                     {"mode", options.gather == "sglc" ? cutModeOf(options) : ""},
                     {"size", {film.fullWidth, film.fullHeight}},
                     {"crop", {film.x0, film.y0, film.x0 + film.width, film.y0 + film.height}},
                     {"parts", parts}};
  const std::string text = json.dump(2) + "\n";
  writeFileAtomically(description, std::as_bytes(std::span<const char>(text)));
  context.info(fmt::format("wrote {}", description));
}

}  // namespace lobelia::app

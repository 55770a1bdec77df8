// `--export-trees FOLDER`: the light trees of the first set of lights and the cuts of the first
// sample, as NPY files with a description (docs/manual.md).
#pragma once

#include "lobelia/app/light_gather.h"
#include "lobelia/film/film.h"

namespace lobelia::app {

// Wrong use that shows without the scene. Throws UsageError.
void requireCutExport(const RenderOptions& options);

class CutExport {
 public:
  // A run of receivers with the light that they got, whose parts have cuts and rays.
  void add(const Receivers& run, const LightGather::Light& light);
  // After the last run.
  void addTrees(const LightGather& lights);

  // description.json comes last: a folder that has one is complete. Throws RuntimeError.
  void write(const RenderOptions& options, const Scene& scene, const Film& film,
             const std::string& commandLine, Context& context) const;

 private:
  struct Receiver {
    uint32_t pixel;
    Vec3f p, n;
    Rgb weight;
    uint32_t depth, rays;
  };
  struct Cluster {
    uint32_t firstMember, memberCount, firstNode, nodeCount;
    RecordedCut::Lobes lobes;
  };
  struct Part {
    std::vector<gather::ExportedTree> trees;
    std::vector<Receiver> receivers;
    std::vector<Cluster> clusters;
    std::vector<uint32_t> members;
    std::vector<RecordedCut::Node> nodes;
  };
  static void add(const Receivers& run, const GatherParts& parts, Part* part);
  static std::vector<gather::ExportTable> tables(const Part& part, const Film& film,
                                                 const std::string& estimate);

  Part direct_, indirect_;
  bool complete_ = false;
};

}  // namespace lobelia::app

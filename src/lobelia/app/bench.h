// `lobelia bench`: regenerates tables of docs/performance.md, or runs a study on one's own scene.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/base/error.h"

namespace lobelia::app {

struct BenchOptions {
  std::string name;
  std::vector<std::string> scenes;  // of the study instead of its own; most take one
  SceneOptions scene;               // scene.scene: the first of them; empty: the study's own
  std::string size, camera, json;
  std::string figures, output;  // vsl, vsgl, sglc: "" all figures; "": no pictures
  std::string methods;          // sglc: "" all
  std::string commandLine;
  int maxDepth = 0;     // 0: the scene's
  uint64_t pixels = 0;  // these: 0 is the study's default
  uint64_t lightCount = 0;
  size_t rows = 0, columns = 0;
  int spp = 0;
  int sets = 0;
  uint64_t seed = 0;
};

void addBenchOptions(CLI::App& command, BenchOptions& options);
ExitCode bench(const BenchOptions& options, const GlobalOptions& global,
               const std::string& commandLine);

}  // namespace lobelia::app

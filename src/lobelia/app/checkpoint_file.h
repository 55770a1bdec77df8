// `--checkpoint FILE` and `--resume FILE`: the state of a render on disk.
//
// A store file of kind "checkpoint" with the scene's hash and the chunks
//   settings   lines "name=value": the program's version and all that changes pixels
//   stage      which stage has saved it
//   counts     lines "name=value": counters of the statistics
//   the stage's own arrays
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lobelia/app/render_options.h"
#include "lobelia/base/checkpoints.h"
#include "lobelia/base/context.h"
#include "lobelia/path/path_tracer.h"
#include "lobelia/store/store.h"

namespace lobelia::app {

// What two renders must have in common to be the same picture.
struct RenderIdentity {
  uint64_t sceneHash = 0;
  std::vector<std::pair<std::string, std::string>> settings;
};
// camera: as chosen, with size and crop; maxDepth: as resolved.
RenderIdentity identify(const Scene& scene, const Camera& camera, int maxDepth,
                        const RenderOptions& options);

class CheckpointFile : public Checkpoints {
 public:
  // resume: goes on from the file when it is there. Throws InputError when it is damaged or of
  // another scene, other settings or another version.
  CheckpointFile(std::string file, RenderIdentity identity, double interval, bool resume,
                 Context& context);
  bool due() const override;
  void markCounts() override;
  void save(std::string_view stage, const StateFields& state) override;
  bool load(std::string_view stage, const StateFields& state) override;
  void restoreCounts() override;

 private:
  using Counts = std::map<std::string, uint64_t>;
  void open();
  std::string file_;
  RenderIdentity identity_;
  int64_t interval_;  // nanoseconds
  Context& context_;
  std::optional<store::Reader> saved_;  // until a stage has loaded it
  Counts marked_, loaded_;
  std::atomic<int64_t> due_;  // when the next save is
  bool failed_ = false;
};

// As --checkpoint and --resume say; null: neither.
std::unique_ptr<Checkpoints> openCheckpoint(const Scene& scene, const Camera& camera, int maxDepth,
                                            const RenderOptions& options, Context& context);

}  // namespace lobelia::app

#include "lobelia/app/replay_path.h"

#include "lobelia/app/replay_text.h"

namespace lobelia::app {
namespace {

constexpr size_t kLongest =
    20'000;  // characters of a sample: a path may have thousands of vertices

void append(std::string& lines, const std::string& line) {
  if (lines.size() < kLongest) lines += line;
}

}  // namespace

void PathTrace::vertex(const PathState& path, const SurfacePoint& at, const Bsdf& bsdf) {
  const Instance& instance = scene_.instances[at.instance];
  const std::string material =
      at.material.valid() ? scene_[at.material].name : std::string("default");
  append(lines_[&path], fmt::format("  depth {}  at {}  instance {} '{}'  material '{}'  lobes {}\n"
                                    "    throughput sharp {}  rough {}\n",
                                    path.depth, place(at.p), at.instance, instance.name, material,
                                    bsdf.lobeCount, text(path.chain), text(path.indirect)));
}

void PathTrace::met(const PathState& path, Rgb direct, Rgb indirect) {
  append(lines_[&path], fmt::format("    emission met at depth {}: direct {}  indirect {}\n",
                                    path.depth, text(direct), text(indirect)));
}

void PathTrace::lit(const PathShadow& shadow) {
  append(lines_[shadow.path],
         fmt::format("    emitter sample {} visible: direct {}  indirect {}\n", shadow.sample,
                     text(shadow.direct), text(shadow.indirect)));
}

void PathTrace::ended(const PathState& path) {
  const bool finite = isFinite(path.result.direct) && isFinite(path.result.indirect);
  if (all_ || sample_ < kReplaySamples || (!finite && sample_ - hidden_ < 4 * kReplaySamples)) {
    fmt::print("sample {}\n{}  light: direct {}  indirect {}{}\n", sample_, lines_[&path],
               text(path.result.direct), text(path.result.indirect),
               finite ? "" : "; the sample counts as black");
  } else {
    ++hidden_;
  }
  lines_.erase(&path);
  ++sample_;
}

}  // namespace lobelia::app

#include "lobelia/app/bench.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <span>

#include "lobelia/app/bench_studies.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/signals.h"
#include "lobelia/base/file.h"
#include "lobelia/base/parallel.h"

namespace lobelia::app {
namespace {

struct Study {
  const char* name;
  const char* summary;
  std::vector<BenchTable> (*run)(const BenchOptions&, Context&);
  const std::vector<std::string>& (*figures)() = nullptr;  // null: it takes no --figures
};
constexpr Study kStudies[] = {
    {"rates", "rays per second: bare, of the gather, of the path tracer", benchRates},
    {"picture", "time and error of whole pictures", benchPicture},
    {"clamp", "energy that clamping loses, against the path tracer", benchClamp},
    {"convergence", "mean of glossy virtual lights against the path tracer", benchConvergence},
    {"vsl", "virtual spherical lights: figures 1, 2 and 4 to 8 of their paper", benchVsl,
     vslFigures},
    {"vsgl", "virtual spherical Gaussian lights: sampling, time and cuts", benchVsgl, vsglFigures},
    {"sglc", "spherical-Gaussian lightcuts: table 2 and figures 4 to 9 of their paper", benchSglc,
     sglcFigures},
    {"cuts", "visibility cuts: figures 5, 6 and 8 to 10 of their paper", benchCuts, cutsFigures},
    {"vmf", "multi-bounce glossy transfer: table 1 and figures 1 to 4 of its paper", benchVmf,
     vmfFigures},
};

std::vector<std::string> studyNames() {
  std::vector<std::string> names;
  for (const Study& study : kStudies) names.emplace_back(study.name);
  return names;
}

std::vector<std::string> figureNames() {
  std::vector<std::string> names;
  for (const Study& study : kStudies) {
    if (study.figures == nullptr) continue;
    for (const std::string& figure : study.figures())
      if (std::find(names.begin(), names.end(), figure) == names.end()) names.push_back(figure);
  }
  std::sort(names.begin(), names.end());
  return names;
}

const Study& findStudy(const std::string& name) {
  for (const Study& study : kStudies)
    if (study.name == name) return study;
  std::string known;
  for (const Study& study : kStudies)
    known += fmt::format("\n  {:<12} {}", study.name, study.summary);
  throw UsageError(fmt::format("there is no bench '{}'{}; there are{}", name,
                               suggestion(name, studyNames()), known));
}

// Throws where an option is given to a study that knows nothing of it.
void requireOptions(const Study& study, const BenchOptions& options) {
  if (options.name != "vsl" && (options.rows > 0 || options.columns > 0)) {
    throw UsageError(
        fmt::format("bench {} has no use for --rows or --columns; vsl has", options.name));
  }
  if (options.name != "sglc" && !options.methods.empty())
    throw UsageError(fmt::format("bench {} has no use for --methods; sglc has", options.name));
  const bool hasSets =
      options.name == "clamp" || options.name == "convergence" || options.name == "rates";
  if (options.sets > 0 && !hasSets)
    throw UsageError(fmt::format(
        "bench {} has no use for --sets; clamp, convergence and rates have", options.name));
  if (study.figures != nullptr) return;
  if (options.scenes.size() > 1) {
    throw UsageError(fmt::format(
        "bench {} takes one --scene; vsl, vsgl, sglc, cuts and vmf take several", options.name));
  }
  if (!options.output.empty() || !options.figures.empty()) {
    throw UsageError(fmt::format(
        "bench {} has no use for --output or --figures; vsl, vsgl, sglc, cuts and vmf have",
        options.name));
  }
}

// Shows a study's own progress, and not what every small picture in it tells (--verbose does).
class StudyListener : public Listener {
 public:
  explicit StudyListener(Console& console) : console_(console) {}
  void message(Severity severity, std::string_view text) override {
    console_.message(severity == Severity::info ? Severity::debug : severity, text);
  }
  void progress(std::string_view stage, double fraction) override {
    if (stage.starts_with(kBenchStage))
      console_.progress(stage.substr(kBenchStage.size()), fraction);
  }

 private:
  Console& console_;
};

}  // namespace

void addBenchOptions(CLI::App& c, BenchOptions& o) {
  std::string summaries;
  for (const Study& study : kStudies) {
    summaries += fmt::format("; {}: {}", study.name, study.summary);
  }
  c.add_option("name", o.name, "Study to run" + summaries)
      ->type_name("STUDY")
      ->check(offered(studyNames()))
      ->required();
  c.add_option("--scene", o.scenes,
               "Run the study on this scene file or built-in scene instead of its own; vsl, vsgl, "
               "sglc, cuts and vmf take several")
      ->type_name("FILE|SCENE")
      ->allow_extra_args(false);
  c.add_option(
       "-o,--output", o.output,
       "vsl, vsgl, sglc, cuts, vmf: folder for pictures and for a page that shows them with the "
       "tables; without "
       "it vsl renders only the pixels compared")
      ->type_name("FOLDER");
  c.add_option("--figures", o.figures,
               "vsl, vsgl, sglc, cuts, vmf: figures of the study; default: all")
      ->type_name("LIST")
      ->check(offered(figureNames()));
  c.add_option("--methods", o.methods,
               "sglc: only these methods, and mode shared, in table 2, figures 8 and 9 and the "
               "floors; default: all")
      ->type_name("LIST")
      ->check(offered(sglcMethodKeys()));
  c.add_option("--json", o.json, "Write the tables as JSON")->type_name("FILE");
  c.add_option("-D,--define", o.scene.definitions, "name=value for a scene's $name")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  c.add_option("--environment", o.scene.environment,
               "Equirectangular HDR image that lights the scene")
      ->type_name("FILE");
  c.add_flag("--strict", o.scene.strict, "Warnings about the scene are errors");
  c.add_option("--detail", o.scene.detail, "Tessellation of built-in scenes")
      ->type_name("X")
      ->check(finiteNumber(0.01, 100))
      ->capture_default_str();
  c.add_option("--camera", o.camera, "Camera by name or index (from 0)")->type_name("NAME");
  c.add_option("--size", o.size, "WxH in pixels")->type_name("WxH");
  c.add_option("--pixels", o.pixels,
               "clamp, convergence, vsl, vsgl, sglc: pixels compared, spread over the image; cuts: "
               "vertices of figures 5 and 8; vmf: most vertices that subdivision may leave")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 32));
  c.add_option("--max-depth", o.maxDepth, "As for render; default: the scene's, else unlimited")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 20));
  c.add_option(
       "--num-lights", o.lightCount,
       "Virtual lights in a set (convergence: in the largest set; cuts: directions of light)")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 31));
  c.add_option("--rows", o.rows, "vsl: rows of --gather mrcs, as for render")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 20));
  c.add_option("--columns", o.columns, "vsl: columns of --gather mrcs; default: 5000")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 31));
  c.add_option("--spp", o.spp, "Samples per pixel of the path tracer")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24));
  c.add_option("--sets", o.sets,
               "clamp, convergence: independent sets of lights of a size; rates: turns")
      ->type_name("N")
      ->check(integerRange(2, int64_t{1} << 20));
  c.add_option("--seed", o.seed, "Seed of all randomness")
      ->type_name("N")
      ->check(seedNumber())
      ->capture_default_str();
}

ExitCode bench(const BenchOptions& asked, const GlobalOptions& global,
               const std::string& commandLine) {
  const Study& study = findStudy(asked.name);
  requireOptions(study, asked);
  BenchOptions options = asked;
  options.commandLine = commandLine;
  if (!options.scenes.empty()) options.scene.scene = options.scenes.front();
  requireSize(options.size);
  if (!options.json.empty()) requireWritable(options.json);
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  StudyListener listener(console);
  Context context(&listener);
  context.seed = options.seed;
  const SignalGuard signals(context);
  BenchRun run{options.name, commandLine, options.seed, study.run(options, context)};
  for (size_t i = 0; i < run.tables.size(); ++i)
    fmt::print("{}{}", i > 0 ? "\n" : "", markdown(run.tables[i]));
  std::fflush(stdout);
  if (!options.json.empty()) {
    const std::string text = json(run);
    writeFileAtomically(options.json, std::as_bytes(std::span<const char>(text)));
  }
  return signalExitCode();
}

}  // namespace lobelia::app

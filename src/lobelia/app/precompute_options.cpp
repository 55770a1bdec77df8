#include "lobelia/app/precompute_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <span>

#include "lobelia/app/option_checks.h"
#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

constexpr const char* kOfCuts[] = {"--light", "--samples",  "--sigma",    "--max-cut",
                                   "--beta",  "--clusters", "--adaptive", "--horizon"};
constexpr const char* kOfVmf[] = {
    "--solver",     "--directions",     "--bounces",      "--lobes",  "--rays", "--slice-rays",
    "--mask-level", "--mask-tolerance", "--max-vertices", "--memory", "--work"};
constexpr const char* kOfGather[] = {"--rays", "--memory", "--work"};
constexpr const char* kOfScatter[] = {"--slice-rays", "--seed"};

CLI::Validator powerOfTwo(uint64_t least, uint64_t most) {
  return CLI::Validator(
      [=](const std::string& text) {
        uint64_t value = 0;
        if (CLI::detail::lexical_cast(text, value) && std::has_single_bit(value) &&
            value >= least && value <= most)
          return std::string();
        return fmt::format("{} is not a power of two from {} to {}", text, least, most);
      },
      "");
}

void addCutOptions(CLI::App& c, PrecomputeOptions& o) {
  c.add_option("--light", o.light,
               "cuts: light that will be looked for: from all directions (environment), or from "
               "the scene's surfaces, for one bounce of local light (surfaces)")
      ->type_name("WHICH")
      ->check(oneOf({"environment", "surfaces"}))
      ->capture_default_str();
  relight::PrecomputeSettings& s = o.cuts;
  c.add_option("--samples", s.sampleCount,
               "cuts: samples of light: directions, or places on surfaces; a power of two, at "
               "least 256")
      ->type_name("N")
      ->check(powerOfTwo(256, 32768))
      ->capture_default_str();
  c.add_option("--sigma", s.sigma,
               "cuts: error that each node of a cut may have: the root of its summed squared "
               "differences; 0: none")
      ->type_name("X")
      ->check(finiteNumber(0, 1000))
      ->capture_default_str();
  c.add_option("--max-cut", s.mostNodes, "cuts: nodes of a cut, at most")
      ->type_name("N")
      ->check(integerRange(1, 32768))
      ->capture_default_str();
  c.add_option("--beta", s.beta,
               "cuts: clusters of samples go by geometry (1), by what parts of the scene see of "
               "them (0), or by a mix of both")
      ->type_name("X")
      ->check(finiteNumber(0, 1))
      ->capture_default_str();
  c.add_option("--clusters", s.clusterCount,
               "cuts: clusters of vertices that are asked what they see; a power of two")
      ->type_name("N")
      ->check(powerOfTwo(1, 16384))
      ->capture_default_str();
  c.add_option(
       "--adaptive", o.adaptive,
       "cuts: trace few rays where vertices nearby agree (on), or all (off); verify: few, and all "
       "as well, to count in the statistics what differs")
      ->type_name("WHICH")
      ->check(oneOf({"on", "off", "verify"}))
      ->capture_default_str();
  c.add_option("--horizon", o.horizon,
               "cuts: light from behind an opaque surface: what cuts say of it does not matter "
               "(ignore), or they say that it is blocked (keep), which makes them larger")
      ->type_name("WHICH")
      ->check(oneOf({"ignore", "keep"}))
      ->capture_default_str();
  c.add_option(
       "--seed", o.seed,
       "cuts, and vmf with --solver scatter: seed of all random choices; --solver gather has "
       "none")
      ->type_name("N")
      ->check(seedNumber())
      ->capture_default_str();
}

void addVmfOptions(CLI::App& c, PrecomputeOptions& o) {
  transfer::TransferSettings& s = o.vmf;
  c.add_option("--solver", o.solver,
               "vmf: gather: rays from each vertex gather what the bounce before has at other "
               "surfaces; scatter: paths are followed from each vertex until they leave the scene, "
               "the baseline to compare with, noisy and slow")
      ->type_name("WHICH")
      ->check(oneOf({"gather", "scatter"}))
      ->capture_default_str();
  c.add_option("--directions", o.directions,
               "vmf: directions to the eye for which each vertex knows its lobes")
      ->type_name("N")
      ->check(oneOf({"162", "642", "2562", "10242"}))
      ->capture_default_str();
  c.add_option("--bounces", s.bounces,
               "vmf: reflections at other surfaces before the one that is seen; 0: direct light")
      ->type_name("N")
      ->check(integerRange(0, 64))
      ->capture_default_str();
  c.add_option("--lobes", o.lobes,
               "vmf: for glossy light over other surfaces one lobe, or one for each of their "
               "materials (five at most)")
      ->type_name("WHICH")
      ->check(oneOf({"one", "materials"}))
      ->capture_default_str();
  c.add_option("--rays", o.rays,
               "vmf: level of the grid of rays from each vertex: 4 (2,562), 5 (10,242), 6 (40,962) "
               "or 7 (163,842); auto: as the sharpest material wants")
      ->type_name("LEVEL")
      ->check(oneOf({"auto", "4", "5", "6", "7"}))
      ->capture_default_str();
  c.add_option("--slice-rays", o.sliceRays,
               "vmf, --solver scatter: paths for each vertex and direction")
      ->type_name("N")
      ->check(integerRange(1, 65536))
      ->capture_default_str();
  c.add_option("--mask-level", s.maskLevel,
               "vmf: level of the grid of directions in which visibility is compared for "
               "--subdivide; 7 has 163,842")
      ->type_name("LEVEL")
      ->check(integerRange(3, 7))
      ->capture_default_str();
  c.add_option("--mask-tolerance", s.maskTolerance,
               "vmf: share of these directions whose visibility may differ along an edge")
      ->type_name("X")
      ->check(finiteNumber(0, 1))
      ->capture_default_str();
  c.add_option("--max-vertices", s.mostVertices,
               "vmf: vertices after subdivision, at most, edges that need it most first; 0: twice "
               "the scene's, or 20,000 more")
      ->type_name("N")
      ->check(integerRange(0, int64_t{1} << 31))
      ->capture_default_str();
  c.add_option("--memory", s.memoryBytes,
               "vmf: memory for the data and what it is made of; units K, M, G; default: three "
               "quarters of the machine's")
      ->type_name("BYTES")
      ->transform(byteCount());
  c.add_option("--work", o.work,
               "vmf: folder for what is done so far, from which the same command goes on when it "
               "was stopped; removed at the end; none: nothing is kept, and rays stay in memory; "
               "default: the output's name and .work")
      ->type_name("FOLDER");
}

bool isGiven(const PrecomputeOptions& options, const char* name) {
  return std::find(options.given.begin(), options.given.end(), name) != options.given.end();
}

// what: the option that chooses; owner: its value to which these options belong.
void refuse(const PrecomputeOptions& options, std::span<const char* const> names, const char* what,
            const char* owner, const std::string& chosen) {
  for (const char* name : names)
    if (isGiven(options, name))
      throw UsageError(
          fmt::format("{} is of {} {}; {} {} has no such option", name, what, owner, what, chosen));
}

// A slice's directions are not looked at more closely than by the rays of its vertex.
void requireRaysFor(const PrecomputeOptions& options) {
  if (options.rays == "auto" || directionLevel(options) <= std::stoi(options.rays)) return;
  throw UsageError(
      fmt::format("--directions {} is finer than the grid of --rays {}; give --rays {} or more, or "
                  "fewer directions",
                  options.directions, options.rays, directionLevel(options)));
}

}  // namespace

int directionLevel(const PrecomputeOptions& options) {
  int level = 0;
  while (10 * (1 << 2 * level) + 2 < std::stoi(options.directions)) ++level;
  return level;
}

const std::vector<std::string>& precomputeMethods() {
  static const std::vector<std::string> names{"cuts", "vmf"};
  return names;
}

void addPrecomputeOptions(CLI::App& c, PrecomputeOptions& o) {
  addSceneOptions(c, o.scene);
  c.add_option("--method", o.method,
               "What is precomputed; cuts: visibility cuts at vertices, for light and materials "
               "that change; vmf: glossy reflections of any number of bounces, for light from "
               "infinity that changes")
      ->type_name("METHOD")
      ->check(offered(precomputeMethods()))
      ->required();
  c.add_option("-o,--output", o.output, "Data to write")->type_name("FILE")->required();
  c.add_option("--subdivide", o.subdivision,
               "How often edges are halved at most where visibility differs along them; 0: never")
      ->type_name("N")
      ->check(integerRange(0, 8))
      ->capture_default_str();
  addCutOptions(c, o);
  addVmfOptions(c, o);
  c.add_option("--stats", o.stats, "Write statistics as JSON")->type_name("FILE");
}

void requireOfMethod(const PrecomputeOptions& options) {
  const std::vector<std::string>& known = precomputeMethods();
  if (std::find(known.begin(), known.end(), options.method) == known.end())
    throw UsageError(fmt::format("--method '{}' is not known{}", options.method,
                                 suggestion(options.method, known)));
  if (options.method == "cuts") return refuse(options, kOfVmf, "--method", "vmf", "cuts");
  refuse(options, kOfCuts, "--method", "cuts", "vmf");
  if (options.solver == "scatter")
    return refuse(options, kOfGather, "--solver", "gather", "scatter");
  refuse(options, kOfScatter, "--solver", "scatter", "gather");
  requireRaysFor(options);
}

}  // namespace lobelia::app

#include "lobelia/app/light_reduction.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "lobelia/app/gather_options.h"
#include "lobelia/app/receiver_sample.h"
#include "lobelia/base/error.h"
#include "lobelia/base/random.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kStream = 0x6d726373;  // of everything random here
constexpr size_t kDefaultRows = 1024;
// Where neither --columns nor --error says what is wanted.
constexpr double kDefaultError = 0.02;
constexpr size_t kDefaultMostColumns = 16384;

bool reduces(const RenderOptions& options) { return options.gather == "mrcs"; }

MrcsSettings settingsFor(const RenderOptions& options, const BandPlan& plan) {
  MrcsSettings settings;
  settings.gather = plan.gather;
  settings.columns = mostColumns(options);
  settings.errorLimit = options.error;
  if (options.error > 0 && options.columns == 0) settings.columns = SIZE_MAX;
  if (options.error <= 0 && options.columns == 0) settings.errorLimit = kDefaultError;
  // The picture is the mean of independent sets.
  settings.errorLimit *= std::sqrt(static_cast<double>(plan.sets));
  if (!options.sketch.empty())
    settings.sketch = options.sketch == "off" ? 0 : std::stoi(options.sketch);
  settings.memory = memoryOf(options);
  settings.scalePerChannel = options.columnScale == "channel";
  return settings;
}

// Fewer radii where the user asks for wider spheres, which overlap more already.
float nearFieldRadii(const RenderOptions& options) {
  constexpr float kDefault = 6, kUsualFactor = 2;
  if (options.nearField >= 0) return options.nearField;
  return options.radius > kUsualFactor ? std::max(1.f, kDefault * kUsualFactor / options.radius)
                                       : kDefault;
}

// Spherical lights alone: others have no near field.
VirtualLights nearLights(VirtualLights lights) {
  lights.omni = {}, lights.directional = {}, lights.diffuse = {}, lights.glossy = {};
  lights.gaussian = {};
  lights.omniGroups = {}, lights.directionalGroups = {}, lights.glossyGroups = {};
  lights.diffuseDepthEnds = {}, lights.glossyDepthEnds = {}, lights.gaussianDepthEnds = {};
  lights.sphereShading.reach = SphereShading::Reach::nearField;
  return lights;
}

gather::Rows traceRows(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                       const BandPlan& plan, int set, size_t rows, uint64_t seed,
                       Context& context) {
  const gather::RowPixels chosen = choosePixelSample(camera, plan, rows, seed);
  return makeRows(chosen, traceSample(tracer, emitters, camera, plan, set, chosen.pixels, context),
                  camera.cropX1 - camera.cropX0);
}

}  // namespace

double ReductionReport::error(int part) const {
  return sets > 0 ? std::sqrt(squaredError[part]) / static_cast<double>(sets) : 0;
}

void requireSketch(const RenderOptions& options) {
  if (!options.sketch.empty() && options.sketch != "off") {
    int dims = 0;
    const char* end = options.sketch.data() + options.sketch.size();
    const auto [next, error] = std::from_chars(options.sketch.data(), end, dims);
    if (error != std::errc() || next != end || dims < 16 || dims > 4096 || dims % 16 != 0) {
      throw UsageError(fmt::format(
          "--sketch '{}' is neither a multiple of 16 from 16 to 4096 nor 'off'", options.sketch));
    }
  }
}

size_t mostColumns(const RenderOptions& options) {
  return options.columns > 0 ? options.columns : kDefaultMostColumns;
}

LightParts reduceParts(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                       const BandPlan& plan, int set, LightParts parts,
                       const RenderOptions& options, ReductionReport* report, Context& context) {
  if (!reduces(options)) return parts;
  ReductionReport sum = *report;  // a set that is cancelled must not count
  MrcsSettings settings = settingsFor(options, plan);
  const uint64_t seed = hashCombine(hashCombine(context.seed, kStream), static_cast<uint64_t>(set));
  const gather::Rows rows =
      traceRows(tracer, emitters, camera, plan, set, options.rows > 0 ? options.rows : kDefaultRows,
                seed, context);
  ++sum.sets;
  VirtualLights* const lights[] = {&parts.direct, &parts.indirect};
  const float nearField = nearFieldRadii(options);
  VirtualLights* const near[] = {&parts.nearDirect, &parts.nearIndirect};
  for (const int part : {0, 1}) {
    if (part == 1 && options.component == "direct") continue;
    if (context.cancelled() || lights[part]->size() == 0) continue;
    settings.seed = hashCombine(seed, static_cast<uint64_t>(part));
    lights[part]->sphereShading.reach = SphereShading::Reach::farField;
    lights[part]->sphereShading.nearField = nearField;
    MrcsReport one;
    VirtualLights few = reduceLights(tracer, rows, *lights[part], settings, &one, context);
    if (context.cancelled()) break;
    if (one.rows > 0 && nearField > 0) *near[part] = nearLights(std::move(*lights[part]));
    if (one.rows == 0) few.sphereShading.reach = SphereShading::Reach::all;
    *lights[part] = std::move(few);
    sum.columns += one.columns;
    sum.rows = std::max(sum.rows, one.rows);
    sum.sketch = std::max(sum.sketch, one.sketch);
    sum.squaredError[part] += one.error * one.error;
    const std::string text = fmt::format(
        "light set {}: {} of {} lights {} stand for all; {} rows; predicted error {:.2f} % "
        "({:.2f} % in the rows)",
        set, one.columns, one.lights, part == 0 ? "of emitters" : "of bounces", one.rows,
        100 * one.error, 100 * one.rowError);
    set == 0 ? context.info(text) : context.debug(text);
  }
  if (!context.cancelled()) *report = sum;
  return parts;
}

}  // namespace lobelia::app

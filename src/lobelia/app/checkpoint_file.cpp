#include "lobelia/app/checkpoint_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "lobelia/app/gather_options.h"
#include "lobelia/app/light_sets.h"
#include "lobelia/app/vsgl_options.h"
#include "lobelia/base/file.h"
#include "lobelia/gather/simd_target.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

constexpr const char* kKind = "checkpoint";
constexpr uint32_t kFileVersion = 3;
constexpr const char* kFirstBad = "first_nonfinite_pixel";  // a value among the counters
constexpr const char* kCounters[] = {"path_rays",
                                     "shadow_rays",
                                     "nonfinite",
                                     "light_particles",
                                     "light_points",
                                     "rsm_texels",
                                     "lights_dropped",
                                     "paths_cut",
                                     "node_pairs_visited",
                                     "node_pairs_shaded",
                                     "specular_connections",
                                     "near_receivers",
                                     "cut_lights",
                                     "receiver_clusters",
                                     "clustered_receivers",
                                     "clustered_lights",
                                     "dominant_lights",
                                     "dominant_comparisons",
                                     "rich_lights",
                                     "rich_bytes",
                                     "shared_rays",
                                     "error_missed"};

constexpr int64_t kSaveTimes = 10;  // between two saves passes so often the time of one,
constexpr int64_t kLongestWait = 60'000'000'000;  // nanoseconds; but no longer than this

using Lines = std::vector<std::pair<std::string, std::string>>;

void addText(store::Writer& writer, std::string_view chunk, std::string_view text) {
  writer.add(chunk, std::span<const char>(text.data(), text.size()));
}

std::string text(const store::Reader& reader, std::string_view chunk) {
  const std::vector<char> chars = reader.get<char>(chunk);
  return {chars.begin(), chars.end()};
}

// Values hold no line breaks: file names are hashed.
std::string join(const Lines& lines) {
  std::string out;
  for (const auto& [name, value] : lines) out += fmt::format("{}={}\n", name, value);
  return out;
}

Lines parse(const std::string& text) {
  Lines lines;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const size_t equals = std::min(line.find('='), line.size());
    lines.emplace_back(line.substr(0, equals),
                       equals < line.size() ? line.substr(equals + 1) : std::string());
    begin = end + 1;
  }
  return lines;
}

std::string hashOf(const std::string& file) {
  return file.empty() ? "none" : fmt::format("{:016x}", store::hashBytes(readFile(file)));
}

// Settings that several strategies have, each with its own meaning and default.
constexpr const char* kOfGather[] = {"--columns", "--memory", "--cut-size", "--threshold",
                                     "--error"};

// Both ways, so that a setting that only one side has shows too, unless another difference (of
// --lights, --gather...) is what brings it.
std::vector<std::string> differences(const Lines& saved, const Lines& wanted) {
  constexpr const char* kNone = "not known";
  const auto valueIn = [](const Lines& lines, const std::string& name) {
    const auto it = std::find_if(lines.begin(), lines.end(),
                                 [&](const auto& line) { return line.first == name; });
    return it != lines.end() ? it->second : std::string(kNone);
  };
  const bool otherGather = valueIn(saved, "--gather") != valueIn(wanted, "--gather");
  const auto saysNothing = [&](const std::string& name) {
    return otherGather &&
           std::find(std::begin(kOfGather), std::end(kOfGather), name) != std::end(kOfGather);
  };
  std::vector<std::string> ofBoth, ofOne;
  const auto compare = [&](const std::string& name) {
    const std::string before = valueIn(saved, name), now = valueIn(wanted, name);
    if (before == now || saysNothing(name)) return;
    std::vector<std::string>& list = before == kNone || now == kNone ? ofOne : ofBoth;
    list.push_back(fmt::format("{} {} (now {})", name, before, now));
  };
  for (const auto& [name, value] : wanted) compare(name);
  for (const auto& [name, value] : saved)
    if (valueIn(wanted, name) == kNone) compare(name);
  return ofBoth.empty() ? ofOne : ofBoth;
}

}  // namespace

RenderIdentity identify(const Scene& scene, const Camera& camera, int maxDepth,
                        const RenderOptions& o) {
  RenderIdentity identity;
  identity.sceneHash = hash(scene);
  Lines& s = identity.settings;
  const bool virtualLights = o.lights != "path" && o.lights != "light";
  s.emplace_back("version", kVersion);
  s.emplace_back("SIMD", simdTarget());
  s.emplace_back("--lights", o.lights);
  s.emplace_back("--size", fmt::format("{}x{}", camera.width, camera.height));
  s.emplace_back("--crop", fmt::format("{},{},{},{}", camera.cropX0, camera.cropY0, camera.cropX1,
                                       camera.cropY1));
  Scene seen;
  seen.cameras = {camera};
  s.emplace_back("--camera", fmt::format("{:016x}", hash(seen)));
  const int spp = o.spp > 0 || virtualLights ? o.spp : camera.spp;
  s.emplace_back("--spp", spp > 0 ? std::to_string(spp) : "default");
  s.emplace_back("--pixels", std::to_string(o.pixels));
  s.emplace_back("--seed", std::to_string(o.seed));
  s.emplace_back("--max-depth", std::to_string(maxDepth));
  s.emplace_back("--component", o.component);
  s.emplace_back("--specular-limit", fmt::format("{}", o.specularLimit));
  s.emplace_back("--aov", o.aovs);
  if (!virtualLights) return identity;
  s.emplace_back("--gather", o.gather);
  if (o.gather == "mrcs") {
    s.emplace_back("--rows", std::to_string(o.rows));
    s.emplace_back("--columns", std::to_string(o.columns));
    s.emplace_back("--error", fmt::format("{}", o.error));
    s.emplace_back("--sketch", o.sketch);
    s.emplace_back("--column-scale", o.columnScale);
    s.emplace_back("--near-field", fmt::format("{}", o.nearField));
    s.emplace_back("--memory", std::to_string(memoryOf(o)));
  }
  if (o.gather == "lightcuts" || o.gather == "mdlc" || o.gather == "stochastic") {
    s.emplace_back("--threshold", fmt::format("{}", thresholdOf(o)));
    s.emplace_back("--cut-size", std::to_string(cutSizeOf(o)));
  }
  if (o.gather == "illumcut") {
    s.emplace_back("--threshold", fmt::format("{}", thresholdOf(o)));
    s.emplace_back("--illumcut-rays", illumcutRaysOf(o));
  }
  if (o.gather == "lightslice") {
    s.emplace_back("--slices", std::to_string(slicesOf(o)));
    s.emplace_back("--columns", std::to_string(sliceColumnsOf(o)));
    s.emplace_back("--memory", std::to_string(memoryOf(o)));
  }
  if (o.gather == "sglc") {
    s.emplace_back("--sglc-mode", cutModeOf(o));
    if (!gathersPairs(o)) {
      s.emplace_back("--cut-size", std::to_string(cutSizeOf(o)));
      s.emplace_back("--error", fmt::format("{}", o.error));
    }
  }
  if (gathersPairs(o)) {
    s.emplace_back("--threshold", fmt::format("{}", thresholdOf(o)));
    s.emplace_back("--bound", boundOf(o));
    s.emplace_back("--sglc-bounds", boundFormOf(o));
    s.emplace_back("--sglc-share", shareOf(o));
    s.emplace_back("--sglc-children", childrenOf(o));
  }
  if (o.lights == "vsl") {
    s.emplace_back("--radius", fmt::format("{}", o.radius));
    s.emplace_back("--vsl-indicator", o.sphereIndicator);
    s.emplace_back("--vsl-sampling", o.sphereSampling);
    s.emplace_back("--vsl-samples", std::to_string(o.sphereSamples));
  }
  if (o.lights == "vsgl") {
    const GaussianShading shading = gaussianShadingOf(o);
    s.emplace_back("--vsgl-clusters", o.vsglClusters.empty() ? "tree" : o.vsglClusters);
    const auto count = [](size_t n) { return n > 0 ? std::to_string(n) : "default"; };
    s.emplace_back("--vsgl-points", count(o.vsglPoints));
    s.emplace_back("--vsgl-views", count(o.vsglViews));
    s.emplace_back("--vsgl-overlap", fmt::format("{}", o.vsglOverlap > 0 ? o.vsglOverlap : 1));
    s.emplace_back("--vsgl-shading", o.vsglShading.empty() ? "accurate" : o.vsglShading);
    s.emplace_back("--vsgl-variance", shading.projected ? "projected" : "isotropic");
    s.emplace_back("--vsgl-spread", fmt::format("{}", shading.spread));
    s.emplace_back("--vsgl-merging", shading.toksvig ? "toksvig" : "exact");
    s.emplace_back("--vsgl-shadows", o.vsglShadows.empty() ? "mean" : o.vsglShadows);
    s.emplace_back("--vsgl-map-size", std::to_string(mapSizeOf(o)));
  }
  if (o.lights == "richvpl") {
    s.emplace_back("--richvpl-lights", std::to_string(richLightsOf(o)));
    s.emplace_back("--richvpl-radiance", richRadianceOf(o));
    if (richRadianceOf(o) == "cube") {
      s.emplace_back("--richvpl-texels", std::to_string(richTexelsOf(o)));
    } else {
      s.emplace_back("--richvpl-lobes", std::to_string(richLobesOf(o)));
    }
  }
  s.emplace_back("--num-lights", std::to_string(o.lightCount));
  if (o.direct == "lights") s.emplace_back("--env-lights", std::to_string(o.environmentLights));
  s.emplace_back("--passes", std::to_string(o.passes));
  s.emplace_back("--direct", o.direct);
  s.emplace_back("--clamp", o.clamp);
  s.emplace_back("--near-lights", fmt::format("{}", nearLightsOf(o)));
  s.emplace_back("--compensate", o.compensate ? "yes" : "no");
  if (o.lights == "photon") {
    s.emplace_back("--photons-nearest", std::to_string(o.photonsNearest));
    s.emplace_back("--photon-radius", fmt::format("{}", o.photonRadius));
    s.emplace_back("--gather-rays", std::to_string(o.gatherRays));
  }
  s.emplace_back("--save-lights", o.saveLights.empty() ? "no" : "yes");  // one set of lights
  s.emplace_back("--load-lights", hashOf(o.loadLights));
  return identity;
}

CheckpointFile::CheckpointFile(std::string file, RenderIdentity identity, double interval,
                               bool resume, Context& context)
    : file_(std::move(file)),
      identity_(std::move(identity)),
      interval_(static_cast<int64_t>(std::min(interval, 1e9) * 1e9)),
      context_(context),
      due_(nanosecondsNow() + interval_) {
  const bool exists = std::filesystem::exists(file_);
  if (exists && !std::filesystem::is_regular_file(file_))
    throw InputError({file_}, "is not a regular file; a checkpoint needs one of its own");
  if (!resume) {
    if (exists && !readFileStart(file_, 1).empty() && store::kindOf(file_) != kKind)
      throw InputError({file_},
                       "is there and no checkpoint, which --checkpoint would replace; "
                       "name another file, or remove this one");
    return;
  }
  if (exists) {
    open();
  } else {
    context.info(fmt::format("no checkpoint {} yet: starting afresh", file_));
  }
}

void CheckpointFile::open() {
  saved_.emplace(file_, kKind, kFileVersion);
  const auto refuse = [&](const std::string& what) {
    throw InputError({file_}, fmt::format("{}; use --checkpoint to start afresh", what));
  };
  if (saved_->sceneHash() != identity_.sceneHash) {
    refuse("the checkpoint belongs to another scene, or the scene was changed since");
  }
  const std::vector<std::string> different =
      differences(parse(text(*saved_, "settings")), identity_.settings);
  if (!different.empty()) {
    refuse(fmt::format("the checkpoint was made with {}", fmt::join(different, ", ")));
  }
}

bool CheckpointFile::due() const { return nanosecondsNow() > due_; }

void CheckpointFile::markCounts() {
  for (const char* name : kCounters) marked_[name] = context_.statistics.count(name);
  marked_[kFirstBad] = static_cast<uint64_t>(context_.statistics.value(kFirstBad));
}

// A disk that is full now must not cost the picture, and a slow one not much of its time.
void CheckpointFile::save(std::string_view stage, const StateFields& state) {
  const int64_t begin = nanosecondsNow();
  try {
    store::Writer writer(kKind, kFileVersion, identity_.sceneHash);
    addText(writer, "settings", join(identity_.settings));
    addText(writer, "stage", stage);
    Lines counts;
    for (const auto& [name, count] : marked_) counts.emplace_back(name, std::to_string(count));
    addText(writer, "counts", join(counts));
    for (const StateFields::Field& field : state.fields) {
      writer.add(field.name, std::span<const std::byte>(field.bytes));
    }
    writer.save(file_);
    failed_ = false;
  } catch (const RuntimeError& e) {
    if (!failed_) context_.warning(fmt::format("no checkpoint: {}; the render goes on", e.what()));
    failed_ = true;
  }
  const int64_t now = nanosecondsNow();
  due_ = now + std::max(interval_, std::min(kSaveTimes * (now - begin), kLongestWait));
}

bool CheckpointFile::load(std::string_view stage, const StateFields& state) {
  if (!saved_ || text(*saved_, "stage") != stage) return false;
  for (const StateFields::Field& field : state.fields) {
    const std::vector<std::byte> bytes = saved_->get<std::byte>(field.name);
    if (bytes.size() != field.bytes.size()) {
      throw InputError({file_},
                       fmt::format("'{}' has {} bytes; {} are expected; use --checkpoint to "
                                   "start afresh",
                                   field.name, bytes.size(), field.bytes.size()));
    }
    std::copy(bytes.begin(), bytes.end(), field.bytes.begin());
  }
  for (const auto& [name, value] : parse(text(*saved_, "counts"))) {
    uint64_t& count = loaded_[name];
    std::from_chars(value.data(), value.data() + value.size(), count);
  }
  saved_.reset();
  context_.info(fmt::format("going on from {}", file_));
  return true;
}

void CheckpointFile::restoreCounts() {
  // Counters only grow; modulo 2^64 that is no limit.
  for (const auto& [name, count] : loaded_) {
    if (name == kFirstBad) {
      context_.statistics.setValue(name, static_cast<double>(count));
      continue;
    }
    context_.statistics.addCount(name, count - context_.statistics.count(name));
  }
}

std::unique_ptr<Checkpoints> openCheckpoint(const Scene& scene, const Camera& camera, int maxDepth,
                                            const RenderOptions& options, Context& context) {
  const bool resume = !options.resume.empty();
  const std::string& file = resume ? options.resume : options.checkpoint;
  if (file.empty()) return nullptr;
  return std::make_unique<CheckpointFile>(file, identify(scene, camera, maxDepth, options),
                                          options.checkpointInterval, resume, context);
}

}  // namespace lobelia::app

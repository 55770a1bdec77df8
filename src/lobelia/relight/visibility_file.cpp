// Visibility data on disk, as chunks of a store file. What is read is checked before anything uses
// it: a checksum proves that the file is what was written, not that what was written makes sense.
//
// Levels of cut nodes go two to a byte and apart from values, each of which packs better alone.
// Welding and the light tree's means are made again on reading: only what subdivision added is kept
// of the mesh.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"
#include "lobelia/relight/mesh_chunks.h"
#include "lobelia/relight/visibility_data.h"
#include "lobelia/relight/visibility_summary.h"
#include "lobelia/store/store.h"

namespace lobelia::relight {
namespace {

constexpr uint32_t kVersion = 1;

[[noreturn]] void damaged(const std::string& file, const std::string& what) {
  throw InputError({file}, what + "; make it again with `lobelia precompute`");
}

template <class T>
std::span<const T> spanOf(const std::vector<T>& values) {
  return {values.data(), values.size()};
}

void addCuts(const CutSet& cuts, store::Writer* writer) {
  const auto nodes = cuts.nodes();
  std::vector<uint16_t> sizes;
  for (size_t v = 0; v < cuts.count(); ++v)
    sizes.push_back(static_cast<uint16_t>(cuts.cut(v).size()));
  std::vector<uint8_t> levels((nodes.size() + 1) / 2, 0), values(nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) {
    levels[i / 2] |= static_cast<uint8_t>(nodes[i].level << (i % 2 * 4));
    values[i] = nodes[i].value;
  }
  writer->add("cut-sizes", spanOf(sizes));
  writer->add("cut-levels", spanOf(levels));
  writer->add("cut-values", spanOf(values));
}

CutSet readCuts(const store::Reader& reader, const std::string& file, int treeLevels) {
  const auto sizes = reader.get<uint16_t>("cut-sizes");
  const auto levels = reader.get<uint8_t>("cut-levels"), values = reader.get<uint8_t>("cut-values");
  std::vector<uint64_t> begin{0};
  for (const uint16_t size : sizes) begin.push_back(begin.back() + size);
  if (values.size() != begin.back() || levels.size() != (values.size() + 1) / 2)
    damaged(file, "the sizes of cuts do not fit their nodes");
  std::vector<CutNode> nodes(values.size());
  parallelFor(nodes.size(), 65536, [&](size_t i) {
    nodes[i] = {static_cast<uint8_t>(levels[i / 2] >> (i % 2 * 4) & 15), values[i]};
  });
  CutSet cuts(std::move(nodes), std::move(begin));
  std::vector<uint8_t> good(cuts.count());
  parallelFor(cuts.count(), 256, [&](size_t v) {
    uint32_t leaf = 0;
    bool fits = true;
    for (const CutNode n : cuts.cut(v)) {
      fits =
          fits && n.level <= treeLevels && leaf % (1u << n.level) == 0 && leaf < 1u << treeLevels;
      leaf += 1u << n.level;
    }
    good[v] = fits && leaf == 1u << treeLevels ? 1 : 0;
  });
  if (std::find(good.begin(), good.end(), 0) != good.end())
    damaged(file, "a cut does not cover the light tree's leaves");
  return cuts;
}

LightSamples readSamples(const store::Reader& reader, const std::string& file) {
  LightSamples samples;
  const auto kind = reader.get<uint32_t>("kind");
  if (kind.size() != 1 || kind[0] > 1) damaged(file, "the kind of light is not known");
  samples.kind = static_cast<LightSamples::Kind>(kind[0]);
  samples.p = reader.get<Vec3f>("sample-places");
  samples.n = reader.get<Vec3f>("sample-normals");
  samples.measure = reader.get<float>("sample-measures");
  try {
    requireSampleCount(samples.count());
  } catch (const std::invalid_argument& e) {
    damaged(file, e.what());
  }
  const bool surfaces = samples.kind == LightSamples::Kind::surfaces;
  bool good = samples.measure.size() == samples.count() &&
              samples.n.size() == (surfaces ? samples.count() : 0);
  for (size_t i = 0; i < samples.count() && good; ++i) {
    const Vec3f unit = surfaces ? samples.n[i] : samples.p[i];
    good = isFinite(samples.p[i]) && std::abs(lengthSquared(unit) - 1) < 1e-3f &&
           samples.measure[i] > 0 && std::isfinite(samples.measure[i]);
  }
  if (!good) damaged(file, "the light samples are not unit directions or places with areas");
  return samples;
}

}  // namespace

void save(const VisibilityData& data, const Scene& scene, const std::string& file) {
  store::Writer writer(kVisibilityKind, kVersion, geometryHash(scene));
  const std::vector<uint32_t> kind{static_cast<uint32_t>(data.samples.kind)};
  writer.add("kind", spanOf(kind));
  writer.add("sample-places", spanOf(data.samples.p));
  writer.add("sample-normals", spanOf(data.samples.n));
  writer.add("sample-measures", spanOf(data.samples.measure));
  writer.add("both-sides", spanOf(data.bothSides));
  addMesh(data.mesh, &writer);
  addCuts(data.cuts, &writer);
  writer.save(file);
}

VisibilityData load(const std::string& file, const Scene& scene) {
  const store::Reader reader(file, kVisibilityKind, kVersion);
  if (reader.sceneHash() != geometryHash(scene)) {
    throw InputError({file},
                     "this visibility is of other geometry (or the scene's shapes or masks were "
                     "changed since); make it again with `lobelia precompute`");
  }
  VisibilityData data;
  data.samples = readSamples(reader, file);
  data.tree = makeSampleTree(data.samples);
  data.mesh = readMesh(reader, file, weldedMesh(scene));
  data.cuts = readCuts(reader, file, data.tree.levels);
  if (data.cuts.count() != data.mesh.positions().size())
    damaged(file, fmt::format("there are {} cuts for {} vertices", data.cuts.count(),
                              data.mesh.positions().size()));
  data.bothSides = reader.get<uint8_t>("both-sides");
  if (data.bothSides.size() != scene.instances.size())
    damaged(file, "the list of two-sided surfaces does not fit the scene");
  requireKnownSides(data, scene, {file});
  return data;
}

VisibilitySummary summaryOf(const std::string& file) {
  const store::Reader reader(file, kVisibilityKind, kVersion);
  const LightSamples samples = readSamples(reader, file);
  const CutSet cuts = readCuts(reader, file, makeSampleTree(samples).levels);
  return {reader.sceneHash(), samples.kind, samples.count(), cuts.count(), cuts.nodes().size()};
}

void requireKnownSides(const VisibilityData& data, const Scene& scene, const Location& where) {
  for (size_t i = 0; i < data.bothSides.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (data.bothSides[i] == 0 && scattersBehind(scene, instance.material)) {
      throw InputError(where, fmt::format("the surface '{}' has come to scatter light from behind, "
                                          "where its visibility is not known; make it again with "
                                          "`lobelia precompute`",
                                          instance.name));
    }
  }
}

}  // namespace lobelia::relight

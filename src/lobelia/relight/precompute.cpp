#include "lobelia/relight/precompute.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "lobelia/relight/pilot_visibility.h"
#include "lobelia/relight/subdivision.h"
#include "lobelia/relight/vertex_cuts.h"

namespace lobelia::relight {

namespace {

// In the order of a tree by geometry alone, which makes rays to samples in a row coherent.
LightSamples lightSamples(const Scene& scene, const PrecomputeSettings& settings, float diagonal,
                          Context& context) {
  context.progress("samples", 0);
  LightSamples samples;
  {
    const StageTimer timer(context, "samples");
    samples = settings.light == LightSamples::Kind::environment
                  ? environmentSamples(settings.sampleCount, context.seed)
                  : surfaceSamples(scene, settings.sampleCount, context.seed);
  }
  const StageTimer timer(context, "trees");
  return reordered(samples, treeOrder(samples, {}, 0, 1, diagonal));
}

SampleMesh sampleMesh(const Tracer& tracer, const LightSamples& samples,
                      std::span<const uint8_t> bothSides, const PrecomputeSettings& settings,
                      Context& context) {
  const StageTimer timer(context, "subdivision");
  context.progress("subdivision", 0);
  SampleMesh mesh = weldedMesh(tracer.scene());
  if (settings.subdivision == 0) return mesh;
  return subdivided(tracer, std::move(mesh), samples, bothSides, settings.subdivision, context);
}

// In the order of the light tree. order: of vertices.
LightSamples treeSamples(const Tracer& tracer, const LightSamples& samples,
                         const VertexFaces& faces, std::span<const uint32_t> order,
                         const PrecomputeSettings& settings, float diagonal, Context& context) {
  if (settings.beta >= 1) return samples;
  std::vector<uint8_t> rows;
  {
    const StageTimer timer(context, "pilot");
    context.progress("pilot visibility", 0);
    rows = pilotVisibility(tracer, samples, faces, order, settings.clusterCount, context);
  }
  const StageTimer timer(context, "trees");
  context.progress("light tree", 0.5);
  return reordered(samples,
                   treeOrder(samples, rows, settings.clusterCount, settings.beta, diagonal));
}

}  // namespace

VisibilityData precomputeVisibility(const Tracer& tracer, const PrecomputeSettings& settings,
                                    Context& context) {
  requireSampleCount(settings.sampleCount);
  const Scene& scene = tracer.scene();
  const float diagonal = std::max(length(tracer.bounds().extent()), 1e-20f);
  VisibilityData data;
  data.bothSides = bothSidesOf(scene);
  data.samples = lightSamples(scene, settings, diagonal, context);
  data.mesh = sampleMesh(tracer, data.samples, data.bothSides, settings, context);
  const size_t vertexCount = data.mesh.positions().size();
  context.statistics.addCount("vertices", vertexCount);

  const std::vector<LeafTriangle> triangles = leafTriangles(data.mesh);
  const VertexFaces faces(scene, data.mesh, triangles, data.bothSides);
  const VertexNeighbours neighbours(vertexCount, triangles);
  std::vector<uint32_t> order;
  {
    const StageTimer timer(context, "trees");
    const int clusterLevels = std::countr_zero(settings.clusterCount);
    order = vertexOrder(data.mesh, faces, diagonal,
                        std::max(clusterLevels, vertexBlockLevels(vertexCount)));
  }
  data.samples = treeSamples(tracer, data.samples, faces, order, settings, diagonal, context);
  data.tree = makeSampleTree(data.samples);
  const StageTimer timer(context, "visibility");
  data.cuts = vertexCuts(tracer, data, faces, neighbours, order, settings, context);
  return data;
}

}  // namespace lobelia::relight

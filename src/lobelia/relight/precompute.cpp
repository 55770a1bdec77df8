#include "lobelia/relight/precompute.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "lobelia/relight/pilot_visibility.h"
#include "lobelia/relight/subdivision.h"
#include "lobelia/relight/vertex_cuts.h"

namespace lobelia::relight {

VisibilityData precomputeVisibility(const Tracer& tracer, const PrecomputeSettings& settings,
                                    Context& context) {
  requireSampleCount(settings.sampleCount);
  const Scene& scene = tracer.scene();
  const float diagonal = std::max(length(tracer.bounds().extent()), 1e-20f);
  VisibilityData data;
  {
    const StageTimer timer(context, "samples");
    context.progress("samples", 0);
    data.samples = settings.light == LightSamples::Kind::environment
                       ? environmentSamples(settings.sampleCount, context.seed)
                       : surfaceSamples(scene, settings.sampleCount, context.seed);
    data.mesh = weldedMesh(scene);
    for (const Instance& instance : scene.instances)
      data.bothSides.push_back(scattersBehind(scene, instance.material) ? 1 : 0);
  }
  {
    const StageTimer timer(context, "trees");
    context.progress("light tree", 0);
    data.samples = reordered(data.samples, treeOrder(data.samples, {}, 0, 1, diagonal));
  }
  if (settings.subdivision > 0) {
    const StageTimer timer(context, "subdivision");
    context.progress("subdivision", 0);
    data.mesh = subdivided(tracer, std::move(data.mesh), data.samples, data.bothSides,
                           settings.subdivision, context);
  }
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
  if (settings.beta < 1) {
    std::vector<uint8_t> rows;
    {
      const StageTimer timer(context, "pilot");
      context.progress("pilot visibility", 0);
      rows = pilotVisibility(tracer, data.samples, faces, order, settings.clusterCount, context);
    }
    const StageTimer timer(context, "trees");
    context.progress("light tree", 0.5);
    data.samples = reordered(data.samples, treeOrder(data.samples, rows, settings.clusterCount,
                                                     settings.beta, diagonal));
  }
  data.tree = makeSampleTree(data.samples);
  const StageTimer timer(context, "visibility");
  data.cuts = vertexCuts(tracer, data, faces, neighbours, order, settings, context);
  return data;
}

}  // namespace lobelia::relight

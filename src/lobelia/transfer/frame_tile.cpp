#include "lobelia/transfer/frame_tile.h"

#include <algorithm>

#include "lobelia/trace/flush_denormals.h"
#include "lobelia/transfer/packet_kernels.h"

namespace lobelia::transfer {
namespace {

using relight::kTileSize;
using relight::TilePixel;

// Vertices beyond which they are forgotten between samples; a sample adds at most three for each
// pixel.
constexpr size_t kMostVertices = 16384;

// A pixel without table: the lobes it has not are lobes of nothing.
void setReflection(const Reflection& own, PixelPacket* packet, size_t lane) {
  packet->diffuse.set(lane, own.diffuse), packet->glossy.set(lane, own.glossy);
  packet->mirror.set(lane, own.mirror), packet->r.set(lane, own.r);
  packet->lobeCount = std::max(packet->lobeCount, own.count);
  for (int j = 0; j < Reflection::kMostLobes; ++j) {
    const ReflectedLobe lobe =
        j < own.count ? own.lobes[static_cast<size_t>(j)] : ReflectedLobe{own.mirror, 1, {}};
    PixelPacket::Lobe& to = packet->lobes[j];
    to.axis.set(lane, lobe.axis), to.alpha.set(lane, lobe.alpha), to.kappa.at[lane] = lobe.kappa;
  }
}

}  // namespace

void TileCounts::add(const TileCounts& o) {
  bufferNs += o.bufferNs, mergeNs += o.mergeNs, shadeNs += o.shadeNs;
  objectPixels += o.objectPixels, vertices += o.vertices;
  lightLookups += o.lightLookups, nonFinite += o.nonFinite;
  if (o.firstBad) firstBad = std::min(firstBad.value_or(*o.firstBad), *o.firstBad);
}

void FrameTile::placePixels(const FrameInput& input) {
  const Scene& scene = input.tracer.scene();
  normals_.resize(pixels_.size());
  for (size_t i = 0; i < pixels_.size(); ++i) {
    TilePixel& pixel = pixels_[i];
    if (!pixel.hit) continue;
    normals_[i] = surfaceNormals(scene, *pixel.hit);
    const relight::SurroundingVertices around = input.data.mesh.around(*pixel.hit);
    const Side side = input.lookup.sideOf(scene.instances[pixel.hit->instance].material,
                                          normals_[i].ng, -pixel.ray.d);
    for (size_t v = 0; v < 3; ++v) {
      pixel.place.slot[v] = vertices_.slotOf(around.vertex[v], side);
      pixel.place.weight[v] = around.weight[v];
    }
  }
}

void FrameTile::shade(const FrameInput& input) {
  packets_.resize(input.tables.tableCount() + 1);
  for (size_t i = 0; i < pixels_.size(); ++i) addPixel(input, i);
  for (size_t table = 0; table < packets_.size(); ++table)
    if (packets_[table] && packets_[table]->count > 0) finish(input, table);
}

void FrameTile::addPixel(const FrameInput& input, size_t number) {
  const TilePixel& pixel = pixels_[number];
  const bool hidden = input.settings.hideEmitters;
  if (!pixel.hit) {
    if (!hidden) addTo(pixel, input.emitters.escaped(normalize(input.light.toLight * pixel.ray.d)));
    return;
  }
  ++counts_.objectPixels;
  const Scene& scene = input.tracer.scene();
  const Instance& instance = scene.instances[pixel.hit->instance];
  const Vec3f wo = aboveHorizon(-pixel.ray.d, normals_[number]);
  const Vec3f emitted = instance.emitter.valid() && !hidden
                            ? input.emitters.emitted(surfacePoint(scene, *pixel.hit), -pixel.ray.d)
                            : Rgb{};
  const bool behind = dot(normals_[number].n, wo) < 0;
  const bool tabled = input.tables.has(instance.material);
  const size_t table =
      tabled ? ReflectionTables::numberOf(instance.material, behind) : input.tables.tableCount();
  if (!instance.material.valid() || (tabled && input.tables.rows(table).nodes == nullptr)) {
    addTo(pixel, emitted);  // nothing is reflected on this side
    return;
  }
  PixelPacket& packet = packetFor(table);
  const size_t lane = packet.count++;
  packet.n.set(lane, behind ? -normals_[number].n : normals_[number].n);
  packet.wo.set(lane, wo), packet.emitted.set(lane, emitted);
  packet.number[lane] = static_cast<uint32_t>(number);
  for (size_t v = 0; v < 3; ++v) {
    packet.slot[v][lane] = pixel.place.slot[v];
    packet.weight[v].at[lane] = pixel.place.weight[v];
  }
  if (!tabled)
    setReflection(input.tables.reflection(scene, surfacePoint(scene, *pixel.hit), wo), &packet,
                  lane);
  if (packet.count == PixelPacket::kSize) finish(input, table);
}

PixelPacket& FrameTile::packetFor(size_t table) {
  if (!packets_[table]) packets_[table] = std::make_unique<PixelPacket>();
  return *packets_[table];
}

void FrameTile::finish(const FrameInput& input, size_t table) {
  PixelPacket& packet = *packets_[table];
  packet.fillUp();
  if (table < input.tables.tableCount()) lookUpReflection(input.tables.rows(table), &packet);
  lightLookups_ += shadePacket(vertices_.rows(), input.light.forPackets(), &packet);
  for (size_t i = 0; i < packet.count; ++i)
    addTo(pixels_[packet.number[i]], packet.radiance.get(i));
  packet.clear();
}

void FrameTile::addTo(const TilePixel& pixel, Rgb value) {
  value *= pixel.weight;
  if (isFinite(value)) {
    sums_[pixel.index] += value;
    return;
  }
  ++counts_.nonFinite;
  counts_.firstBad = std::min(counts_.firstBad.value_or(pixel.index), pixel.index);
}

TileCounts FrameTile::render(const FrameInput& input, const relight::TileArea& area, Film& film) {
  const FlushDenormals flush;
  TileCounts& counts = counts_;
  counts = {};
  for (const auto& packet : packets_)
    if (packet) packet->clear();  // of a tile that was left halfway
  sums_.assign(kTileSize * kTileSize, Rgb{});
  if (frame_ != input.frame) vertices_.begin(input.lookup, input.data, input.light, input.eye);
  frame_ = input.frame;
  const uint64_t before = vertices_.merged, lookups = vertices_.lightLookups;
  lightLookups_ = 0;
  for (int sample = 0; sample < input.settings.spp; ++sample) {
    const int64_t start = nanosecondsNow();
    relight::makeTileRays(input.camera, film, area, input.seed, sample, input.settings.spp,
                          &pixels_);
    relight::traceTileRays(input.tracer, &pixels_);
    if (vertices_.count() > kMostVertices) vertices_.forget();
    placePixels(input);
    const int64_t placed = nanosecondsNow();
    vertices_.mergeNew();
    const int64_t merged = nanosecondsNow();
    shade(input);
    counts.bufferNs += placed - start;
    counts.mergeNs += merged - placed;
    counts.shadeNs += nanosecondsNow() - merged;
  }
  if (counts.firstBad) {  // it was the tile's
    const int pixel = static_cast<int>(*counts.firstBad);
    counts.firstBad = static_cast<uint32_t>((area.y0 + pixel / kTileSize) * film.width + area.x0 +
                                            pixel % kTileSize);
  }
  counts.vertices = vertices_.merged - before;
  counts.lightLookups = lightLookups_ + vertices_.lightLookups - lookups;
  relight::writeTile(sums_, 1 / static_cast<float>(input.settings.spp), false, area, &film);
  return counts;
}

}  // namespace lobelia::transfer

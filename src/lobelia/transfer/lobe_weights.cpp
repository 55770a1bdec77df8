#include "lobelia/transfer/lobe_weights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/transfer/lobe_cone.h"
#include "lobelia/transfer/lobe_kernels.h"

namespace lobelia::transfer {
namespace {

constexpr float kShare = 1e-3f;  // of a lobe's value in the mirror direction

bool isActiveFor(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo) {
  return isActive(lobe, dot(wo, bsdf.frameOf(lobe).n));
}

LobeCone coneOf(const ShadingFrame& frame, const Lobe& lobe, Vec3f wo) {
  const Vec3f o = frame.toLocal(wo);
  const float angle = std::min(coneAngle(lobe, o, kShare), kPi);
  return {frame.toWorld({-o.x, -o.y, o.z}), o.z < 0 ? -frame.n : frame.n, std::cos(angle),
          angle < kPi ? std::sin(angle) : 0.f};
}

}  // namespace

DirectionChunks::DirectionChunks(std::span<const Vec3f> directions) : count(directions.size()) {
  const size_t chunks = (count + relight::kChunk - 1) / relight::kChunk;
  for (relight::AlignedFloats* lanes : {&x, &y, &z}) lanes->resize(chunks * relight::kChunk);
  for (size_t i = 0; i < x.size(); ++i) {
    const Vec3f d = directions[std::min(i, count - 1)];
    x[i] = d.x, y[i] = d.y, z[i] = d.z;
  }
  const size_t registers = (chunks + relight::kChunk - 1) / relight::kChunk * relight::kChunk;
  for (relight::AlignedFloats* lanes : {&axisX, &axisY, &axisZ, &cosine, &sine})
    lanes->resize(registers, 0.f);
  for (size_t chunk = 0; chunk < chunks; ++chunk) {
    const auto members = directions.subspan(
        chunk * relight::kChunk, std::min(relight::kChunk, count - chunk * relight::kChunk));
    Vec3f sum{};
    for (const Vec3f d : members) sum += d;
    const Vec3f axis = lengthSquared(sum) > 1e-6f ? normalize(sum) : members[0];
    float least = 1;
    for (const Vec3f d : members) least = std::min(least, dot(axis, d));
    least = std::max(least - 1e-6f, -1.f);  // what rounding takes away
    axisX[chunk] = axis.x, axisY[chunk] = axis.y, axisZ[chunk] = axis.z;
    cosine[chunk] = least, sine[chunk] = std::sqrt(std::max(1 - least * least, 0.f));
  }
}

void findChunks(const DirectionChunks& directions, const Bsdf& part, Vec3f wo,
                std::vector<uint32_t>* chunks) {
  chunks->clear();
  std::array<LobeCone, kMaxLobes> lobes;
  size_t count = 0;
  for (int i = 0; i < part.lobeCount; ++i) {
    const Lobe& lobe = part.lobes[i];
    if (isActiveFor(part, lobe, wo)) lobes[count++] = coneOf(part.frameOf(lobe), lobe, wo);
  }
  const ChunkCones cones{directions.chunkCount(), directions.axisX.data(),  directions.axisY.data(),
                         directions.axisZ.data(), directions.cosine.data(), directions.sine.data()};
  if (count > 0) findMeeting(cones, std::span(lobes).first(count), chunks);
}

void lobeWeights(const DirectionChunks& directions, const Bsdf& part, Vec3f wo,
                 std::span<const uint32_t> chunks, float* out) {
  bool first = true;
  for (int i = 0; i < part.lobeCount; ++i) {
    const Lobe& lobe = part.lobes[i];
    if (!isActiveFor(part, lobe, wo)) continue;
    const LobeLanes query{&lobe,
                          &part.frameOf(lobe),
                          part.baseNormal,
                          wo,
                          directions.x.data(),
                          directions.y.data(),
                          directions.z.data()};
    addWeights(query, chunks, first, out);
    first = false;
  }
  if (first) std::fill_n(out, chunks.size() * relight::kChunk, 0.f);
  // The last chunk may be listed anywhere.
  for (size_t i = 0; i < chunks.size(); ++i)
    for (size_t at = std::max(directions.count, chunks[i] * relight::kChunk);
         at < (chunks[i] + 1) * relight::kChunk; ++at)
      out[i * relight::kChunk + at - chunks[i] * relight::kChunk] = 0;
}

}  // namespace lobelia::transfer

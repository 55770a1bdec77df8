#include "lobelia/relight/vertex_visibility.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "lobelia/relight/leaf_words.h"

namespace lobelia::relight {
namespace {

constexpr uint8_t kBehind = 0x80;
// Around a vertex: as many numbers as fit beside kBehind. In larger fans, samples that are in front
// of later faces alone count as behind the surface: few, because the leading faces come first and
// look in all directions that there are, up to 45 degrees.
constexpr size_t kMostFaces = 0x80;

// Bit i: flags[i], which is 0 or 1. The product moves the lowest bits of eight bytes into its top
// byte, each to its place.
uint64_t packed(const uint8_t (&flags)[64]) {
  static_assert(std::endian::native == std::endian::little);
  uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) {
    uint64_t eight;
    std::memcpy(&eight, flags + 8 * i, 8);
    bits |= (eight * 0x0102040810204080u >> 56) << (8 * i);
  }
  return bits;
}

}  // namespace

LeafBits leafBits(const LightSamples& samples) {
  const size_t count = samples.count();
  LeafBits bits(std::has_single_bit(count) ? std::countr_zero(count) : 0);
  bits.visible.assign((count + 63) / 64, 0), bits.matters.assign((count + 63) / 64, 0);
  return bits;
}

VertexTracer::VertexTracer(const Tracer& tracer, const LightSamples& samples,
                           const SampleNeighbours* neighbours)
    : tracer_(tracer),
      neighbours_(neighbours),
      directions_(samples.kind == LightSamples::Kind::environment),
      count_(samples.count()) {
  const size_t padded = (count_ + 63) / 64 * 64;
  for (auto* values : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) values->assign(padded, 0.f);
  for (size_t i = 0; i < count_; ++i) {
    x_[i] = samples.p[i].x, y_[i] = samples.p[i].y, z_[i] = samples.p[i].z;
    if (directions_) continue;
    nx_[i] = samples.n[i].x, ny_[i] = samples.n[i].y, nz_[i] = samples.n[i].z;
  }
  faceOf_.resize(padded), more_.resize(padded), traced_.resize(padded / 64);
}

// The samples of a word in front of a face (side 1) or behind it (-1) that send light there.
uint64_t VertexTracer::facing(const FacePlace& face, float side, uint32_t word) const {
  const size_t first = size_t{word} * 64;
  const float *x = &x_[first], *y = &y_[first], *z = &z_[first];
  const Vec3f n = face.n * side;
  uint8_t flags[64];
  if (directions_) {
    for (size_t i = 0; i < 64; ++i) flags[i] = n.x * x[i] + n.y * y[i] + n.z * z[i] > 0;
  } else {
    const Vec3f o = side > 0 ? face.front : face.back;
    const float *nx = &nx_[first], *ny = &ny_[first], *nz = &nz_[first];
    for (size_t i = 0; i < 64; ++i) {
      const float dx = x[i] - o.x, dy = y[i] - o.y, dz = z[i] - o.z;
      const bool front = n.x * dx + n.y * dy + n.z * dz > 0;
      const bool sent = nx[i] * dx + ny[i] * dy + nz[i] * dz < 0;
      flags[i] = static_cast<uint8_t>(front & sent);
    }
  }
  const uint64_t bits = packed(flags);
  return first + 64 > count_ ? bits & ((uint64_t{1} << (count_ - first)) - 1) : bits;
}

void VertexTracer::assign(uint64_t leaves, uint32_t word, uint8_t face) {
  for (; leaves != 0; leaves &= leaves - 1)
    faceOf_[word * 64 + static_cast<uint32_t>(std::countr_zero(leaves))] = face;
}

void VertexTracer::prepare(std::span<const FacePlace> faces, LeafBits* bits) {
  std::fill(traced_.begin(), traced_.end(), 0);
  faces_ = faces.first(std::min(faces.size(), kMostFaces));
  const auto both =
      std::find_if(faces_.begin(), faces_.end(), [](const FacePlace& f) { return f.bothSides; });
  const size_t leading = leadingFaces(faces_);
  several_ = leading > 1;
  if (several_) std::fill(more_.begin(), more_.end(), uint8_t{0});
  for (uint32_t w = 0; w < bits->wordCount(); ++w) {
    uint64_t left = ~uint64_t{0};
    for (size_t f = 0; f < faces_.size() && (left != 0 || f < leading); ++f) {
      const uint64_t mine = facing(faces_[f], 1, w);
      assign(mine & left, w, static_cast<uint8_t>(f));
      for (uint64_t also = f < leading ? mine & ~left : 0; also != 0; also &= also - 1)
        more_[w * 64 + static_cast<uint32_t>(std::countr_zero(also))] |=
            static_cast<uint8_t>(1u << f);
      left &= ~mine;
    }
    if (both != faces_.end() && left != 0) {
      const uint64_t mine = left & facing(*both, -1, w);
      assign(mine, w, static_cast<uint8_t>(both - faces_.begin()) | kBehind);
      left &= ~mine;
    }
    bits->matters[w] = ~left, bits->visible[w] = 0;
  }
}

void VertexTracer::setLane(uint32_t leaf) {
  const FacePlace& face = faces_[faceOf_[leaf] & ~kBehind];
  const Vec3f o = (faceOf_[leaf] & kBehind) != 0 ? face.back : face.front;
  const Vec3f p{x_[leaf], y_[leaf], z_[leaf]};
  if (directions_) {
    packet_.set(lanes_, Ray{o, p, 0, 3.4e38f});
  } else {
    packet_.set(lanes_, o, p);
  }
  leafOf_[lanes_++] = leaf;
}

void VertexTracer::push(uint32_t leaf, LeafBits* bits) {
  if ((traced_[leaf / 64] & bit(leaf)) != 0) return;  // it was a probe
  traced_[leaf / 64] |= bit(leaf);
  queue(leaf, bits);
}

void VertexTracer::queue(uint32_t leaf, LeafBits* bits) {
  setLane(leaf);
  if (lanes_ == ShadowPacket::kSize) tracePacket(bits);
}

void VertexTracer::tracePacket(LeafBits* bits) {
  for (int i = lanes_; i < ShadowPacket::kSize; ++i) {
    packet_.set(i, Vec3f(0.f), Vec3f(0.f));
    packet_.active[i] = 0;
  }
  uint32_t visible = tracer_.visible(packet_, true);
  for (; visible != 0; visible &= visible - 1) {
    const uint32_t leaf = leafOf_[std::countr_zero(visible)];
    if (several_ && more_[leaf] != 0) {
      faceOf_[leaf] = static_cast<uint8_t>(std::countr_zero(more_[leaf]));
      more_[leaf] &= static_cast<uint8_t>(more_[leaf] - 1);
      again_.push_back(leaf);
    } else {
      bits->visible[leaf / 64] |= bit(leaf);
    }
  }
  rays_ += static_cast<uint64_t>(lanes_);
  lanes_ = 0;
}

// Until all that was pushed is known.
void VertexTracer::flush(LeafBits* bits) {
  while (lanes_ > 0 || !again_.empty()) {
    while (lanes_ < ShadowPacket::kSize && !again_.empty()) {
      setLane(again_.back());
      again_.pop_back();
    }
    tracePacket(bits);
  }
}

void VertexTracer::pushAll(uint64_t leaves, uint32_t word, LeafBits* bits) {
  for (; leaves != 0; leaves &= leaves - 1)
    push(word * 64 + static_cast<uint32_t>(std::countr_zero(leaves)), bits);
}

void VertexTracer::traceAll(LeafBits* bits) {
  for (uint32_t w = 0; w < bits->wordCount(); ++w) pushAll(bits->matters[w], w, bits);
  flush(bits);
}

void VertexTracer::trace(std::span<const uint32_t> leaves, LeafBits* bits) {
  for (const uint32_t leaf : leaves)
    if ((bits->matters[leaf / 64] & bit(leaf)) != 0) push(leaf, bits);
  flush(bits);
}

}  // namespace lobelia::relight

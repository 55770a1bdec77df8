#include "lobelia/transfer/visibility_mask.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace lobelia::transfer {
namespace {

using relight::LeafBits;

constexpr int kCoarseLevel = 5;  // 10,242 directions

bool isSet(const std::vector<uint64_t>& words, uint32_t i) {
  return (words[i / 64] >> (i % 64) & 1) != 0;
}

// Lengths of runs by turns of zeros and ones, zeros first. Of longer runs than fit, a run of the
// other kind without length divides the parts.
std::vector<uint16_t> runsOf(const std::vector<uint64_t>& words) {
  constexpr uint32_t kMost = 0xffff;
  std::vector<uint16_t> runs;
  const auto add = [&](uint32_t length) {
    for (; length > kMost; length -= kMost) runs.push_back(kMost), runs.push_back(0);
    runs.push_back(static_cast<uint16_t>(length));
  };
  uint32_t length = 0;
  bool one = false;
  for (uint64_t word : words) {
    if (one) word = ~word;
    for (int left = 64; left > 0;) {
      const int same = std::min(std::countr_zero(word), left);
      length += static_cast<uint32_t>(same), left -= same;
      if (left == 0) break;
      add(length);
      length = 0, one = !one;
      word = ~(word >> same);
    }
  }
  add(length);
  runs.shrink_to_fit();
  return runs;
}

void setRuns(const std::vector<uint16_t>& runs, std::vector<uint64_t>* words) {
  std::fill(words->begin(), words->end(), 0);
  uint32_t at = 0;
  for (size_t r = 0; r < runs.size(); ++r) {
    const uint32_t end = at + runs[r];
    if (r % 2 == 1)
      for (; at < end;) {
        const uint32_t bits = std::min(64 - at % 64, end - at);
        const uint64_t ones = bits == 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
        (*words)[at / 64] |= ones << (at % 64);
        at += bits;
      }
    at = end;
  }
}

}  // namespace

MaskDirections::MaskDirections(int level) : grid_(level) {
  samples_.kind = relight::LightSamples::Kind::environment;
  samples_.p.assign(grid_.directions().begin(), grid_.directions().end());
  samples_.measure.assign(grid_.solidAngles().begin(), grid_.solidAngles().end());
  const int coarse = std::min(level, kCoarseLevel);
  coarse_ = grid_.indicesOf(GeodesicGrid(coarse));
  std::sort(coarse_.begin(), coarse_.end());
  for (int l = coarse; l < level; ++l) {
    // Of a triangle's children the second lies in its middle: its corners are those of the edges.
    const auto triangles = grid_.triangles(l), children = grid_.triangles(l + 1);
    std::unordered_map<uint32_t, Middle> middles;
    for (size_t t = 0; t < triangles.size(); ++t)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3],
                       other = triangles[t][(k + 2) % 3], at = children[4 * t + 1][k];
        const auto [entry, isNew] = middles.try_emplace(at, Middle{at, a, b, other, other});
        if (!isNew) entry->second.d = other;
      }
    auto& sorted = middles_.emplace_back();
    for (const auto& [at, middle] : middles) sorted.push_back(middle);
    std::sort(sorted.begin(), sorted.end(),
              [](const Middle& x, const Middle& y) { return x.at < y.at; });
  }
}

MaskTracer::MaskTracer(const Tracer& tracer, const MaskDirections& directions)
    : directions_(directions),
      rays_(tracer, directions.samples_),
      bits_(relight::leafBits(directions.samples_)) {}

const LeafBits& MaskTracer::traceAll(std::span<const relight::FacePlace> faces) {
  rays_.prepare(faces, &bits_);
  rays_.traceAll(&bits_);
  return bits_;
}

const LeafBits& MaskTracer::trace(std::span<const relight::FacePlace> faces) {
  rays_.prepare(faces, &bits_);
  rays_.trace(directions_.coarse_, &bits_);
  for (const auto& middles : directions_.middles_) {
    unknown_.clear();
    for (const MaskDirections::Middle& m : middles) {
      if (!isSet(bits_.matters, m.at)) continue;
      const bool a = isSet(bits_.visible, m.a);
      // At the horizon nothing is known of what lies beyond it.
      const bool known = isSet(bits_.matters, m.a) && isSet(bits_.matters, m.b);
      const auto unlike = [&](uint32_t other) {
        return isSet(bits_.matters, other) && isSet(bits_.visible, other) != a;
      };
      if (!known || unlike(m.b) || unlike(m.c) || unlike(m.d)) {
        unknown_.push_back(m.at);
      } else if (a) {
        bits_.visible[m.at / 64] |= uint64_t{1} << (m.at % 64);
      }
    }
    rays_.trace(unknown_, &bits_);
  }
  return bits_;
}

PackedMask::PackedMask(const LeafBits& bits)
    : visible_(runsOf(bits.visible)), matters_(runsOf(bits.matters)) {}

void PackedMask::unpack(LeafBits* bits) const {
  setRuns(visible_, &bits->visible);
  setRuns(matters_, &bits->matters);
}

}  // namespace lobelia::transfer

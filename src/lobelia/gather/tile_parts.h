// What one tile gathers, taken apart by light group, by kinds of light and lobe, and by rays
// (GatherParts).
//
// Groups: the visible pairs of a block are shaded again, group by group. Types: a strip whose lobes
// are all of one kind has its class' whole sum; where a strip has both, its diffuse lobes are
// shaded again by themselves and the rest is glossy. With a clamp, which works on all lobes
// together, the diffuse part is at most the whole.
#pragma once

#include "lobelia/gather/gather.h"
#include "lobelia/gather/kernels.h"

namespace lobelia::gather {

class TileParts {
 public:
  TileParts(const Receivers& receivers, const VirtualLights& lights, const Tile& tile,
            GatherParts* parts);

  // Around the blocks of a class; sums: the whole ones.
  void beginClass(const TileSums& sums);
  void endClass(LightClass lightClass, const TileSums& sums);
  // Before keepVisible(): rays are to be counted.
  void watchRays(PairMasks* pairs);
  void add(const LightBlock& block, float clamp, const PairMasks& visible);
  // To the points, when the tile is complete.
  void write() const;

 private:
  enum class Lobes : uint8_t { diffuse, glossy, mixed };
  void addGroups(const LightBlock& block, float clamp, const PairMasks& visible);
  void addDiffuseLobes(const LightBlock& block, float clamp, const PairMasks& visible);
  void write(const TileSums& sums, size_t layer, std::vector<Rgb>* out) const;

  const Receivers& receivers_;
  const VirtualLights& lights_;
  const Tile& tile_;
  GatherParts* parts_;
  std::vector<TileSums> groups_;  // empty sums until a light of the group is met
  std::vector<Lobes> lobes_;      // of the strips
  bool anyMixed_ = false;
  Tile diffuse_;  // the same strips with their diffuse lobes only; empty unless any is mixed
  TileSums before_, diffuseSums_;
  std::vector<TileSums> types_;
  std::vector<uint16_t> traced_;
  std::vector<uint32_t> rays_;  // [strip * kStrip + lane]
};

}  // namespace lobelia::gather

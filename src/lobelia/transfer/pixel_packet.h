// Pixels that are shaded side by side, in registers (packet_kernels.h), and what they read of the
// vertices around them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lobelia/transfer/elevation_rows.h"
#include "lobelia/transfer/prefiltered_light.h"
#include "lobelia/transfer/visible_part.h"

namespace lobelia::transfer {

// Sums over vertices are sums of these rows, weighted: all that interpolation (lobe_sum.h,
// visible_part.h) adds up.
struct alignas(16) LobeRow {
  LobeRow() = default;
  LobeRow(const TransferLobe& lobe, Vec3f mirror);
  Rgb share{};
  float energy = 0;  // luminance of share
  Vec3f moment{};    // energy r
  float lengths = 0;
  Vec3f mirrors{};
  float unused = 0;
};
struct alignas(16) VisibleRow {
  VisibleRow() = default;
  explicit VisibleRow(const VisiblePart& part);
  Rgb share{1, 1, 1};
  float energy = 1;
  Vec3f own{0, 0, 1};
  float width = 1;  // times energy
  Vec3f axis{};     // times energy; not looked at where all is visible
  float whole = 1;  // 1: all is
};
struct alignas(16) LightRow {
  Rgb light{};
  float unused = 0;
};
// Registers read them by fours of floats.
static_assert(sizeof(LobeRow) == 12 * sizeof(float) && sizeof(VisibleRow) == 12 * sizeof(float));
static_assert(sizeof(LightRow) == 4 * sizeof(float));

// By slot of a vertex.
struct VertexRows {
  const VisibleRow* visible = nullptr;
  const LightRow* diffuse = nullptr;  // radiance over albedo
  const LobeRow* lobes = nullptr;     // lobeCount for each slot
  const uint8_t* hasLobes = nullptr;  // 0: none has energy
  size_t lobeCount = 0;
};

struct PixelPacket {
  static constexpr size_t kSize = 16;
  struct alignas(64) Lanes {
    float at[kSize] = {};
  };
  struct Vectors {
    Lanes x, y, z;
    void set(size_t lane, Vec3f v) { x.at[lane] = v.x, y.at[lane] = v.y, z.at[lane] = v.z; }
    Vec3f get(size_t lane) const { return {x.at[lane], y.at[lane], z.at[lane]}; }
  };
  struct Lobe {
    Vectors axis, alpha;
    Lanes kappa;
  };

  Vectors n, wo;  // unit, world; n on wo's side
  Vectors emitted;
  Lanes weight[3];  // of the vertices around the pixel
  uint32_t slot[3][kSize] = {};
  uint32_t number[kSize] = {};  // of the pixel, for who has made the packet
  size_t count = 0;             // lanes in use

  // As Reflection: looked up from a table by lookUpReflection(), else to be set.
  Vectors diffuse, glossy, mirror, r;
  Lobe lobes[Reflection::kMostLobes];
  int lobeCount = 0;

  Vectors radiance;  // the result

  // As if all lanes were in use: the others become copies of the first. Of what is above, but for
  // the result.
  void fillUp();
  void clear() { count = 0, lobeCount = 0; }
};

// Lobes of which light is looked up, side by side: two sets of a lobe for each octant.
struct LobePacket {
  PixelPacket::Vectors share, r;  // as TransferLobe
  PixelPacket::Vectors light;     // the result: share times light, 0 where r is
};

struct PacketLight {
  LightLevels levels;
  Vec3f toLight[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // rows: from the world to the light
  bool direct = true;  // light straight from infinity by glossy lobes
};

}  // namespace lobelia::transfer

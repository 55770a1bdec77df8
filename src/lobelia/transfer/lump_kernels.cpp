// Registers run over directions; left out: scalable vectors and SSSE3, as in gather/kernels.cpp.
#include "lobelia/transfer/lump_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/transfer/lump_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/base/simd-inl.h"

LOBELIA_CORE_BEGIN

void addLumps(const transfer::LumpLobes& lobes, size_t begin, size_t end,
              transfer::TexelBlock* block) {
  const Df df;
  for (size_t t = 0; t < transfer::kBlockTexels; t += kLanes) {
    const Vf x = Vf::load(block->x + t), y = Vf::load(block->y + t), z = Vf::load(block->z + t);
    Vf r = Vf::load(block->r + t), g = Vf::load(block->g + t), b = Vf::load(block->b + t);
    for (size_t i = begin; i < end; ++i) {
      const Vf dx = x - Vf(lobes.x[i]), dy = y - Vf(lobes.y[i]), dz = z - Vf(lobes.z[i]);
      const Vf value = hn::Exp(df, (-(Vf(lobes.halfKappa[i]) * (dx * dx + dy * dy + dz * dz))).v);
      r += value * Vf(lobes.r[i]);
      g += value * Vf(lobes.g[i]);
      b += value * Vf(lobes.b[i]);
    }
    r.store(block->r + t), g.store(block->g + t), b.store(block->b + t);
  }
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(addLumps);
}  // namespace lobelia

namespace lobelia::transfer {

void addLumps(const LumpLobes& lobes, size_t begin, size_t end, TexelBlock* block) {
  HWY_DYNAMIC_DISPATCH(lobelia::addLumps)(lobes, begin, end, block);
}

}  // namespace lobelia::transfer
#endif

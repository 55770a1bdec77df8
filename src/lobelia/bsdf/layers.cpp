#include "lobelia/bsdf/layers.h"

#include <bit>
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/memo.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

// The numbers of a lobe that its largest reflectance depends on.
constexpr size_t kLobeKey = 7;
using Key = std::array<float, kMaxLayers * kLobeKey>;

Key keyOf(std::span<const Lobe> layers) {
  Key key{};
  for (size_t i = 0; i < layers.size(); ++i) {
    const Lobe& l = layers[i];
    const int tags = 1 + static_cast<int>(l.type) + 32 * static_cast<int>(l.distribution) +
                     1024 * static_cast<int>(l.fresnel);
    const float numbers[kLobeKey] = {
        static_cast<float>(tags), l.alphaX,          l.alphaY,      maxComponent(l.weight),
        maxComponent(l.eta),      minComponent(l.k), l.parameters.x};
    std::copy(std::begin(numbers), std::end(numbers),
              key.begin() + static_cast<long>(i * kLobeKey));
  }
  return key;
}

TransmittanceTable integrate(std::span<const Lobe> layers) {
  TransmittanceTable table;
  for (size_t i = 0; i < kTransmittanceSize; ++i) {
    const float cosine = static_cast<float>(i) / static_cast<float>(kTransmittanceSize - 1);
    float through = 1;
    for (const Lobe& lobe : layers) {
      const float reflected = maxComponent(lobeAlbedo(lobe, std::max(cosine, 1e-4f)));
      through *= std::clamp(1 - reflected, 0.f, 1.f);
    }
    table[i] = through;
  }
  table[kTransmittanceSize] = diffuseMean(table);
  return table;
}

}  // namespace

float tableAt(const TransmittanceTable& table, float cosine) {
  return lookUpCoat(table.data(), cosine);
}

float diffuseMean(const TransmittanceTable& table) {
  double mean = 0;
  for (size_t i = 0; i + 1 < kTransmittanceSize; ++i) {
    const double h = 1.0 / (kTransmittanceSize - 1), c = static_cast<double>(i) * h;
    const double t0 = static_cast<double>(table[i]), t1 = static_cast<double>(table[i + 1]);
    mean += 2 * h * (c * (t0 + t1) / 2 + h * (t0 / 6 + t1 / 3));
  }
  return static_cast<float>(mean);
}

const TransmittanceTable& layerTransmittance(std::span<const Lobe> layers) {
  static Memo<Key, TransmittanceTable> memo;
  const Key key = keyOf(layers);
  uint64_t slot = 0;
  for (const float v : key) slot = mixBits(slot + std::bit_cast<uint32_t>(v));
  return memo.find(key, slot, [&] { return integrate(layers); });
}

}  // namespace lobelia

#include "lobelia/builtin/noise.h"

#include <cmath>

#include "lobelia/base/random.h"

namespace lobelia::builtin {
namespace {

uint64_t cellHash(int x, int y, int z, uint64_t seed) {
  const auto bits = [](int v) { return static_cast<uint64_t>(static_cast<uint32_t>(v)); };
  return mixBits(seed * 0x9e3779b97f4a7c15ull ^ bits(x) * 0xd6e8feb86659fd93ull ^
                 bits(y) * 0xa0761d6478bd642full ^ bits(z) * 0xe7037ed1a0b428dbull);
}

int modulo(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
float mix(float a, float b, float t) { return a + (b - a) * t; }

// The gradient of a lattice point times the way from it. Gradients are uniform in a square or cube,
// 21 bits a component: as good here as directions, without their sines.
float component(uint64_t hash, int shift) {
  return static_cast<float>((hash >> shift) & 0x1fffff) * 0x1p-20f - 1;
}
float slope(uint64_t hash, Vec2f d) { return d.x * component(hash, 0) + d.y * component(hash, 21); }
float slope(uint64_t hash, Vec3f d) {
  return d.x * component(hash, 0) + d.y * component(hash, 21) + d.z * component(hash, 42);
}

// To the spread of noise with gradients of length 1.4 in the plane.
constexpr float kToUnit = 1.7f;

}  // namespace

float noise(Vec2f at, Vec2i period, uint64_t seed) {
  const float fx = std::floor(at.x), fy = std::floor(at.y);
  const int x = static_cast<int>(fx), y = static_cast<int>(fy);
  const Vec2f d{at.x - fx, at.y - fy};
  const int xs[2] = {modulo(x, period.x), modulo(x + 1, period.x)};
  const int ys[2] = {modulo(y, period.y), modulo(y + 1, period.y)};
  const auto corner = [&](int i, int j) {
    return slope(cellHash(xs[i], ys[j], 0, seed),
                 d - Vec2f(static_cast<float>(i), static_cast<float>(j)));
  };
  const float u = fade(d.x), v = fade(d.y);
  return kToUnit * mix(mix(corner(0, 0), corner(1, 0), u), mix(corner(0, 1), corner(1, 1), u), v);
}

float fbm(Vec2f at, Vec2i period, int octaves, uint64_t seed, float gain) {
  float sum = 0, height = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += height * noise(at, period, seed + static_cast<uint64_t>(i));
    total += height;
    at = at * 2.f, period = {2 * period.x, 2 * period.y}, height *= gain;
  }
  return sum / total;
}

float noise(Vec3f at, uint64_t seed) {
  const Vec3f f{std::floor(at.x), std::floor(at.y), std::floor(at.z)};
  const int x = static_cast<int>(f.x), y = static_cast<int>(f.y), z = static_cast<int>(f.z);
  const Vec3f d = at - f;
  const auto corner = [&](int i, int j, int k) {
    return slope(cellHash(x + i, y + j, z + k, seed),
                 d - Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)));
  };
  const float u = fade(d.x), v = fade(d.y), w = fade(d.z);
  const auto layer = [&](int k) {
    return mix(mix(corner(0, 0, k), corner(1, 0, k), u), mix(corner(0, 1, k), corner(1, 1, k), u),
               v);
  };
  return kToUnit * mix(layer(0), layer(1), w);
}

float fbm(Vec3f at, int octaves, uint64_t seed, float gain) {
  float sum = 0, height = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += height * noise(at, seed + static_cast<uint64_t>(i));
    total += height;
    at = at * 2.f, height *= gain;
  }
  return sum / total;
}

float cellRandom(int x, int y, uint64_t seed) {
  return toUnitFloat(static_cast<uint32_t>(cellHash(x, y, 1, seed)));
}

}  // namespace lobelia::builtin

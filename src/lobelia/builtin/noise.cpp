#include "lobelia/builtin/noise.h"

#include <cmath>

#include "lobelia/base/random.h"

namespace lobelia::builtin {
namespace {

uint64_t cellHash(int x, int y, int z, uint64_t seed) {
  const auto bits = [](int v) { return static_cast<uint64_t>(static_cast<uint32_t>(v)); };
  return hashCombine(hashCombine(hashCombine(seed, bits(x)), bits(y)), bits(z));
}

int modulo(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
float mix(float a, float b, float t) { return a + (b - a) * t; }

// The gradient of a lattice point times the way from it.
float slope(uint64_t hash, Vec2f d) {
  const float angle = kTwoPi * toUnitFloat(static_cast<uint32_t>(hash));
  return d.x * std::cos(angle) + d.y * std::sin(angle);
}
float slope(uint64_t hash, Vec3f d) {
  const float z = 2 * toUnitFloat(static_cast<uint32_t>(hash)) - 1;
  const float angle = kTwoPi * toUnitFloat(static_cast<uint32_t>(hash >> 32));
  const float r = std::sqrt(std::max(0.f, 1 - z * z));
  return d.x * r * std::cos(angle) + d.y * r * std::sin(angle) + d.z * z;
}

constexpr float kToUnit = 1.4f;  // gradient noise with unit gradients reaches about 0.7

}  // namespace

float noise(Vec2f at, Vec2i period, uint64_t seed) {
  const float fx = std::floor(at.x), fy = std::floor(at.y);
  const int x = static_cast<int>(fx), y = static_cast<int>(fy);
  const Vec2f d{at.x - fx, at.y - fy};
  const auto corner = [&](int i, int j) {
    return slope(cellHash(modulo(x + i, period.x), modulo(y + j, period.y), 0, seed),
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

// Small vectors for scene data: plain structs of floats, passed by value.
//
// These are the types of data structures and of scalar code. The numerical core that also runs in
// SIMD registers has its own V3<F> (base/core-inl.h); the two have the same layout for F = float.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lobelia {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kTwoPi = 2 * kPi;
inline constexpr float kInvPi = 1 / kPi;

template <class T>
struct Vec2 {
  T x{}, y{};
  constexpr Vec2() = default;
  constexpr Vec2(T x_, T y_) : x(x_), y(y_) {}
  constexpr T& operator[](int i) { return i == 0 ? x : y; }
  constexpr const T& operator[](int i) const { return i == 0 ? x : y; }
  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator*(Vec2 a, Vec2 b) { return {a.x * b.x, a.y * b.y}; }
  friend constexpr Vec2 operator*(Vec2 a, T s) { return {a.x * s, a.y * s}; }
  friend constexpr Vec2 operator*(T s, Vec2 a) { return a * s; }
  friend constexpr bool operator==(Vec2, Vec2) = default;
};

template <class T>
struct Vec3 {
  T x{}, y{}, z{};
  constexpr Vec3() = default;
  constexpr explicit Vec3(T s) : x(s), y(s), z(s) {}
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3 operator/(Vec3 a, Vec3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
  constexpr Vec3& operator*=(Vec3 b) { return *this = *this * b; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }
  constexpr Vec3& operator/=(T s) { return *this = *this / s; }
  friend constexpr bool operator==(Vec3, Vec3) = default;
};

using Vec2f = Vec2<float>;
using Vec2i = Vec2<int>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Vec3u = Vec3<uint32_t>;
using Rgb = Vec3f;  // scene-linear, sRGB primaries

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
template <class T>
constexpr T lengthSquared(Vec3<T> a) {
  return dot(a, a);
}
template <class T>
Vec3<T> normalize(Vec3<T> a) {
  return a / length(a);
}
template <class T>
constexpr T maxComponent(Vec3<T> a) {
  return std::max(a.x, std::max(a.y, a.z));
}
template <class T>
constexpr T minComponent(Vec3<T> a) {
  return std::min(a.x, std::min(a.y, a.z));
}
template <class T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class V>
constexpr V lerp(V a, V b, float t) {
  return a * (1 - t) + b * t;
}
constexpr float sqr(float x) { return x * x; }
inline bool isFinite(Vec3f a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

// Rec. 709 luminance of scene-linear RGB.
constexpr float luminance(Rgb c) { return 0.212671f * c.x + 0.715160f * c.y + 0.072169f * c.z; }

// Axis-aligned box; empty until something is added.
struct Bounds3f {
  Vec3f lo{3.4e38f, 3.4e38f, 3.4e38f};
  Vec3f hi{-3.4e38f, -3.4e38f, -3.4e38f};
  void add(Vec3f p) { lo = min(lo, p), hi = max(hi, p); }
  void add(const Bounds3f& b) { lo = min(lo, b.lo), hi = max(hi, b.hi); }
  bool empty() const { return lo.x > hi.x; }
  Vec3f centre() const { return (lo + hi) * 0.5f; }
  Vec3f extent() const { return hi - lo; }
  float radius() const { return empty() ? 0.f : 0.5f * length(extent()); }
};

}  // namespace lobelia

#include "lobelia/builtin/textures.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/io/image_pixels.h"

namespace lobelia::builtin {
namespace {

// The nearest of the values that 8 bits can stand for.
float nearest(const std::vector<float>& table, float v) {
  const auto above = std::lower_bound(table.begin(), table.end() - 1, v);
  if (above == table.begin()) return *above;
  return v - *(above - 1) < *above - v ? *(above - 1) : *above;
}

template <class F>
void fill(Image& image, const std::vector<float>& table, const F& f) {
  const auto width = static_cast<size_t>(image.width),
             channels = static_cast<size_t>(image.channels);
  image.pixels.resize(width * static_cast<size_t>(image.height) * channels);
  parallelFor(static_cast<size_t>(image.height), 16, [&](size_t y) {
    float* pixel = &image.pixels[y * width * channels];
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = f(Vec2f((static_cast<float>(x) + 0.5f) / static_cast<float>(image.width),
                            (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height)));
      for (int k = 0; k < image.channels; ++k) *pixel++ = nearest(table, c[k]);
    }
  });
}

Image empty(int width, int height, int channels) {
  Image image;
  image.width = width, image.height = height, image.channels = channels;
  return image;
}

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

int floorToInt(float x) { return static_cast<int>(std::floor(x)); }
float toFloat(int i) { return static_cast<float>(i); }

// A point on a plank: which one, and how far from the joints (in widths of a plank).
struct OnPlank {
  int row, piece;
  float toJoint;
};
OnPlank onPlank(const Wood& w, Vec2f uv) {
  if (w.planks <= 1) return {0, 0, 1};
  const float v = uv.y * toFloat(w.planks);
  OnPlank at{floorToInt(v), 0, 0};
  const float across = v - toFloat(at.row);
  const float length = toFloat(w.planks);  // of the repeat in widths; two pieces per row
  float u = uv.x + cellRandom(at.row, 0, w.seed);
  u -= std::floor(u);
  const float cut = 0.35f + 0.3f * cellRandom(at.row, 1, w.seed);
  at.piece = u < cut ? 0 : 1;
  const float toEnd = length * std::min({u, std::abs(u - cut), 1 - u});
  at.toJoint = std::min({across, 1 - across, toEnd});
  return at;
}

struct OnTile {
  int column, row;
  float toEdge;  // in smaller sides of a tile
  Vec2f in;      // place in the tile, 0 to 1
};

OnTile onTile(const Tiles& t, Vec2f uv) {
  const float v = uv.y * toFloat(t.rows);
  OnTile at{};
  at.row = floorToInt(v);
  float u = uv.x * toFloat(t.columns) + (t.brickBond && at.row % 2 != 0 ? 0.5f : 0.f);
  const int column = floorToInt(u);
  at.column = column % t.columns;
  at.in = {u - toFloat(column), v - toFloat(at.row)};
  const float x = std::min(at.in.x, 1 - at.in.x) * std::max(t.aspect, 1.f);
  const float y = std::min(at.in.y, 1 - at.in.y) * std::max(1 / t.aspect, 1.f);
  at.toEdge = std::min(x, y);
  return at;
}

}  // namespace

Image colorImage(int width, int height, const std::function<Rgb(Vec2f)>& f) {
  Image image = empty(width, height, 3);
  fill(image, io::decodingTable(8, io::Transfer::srgb), f);
  return image;
}

Image dataImage(int width, int height, const std::function<float(Vec2f)>& f) {
  Image image = empty(width, height, 1);
  fill(image, io::decodingTable(8, io::Transfer::linear), [&](Vec2f uv) { return Rgb(f(uv)); });
  return image;
}

SurfaceImages wood(const Wood& w, int size) {
  // Growth rings cut lengthwise: bands of a noise that is long along u; and fine pores.
  const auto grain = [&w](Vec2f uv, const OnPlank& at) {
    const auto seed = w.seed + static_cast<uint64_t>(1000 + 7 * at.row + at.piece);
    const int across = std::max(w.planks, 1) * 3;
    const float bend = fbm({uv.x * 3, uv.y * toFloat(across)}, {3, across}, 3, seed);
    const float rings = 0.5f + 0.5f * std::sin(bend * 14 + uv.y * kTwoPi * toFloat(across));
    const float pores = fbm({uv.x * 10, uv.y * 160}, {10, 160}, 3, seed + 50);
    return std::clamp(0.5f + 0.45f * (rings - 0.5f) + 0.45f * pores + 0.25f * bend, 0.f, 1.f);
  };
  const auto isJoint = [&w](const OnPlank& at) {
    return 1 - smoothstep(0.5f * w.joint, w.joint, at.toJoint);
  };
  SurfaceImages images;
  images.color = colorImage(size, size, [&](Vec2f uv) {
    const OnPlank at = onPlank(w, uv);
    const float tone = 0.82f + 0.36f * cellRandom(at.row, 10 + at.piece, w.seed);
    const Rgb c = lerp(w.light, w.dark, grain(uv, at)) * (w.planks > 1 ? tone : 1.f);
    return lerp(c, w.dark * 0.25f, isJoint(at));
  });
  images.height = dataImage(size, size, [&](Vec2f uv) {
    const OnPlank at = onPlank(w, uv);
    return (0.9f + 0.1f * (1 - grain(uv, at))) * (1 - isJoint(at));
  });
  images.roughness = dataImage(size, size, [&](Vec2f uv) {
    const OnPlank at = onPlank(w, uv);
    return w.roughness + w.roughnessSpread * (2 * grain(uv, at) - 1) + 0.3f * isJoint(at);
  });
  return images;
}

SurfaceImages tiles(const Tiles& t, int size) {
  const auto isTile = [&t](const OnTile& at) {
    return smoothstep(0.4f * t.groutWidth, 0.6f * t.groutWidth, at.toEdge);
  };
  SurfaceImages images;
  images.color = colorImage(size, size, [&](Vec2f uv) {
    const OnTile at = onTile(t, uv);
    const float tone = 1 + t.toneSpread * (2 * cellRandom(at.column, at.row, t.seed) - 1) +
                       t.mottle * fbm(uv * 12.f, {12, 12}, 5, t.seed);
    const float dirt = 1 + 0.15f * fbm(uv * 24.f, {24, 24}, 3, t.seed + 9);
    const bool isSecond = t.second.x >= 0 && (at.column + at.row) % 2 != 0;
    return min(lerp(t.grout * dirt, (isSecond ? t.second : t.color) * tone, isTile(at)),
               Rgb(0.95f));
  });
  images.height = dataImage(size, size, [&](Vec2f uv) {
    const OnTile at = onTile(t, uv);
    // A quarter circle down to the grout; each tile lies a little crooked.
    const float x = std::clamp((at.toEdge - 0.5f * t.groutWidth) / t.edge, 0.f, 1.f);
    const Vec2f tilt{cellRandom(at.column, at.row, t.seed + 1) - 0.5f,
                     cellRandom(at.column, at.row, t.seed + 2) - 0.5f};
    const float crooked = tilt.x * (at.in.x - 0.5f) + tilt.y * (at.in.y - 0.5f);
    return 0.85f * std::sqrt(1 - sqr(1 - x)) + (x > 0 ? 0.12f * (crooked + 0.5f) : 0);
  });
  images.roughness = dataImage(size, size, [&](Vec2f uv) {
    const OnTile at = onTile(t, uv);
    const float own =
        t.roughness + t.roughnessSpread * (2 * cellRandom(at.column, at.row, t.seed + 3) - 1 +
                                           0.5f * fbm(uv * 8.f, {8, 8}, 4, t.seed + 4));
    return t.groutRoughness + (own - t.groutRoughness) * isTile(at);
  });
  return images;
}

Image marble(const Marble& m, int size) {
  const int n = m.scale;
  return colorImage(size, size, [&](Vec2f uv) {
    const Vec2f p = uv * toFloat(n);
    const Vec2f warp{fbm(p, {n, n}, 5, m.seed), fbm(p, {n, n}, 5, m.seed + 20)};
    const float ridge = 1 - std::abs(fbm(p + warp * 0.9f, {n, n}, 6, m.seed + 40)) * 2;
    const float vein = std::pow(std::clamp(ridge, 0.f, 1.f), 2 * m.sharpness);
    const float fine = std::pow(
        std::clamp(1 - std::abs(fbm(p * 3.f + warp * 2.f, {3 * n, 3 * n}, 4, m.seed + 60)) * 3, 0.f,
                   1.f),
        3 * m.sharpness);
    const float clouds = 0.5f + 0.5f * fbm(p, {n, n}, 4, m.seed + 80);
    return lerp(m.ground * (0.93f + 0.1f * clouds), m.vein,
                std::clamp(0.7f * vein * clouds * 1.4f + 0.25f * fine, 0.f, 1.f));
  });
}

Image granite(Rgb a, Rgb b, Rgb c, int grains, int size, uint64_t seed) {
  return colorImage(size, size, [&](Vec2f uv) {
    const Vec2f p = uv * toFloat(grains);
    const Vec2i period{grains, grains};
    const float first = fbm(p, period, 3, seed), second = fbm(p, period, 2, seed + 7);
    const float cloud = fbm(uv * 4.f, {4, 4}, 3, seed + 13);
    return lerp(lerp(a, b, smoothstep(-0.05f, 0.15f, first + 0.2f * cloud)), c,
                smoothstep(0.25f, 0.4f, second));
  });
}

Image brushed(float mean, float spread, int size, uint64_t seed) {
  return dataImage(size, size, [&](Vec2f uv) {
    const float streak = fbm({uv.x * 2, uv.y * 128}, {2, 128}, 3, seed, 0.7f);
    const float cloud = fbm(uv * 3.f, {3, 3}, 4, seed + 5);
    return std::max(mean + spread * (0.8f * streak + 0.5f * cloud), 0.02f);
  });
}

Image stripes(Rgb a, Rgb b, int n, float share, int size) {
  return colorImage(size, size, [&](Vec2f uv) {
    const float u = uv.x * toFloat(n);
    return u - std::floor(u) < share ? a : b;
  });
}

SurfaceImages fabric(Rgb warp, Rgb weft, int threads, int size, uint64_t seed) {
  struct Thread {
    bool isWarp;
    float height;
  };
  const auto thread = [threads](Vec2f uv) {
    const float u = uv.x * toFloat(threads), v = uv.y * toFloat(threads);
    const float round = [](float x) { return std::sin(kPi * (x - std::floor(x))); }(u);
    const float roundV = std::sin(kPi * (v - std::floor(v)));
    const bool isWarp = (floorToInt(u) + floorToInt(v)) % 2 == 0;
    return Thread{isWarp,
                  std::sqrt(isWarp ? round : roundV) * (0.6f + 0.4f * (isWarp ? roundV : round))};
  };
  SurfaceImages images;
  images.color = colorImage(size, size, [&](Vec2f uv) {
    const Thread t = thread(uv);
    const float slub = 1 + 0.12f * fbm(uv * 16.f, {16, 16}, 4, seed);
    return min((t.isWarp ? warp : weft) * (slub * (0.7f + 0.3f * t.height)), Rgb(0.95f));
  });
  images.height = dataImage(size, size, [&](Vec2f uv) { return thread(uv).height; });
  images.roughness = dataImage(size, size, [&](Vec2f) { return 0.6f; });
  return images;
}

}  // namespace lobelia::builtin

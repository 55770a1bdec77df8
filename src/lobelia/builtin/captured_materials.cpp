#include "lobelia/builtin/captured_materials.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "lobelia/bsdf/captured.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/textures.h"

namespace lobelia::builtin {
namespace {

// What a pattern says of a point: reflectances of the diffuse part and of the lobe, its sharpness.
struct Spot {
  Rgb diffuse, lobe;
  float sharpness = 1;
};
using Pattern = std::function<Spot(Vec2f)>;

// Images hold [0,1]: what exceeds that is scaled by a texture around them.
TextureHandle addImage(SceneBuilder& builder, Image image, const std::string& name, float repeats,
                       float scale) {
  image.name = name;
  Texture bitmap;
  bitmap.type = TextureType::bitmap;
  bitmap.image = builder.add(std::move(image));
  bitmap.uvMatrix[0][0] = bitmap.uvMatrix[1][1] = repeats;
  const TextureHandle inner = builder.add(bitmap);
  if (scale == 1) return inner;
  Texture scaled;
  scaled.type = TextureType::scale;
  scaled.a = inner;
  scaled.scale = scale;
  return builder.add(scaled);
}

Rgb amplitudeOf(const Spot& spot) { return spot.lobe / projectedIntegral(spot.sharpness); }

// One lobe whose reflectance and sharpness are those of the pattern at each point.
Material textured(SceneBuilder& builder, const std::string& name, int size, float repeats,
                  float sharpest, const Pattern& pattern) {
  // The sharpest spot that reflects all has the greatest amplitude.
  const float highest = 1 / projectedIntegral(sharpest);
  Material m;
  m.type = MaterialType::sphericalGaussians;
  m.diffuse =
      addImage(builder, colorImage(size, size, [&](Vec2f uv) { return pattern(uv).diffuse; }),
               name + "_diffuse", repeats, 1);
  CapturedLobe lobe;
  lobe.amplitude = addImage(
      builder, colorImage(size, size, [&](Vec2f uv) { return amplitudeOf(pattern(uv)) / highest; }),
      name + "_amplitude", repeats, highest);
  lobe.sharpness = addImage(
      builder, dataImage(size, size, [&](Vec2f uv) { return pattern(uv).sharpness / sharpest; }),
      name + "_sharpness", repeats, sharpest);
  m.capturedLobes = {lobe};
  return m;
}

float fraction(float x) { return x - std::floor(x); }
// Offset to the nearest point of the lattice of whole numbers.
Vec2f fromLattice(Vec2f p) { return {p.x - std::round(p.x), p.y - std::round(p.y)}; }

// The damask's drawing: flowers at the corners and the middle of the repeat, leaves between them.
bool isFlower(Vec2f uv) {
  for (const Vec2f centre : {Vec2f(0, 0), Vec2f(0.5f, 0.5f)}) {
    const Vec2f d = fromLattice(uv - centre);
    const float r = std::sqrt(d.x * d.x + d.y * d.y), angle = std::atan2(d.y, d.x);
    const float outer = 0.11f + 0.1f * std::sqrt(std::abs(std::cos(4 * angle)));
    const float inner = 0.055f + 0.045f * std::abs(std::sin(4 * angle));
    if (r < 0.028f || (r > 0.04f && r < inner) || (r > inner + 0.014f && r < outer)) return true;
  }
  for (const Vec2f centre : {Vec2f(0.5f, 0), Vec2f(0, 0.5f)}) {
    const Vec2f d = fromLattice(uv - centre);
    // Four leaves: lenses along the diagonals, with a vein left out.
    const float a = (std::abs(d.x) + std::abs(d.y)) * 0.7071f;
    const float b = std::abs(std::abs(d.x) - std::abs(d.y)) * 0.7071f;
    const float width = 0.045f * std::sin(kPi * std::clamp(a / 0.2f, 0.f, 1.f));
    if (b < width && b > 0.004f) return true;
  }
  return false;
}

// Threads per repeat of the damask; in its eight-end satin each warp thread passes under every
// eighth weft thread, three steps further in the next.
constexpr int kThreads = 64, kEnds = 8, kStep = 3;

Spot satinAt(const SatinStyle& style, Vec2f uv) {
  const float u = fraction(uv.x) * kThreads, v = fraction(uv.y) * kThreads;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const bool crossing = (kStep * i + j) % kEnds == 0;
  // The drawing is made of whole crossings.
  const Vec2f middle((static_cast<float>(i) + 0.5f) / kThreads,
                     (static_cast<float>(j) + 0.5f) / kThreads);
  const bool flower = isFlower(middle);
  const bool warp = flower != crossing;
  // Threads are round: their flanks shine less towards any one side.
  const float across = 2 * fraction(warp ? u : v) - 1;
  const float round = 1 - 0.45f * sqr(across);
  const float thread = 0.88f + 0.12f * cellRandom(warp ? i : -1 - j, warp ? 1 : 2, 7);
  Spot spot;
  spot.diffuse = style.dye * (thread * (warp ? 1.f : 0.75f));
  spot.lobe = style.sheen * (round * thread * (warp ? 1.f : 1.f / 3));
  spot.sharpness = warp ? style.flowerSharpness : style.groundSharpness;
  return spot;
}

// How much ink of each kind lies at a point of the card.
struct Print {
  float ink = 0, accent = 0;
};
Print printAt(Vec2f uv) {
  const Vec2f d(fraction(uv.x) - 0.5f, fraction(uv.y) - 0.5f);
  const float edge = 0.5f - std::max(std::abs(d.x), std::abs(d.y));
  if (edge < 0.05f) return {};
  if (edge < 0.065f) return {1, 0};
  if (edge < 0.08f) return {};
  const float r = std::sqrt(d.x * d.x + d.y * d.y), angle = std::atan2(d.y, d.x);
  // Guilloche: two waves round the middle whose crossings leave the paper free.
  const float first = std::sin(70 * r + 3 * std::sin(8 * angle));
  const float second = std::sin(70 * r - 3 * std::sin(8 * angle));
  if (r < 0.13f) {
    const float petals = 0.07f + 0.045f * std::cos(8 * angle);
    return {0, r < petals && r > 0.02f ? 1.f : 0.f};
  }
  if (r < 0.15f) return {1, 0};
  if (r < 0.36f) return {first * second < 0.12f ? 1.f : 0.f, 0};
  if (r < 0.375f) return {0, 1};
  // Corners: a diamond lattice.
  const float a = fraction((d.x + d.y) * 14), b = fraction((d.x - d.y) * 14);
  const bool line = std::min(std::min(a, 1 - a), std::min(b, 1 - b)) < 0.12f;
  const bool dot = sqr(a - 0.5f) + sqr(b - 0.5f) < 0.03f;
  return {line || dot ? 0.f : 1.f, dot ? 1.f : 0.f};
}

Spot cardAt(const CardStyle& style, Vec2f uv) {
  const Print print = printAt(uv);
  const float coverage = std::min(print.ink + print.accent, 1.f);
  const float fibres = fbm(uv * 64.f, {64, 64}, 3, 3);
  const Rgb ink = print.accent > 0 ? style.accent : style.ink;
  Spot spot;
  spot.diffuse =
      (style.paper * (1 - coverage) + ink * coverage) * std::min(1 + 0.05f * fibres, 1.05f);
  // Varnish fills the paper's grain, but not quite.
  spot.lobe = Rgb(0.75f + 0.2f * coverage);
  spot.sharpness = coverage > 0 ? style.varnishSharpness * (0.85f + 0.15f * fibres)
                                : style.paperSharpness * (1 + 0.3f * fibres);
  return spot;
}

}  // namespace

MaterialHandle addSatin(SceneBuilder& builder, const SatinStyle& style, std::string name) {
  Material m = textured(builder, name, style.resolution, style.repeats,
                        std::max(style.flowerSharpness, style.groundSharpness),
                        [&](Vec2f uv) { return satinAt(style, uv); });
  m.ior = 1;  // the lobe has its colour at all angles
  return builder.add(std::move(m), std::move(name));
}

MaterialHandle addCard(SceneBuilder& builder, const CardStyle& style, std::string name) {
  Material m = textured(builder, name, style.resolution, style.repeats,
                        std::max(style.varnishSharpness, style.paperSharpness) * 1.3f,
                        [&](Vec2f uv) { return cardAt(style, uv); });
  m.ior = 1.5f;
  return builder.add(std::move(m), std::move(name));
}

}  // namespace lobelia::builtin

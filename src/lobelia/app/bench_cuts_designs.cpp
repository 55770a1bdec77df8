#include "lobelia/app/bench_cuts_designs.h"

#include <algorithm>
#include <cmath>

#include "lobelia/relight/visibility_data.h"

namespace lobelia::app {
namespace {

constexpr int kTexels = 256;
constexpr float kTurn = 6.2831853f;

// f(u, v) at texels' middles, u and v from 0 to 1.
template <class F>
Image image(const char* name, const F& f) {
  Image out;
  out.name = name, out.width = out.height = kTexels;
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x) {
      const Rgb color =
          f((static_cast<float>(x) + 0.5f) / kTexels, (static_cast<float>(y) + 0.5f) / kTexels);
      for (const float c : {color.x, color.y, color.z}) out.pixels.push_back(c);
    }
  return out;
}

float smoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// 1 within a star of five points, 0 around it.
float star(float u, float v) {
  const float x = u - 0.5f, y = v - 0.5f;
  const float angle = std::atan2(x, -y), wedge = std::abs(std::remainder(angle, kTurn / 5));
  const float radius = std::hypot(x, y);
  // The edge from a point at radius .45 to a notch at .18, half a wedge further.
  const float half = kTurn / 10, outer = 0.45f, inner = 0.18f;
  const float edge =
      outer * inner * std::sin(half) / (outer * std::sin(wedge) + inner * std::sin(half - wedge));
  return 1 - smoothStep(edge - 0.01f, edge + 0.01f, radius);
}

Rgb veins(float u, float v) {
  const float wave = std::sin(kTurn * (2 * u + 3 * v + 0.35f * std::sin(kTurn * (3 * u - 2 * v)) +
                                       0.2f * std::sin(kTurn * 5 * v)));
  const float t = std::pow(std::abs(wave), 0.35f);
  return Rgb(0.55f, 0.16f, 0.07f) * (1 - t) + Rgb(0.80f, 0.70f, 0.52f) * t;
}

// Rounded studs, four a side.
float studs(float u, float v) {
  const float x = std::sin(kTurn * 2 * u), y = std::sin(kTurn * 2 * v);
  return smoothStep(0, 0.8f, std::abs(x * y));
}

TextureHandle addTexture(Scene& scene, Image pixels, float perUv, int channel = -1) {
  scene.images.push_back(std::move(pixels));
  Texture texture;
  texture.type = TextureType::bitmap;
  texture.image = {static_cast<uint32_t>(scene.images.size() - 1)};
  texture.channel = channel;
  texture.uvMatrix[0][0] = texture.uvMatrix[1][1] = perUv;
  scene.textures.push_back(texture);
  return {static_cast<uint32_t>(scene.textures.size() - 1)};
}

Material lacquer(ColorParam color, FloatParam alpha) {
  Material m;
  m.type = MaterialType::roughPlastic;
  m.distribution = Distribution::ggx;
  m.diffuse = color, m.alphaU = m.alphaV = alpha;
  return m;
}

// Copper.
Material metal(FloatParam alpha) {
  Material m;
  m.type = MaterialType::roughConductor;
  m.distribution = Distribution::ggx;
  m.eta = Rgb(0.2004f, 0.9240f, 1.1022f), m.k = Rgb(3.9129f, 2.4528f, 2.1421f);
  m.alphaU = m.alphaV = alpha;
  return m;
}

Material ward(ColorParam diffuse, ColorParam specular, float alphaU, float alphaV) {
  Material m;
  m.type = MaterialType::ward;
  m.diffuse = diffuse, m.specular = specular, m.alphaU = alphaU, m.alphaV = alphaV;
  return m;
}

Material bumped(Scene& scene, const Material& inner, TextureHandle height, float scale) {
  scene.materials.push_back(inner);
  Material m;
  m.type = MaterialType::bump;
  m.a = {static_cast<uint32_t>(scene.materials.size() - 1)};
  m.map = height, m.scale = scale;
  return m;
}

void projectUvs(Mesh& mesh, const Bounds3f& box) {
  const float size = std::max(length(box.extent()), 1e-20f);
  for (const Vec3f& p : mesh.positions) {
    const Vec3f q = (p - box.lo) / size;
    mesh.uvs.emplace_back(q.x + 0.5f * q.z, q.y + 0.3f * q.z);
  }
}

// Texture coordinates for all of the object's meshes. Returns the length of the diagonal of the
// largest of them in the world.
float prepareObject(Scene& scene, MaterialHandle object) {
  float largest = 0;
  for (const Instance& instance : scene.instances) {
    if (instance.material != object) continue;
    Mesh& mesh = scene.meshes[instance.mesh.index];
    Bounds3f own, world;
    for (const Vec3f& p : mesh.positions) own.add(p), world.add(instance.toWorld.point(p));
    if (mesh.uvs.empty()) projectUvs(mesh, own);
    largest = std::max(largest, length(world.extent()));
  }
  return largest;
}

}  // namespace

MaterialHandle largestMaterial(const Scene& scene) {
  std::vector<size_t> triangles(scene.materials.size(), 0);
  for (const Instance& instance : scene.instances)
    if (instance.material.valid() && !instance.emitter.valid() &&
        !relight::transmits(scene, instance.material))
      triangles[instance.material.index] += scene[instance.mesh].triangles.size();
  const auto most = std::max_element(triangles.begin(), triangles.end());
  if (most == triangles.end() || *most == 0) return {};
  return {static_cast<uint32_t>(most - triangles.begin())};
}

std::vector<MaterialDesign> addDesigns(Scene& scene, MaterialHandle object) {
  const float size = prepareObject(scene, object);
  const TextureHandle stars =
      addTexture(scene, image("stars", [](float u, float v) { return Rgb(0.6f * star(u, v)); }), 9);
  const TextureHandle gloss = addTexture(
      scene, image("gloss", [](float u, float v) { return Rgb(0.32f - 0.26f * star(u, v)); }), 9,
      0);
  const TextureHandle stone = addTexture(scene, image("stone", veins), 3);
  const TextureHandle height =
      addTexture(scene, image("studs", [](float u, float v) { return Rgb(studs(u, v)); }), 6, 0);
  return {{"matt", lacquer(Rgb(0.45f, 0.42f, 0.38f), 0.4f)},
          {"lacquer", lacquer(Rgb(0.35f, 0.03f, 0.03f), 0.08f)},
          {"metal", metal(0.15f)},
          {"ward", ward(Rgb(0.08f, 0.09f, 0.12f), Rgb(0.5f), 0.06f, 0.3f)},
          {"texture", lacquer(stone, 0.15f)},
          {"bump", bumped(scene, lacquer(Rgb(0.10f, 0.22f, 0.12f), 0.12f), height, 0.006f * size)},
          {"star", ward(Rgb(0.10f, 0.06f, 0.16f), stars, 0.1f, 0.1f)},
          {"gloss", metal(gloss)}};
}

}  // namespace lobelia::app

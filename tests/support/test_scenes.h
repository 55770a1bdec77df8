// Scenes with one emitter of every kind, over a small stage, for tests of light transport.
#pragma once

#include "lobelia/path/path_tracer.h"
#include "support/box_scene.h"

namespace lobelia::test {

// The unit sphere as `rings` x 2 rings facets, vertices on the sphere, facing outwards.
inline Mesh sphereMesh(int rings, bool smooth) {
  Mesh mesh;
  mesh.isUnitSphere = true;
  const int around = 2 * rings;
  for (int y = 0; y <= rings; ++y) {
    for (int x = 0; x < around; ++x) {
      const float theta = kPi * static_cast<float>(y) / static_cast<float>(rings);
      const float phi = kTwoPi * static_cast<float>(x) / static_cast<float>(around);
      mesh.positions.push_back(
          {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  const auto vertex = [&](int x, int y) { return static_cast<uint32_t>(y * around + x % around); };
  for (int y = 0; y < rings; ++y) {
    for (int x = 0; x < around; ++x) {
      if (y > 0) mesh.triangles.push_back({vertex(x, y), vertex(x, y + 1), vertex(x + 1, y)});
      if (y + 1 < rings) {
        mesh.triangles.push_back({vertex(x + 1, y), vertex(x, y + 1), vertex(x + 1, y + 1)});
      }
    }
  }
  if (smooth) mesh.normals = mesh.positions;
  return mesh;
}

inline size_t addSphere(Scene& scene, Vec3f centre, float radius, MaterialHandle material,
                        EmitterHandle emitter = {}, int rings = 64) {
  scene.meshes.push_back(sphereMesh(rings, true));
  Instance instance;
  instance.mesh = {static_cast<uint32_t>(scene.meshes.size() - 1)};
  instance.toWorld = Transform(translation({double{centre.x}, double{centre.y}, double{centre.z}}) *
                               scaling(Vec3d(double{radius})));
  instance.material = material;
  instance.emitter = emitter;
  scene.instances.push_back(std::move(instance));
  return scene.instances.size() - 1;
}

inline EmitterHandle addEmitter(Scene& scene, Emitter emitter) {
  scene.emitters.push_back(std::move(emitter));
  return {static_cast<uint32_t>(scene.emitters.size() - 1)};
}
inline EmitterHandle addAreaEmitter(Scene& scene, Rgb radiance) {
  Emitter emitter;
  emitter.type = EmitterType::area;
  emitter.radiance = radiance;
  return addEmitter(scene, emitter);
}

// Floor and back wall of grey diffuse quads around the origin, seen from the front.
inline Scene stageScene(Rgb albedo = {0.5f, 0.6f, 0.7f}) {
  Scene scene;
  scene.name = "stage";
  const MaterialHandle grey = addMaterial(scene, diffuseMaterial(albedo));
  addQuad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, grey);  // floor, faces up
  addQuad(scene, {-2, 0, 2}, {0, 2, 0}, {4, 0, 0}, grey);   // back, faces -z
  Camera camera;
  camera.toWorld = Transform(*lookAt({0, 2, -5}, {0, 0.7, 0}, {0, 1, 0}));
  camera.fovX = 0.9f;
  camera.width = 24;
  camera.height = 16;
  camera.filter = PixelFilter::box;
  scene.cameras.push_back(camera);
  return scene;
}

// An image of random values as a texture, bilinear.
inline TextureHandle addRandomTexture(Scene& scene, int size, float low) {
  Image image;
  image.width = image.height = size;
  for (int i = 0; i < size * size * 3; ++i) {
    const uint64_t bits = static_cast<uint64_t>(i) * 0x9e3779b97f4a7c15ull;
    image.pixels.push_back(low + static_cast<float>((bits >> 40) & 0xff) / 128.f);
  }
  scene.images.push_back(std::move(image));
  Texture texture;
  texture.type = TextureType::bitmap;
  texture.image = {static_cast<uint32_t>(scene.images.size() - 1)};
  scene.textures.push_back(texture);
  return {static_cast<uint32_t>(scene.textures.size() - 1)};
}

enum class Lighting {
  quad,
  texturedQuad,
  sphere,
  meshSphere,
  insideOut,
  manyTriangles,
  point,
  spot,
  projector,
  directional,
  constant,
  environment,
  goniometric,
  sun,
  sunAndSky,
  mixed,
};
inline const char* nameOf(Lighting l) {
  static constexpr const char* kNames[] = {
      "quad",        "texturedQuad", "sphere",    "meshSphere",  "insideOut", "manyTriangles",
      "point",       "spot",         "projector", "directional", "constant",  "environment",
      "goniometric", "sun",          "sunAndSky", "mixed"};
  return kNames[static_cast<int>(l)];
}

inline void addLighting(Scene& scene, Lighting lighting) {
  const MaterialHandle black = addMaterial(scene, diffuseMaterial(Rgb(0.f)));
  const Mat4 above = *lookAt({0.3, 2.5, -0.5}, {0, 0, 0.5}, {0, 0, 1});
  Emitter emitter;
  emitter.toWorld = Transform(above);
  switch (lighting) {
    case Lighting::quad:
      addQuad(scene, {-0.5f, 1.8f, -0.5f}, {1, 0, 0}, {0, 0, 1}, black,
              addAreaEmitter(scene, {5, 6, 7}));
      return;
    case Lighting::texturedQuad: {
      const EmitterHandle light = addAreaEmitter(scene, {});
      scene.emitters[light.index].radiance = addRandomTexture(scene, 8, 0);
      const size_t quad =
          addQuad(scene, {-0.7f, 1.2f, 0.5f}, {1.4f, 0, 0}, {0, 0.3f, 0.8f}, black, light);
      scene.meshes[scene.instances[quad].mesh.index].uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      return;
    }
    case Lighting::sphere:
      addSphere(scene, {0.4f, 0.8f, 0.5f}, 0.3f, black, addAreaEmitter(scene, {6, 5, 4}));
      return;
    case Lighting::meshSphere: {
      const size_t i =
          addSphere(scene, {0.4f, 0.8f, 0.5f}, 0.3f, black, addAreaEmitter(scene, {6, 5, 4}), 12);
      scene.meshes[scene.instances[i].mesh.index].isUnitSphere = false;
      return;
    }
    case Lighting::insideOut: {  // a large sphere that shines inwards, round everything
      const size_t i =
          addSphere(scene, {}, 20, black, addAreaEmitter(scene, {0.5f, 0.6f, 0.4f}), 24);
      scene.instances[i].flipNormals = true;
      return;
    }
    case Lighting::manyTriangles: {
      const EmitterHandle light = addAreaEmitter(scene, {40, 50, 60});
      Mesh mesh;
      for (int i = 0; i < 400; ++i) {
        const float x = static_cast<float>(i % 20) * 0.2f - 1.9f;
        const float z = static_cast<float>(i / 20) * 0.2f - 1.9f;
        const uint32_t v = static_cast<uint32_t>(mesh.positions.size());
        const float y = 0.3f + 0.1f * static_cast<float>(i % 7);
        const Vec3f at{x, y, z};
        mesh.positions.insert(mesh.positions.end(),
                              {at, at + Vec3f{0.03f, 0.01f, 0}, at + Vec3f{0, 0.01f, 0.03f}});
        mesh.triangles.push_back(i % 2 == 0 ? Vec3u{v, v + 1, v + 2} : Vec3u{v, v + 2, v + 1});
      }
      scene.meshes.push_back(std::move(mesh));
      Instance instance;
      instance.mesh = {static_cast<uint32_t>(scene.meshes.size() - 1)};
      instance.material = black;
      instance.emitter = light;
      scene.instances.push_back(instance);
      return;
    }
    case Lighting::point:
      emitter.type = EmitterType::point;
      emitter.radiance = Rgb(3, 2, 4);
      break;
    case Lighting::spot:
      emitter.type = EmitterType::spot;
      emitter.radiance = Rgb(9, 8, 7);
      emitter.cutoff = 0.5f;
      emitter.beamWidth = 0.3f;
      emitter.pattern = addRandomTexture(scene, 8, 0.1f);
      break;
    case Lighting::projector:
      emitter.type = EmitterType::projector;
      emitter.radiance = addRandomTexture(scene, 8, 0.1f);
      emitter.scale = 2;
      emitter.fov = 0.8f;
      break;
    case Lighting::directional:
      emitter.type = EmitterType::directional;
      emitter.radiance = Rgb(2, 2.5f, 3);
      emitter.direction = normalize(Vec3f{0.3f, -1, 0.4f});
      break;
    case Lighting::constant:
      emitter.type = EmitterType::constant;
      emitter.radiance = Rgb(0.7f, 0.8f, 0.9f);
      break;
    case Lighting::environment: {
      emitter.type = EmitterType::environment;
      emitter.toWorld = Transform(rotation({0, 1, 0}, 70));
      Image image;
      image.width = 32, image.height = 16;
      for (int i = 0; i < 32 * 16; ++i) {
        const float v = i == 5 * 32 + 12 ? 60.f : 0.2f + 0.01f * static_cast<float>(i % 32);
        image.pixels.insert(image.pixels.end(), {v, 0.8f * v, 1.2f * v});
      }
      scene.images.push_back(std::move(image));
      emitter.image = {static_cast<uint32_t>(scene.images.size() - 1)};
      break;
    }
    case Lighting::goniometric: {
      emitter.type = EmitterType::goniometric;
      emitter.radiance = Rgb(2, 3, 2.5f);
      emitter.scale = 1.5f;
      Image image;
      image.width = 16, image.height = 9, image.channels = 1;
      for (int i = 0; i < 16 * 9; ++i)
        image.pixels.push_back(i / 16 < 4 ? 1 + static_cast<float>(i % 5) : 0.1f);
      scene.images.push_back(std::move(image));
      emitter.image = {static_cast<uint32_t>(scene.images.size() - 1)};
      break;
    }
    case Lighting::sun:
      emitter.type = EmitterType::sun;
      emitter.radiance = Rgb(3, 2.5f, 2);
      emitter.direction = normalize(Vec3f{0.3f, -1, 0.4f});
      emitter.angularRadius = 0.3f;
      break;
    case Lighting::sunAndSky:
      addLighting(scene, Lighting::sun);
      addLighting(scene, Lighting::environment);
      return;
    case Lighting::mixed:
      for (const Lighting l : {Lighting::quad, Lighting::sphere, Lighting::spot, Lighting::point,
                               Lighting::directional, Lighting::environment, Lighting::constant}) {
        addLighting(scene, l);
      }
      return;
  }
  addEmitter(scene, emitter);
}

inline Film filmFor(const Camera& camera, std::initializer_list<const char*> layers = {}) {
  Film film;
  film.fullWidth = camera.width, film.fullHeight = camera.height;
  film.x0 = camera.cropX0, film.y0 = camera.cropY0;
  film.width = camera.cropX1 > 0 ? camera.cropX1 - camera.cropX0 : camera.width;
  film.height = camera.cropX1 > 0 ? camera.cropY1 - camera.cropY0 : camera.height;
  film.addLayer("");
  for (const char* name : layers) film.addLayer(name, std::string_view(name) == "depth" ? 1 : 3);
  return film;
}

inline Vec3d meanOf(const Film& film, const char* layer = "") {
  Vec3d sum;
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    const Rgb c = film.rgb(i, layer);
    sum += Vec3d(double{c.x}, double{c.y}, double{c.z});
  }
  return sum / static_cast<double>(film.pixelCount());
}

// A scene with what it takes to render it.
struct Renderable {
  explicit Renderable(Scene s)
      : scene(std::move(s)), tracer(scene, context), emitters(scene, tracer.bounds()) {}
  Film path(const PathSettings& settings, std::initializer_list<const char*> layers = {}) {
    Film film = filmFor(scene.cameras[0], layers);
    renderPath(tracer, emitters, scene.cameras[0], settings, film, context);
    return film;
  }
  Film light(const PathSettings& settings, std::initializer_list<const char*> layers = {}) {
    Film film = filmFor(scene.cameras[0], layers);
    renderLight(tracer, emitters, scene.cameras[0], settings, film, context);
    return film;
  }
  Scene scene;
  Context context;
  Tracer tracer;
  EmitterSampler emitters;
};

}  // namespace lobelia::test

#include <random>

#include "io/scene_text.h"
#include "io/temporary_folder.h"
#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/mesh_io.h"
#include "lobelia/io/scene_io.h"
#include "support/data.h"

namespace lobelia {
namespace {

Scene readBack(const std::string& folder) {
  Context context;
  return io::readMitsuba(folder + "/scene.xml", {}, context);
}

// Writes a scene, reads it, and expects nothing to differ.
Scene expectSame(const Scene& scene, const std::string& folder) {
  io::writeMitsuba(folder, scene);
  const Scene copy = readBack(folder);
  for (const Finding& f : copy.findings) ADD_FAILURE() << toString(f.where) << ": " << f.message;
  EXPECT_EQ(copy.instances.size(), scene.instances.size());
  for (size_t i = 0; i < std::min(copy.instances.size(), scene.instances.size()); ++i)
    EXPECT_TRUE(test::SceneText(copy).instance(copy.instances[i]) ==
                test::SceneText(scene).instance(scene.instances[i]))
        << scene.instances[i].name;
  EXPECT_TRUE(test::SceneText(copy).all() == test::SceneText(scene).all());
  return copy;
}

TEST(MitsubaWriter, CornellComesBackBitForBit) {
  const TemporaryFolder folder;
  const Scene scene = builtin::builtinScene("cornell", 0.2f);
  const Scene copy = expectSame(scene, folder.path("cornell"));
  EXPECT_EQ(copy.name, "cornell");
  EXPECT_EQ(copy.meshes.size(), scene.meshes.size());
  EXPECT_EQ(copy.materials.size(), scene.materials.size());
  ASSERT_EQ(copy.cameras.size(), 1u);
  EXPECT_EQ(copy.cameras[0].name, "front");
}

class Everything {
 public:
  Scene scene;

  Everything() {
    addTextures();
    addMaterials();
    addShapes();
    addEmitters();
    addCameras();
    scene.integrator = "direct";
    scene.maxDepth = 7;
    scene.hideEmitters = true;
  }

 private:
  template <class T>
  static auto put(std::vector<T>& to, T value) {
    to.push_back(std::move(value));
    return Handle<T>{static_cast<uint32_t>(to.size() - 1)};
  }
  float random() { return std::uniform_real_distribution<float>(0.01f, 1)(random_); }
  Rgb randomRgb() { return {random(), random(), random()}; }
  Mat4 randomMatrix() {
    return translation({random(), -random(), 10 * random()}) *
           rotation({random(), random(), 1}, 100 * random()) * scaling({random(), random(), 2});
  }

  void addTextures() {
    for (int kind = 0; kind < 5; ++kind) {
      Image image;
      image.name = kind % 2 ? "/some where/../strange $name\"<&>.png" : "";
      image.width = 5, image.height = 3;
      image.channels = kind == 1 ? 4 : kind == 2 ? 1 : 3;
      for (int i = 0; i < 15 * image.channels; ++i) {
        const auto byte = static_cast<float>(random_() % 256);
        // 0: any floats; 1, 2: 8 bits, sRGB; 3: 8 bits, raw; 4: for the environment
        const bool linear = kind == 3 || i % image.channels == 3;
        image.pixels.push_back(kind == 0 || kind == 4 ? 100 * random()
                               : linear ? static_cast<float>(static_cast<double>(byte) / 255)
                                        : srgb(byte));
      }
      put(scene.images, image);
      if (kind == 4) break;
      Texture t;
      t.type = TextureType::bitmap;
      t.image = {static_cast<uint32_t>(kind)};
      t.filter = kind % 2 ? Filter::nearest : Filter::bilinear;
      t.wrapU = static_cast<Wrap>(kind);
      t.wrapV = static_cast<Wrap>(kind % 2 == 0 ? kind : kind - 1);
      t.alphaChannel = kind == 1;
      for (auto& row : t.uvMatrix)
        for (float& v : row) v = kind == 0 ? v : random();
      bitmaps_.push_back(put(scene.textures, t));
    }
    Texture a, b;
    a.value = randomRgb();
    b.type = TextureType::meshAttribute;
    b.attribute = "vertex_color";
    Texture checker, scaled;
    checker.type = TextureType::checkerboard;
    checker.a = put(scene.textures, a), checker.b = put(scene.textures, b);
    checker.uvMatrix[0][0] = 7, checker.uvMatrix[1][2] = 0.3f;
    checker_ = put(scene.textures, checker);
    scaled.type = TextureType::scale;
    scaled.scale = 0.37f;
    scaled.a = bitmaps_[2];
    scaled_ = put(scene.textures, scaled);
    // Ours: one within the other, with constants among the parts.
    Texture tinted, blended, curve, second;
    tinted.type = TextureType::product;
    tinted.a = bitmaps_[0], tinted.b = checker.a;
    blended.type = TextureType::mix;
    blended.a = checker_, blended.b = put(scene.textures, tinted), blended.c = scaled_;
    curve.type = TextureType::power;
    curve.a = put(scene.textures, blended), curve.scale = 0.45f;
    combined_ = put(scene.textures, curve);
    second = scene[bitmaps_[2]];
    second.channel = 3;
    second.attribute = "vertex_uv1";
    second_ = put(scene.textures, second);
    b.channel = 1, b.scale = 1.5f;
    attribute_ = put(scene.textures, b);
  }
  static float srgb(float byte) {
    const double v = static_cast<double>(byte) / 255;
    return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }

  void addMaterials() {
    for (int type = 0; type <= static_cast<int>(MaterialType::sphericalGaussians); ++type) {
      Material m;
      m.type = static_cast<MaterialType>(type);
      m.name = type % 3 ? "same \"name\" $x" : "";
      // Only what the type has: the rest stays at its default and must come back so.
      const auto is = [&](auto... types) { return ((m.type == types) || ...); };
      using T = MaterialType;
      if (is(T::diffuse, T::plastic, T::roughPlastic, T::phong, T::ward, T::principled,
             T::diffuseTransmitter, T::metallicRoughness, T::sphericalGaussians))
        m.diffuse = type % 2 ? ColorParam(checker_) : ColorParam(randomRgb());
      if (!is(T::diffuse, T::principled, T::diffuseTransmitter, T::sphericalGaussians))
        m.specular = type % 2 ? ColorParam(randomRgb()) : ColorParam(bitmaps_[0]);
      if (is(T::dielectric, T::thinDielectric, T::roughDielectric, T::diffuseTransmitter))
        m.transmittance = is(T::thinDielectric) ? ColorParam(combined_) : ColorParam(randomRgb());
      if (is(T::dielectric, T::roughDielectric, T::metallicRoughness)) m.absorption = randomRgb();
      if (is(T::conductor, T::roughConductor, T::coatedConductor))
        m.eta = randomRgb(), m.k = randomRgb();
      if (is(T::dielectric, T::thinDielectric, T::roughDielectric, T::plastic, T::roughPlastic,
             T::principled, T::metallicRoughness, T::sphericalGaussians))
        m.ior = 1 + random();
      if (is(T::sphericalGaussians))
        m.capturedLobes = {{randomRgb() * 30.f, 70.5f}, {bitmaps_[0], scaled_}};
      if (is(T::plastic, T::roughPlastic)) m.nonlinear = true;
      if (is(T::roughConductor))
        m.distribution = Distribution::ggx, m.alphaU = second_, m.alphaV = attribute_;
      if (is(T::coatedConductor))
        m.coatAlphaU = second_, m.coatAlphaV = random(), m.coatIor = 1 + random();
      if (is(T::metallicRoughness)) {
        for (FloatParam* f : {&m.roughness, &m.metallic, &m.specTrans, &m.anisotropic, &m.clearcoat,
                              &m.specularStrength, &m.sheenRoughness, &m.clearcoatRoughness,
                              &m.anisotropicRotation})
          *f = random();
        m.metallic = second_;
        m.sheenColor = randomRgb();
        m.clearcoatNormal = bitmaps_[3], m.anisotropicDirection = combined_;
        m.isSpecularGlossiness = m.thin = true;
      }
      if (is(T::roughDielectric))
        m.distribution = Distribution::phong, m.alphaU = m.alphaV = scaled_;
      if (is(T::roughPlastic))
        m.alphaU = m.alphaV = checker_;  // the colours are exchanged for numbers
      if (is(T::phong)) m.alphaU = m.alphaV = 45.5f;
      if (is(T::ward)) m.wardVariant = 1, m.alphaU = random(), m.alphaV = bitmaps_[3];
      if (is(T::principled))
        for (FloatParam* f : {&m.roughness, &m.anisotropic, &m.metallic, &m.specTrans, &m.specTint,
                              &m.sheen, &m.sheenTint, &m.flatness, &m.clearcoat, &m.clearcoatGloss})
          *f = random();
      put(scene.materials, m);
    }
    const auto wrap = [&](MaterialType type, uint32_t inner) {
      Material m;
      m.type = type;
      m.a = {inner};
      if (type == MaterialType::blend) m.b = {3}, m.weight = bitmaps_[2];
      if (type == MaterialType::mask) m.opacity = bitmaps_[1];
      if (type == MaterialType::bump) m.map = scaled_, m.scale = 2.5f;
      if (type == MaterialType::normalMap) m.map = bitmaps_[3];
      return put(scene.materials, m).index;
    };
    const uint32_t bump = wrap(MaterialType::bump, 1), normal = wrap(MaterialType::normalMap, 2);
    wrap(MaterialType::twoSided, bump);
    wrap(MaterialType::mask, normal);
    wrap(MaterialType::blend, 4);
    Material twoSided, null;
    twoSided.type = MaterialType::twoSided, twoSided.a = {0}, twoSided.b = {1};
    put(scene.materials, twoSided);
    null.type = MaterialType::null;
    put(scene.materials, null);
  }

  void addShapes() {
    Mesh mesh;
    mesh.name = "../a mesh/with: a name";
    mesh.positions = {{0, 0, 0}, {1, 0.1f, 0}, {1, 1, 0.3f}, {0, 1, 1e-7f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.attributes = {
        {"vertex_color", false, 3, {0, .1f, .2f, .3f, .4f, .5f, .6f, .7f, .8f, .9f, 1, 0}},
        {"vertex_uv1", false, 2, {0, 0, 1, 0.1f, 1, 1, -2, 3}},
        {"face_tone", true, 1, {3, 4}}};
    put(scene.meshes, mesh);  // flat
    mesh.normals = {{0, 0, 1}, normalize(Vec3f(1, 2, 3)), {1, 0, 0}, {0, -1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {0.1f, 1.f / 3}, {-2, 5}};
    put(scene.meshes, mesh);
    for (const Mesh& unit : {io::unitSphere(), io::unitCube(), io::unitRectangle(), io::unitDisk(),
                             io::unitCylinder()})
      put(scene.meshes, unit);
    for (uint32_t i = 0; i < scene.materials.size(); ++i) {
      Instance instance;
      instance.name = i % 2 ? "an instance" : "";
      instance.mesh = {i % 7};
      Mat4 matrix = randomMatrix();
      if (i % 4 == 1) matrix = matrix * scaling({-1, 1, 1});  // mirrors
      instance.toWorld = Transform(matrix);
      instance.material = {i};
      instance.flipNormals = i % 3 == 2;
      scene.instances.push_back(instance);
    }
    Emitter shared;
    shared.type = EmitterType::area;
    shared.name = "panel";
    shared.radiance = checker_;
    scene.instances[2].emitter = scene.instances[5].emitter = put(scene.emitters, shared);
    shared.radiance = randomRgb() * 1e4f;
    shared.group = "panels";
    scene.instances[6].emitter = put(scene.emitters, shared);
  }

  void addEmitters() {
    const auto emitter = [&](EmitterType type) {
      Emitter e;
      e.type = type;
      e.name = "light";
      e.radiance = randomRgb() * 12;
      if (type != EmitterType::constant && type != EmitterType::directional)
        e.toWorld = Transform(randomMatrix());
      return e;
    };
    put(scene.emitters, emitter(EmitterType::point));
    for (int i = 0; i < 20; ++i) {
      Emitter spot = emitter(EmitterType::spot);
      spot.cutoff = (3 + 80 * random()) * (kPi / 180);
      spot.beamWidth = spot.cutoff * 0.5f;
      if (i == 0) spot.pattern = bitmaps_[0];
      put(scene.emitters, spot);
    }
    Emitter sun = emitter(EmitterType::directional);
    sun.direction = {0, -1, 0};
    put(scene.emitters, sun);
    sun = emitter(EmitterType::sun);
    sun.toWorld = Transform();
    sun.direction = {0, 0, 1};
    sun.angularRadius = 0.01f;
    sun.group = "day & night";
    put(scene.emitters, sun);
    Emitter lamp = emitter(EmitterType::goniometric);
    lamp.image = {4};
    lamp.scale = 1.7f;
    lamp.group = "lamps";
    put(scene.emitters, lamp);
    Emitter projector = emitter(EmitterType::projector);
    projector.radiance = bitmaps_[0];
    projector.scale = 3.3f;
    projector.fov = random();
    put(scene.emitters, projector);
    Emitter sky = emitter(EmitterType::environment);
    sky.radiance = Rgb(0.f);
    sky.image = {4};
    sky.scale = 0.77f;
    put(scene.emitters, sky);
    for (Emitter& e : scene.emitters)
      if (e.type == EmitterType::environment || e.type == EmitterType::projector) {
        e.radiance = e.type == EmitterType::projector ? e.radiance : Emitter().radiance;
      }
  }

  void addCameras() {
    for (int i = 0; i < 6; ++i) {
      Camera c;
      c.name = i < 2 ? "view" : "";
      c.filter = static_cast<PixelFilter>(i);
      c.toWorld = Transform(*lookAt({random(), 2, 3}, {0, random(), 0}, {0, 1, 0}));
      c.fovX = 0.2f + random();
      c.principalPointOffset = {0.1f * random(), -0.2f};
      c.focusDistance = 3.3f;
      c.nearClip = 0.05f, c.farClip = 1234.5f;
      c.width = 100 + i, c.height = 77;
      if (i == 1)
        c.type = CameraType::orthographic, c.fovX = Camera().fovX, c.principalPointOffset = {};
      if (i == 2) c.apertureRadius = 0.031f;
      if (i == 3) c.cropX0 = 5, c.cropY0 = 6, c.cropX1 = 50, c.cropY1 = 60;
      if (c.filter != PixelFilter::mitchell && c.filter != PixelFilter::catmullRom)
        c.filterRadius = i == 5 ? 3.f : 0.7f + static_cast<float>(i);
      c.spp = 16 * i;
      scene.cameras.push_back(c);
    }
  }

  std::mt19937 random_{9};
  std::vector<TextureHandle> bitmaps_;
  TextureHandle checker_, scaled_, combined_, second_, attribute_;
};

TEST(MitsubaWriter, EverythingComesBack) {
  const TemporaryFolder folder;
  const Scene scene = Everything().scene;
  expectSame(scene, folder.path("deep/new folder"));
}

TEST(MitsubaWriter, WritingTwiceGivesTheSameBytes) {
  const TemporaryFolder folder;
  const Scene scene = Everything().scene;
  const auto bytes = [&](const std::string& name) {
    std::ifstream in(folder.path(name + "/scene.xml"));
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  io::writeMitsuba(folder.path("a"), scene);
  io::writeMitsuba(folder.path("b"), scene);
  EXPECT_GT(bytes("a").size(), 1000u);
  EXPECT_EQ(bytes("a"), bytes("b"));
}

TEST(MitsubaWriter, UnwritableFoldersAreRuntimeErrors) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  const Scene scene = builtin::builtinScene("cornell", 0.05f);
  const std::string target = folder.path("file/scene");
  EXPECT_TRUE(contains(messageOf<RuntimeError>([&] { io::writeMitsuba(target, scene); }), target));
}

TEST(MitsubaWriter, RealScenes) {
  const std::string data = test::sharedFolder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  for (const char* name : {"cornell-box", "veach-bidir", "tire-fairylights"}) {
    std::string file;
    for (const auto& entry :
         std::filesystem::directory_iterator(data + "/data/scenes/mitsuba/" + name))
      if (entry.path().extension() == ".xml") file = entry.path().string();
    Context context;
    const Scene scene = io::readMitsuba(file, {}, context);
    const TemporaryFolder folder;
    io::writeMitsuba(folder.path(name), scene);
    const Scene copy = readBack(folder.path(name));
    EXPECT_EQ(triangleCount(copy), triangleCount(scene)) << name;
    EXPECT_TRUE(test::SceneText(copy).all() == test::SceneText(scene).all()) << name;
  }
}

}  // namespace
}  // namespace lobelia

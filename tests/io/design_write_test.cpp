// Designs written and read again: the same values, whatever was changed.
#include <fstream>

#include "io/mitsuba_scene.h"
#include "lobelia/base/random.h"
#include "lobelia/io/design.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/mitsuba/design_changes.h"

namespace lobelia {
namespace {

using io::mitsuba::sameCamera;
using io::mitsuba::sameEmitter;
using io::mitsuba::sameMaterial;

constexpr int kTypes = static_cast<int>(MaterialType::null) + 1;

Rgb randomColor(Rng& random) { return {random.next1D(), random.next1D() * 0.9f, random.next1D()}; }

// A material of every type and one of every kind of emitter; some named, some not, two alike.
Scene everything() {
  Scene scene;
  for (int type = 0; type < kTypes; ++type) {
    Material inner;
    const uint32_t at = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(inner);
    scene.materials.push_back(inner);
    Material m;
    m.type = static_cast<MaterialType>(type);
    m.name = type % 3 == 0 ? "" : type % 3 == 1 ? "twin" : "name " + std::to_string(type);
    if (m.type >= MaterialType::twoSided && m.type != MaterialType::null) m.a = {at};
    if (m.type == MaterialType::twoSided || m.type == MaterialType::blend) m.b = {at + 1};
    if (m.type == MaterialType::bump || m.type == MaterialType::normalMap) m.map = {0};
    if (m.type == MaterialType::sphericalGaussians) m.capturedLobes.resize(2);
    scene.materials.push_back(m);
  }
  Image image;
  image.name = "nowhere.exr";
  image.width = 2, image.height = 1;
  image.pixels = {0.1f, 0.2f, 0.3f, 1, 2, 3};
  scene.images.push_back(image);
  Texture bitmap;
  bitmap.type = TextureType::bitmap;
  bitmap.image = {0};
  scene.textures.push_back(bitmap);
  for (const EmitterType type :
       {EmitterType::point, EmitterType::spot, EmitterType::directional, EmitterType::constant,
        EmitterType::environment, EmitterType::projector, EmitterType::goniometric,
        EmitterType::sun, EmitterType::area, EmitterType::point}) {
    Emitter e;
    e.type = type;
    e.name = type == EmitterType::point ? "" : "e" + std::to_string(static_cast<int>(type));
    if (type != EmitterType::environment) e.radiance = Rgb(1.f);
    if (type == EmitterType::environment || type == EmitterType::goniometric) e.image = {0};
    scene.emitters.push_back(e);
  }
  scene.cameras.resize(2);
  scene.cameras[1].name = "second";
  for (uint32_t i = 2; i < scene.materials.size(); i += 3)
    scene.instances.emplace_back().material = {i};
  return scene;
}

// Of the fields that the type of a material has in files.
void vary(Material& m, Rng& random) {
  const auto number = [&] { return random.next1D() * 0.9f + 0.05f; };
  switch (m.type) {
    case MaterialType::diffuse:
      m.diffuse = randomColor(random);
      break;
    case MaterialType::roughConductor:
    case MaterialType::coatedConductor:
    case MaterialType::ward:
      m.alphaU = number(), m.alphaV = number();
      [[fallthrough]];
    case MaterialType::conductor:
    case MaterialType::plastic:
    case MaterialType::roughPlastic:
    case MaterialType::phong:
      m.specular = randomColor(random);
      break;
    case MaterialType::dielectric:
    case MaterialType::thinDielectric:
    case MaterialType::roughDielectric:
    case MaterialType::diffuseTransmitter:
      m.transmittance = randomColor(random);
      break;
    case MaterialType::principled:
    case MaterialType::metallicRoughness:
      m.diffuse = randomColor(random);
      m.roughness = number(), m.clearcoat = number(), m.anisotropic = number();
      break;
    case MaterialType::sphericalGaussians:
      m.capturedLobes[0].amplitude = randomColor(random);
      m.capturedLobes[1].sharpness = 100 * number();
      break;
    case MaterialType::mask:
      m.opacity = number();
      break;
    case MaterialType::blend:
      m.weight = number();
      break;
    case MaterialType::bump:
      m.scale = number();
      break;
    case MaterialType::normalMap:
      m.map = {0};
      break;
    case MaterialType::twoSided:
    case MaterialType::null:
      break;
  }
}

void vary(Emitter& e, Rng& random) {
  if (e.type != EmitterType::environment) e.radiance = randomColor(random);
  if (e.type == EmitterType::environment || e.type == EmitterType::projector)
    e.scale = 0.5f + random.next1D();
  if (e.type == EmitterType::point)
    e.toWorld = Transform(translation({static_cast<double>(random.next1D()), 1, 2}));
}

std::string contentsOf(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Read {
  Scene scene;
  std::string text;
};
Read writtenAndRead(const TemporaryFolder& folder, const Scene& before, const Scene& now) {
  const std::string file = folder.path("design.xml");
  io::writeDesign(file, before, now);
  Read out{before, contentsOf(file)};
  Context context;
  io::applyDesign(file, {}, out.scene, context);
  for (const Finding& f : out.scene.findings) ADD_FAILURE() << f.message << "\n" << out.text;
  return out;
}

void expectSame(const Scene& now, const Read& read) {
  // Textures and images that the file names are read anew.
  const auto pixels = [](const Scene& scene, ImageHandle h) {
    return h.valid() ? scene[h].pixels : std::vector<float>{};
  };
  for (uint32_t i = 0; i < now.materials.size(); ++i) {
    Material m = read.scene.materials[i];
    if (m.map.valid()) {
      EXPECT_EQ(pixels(read.scene, read.scene[m.map].image), now.images[0].pixels);
      m.map = now.materials[i].map;
    }
    EXPECT_TRUE(sameMaterial(now.materials[i], m)) << i << "\n" << read.text;
    EXPECT_EQ(now.materials[i].name, m.name);
  }
  ASSERT_EQ(read.scene.emitters.size(), now.emitters.size()) << read.text;
  for (size_t i = 0; i < now.emitters.size(); ++i) {
    Emitter e = read.scene.emitters[i];
    EXPECT_EQ(pixels(read.scene, e.image), pixels(now, now.emitters[i].image));
    e.image = now.emitters[i].image;
    EXPECT_TRUE(sameEmitter(e, now.emitters[i])) << i << "\n" << read.text;
  }
  ASSERT_EQ(read.scene.cameras.size(), now.cameras.size());
  for (size_t i = 0; i < now.cameras.size(); ++i) {
    EXPECT_TRUE(sameCamera(read.scene.cameras[i], now.cameras[i])) << i << "\n" << read.text;
    EXPECT_EQ(read.scene.cameras[i].name, now.cameras[i].name);
  }
}

TEST(DesignWriter, NothingChangedIsAnEmptyDesign) {
  const TemporaryFolder folder;
  const Scene scene = everything();
  const Read read = writtenAndRead(folder, scene, scene);
  EXPECT_EQ(read.text.find("id="), std::string::npos) << read.text;
  EXPECT_EQ(hash(read.scene), hash(scene));
}

TEST(DesignWriter, EveryChangeOfEveryKindReadsBack) {
  const TemporaryFolder folder;
  const Scene before = everything();
  for (uint64_t seed = 0; seed < 12; ++seed) {
    Rng random(seed);
    Scene now = before;
    for (Material& m : now.materials)
      if (random.next1D() < 0.4f) vary(m, random);
    for (Emitter& e : now.emitters)
      if (random.next1D() < 0.5f) vary(e, random);
    if (random.next1D() < 0.5f) now.cameras[0].fovX = 0.5f + random.next1D();
    if (random.next1D() < 0.5f)
      now.cameras[1].toWorld =
          Transform(*lookAt({1, static_cast<double>(random.next1D()), 3}, {0, 0, 0}, {0, 1, 0}));
    Emitter added;
    added.name = "added";
    added.radiance = randomColor(random);
    if (random.next1D() < 0.5f) now.emitters.push_back(added);
    expectSame(now, writtenAndRead(folder, before, now));
  }
}

// What is wrapped stays the scene's, which later edits of it by its name then show.
TEST(DesignWriter, WrappedMaterialsStayTheScenes) {
  const TemporaryFolder folder;
  Scene before;
  before.materials.resize(2);
  before.materials[0].name = "wall";
  before.materials[1].type = MaterialType::mask;
  before.materials[1].a = {0};
  Scene now = before;
  now.materials[1].opacity = 0.25f;
  Read read = writtenAndRead(folder, before, now);
  EXPECT_EQ(read.scene.materials[1].a.index, 0u) << read.text;
  EXPECT_EQ(read.scene.materials[1].opacity.value, 0.25f);
  now.materials[0].diffuse = Rgb(0.75f);
  read = writtenAndRead(folder, before, now);
  EXPECT_EQ(read.scene.materials[1].a.index, 0u) << read.text;
  EXPECT_EQ(read.scene.materials[0].diffuse.value.x, 0.75f);
  // A new one around the inner one: index 0 now wraps what it was.
  Material outer;
  outer.type = MaterialType::mask, outer.name = "wall", outer.a = {2}, outer.opacity = 0.5f;
  now.materials.push_back(now.materials[0]);
  now.materials[2].name.clear();
  now.materials[0] = outer;
  read = writtenAndRead(folder, before, now);
  EXPECT_EQ(read.scene.materials[1].a.index, 0u) << read.text;
  EXPECT_EQ(read.scene.materials[0].type, MaterialType::mask);
  EXPECT_EQ(read.scene[read.scene.materials[0].a].diffuse.value.x, 0.75f);
}

// From where they come, when they are read as the same from there; else beside the design.
TEST(DesignWriter, ImagesAreNamedWhereTheyComeFrom) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("images"));
  io::writePng(folder.path("images/grey.png"), std::vector<uint8_t>{10, 20, 30, 40, 50, 60}, 2, 1);
  for (const bool raw : {false, true}) {
    Scene before;
    before.materials.resize(1);
    Scene now = before;
    now.images.push_back(io::readImage(folder.path("images/grey.png"), {.raw = raw}));
    Texture texture;
    texture.type = TextureType::bitmap;
    texture.image = {0};
    now.textures.push_back(texture);
    now.materials[0].diffuse = TextureHandle{0};
    const Read read = writtenAndRead(folder, before, now);
    EXPECT_NE(read.text.find("\"images/grey.png\""), std::string::npos) << read.text;
    EXPECT_EQ(read.scene.images.at(0).pixels, now.images[0].pixels);
    EXPECT_FALSE(std::filesystem::exists(folder.path("design_textures")));
  }
}

TEST(DesignWriter, OtherImagesAreKeptBesideAndNeverWrittenOver) {
  const TemporaryFolder folder;
  Scene before;
  before.materials.resize(2);
  Scene now = before;
  for (const float value : {0.25f, 0.75f}) {
    Image image;
    image.name = "made";
    image.width = image.height = 1, image.channels = 1;
    image.pixels = {value};
    now.images.push_back(image);
    Texture texture;
    texture.type = TextureType::bitmap;
    texture.image = {static_cast<uint32_t>(now.images.size() - 1)};
    now.textures.push_back(texture);
  }
  now.materials[0].diffuse = TextureHandle{0};
  now.materials[1].diffuse = TextureHandle{1};
  for (int again = 0; again < 2; ++again) {
    const Read read = writtenAndRead(folder, before, now);
    for (uint32_t i = 0; i < 2; ++i)
      EXPECT_EQ(read.scene[read.scene[read.scene.materials[i].diffuse.texture].image].pixels,
                now.images[i].pixels);
    size_t files = 0;
    for ([[maybe_unused]] const auto& f :
         std::filesystem::directory_iterator(folder.path("design_textures")))
      ++files;
    EXPECT_EQ(files, 2u) << "again the same";
  }
  std::swap(now.materials[0].diffuse, now.materials[1].diffuse);
  now.images[0].pixels = {0.5f};
  const Read read = writtenAndRead(folder, before, now);
  EXPECT_EQ(read.scene[read.scene[read.scene.materials[1].diffuse.texture].image].pixels[0], 0.5f);
}

TEST(DesignWriter, PlacesAreNames) {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[0].name = "material[1]";  // a name goes before a place
  EXPECT_EQ(io::namedInDesign(scene.materials, "material[1]"), std::vector<size_t>{0});
  EXPECT_EQ(io::namedInDesign(scene.materials, "material[2]"), std::vector<size_t>{2});
  EXPECT_TRUE(io::namedInDesign(scene.materials, "material[3]").empty());
  EXPECT_TRUE(io::namedInDesign(scene.materials, "emitter[0]").empty());
  EXPECT_EQ(io::designName(scene.materials, 2), "material[2]");
}

TEST(DesignWriter, FailsWholeWhereItCannotWrite) {
  const TemporaryFolder folder;
  Scene now;
  EXPECT_THROW(io::writeDesign(folder.path("none/design.xml"), now, now), RuntimeError);
  EXPECT_FALSE(std::filesystem::exists(folder.path("none")));
}

}  // namespace
}  // namespace lobelia

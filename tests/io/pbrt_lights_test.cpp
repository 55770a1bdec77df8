// PBRT files: lights.
#include <gtest/gtest.h>

#include <cmath>

#include "io/pbrt_scene.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/pbrt/octahedral.h"

namespace lobelia::test {
namespace {

Emitter onlyLight(const std::string& text) {
  const Scene scene = readPbrtWorld("LightSource " + text);
  EXPECT_TRUE(scene.findings.empty()) << findingsOf(scene);
  return scene.emitters.at(0);
}

TEST(PbrtLights, LevelsOfSpectra) {
  // A black body, a flat spectrum and a named illuminant all have Y = scale.
  for (const char* spectrum :
       {"\"blackbody I\" 3000", "\"spectrum I\" [300 7 900 7]", "\"spectrum I\" \"stdillum-A\"",
        "\"spectrum I\" \"stdillum-F11\""}) {
    const Rgb c = colorOf(onlyLight(std::string("\"point\" \"float scale\" 3 ") + spectrum));
    EXPECT_NEAR(luminance(c), 3, 0.03) << spectrum;
  }
  // Illuminant A is a black body of 2856 K, D65 is white.
  expectNear(colorOf(onlyLight("\"point\" \"blackbody I\" 2856")),
             colorOf(onlyLight("\"point\" \"spectrum I\" \"stdillum-A\"")), 0.01f);
  expectNear(colorOf(onlyLight("\"point\" \"spectrum I\" \"stdillum-D65\"")), Rgb(1.f), 0.01f);
  expectNear(colorOf(onlyLight("\"point\" \"rgb I\" [1 2 3]")), {1, 2, 3});
  expectNear(colorOf(onlyLight("\"point\"")), Rgb(1.f));
  expectNear(colorOf(onlyLight("\"point\" \"float power\" 100")), Rgb(100 / (4 * kPi)));
  EXPECT_TRUE(contains(pbrtRefusal("LightSource \"point\" \"blackbody I\" -5"), "kelvin"));
  EXPECT_TRUE(contains(pbrtRefusal("LightSource \"pont\""), "did you mean 'point'?"));
}

TEST(PbrtLights, ColourSpaces) {
  // White of Rec. 2020 is D65; its green is outside of sRGB.
  const Scene scene = readPbrtWorld(
      "ColorSpace \"rec2020\" LightSource \"point\" \"rgb I\" [2 2 2] "
      "LightSource \"point\" \"rgb I\" [0 1 0]");
  expectNear(colorOf(scene.emitters.at(0)), Rgb(2.f), 1e-3f);
  EXPECT_EQ(colorOf(scene.emitters.at(1)).x, 0);
  EXPECT_GT(colorOf(scene.emitters.at(1)).y, 1.1f);
}

TEST(PbrtLights, PointAndDistant) {
  const Emitter point = onlyLight("\"point\" \"point3 from\" [1 2 3]");
  expectNear(point.toWorld.point({}), {1, 2, 3});
  const Emitter distant = onlyLight(
      "\"distant\" \"point3 from\" [0 5 0] \"point3 to\" [0 0 0] \"float illuminance\" 7");
  EXPECT_EQ(distant.type, EmitterType::directional);
  expectNear(distant.direction, {0, -1, 0});
  expectNear(colorOf(distant), Rgb(7.f));
}

TEST(PbrtLights, SpotsFallOffSmoothly) {
  const Scene scene = readPbrtWorld(
      "LightSource \"spot\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 "
      "0] \"float coneangle\" 30 \"float conedeltaangle\" 10");
  const Emitter& spot = scene.emitters.at(0);
  EXPECT_EQ(spot.type, EmitterType::spot);
  expectNear(normalize(spot.toWorld.vector({0, 0, 1})), {0, 0, -1});
  for (const float degrees : {0.f, 15.f, 22.f, 25.f, 29.f}) {
    TextureContext at;
    at.uv = {.5f + .5f * std::tan(degrees * kPi / 180) / std::tan(spot.cutoff), .5f};
    const float end = std::cos(30 * kPi / 180), start = std::cos(20 * kPi / 180);
    const float t = std::clamp((std::cos(degrees * kPi / 180) - end) / (start - end), 0.f, 1.f);
    EXPECT_NEAR(evaluate(scene, spot.pattern, at).x, t * t * (3 - 2 * t), 0.01f) << degrees;
  }
  const Scene wide = readPbrtWorld("LightSource \"spot\" \"float coneangle\" 120");
  EXPECT_EQ(wide.emitters.at(0).type, EmitterType::goniometric);
  const Image& image = wide.images.at(0);
  EXPECT_EQ(image.at(0, 0, 0), 1);
  EXPECT_EQ(image.at(0, image.height * 121 / 180, 0), 0);
  // A delta above the cone: the smooth step starts on the far side of the axis.
  const Scene narrow = readPbrtWorld("LightSource \"spot\" \"float coneangle\" 3");
  const Emitter& beam = narrow.emitters.at(0);
  ASSERT_EQ(beam.type, EmitterType::spot);
  const auto cosine = [](float degrees) { return std::cos(degrees * kPi / 180); };
  for (const float degrees : {1.5f, 2.5f}) {
    TextureContext at;
    at.uv = {.5f + .5f * std::tan(degrees * kPi / 180) / std::tan(beam.cutoff), .5f};
    const float t = std::min((cosine(degrees) - cosine(3)) / (cosine(-2) - cosine(3)), 1.f);
    EXPECT_NEAR(evaluate(narrow, beam.pattern, at).x, t * t * (3 - 2 * t), 0.01f) << degrees;
  }
  // Above twice the cone PBRT's formula lights the outside.
  const Scene inverse =
      readPbrtWorld("LightSource \"spot\" \"float coneangle\" 10 \"float conedeltaangle\" 40");
  ASSERT_EQ(inverse.emitters.at(0).type, EmitterType::goniometric);
  const Image& outside = inverse.images.at(0);
  EXPECT_EQ(outside.at(0, 0, 0), 0);
  EXPECT_EQ(outside.at(0, outside.height / 2, 0), 1);
  EXPECT_TRUE(contains(pbrtRefusal("LightSource \"spot\" \"float coneangle\" 200"), "impossible"));
  EXPECT_TRUE(
      contains(pbrtRefusal("LightSource \"spot\" \"float conedeltaangle\" -1"), "impossible"));
}

TEST(PbrtLights, Octahedral) {
  for (uint32_t i = 0; i < 2000; ++i) {
    const float z = 1 - 2 * (static_cast<float>(i) + .5f) / 2000,
                phi = 2.4f * static_cast<float>(i);
    const float s = std::sqrt(1 - z * z);
    const Vec3f d{s * std::cos(phi), s * std::sin(phi), z};
    expectNear(io::pbrt::directionFromOctahedral(io::pbrt::octahedralFromDirection(d)), d, 1e-3f);
  }
  // Known places (Clarberg 2008): +z in the middle, -z in the corners, +x right of the middle.
  expectNear(io::pbrt::directionFromOctahedral({.5f, .5f}), {0, 0, 1});
  expectNear(io::pbrt::directionFromOctahedral({0, 0}), {0, 0, -1});
  expectNear(io::pbrt::directionFromOctahedral({1, .5f}), {1, 0, 0});
  expectNear(io::pbrt::directionFromOctahedral({.5f, 1}), {0, 1, 0});
}

// An image whose colours are the directions, (d + 1) / 2.
std::string writeDirections(const TemporaryFolder& folder, int size) {
  std::vector<uint8_t> pixels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Vec3f d = io::pbrt::directionFromOctahedral(
          {(static_cast<float>(x) + .5f) / static_cast<float>(size),
           (static_cast<float>(y) + .5f) / static_cast<float>(size)});
      for (int c = 0; c < 3; ++c)
        pixels.push_back(static_cast<uint8_t>(std::lround(127.5f * (d[c] + 1))));
    }
  io::writePng(folder.path("d.png"), pixels, size, size);
  return "d.png";
}

TEST(PbrtLights, InfiniteImagesKeepTheirOrientation) {
  const TemporaryFolder folder;
  writeDirections(folder, 128);
  const Scene scene = readPbrtText(folder,
                                   "WorldBegin Rotate 90 1 0 0 LightSource \"infinite\" "
                                   "\"string filename\" \"d.png\" \"float scale\" 3");
  const Emitter& e = scene.emitters.at(0);
  ASSERT_EQ(e.type, EmitterType::environment);
  EXPECT_FLOAT_EQ(e.scale, 3);
  const Image& image = scene[e.image];
  const auto encode = [](float v) {  // 8 bit sRGB to linear
    const float s = (v + 1) / 2;
    return s <= .04045f ? s / 12.92f : std::pow((s + .055f) / 1.055f, 2.4f);
  };
  for (int y = 3; y < image.height; y += 11)
    for (int x = 0; x < image.width; x += 13) {
      const float phi = (static_cast<float>(x) + .5f) / static_cast<float>(image.width) * kTwoPi;
      const float theta = static_cast<float>(y) / static_cast<float>(image.height - 1) * kPi;
      // Local axes of our environments (scene/emitter.h: Mitsuba's).
      const Vec3f d{std::sin(phi) * std::sin(theta), std::cos(theta),
                    -std::cos(phi) * std::sin(theta)};
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, y, c), encode(d[c]), 0.04f);
    }
  expectNear(e.toWorld.vector({0, 1, 0}), {0, 0, 1});
}

TEST(PbrtLights, InfiniteLevels) {
  const Emitter sky = onlyLight("\"infinite\" \"rgb L\" [1 2 3] \"float scale\" 2");
  EXPECT_EQ(sky.type, EmitterType::constant);
  expectNear(colorOf(sky), {2, 4, 6});
  expectNear(colorOf(onlyLight("\"infinite\" \"float illuminance\" 3.14159265")), Rgb(1.f));
  const Scene sum = readPbrtWorld(
      "LightSource \"infinite\" \"rgb L\" [1 2 3] LightSource "
      "\"infinite\" \"rgb L\" [1 1 1]");
  ASSERT_EQ(sum.emitters.size(), 1u);
  expectNear(colorOf(sum.emitters[0]), {2, 3, 4});
  EXPECT_TRUE(
      contains(findingsOf(readPbrtWorld("LightSource \"infinite\" \"point3 portal\" [0 0 0 1 "
                                        "0 0 1 1 0 0 1 0]")),
               "portal"));
  const TemporaryFolder folder;
  writeDirections(folder, 16);
  const Scene both = readPbrtText(folder,
                                  "WorldBegin LightSource \"infinite\" \"rgb L\" [5 5 5] "
                                  "LightSource \"infinite\" \"string filename\" \"d.png\" "
                                  "\"float scale\" 2");
  ASSERT_EQ(both.emitters.size(), 1u);
  EXPECT_EQ(both.emitters[0].type, EmitterType::environment);
  EXPECT_GE(both.images.at(0).at(3, 3, 0), 2.5f);
  io::writePng(folder.path("wide.png"), std::vector<uint8_t>(24), 4, 2);
  EXPECT_TRUE(contains(
      messageOf<InputError>([&] {
        readPbrtText(folder,
                     "WorldBegin LightSource \"infinite\" \"string filename\" \"wide.png\"");
      }),
      "square"));
}

// PBRT takes 2 pi over the pixels' number times the sum of luminance and cosine over the upper
// ones: pi / 2 for an even image of 1.
TEST(PbrtLights, IlluminanceOfMapsIsPbrts) {
  const TemporaryFolder folder;
  io::writePng(folder.path("white.png"), std::vector<uint8_t>(size_t{64} * 64 * 3, 255), 64, 64);
  const Scene scene = readPbrtText(folder,
                                   "WorldBegin LightSource \"infinite\" \"string filename\" "
                                   "\"white.png\" \"float illuminance\" 10");
  EXPECT_NEAR(scene.emitters.at(0).scale, 10 / (kPi / 2), 0.01f);
}

TEST(PbrtLights, GoniometricAndProjection) {
  const TemporaryFolder folder;
  // Light only into the upper part of the image's sphere, its z, which is the light's y.
  constexpr int kSize = 64;
  std::vector<uint8_t> pixels;
  float lit = 0;
  for (int i = 0; i < kSize * kSize; ++i) {
    const Vec3f d =
        io::pbrt::directionFromOctahedral({(static_cast<float>(i % kSize) + .5f) / kSize,
                                           (static_cast<float>(i / kSize) + .5f) / kSize});
    lit += d.z > 0 ? 1.f / (kSize * kSize) : 0.f;
    for (int c = 0; c < 3; ++c) pixels.push_back(d.z > 0 ? 255 : 0);
  }
  io::writePng(folder.path("g.png"), pixels, kSize, kSize);
  const Scene scene = readPbrtText(folder,
                                   "WorldBegin LightSource \"goniometric\" \"string "
                                   "filename\" \"g.png\" \"float power\" 10");
  const Emitter& gonio = scene.emitters.at(0);
  ASSERT_EQ(gonio.type, EmitterType::goniometric);
  EXPECT_NEAR(lit, 0.5f, 0.02f);
  EXPECT_NEAR(colorOf(gonio).x, 10 / (4 * kPi * lit), 0.001f);
  const Image& image = scene[gonio.image];
  EXPECT_EQ(image.at(image.width / 4, image.height / 2, 0), 1);      // azimuth 90 degrees: +y
  EXPECT_EQ(image.at(3 * image.width / 4, image.height / 2, 0), 0);  // -y

  io::writePng(folder.path("p.png"), {255, 255, 255, 0, 0, 0}, 2, 1);
  const Scene projection = readPbrtText(folder,
                                        "WorldBegin LightSource \"projection\" \"string "
                                        "filename\" \"p.png\" \"float fov\" 60");
  const Emitter& p = projection.emitters.at(0);
  ASSERT_EQ(p.type, EmitterType::projector);
  EXPECT_NEAR(std::tan(p.fov / 2), 2 * std::tan(kPi / 6), 1e-5f);  // fov of the shorter side
  // Left in the picture is white and lies at the light's -x; our uv grow towards local -x.
  TextureContext at;
  at.uv = {.49f, .5f};
  EXPECT_NEAR(evaluate(projection, p.radiance, at).x, 1 / kPi, 0.01f);
  at.uv = {.6f, .5f};
  EXPECT_EQ(evaluate(projection, p.radiance, at).x, 0);
  expectNear(p.toWorld.vector({1, 0, 0}), {-1, 0, 0});
}

// A lobe comes out where it is in the file, in the middle of the texels weighted by solid angle.
TEST(PbrtLights, LobesKeepTheirDirections) {
  constexpr int kSize = 64;
  for (const float theta : {0.35f, 1.f, 2.8f}) {
    const Vec3f axis{std::sin(theta) * 0.6f, std::sin(theta) * 0.8f, std::cos(theta)};
    Image square;
    square.width = square.height = kSize, square.channels = 1;
    for (int i = 0; i < kSize * kSize; ++i) {
      const Vec3f d =
          io::pbrt::directionFromOctahedral({(static_cast<float>(i % kSize) + .5f) / kSize,
                                             (static_cast<float>(i / kSize) + .5f) / kSize});
      square.pixels.push_back(std::exp(60 * (dot(d, axis) - 1)));
    }
    const auto middle = [](const Image& image, const auto& direction) {
      Vec3f sum{};
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {  // where path/spherical_image.h puts them
          const float angle = kPi * static_cast<float>(y) / static_cast<float>(image.height - 1);
          const float phi =
              kTwoPi * (static_cast<float>(x) + .5f) / static_cast<float>(image.width);
          sum += direction(std::sin(angle), std::cos(angle), phi) *
                 (image.at(x, y, 0) * std::sin(angle));
        }
      return normalize(sum);
    };
    const Vec3f beam =  // the file's z is the light's y
        middle(io::pbrt::goniometricFromOctahedral(square), [](float s, float c, float phi) {
          return Vec3f(s * std::cos(phi), c, s * std::sin(phi));
        });
    EXPECT_LT(std::acos(std::min(dot(beam, axis), 1.f)), 0.006f) << theta;
    const Vec3f sun =
        middle(io::pbrt::environmentFromOctahedral(square), [](float s, float c, float phi) {
          return Vec3f(s * std::sin(phi), c, -s * std::cos(phi));
        });
    EXPECT_LT(std::acos(std::min(dot(sun, axis), 1.f)), 0.006f) << theta;
  }
}

TEST(PbrtLights, AreaLights) {
  const Scene shared = readPbrtWorld(
      std::string("AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2\n") + kTriangle +
      kTriangle);
  EXPECT_EQ(shared.emitters.size(), 1u);
  expectNear(colorOf(shared.emitters.at(0)), {2, 4, 6});
  EXPECT_EQ(shared.instances.at(1).emitter.index, 0u);

  const Scene power =
      readPbrtWorld(std::string("AreaLightSource \"diffuse\" \"float power\" 10\n") + kTriangle +
                    "Scale 2 2 2\n" + kTriangle);
  ASSERT_EQ(power.emitters.size(), 2u);
  EXPECT_NEAR(colorOf(power.emitters[0]).x, 10 / (kPi * .5f), 1e-3f);
  EXPECT_NEAR(colorOf(power.emitters[1]).x, 10 / (kPi * 2), 1e-3f);

  // As in PBRT each triangle has that power, and each patch; a sphere is one shape.
  const auto radianceOf = [](const std::string& shape, bool isUneven) {
    const Scene scene = readPbrtWorld("AreaLightSource \"diffuse\" \"float power\" 10\n" + shape);
    EXPECT_EQ(contains(findingsOf(scene), "differ in area"), isUneven);
    return colorOf(scene.emitters.at(0)).x;
  };
  const std::string corners = "\"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] ";
  EXPECT_NEAR(
      radianceOf("Shape \"trianglemesh\" " + corners + "\"integer indices\" [0 1 2 1 3 2]", false),
      20 / kPi, 1e-3f);
  EXPECT_NEAR(radianceOf("Shape \"bilinearmesh\" " + corners, false), 10 / kPi, 1e-3f);
  EXPECT_NEAR(radianceOf("Shape \"sphere\"", false), 10 / (4 * kPi * kPi), 1e-2f);
  EXPECT_NEAR(radianceOf("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 0 -3 0] \"integer "
                         "indices\" [0 1 2 0 3 1]",
                         true),
              20 / (2 * kPi), 1e-3f);

  const Scene both = readPbrtWorld(
      std::string("AreaLightSource \"diffuse\" \"bool twosided\" true\n") + kTriangle);
  ASSERT_EQ(both.instances.size(), 2u);
  EXPECT_NE(both.instances[0].flipNormals, both.instances[1].flipNormals);
  EXPECT_LT(both[both.instances[1].mesh].positions[0].z, 0);

  EXPECT_TRUE(contains(pbrtRefusal("AreaLightSource \"difuse\""), "unknown area light"));
  const Scene object =
      readPbrtWorld(std::string("AreaLightSource \"diffuse\" ObjectBegin \"o\"\n") + kTriangle +
                    "ObjectEnd ObjectInstance \"o\"");
  EXPECT_TRUE(contains(findingsOf(object), "do not shine"));
  EXPECT_FALSE(object.instances.at(0).emitter.valid());
}

}  // namespace
}  // namespace lobelia::test

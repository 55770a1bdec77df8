// Textures against values worked out by hand from Mitsuba's rules.
#include "lobelia/scene/texture.h"

#include <gtest/gtest.h>

#include <limits>

#include "lobelia/base/random.h"
#include "support/shapes.h"

namespace lobelia {
namespace {

// 3 x 2 grey pixels: 1 2 3 / 4 5 6, the first row at v = 0.
Scene imageScene(Filter filter, Wrap wrap) {
  Scene scene;
  Image image;
  image.width = 3, image.height = 2, image.channels = 1;
  image.pixels = {1, 2, 3, 4, 5, 6};
  scene.images.push_back(image);
  Texture t;
  t.type = TextureType::bitmap;
  t.image = {0};
  t.filter = filter, t.wrapU = t.wrapV = wrap;
  scene.textures.push_back(t);
  return scene;
}

float at(const Scene& scene, float u, float v, uint32_t texture = 0) {
  TextureContext context;
  context.uv = {u, v};
  return evaluate(scene, FloatParam(TextureHandle{texture}), context);
}

TEST(Texture, NearestReadsTheTexelThatHoldsThePoint) {
  const Scene s = imageScene(Filter::nearest, Wrap::repeat);
  EXPECT_EQ(at(s, 0.01f, 0.01f), 1);  // v = 0 is the first row
  EXPECT_EQ(at(s, 0.5f, 0.49f), 2);
  EXPECT_EQ(at(s, 0.99f, 0.99f), 6);
  EXPECT_EQ(at(s, 1.01f, -0.01f), 4);
}

TEST(Texture, BilinearMeetsTexelsAtTheirCentres) {
  const Scene s = imageScene(Filter::bilinear, Wrap::repeat);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / 3, v = (static_cast<float>(y) + 0.5f) / 2;
      EXPECT_NEAR(at(s, u, v), static_cast<float>(1 + x + 3 * y), 1e-5f);
    }
  }
  EXPECT_NEAR(at(s, 1.f / 3, 0.25f), 1.5f, 1e-5f);
  EXPECT_NEAR(at(s, 0.5f, 0.5f), 3.5f, 1e-5f);
}

TEST(Texture, WrapModesAtTheBorder) {
  // Half a texel outside the left border and on the first row's centre.
  const float u = -0.5f / 3, v = 0.25f;
  EXPECT_NEAR(at(imageScene(Filter::bilinear, Wrap::repeat), u, v), 3, 1e-5f);
  EXPECT_NEAR(at(imageScene(Filter::bilinear, Wrap::mirror), u, v), 1, 1e-5f);
  EXPECT_NEAR(at(imageScene(Filter::bilinear, Wrap::clamp), u, v), 1, 1e-5f);
  EXPECT_NEAR(at(imageScene(Filter::bilinear, Wrap::zero), u, v), 0, 1e-5f);
  EXPECT_NEAR(at(imageScene(Filter::bilinear, Wrap::one), u, v), 1, 1e-5f);
  EXPECT_NEAR(at(imageScene(Filter::bilinear, Wrap::zero), 0, v), 0.5f, 1e-5f);
  // Mirror: the second repetition runs backwards, the third forwards.
  const Scene mirror = imageScene(Filter::nearest, Wrap::mirror);
  EXPECT_EQ(at(mirror, 1.1f, 0.1f), 3);
  EXPECT_EQ(at(mirror, 1.9f, 0.1f), 1);
  EXPECT_EQ(at(mirror, 2.1f, 0.1f), 1);
  EXPECT_EQ(at(mirror, -1.1f, 0.1f), 3);
}

TEST(Texture, EachAxisWrapsItsWay) {
  Scene s = imageScene(Filter::nearest, Wrap::repeat);
  Texture& t = s.textures[0];
  t.wrapV = Wrap::clamp;
  EXPECT_EQ(at(s, 1.1f, 1.2f), 4);  // row 2 goes on upwards, columns begin again
  EXPECT_EQ(at(s, -0.1f, -0.2f), 3);
  t.wrapU = Wrap::clamp, t.wrapV = Wrap::mirror;
  EXPECT_EQ(at(s, 1.1f, 1.2f), 6);
  EXPECT_EQ(at(s, 1.1f, 1.7f), 3);
  t.wrapU = Wrap::one, t.wrapV = Wrap::zero;
  EXPECT_EQ(at(s, 1.1f, 0.2f), 1);
  EXPECT_EQ(at(s, 0.9f, 1.2f), 0);
  EXPECT_EQ(at(s, 0.9f, 0.2f), 3);
}

TEST(Texture, CoordinatesWithoutMeaningAreSafe) {
  for (const Filter f : {Filter::nearest, Filter::bilinear}) {
    const Scene s = imageScene(f, Wrap::repeat);
    for (const float u : {std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(), 1e30f, -1e30f}) {
      const float value = at(s, u, 0.5f);
      EXPECT_GE(value, 1);
      EXPECT_LE(value, 6);
    }
  }
}

TEST(Texture, UvMatrixMovesTheCoordinates) {
  Scene s = imageScene(Filter::nearest, Wrap::repeat);
  s.textures[0].uvMatrix[0][0] = 0, s.textures[0].uvMatrix[0][1] = 1;  // u' = v + 0.4
  s.textures[0].uvMatrix[0][2] = 0.4f;
  s.textures[0].uvMatrix[1][0] = 1, s.textures[0].uvMatrix[1][1] = 0;  // v' = u
  EXPECT_EQ(at(s, 0.7f, 0.f), 5);
  EXPECT_EQ(at(s, 0.2f, 0.4f), 3);
}

TEST(Texture, AlphaIsReadOnlyWhereAskedFor) {
  Scene s = imageScene(Filter::nearest, Wrap::repeat);
  s.images[0] = {};
  s.images[0].width = s.images[0].height = 1, s.images[0].channels = 4;
  s.images[0].pixels = {0.5f, 0.5f, 0.5f, 0.25f};
  EXPECT_EQ(at(s, 0.5f, 0.5f), 0.5f);
  s.textures[0].alphaChannel = true;
  EXPECT_EQ(at(s, 0.5f, 0.5f), 0.25f);
}

TEST(Texture, CheckerboardAndScale) {
  Scene s;
  s.textures.resize(4);
  s.textures[0].value = Rgb(0.4f), s.textures[1].value = Rgb(0.2f);
  s.textures[2].type = TextureType::checkerboard;
  s.textures[2].a = {0}, s.textures[2].b = {1};
  s.textures[3].type = TextureType::scale;
  s.textures[3].a = {2}, s.textures[3].scale = 2;
  EXPECT_FLOAT_EQ(at(s, 0.25f, 0.25f, 2), 0.4f);
  EXPECT_FLOAT_EQ(at(s, 0.75f, 0.25f, 2), 0.2f);
  EXPECT_FLOAT_EQ(at(s, 0.75f, 0.75f, 2), 0.4f);
  EXPECT_FLOAT_EQ(at(s, -0.25f, 0.25f, 2), 0.2f);
  EXPECT_FLOAT_EQ(at(s, 0.75f, 0.25f, 3), 0.4f);
  EXPECT_NEAR(mean(s, ColorParam(TextureHandle{2})).x, 0.3f, 1e-6f);
  EXPECT_NEAR(mean(s, ColorParam(TextureHandle{3})).x, 0.6f, 1e-6f);
}

TEST(Texture, MeshAttributesOfVerticesAndFaces) {
  Scene s;
  Mesh mesh = test::squareMesh();
  mesh.attributes.push_back({"vertex_color", false, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}});
  mesh.attributes.push_back({"face_grey", true, 1, {0.25f, 0.75f}});
  s.textures.resize(2);
  s.textures[0].type = s.textures[1].type = TextureType::meshAttribute;
  s.textures[0].attribute = "vertex_color", s.textures[1].attribute = "face_grey";
  s.textures[1].scale = 2;
  const TextureContext context{{}, &mesh, 1, {0.25f, 0.5f}};  // triangle 0 2 3
  const Rgb c = evaluate(s, TextureHandle{0}, context);
  EXPECT_FLOAT_EQ(c.x, 0.75f);  // 0.25 * red + 0.25 * blue + 0.5 * white
  EXPECT_FLOAT_EQ(c.y, 0.5f);
  EXPECT_FLOAT_EQ(c.z, 0.75f);
  EXPECT_FLOAT_EQ(evaluate(s, TextureHandle{1}, context).x, 1.5f);
}

TEST(Texture, ChannelsAreReadAlone) {
  Scene s = imageScene(Filter::nearest, Wrap::repeat);
  EXPECT_EQ(at(s, 0.5f, 0.1f), 2);
  s.textures[0].channel = 2;
  EXPECT_EQ(at(s, 0.5f, 0.1f), 2);  // grey: all channels alike
  s.textures[0].channel = 3;
  EXPECT_EQ(at(s, 0.5f, 0.1f), 1);  // opaque
  s.images[0].width = 1, s.images[0].height = 1, s.images[0].channels = 4;
  s.images[0].pixels = {0.1f, 0.2f, 0.3f, 0.4f};
  for (int channel = 0; channel < 4; ++channel) {
    s.textures[0].channel = channel;
    EXPECT_EQ(at(s, 0, 0), s.images[0].pixels[static_cast<size_t>(channel)]);
    EXPECT_EQ(mean(s, ColorParam(TextureHandle{0})),
              Rgb(s.images[0].pixels[static_cast<size_t>(channel)]));
  }
  Mesh mesh = test::squareMesh();
  mesh.attributes.push_back({"vertex_color", false, 3, {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}});
  s.textures[0].type = TextureType::meshAttribute;
  s.textures[0].attribute = "vertex_color";
  const TextureContext context{{}, &mesh, 1, {0.25f, 0.5f}};
  const float expected[] = {1, 2, 3, 1};
  for (int channel = 0; channel < 4; ++channel) {
    s.textures[0].channel = channel;
    EXPECT_EQ(evaluate(s, TextureHandle{0}, context), Rgb(expected[channel]));
  }
}

TEST(Texture, BitmapsTakeTheirUvFromAnAttribute) {
  Scene s = imageScene(Filter::bilinear, Wrap::repeat);
  Mesh mesh = test::squareMesh();
  // The mesh's uv, turned: u' = v, v' = 1 - u.
  MeshAttribute turned{"vertex_uv1", false, 2, {}};
  for (const Vec2f uv : mesh.uvs) turned.values.insert(turned.values.end(), {uv.y, 1 - uv.x});
  mesh.attributes.push_back(turned);
  s.textures.push_back(s.textures[0]);
  s.textures[1].attribute = "vertex_uv1";
  const Vec3u v = mesh.triangles[1];
  const Vec2f b{0.3f, 0.45f};
  const Vec2f uv = mesh.uvs[v.x] * (1 - b.x - b.y) + mesh.uvs[v.y] * b.x + mesh.uvs[v.z] * b.y;
  const TextureContext context{uv, &mesh, 1, b};
  EXPECT_NEAR(evaluate(s, FloatParam(TextureHandle{1}), context), at(s, uv.y, 1 - uv.x), 1e-5f);
  TextureContext there;
  there.uv = {uv.y, 1 - uv.x};
  const Vec2f slope = gradient(s, TextureHandle{0}, there);
  const Vec2f g = gradient(s, TextureHandle{1}, context);
  EXPECT_NEAR(g.x, -slope.y, 1e-4f);
  EXPECT_NEAR(g.y, slope.x, 1e-4f);
  EXPECT_GT(std::abs(slope.x) + std::abs(slope.y), 0.1f);
  // Without the attribute the mesh's own uv serve.
  mesh.attributes.clear();
  EXPECT_EQ(evaluate(s, FloatParam(TextureHandle{1}), context), at(s, uv.x, uv.y));
}

// product, mix and power of an image and constants: values, slopes by differences, means.
TEST(Texture, Combinations) {
  Scene s = imageScene(Filter::bilinear, Wrap::repeat);
  s.textures.resize(7);
  s.textures[1].value = {0.5f, 1, 2};
  s.textures[2].value = Rgb(0.25f);
  s.textures[3].type = TextureType::product;
  s.textures[3].a = {0}, s.textures[3].b = {1};
  s.textures[4].type = TextureType::mix;
  s.textures[4].a = {0}, s.textures[4].b = {2}, s.textures[4].c = {2};
  s.textures[5].type = TextureType::power;
  s.textures[5].a = {4}, s.textures[5].scale = 1.5f;
  s.textures[6].type = TextureType::product;
  s.textures[6].a = {5}, s.textures[6].b = {0};
  TextureContext c;
  c.uv = {0.5f, 0.25f};
  const float image = at(s, 0.5f, 0.25f);
  EXPECT_EQ(evaluate(s, TextureHandle{3}, c), Rgb(0.5f * image, image, 2 * image));
  const float mixed = 0.75f * image + 0.25f * 0.25f;
  EXPECT_FLOAT_EQ(at(s, 0.5f, 0.25f, 4), mixed);
  EXPECT_FLOAT_EQ(at(s, 0.5f, 0.25f, 5), std::pow(mixed, 1.5f));
  EXPECT_NEAR(mean(s, ColorParam(TextureHandle{3})).z, 7, 0.02f);
  EXPECT_NEAR(mean(s, ColorParam(TextureHandle{4})).x, 0.75f * 3.5f + 0.0625f, 0.02f);
  c.uv = {0.37f, 0.4f};
  constexpr float h = 1e-3f;
  const Vec2f g = gradient(s, TextureHandle{6}, c);
  EXPECT_NEAR(g.x, (at(s, 0.37f + h, 0.4f, 6) - at(s, 0.37f - h, 0.4f, 6)) / (2 * h), 0.05f);
  EXPECT_NEAR(g.y, (at(s, 0.37f, 0.4f + h, 6) - at(s, 0.37f, 0.4f - h, 6)) / (2 * h), 0.05f);
  EXPECT_GT(std::abs(g.x), 1);
  // The square root of black is black, and has no slope that anybody could use.
  s.textures[2].value = Rgb(-1.f);
  s.textures[5].a = {2};
  EXPECT_EQ(at(s, 0, 0, 5), 0);
  EXPECT_EQ(gradient(s, TextureHandle{5}, c), Vec2f());
}

TEST(Texture, ScalarOfColourIsLuminance) {
  Scene s;
  s.textures.resize(1);
  s.textures[0].value = {0, 1, 0};
  EXPECT_FLOAT_EQ(at(s, 0, 0), 0.715160f);
}

// The gradient is that of the bilinear patch: exact against finite differences inside a patch.
TEST(Texture, GradientIsTheSlopeOfThePatch) {
  Scene s = imageScene(Filter::bilinear, Wrap::repeat);
  s.textures[0].uvMatrix[0][0] = 1.7f, s.textures[0].uvMatrix[0][1] = -0.6f;
  s.textures[0].uvMatrix[1][0] = 0.3f, s.textures[0].uvMatrix[1][1] = 0.9f;
  s.textures.emplace_back();
  s.textures[1].type = TextureType::scale, s.textures[1].a = {0}, s.textures[1].scale = 0.5f;
  Rng rng(3);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    TextureContext c;
    c.uv = rng.next2D();
    const Vec2f g = gradient(s, TextureHandle{1}, c);
    constexpr float h = 1e-3f;
    const float du = at(s, c.uv.x + h, c.uv.y, 1) - at(s, c.uv.x - h, c.uv.y, 1);
    const float dv = at(s, c.uv.x, c.uv.y + h, 1) - at(s, c.uv.x, c.uv.y - h, 1);
    // Leave out steps across the border of a patch: second differences show them.
    const float bend = std::abs(at(s, c.uv.x + h, c.uv.y, 1) + at(s, c.uv.x - h, c.uv.y, 1) -
                                2 * at(s, c.uv.x, c.uv.y, 1)) +
                       std::abs(at(s, c.uv.x, c.uv.y + h, 1) + at(s, c.uv.x, c.uv.y - h, 1) -
                                2 * at(s, c.uv.x, c.uv.y, 1));
    if (bend > 1e-4f) continue;
    ++compared;
    EXPECT_NEAR(g.x, du / (2 * h), 2e-2f);
    EXPECT_NEAR(g.y, dv / (2 * h), 2e-2f);
  }
  EXPECT_GT(compared, 100);
  s.textures[0].filter = Filter::nearest;
  EXPECT_EQ(gradient(s, TextureHandle{0}, {}), Vec2f());
}

TEST(Texture, MeanOfAnImageIsTheMeanOfItsTexels) {
  Scene s = imageScene(Filter::bilinear, Wrap::repeat);
  EXPECT_FLOAT_EQ(mean(s, ColorParam(TextureHandle{0})).x, 3.5f);
  s.textures[0].uvMatrix[0][0] = 0.5f;  // the left half: 1, 2 (half), and the row below
  s.textures[0].filter = Filter::nearest;
  EXPECT_NEAR(mean(s, ColorParam(TextureHandle{0})).x, (2 * (1 + 4) + 2 + 5) / 6.f, 0.02f);
}

}  // namespace
}  // namespace lobelia

// PBRT files: materials, textures.
#include <gtest/gtest.h>

#include <cmath>

#include "io/pbrt_scene.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/io/image_io.h"
#include "lobelia/scene/shading.h"

namespace lobelia::test {
namespace {

Scene withMaterial(const std::string& text) { return readPbrtWorld(text + kTriangle); }

TEST(PbrtMaterials, EveryKind) {
  const auto typeOf = [](const std::string& text) { return onlyMaterial(withMaterial(text)).type; };
  EXPECT_EQ(typeOf(""), MaterialType::diffuse);
  EXPECT_EQ(typeOf("Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3] "), MaterialType::diffuse);
  EXPECT_EQ(typeOf("Material \"coateddiffuse\" "), MaterialType::plastic);
  EXPECT_EQ(typeOf("Material \"coateddiffuse\" \"float roughness\" .1 "),
            MaterialType::roughPlastic);
  EXPECT_EQ(typeOf("Material \"conductor\" "), MaterialType::conductor);
  EXPECT_EQ(typeOf("Material \"conductor\" \"float roughness\" .1 "), MaterialType::roughConductor);
  EXPECT_EQ(typeOf("Material \"coatedconductor\" "), MaterialType::coatedConductor);
  EXPECT_EQ(typeOf("Material \"dielectric\" "), MaterialType::dielectric);
  EXPECT_EQ(typeOf("Material \"dielectric\" \"float roughness\" .1 "),
            MaterialType::roughDielectric);
  EXPECT_EQ(typeOf("Material \"thindielectric\" "), MaterialType::thinDielectric);
  EXPECT_EQ(typeOf("Material \"diffusetransmission\" "), MaterialType::diffuseTransmitter);
  EXPECT_EQ(typeOf("Material \"interface\" "), MaterialType::null);
  for (const char* type : {"hair", "subsurface", "measured"})
    EXPECT_TRUE(contains(findingsOf(withMaterial(std::string("Material \"") + type + "\" ")),
                         "stands for it"));
  EXPECT_TRUE(contains(pbrtRefusal("Material \"difuse\""), "did you mean 'diffuse'?"));
  EXPECT_TRUE(contains(pbrtRefusal("Material \"diffuse\" \"rgb reflectance\" [1 2]"), "takes 3"));
  EXPECT_TRUE(
      contains(pbrtRefusal("Material \"diffuse\" \"rgb reflectance\" [1 -2 0]"), "0 or more"));
}

TEST(PbrtMaterials, Parameters) {
  const Material rough =
      onlyMaterial(withMaterial("Material \"conductor\" \"float roughness\" .25 "));
  EXPECT_FLOAT_EQ(rough.alphaU.value, 0.5f);  // remapped
  const Material plain = onlyMaterial(withMaterial(
      "Material \"conductor\" \"float uroughness\" .25 \"float vroughness\" .1 "
      "\"bool remaproughness\" false \"spectrum eta\" \"metal-Ag-eta\" \"rgb k\" [3 2 1] "));
  EXPECT_FLOAT_EQ(plain.alphaU.value, 0.25f);
  EXPECT_FLOAT_EQ(plain.alphaV.value, 0.1f);
  EXPECT_EQ(plain.distribution, Distribution::ggx);
  EXPECT_NEAR(plain.eta.value.x, 0.155265f, 1e-5f);
  EXPECT_EQ(plain.k.value, Rgb(3, 2, 1));
  // Reflectance at normal incidence of eta = 1 and k is k^2 / (4 + k^2).
  const Material mirror =
      onlyMaterial(withMaterial("Material \"conductor\" \"rgb reflectance\" [.9 .5 .1] "));
  for (int i = 0; i < 3; ++i) {
    const float k2 = mirror.k.value[i] * mirror.k.value[i];
    EXPECT_NEAR(k2 / (4 + k2), Rgb(.9f, .5f, .1f)[i], 1e-5f);
  }
  EXPECT_FLOAT_EQ(onlyMaterial(withMaterial("Material \"dielectric\" \"spectrum eta\" "
                                            "\"glass-BK7\" "))
                      .ior,
                  1.5168f);
  EXPECT_NEAR(
      onlyMaterial(withMaterial("Material \"dielectric\" \"spectrum eta\" [300 1.4 900 1.4] ")).ior,
      1.4f, 1e-4f);
  const Material coat = onlyMaterial(withMaterial(
      "Material \"coatedconductor\" \"float interface.roughness\" .04 \"float interface.eta\" 1.4 "
      "\"float conductor.roughness\" .09 "));
  EXPECT_FLOAT_EQ(coat.coatAlphaU.value, 0.2f);
  EXPECT_FLOAT_EQ(coat.coatIor, 1.4f);
  EXPECT_FLOAT_EQ(coat.alphaU.value, 0.3f);
  EXPECT_TRUE(
      contains(findingsOf(withMaterial("Material \"coateddiffuse\" \"float g\" .5 ")), "'g'"));
  EXPECT_TRUE(contains(pbrtRefusal("Material \"conductor\" \"rgb k\" [1 1 1] \"rgb reflectance\" "
                                   "[1 1 1]"),
                       "give one of them"));
  // A flat spectrum is grey, a wrong name is refused.
  const Rgb grey =
      onlyMaterial(withMaterial("Material \"diffuse\" \"spectrum reflectance\" [300 .4 "
                                "900 .4] "))
          .diffuse.value;
  expectNear(grey, Rgb(0.4f));
  EXPECT_TRUE(contains(pbrtRefusal("Material \"conductor\" \"spectrum eta\" \"metal-Ag-eat\""),
                       "did you mean 'metal-Ag-eta'?"));
  EXPECT_TRUE(
      contains(pbrtRefusal("Material \"diffuse\" \"spectrum reflectance\" [300 1 400]"), "pairs"));
}

TEST(PbrtMaterials, NamesMixturesAndOpacity) {
  const Scene scene = readPbrtWorld(
      std::string(
          "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 0 0]\n"
          "MakeNamedMaterial \"gold\" \"string type\" \"conductor\"\n"
          "MakeNamedMaterial \"both\" \"string type\" \"mix\" \"string materials\" [\"red\" "
          "\"gold\"] \"float amount\" .25\nNamedMaterial \"both\"\n") +
      "Shape \"sphere\" \"float alpha\" .5");
  const Material& mask = onlyMaterial(scene);
  ASSERT_EQ(mask.type, MaterialType::mask);
  EXPECT_FLOAT_EQ(mask.opacity.value, 0.5f);
  const Material& mix = scene[mask.a];
  ASSERT_EQ(mix.type, MaterialType::blend);
  EXPECT_FLOAT_EQ(mix.weight.value, 0.25f);
  EXPECT_EQ(scene[scene[mix.a].a].diffuse.value, Rgb(1, 0, 0));
  EXPECT_TRUE(contains(pbrtRefusal(std::string("NamedMaterial \"read\"\n") + kTriangle),
                       "unknown material 'read'"));
  EXPECT_TRUE(contains(pbrtRefusal("MakeNamedMaterial \"x\""), "no \"string type\""));
}

// White furnaces: what the surface sends towards wo under light of 1 from everywhere.
TEST(PbrtMaterials, DiffuseTransmissionScattersReflectanceAndTransmittance) {
  struct Case {
    const char* text;
    Rgb reflected, transmitted;
  };
  for (const Case& c :
       {Case{"\"rgb reflectance\" [0 0 0] \"rgb transmittance\" [.5 .5 .5] ", Rgb(0.f), Rgb(.5f)},
        Case{"\"rgb reflectance\" [.3 .3 .3] \"rgb transmittance\" [.3 .3 .3] ", Rgb(.3f),
             Rgb(.3f)},
        Case{"\"rgb reflectance\" [.3 .2 .1] \"rgb transmittance\" [.4 .4 .1] \"float scale\" .5 ",
             {.15f, .1f, .05f},
             {.2f, .2f, .05f}},
        Case{"", Rgb(.25f), Rgb(.25f)}}) {
    const Scene scene = withMaterial(std::string("Material \"diffusetransmission\" ") + c.text);
    EXPECT_TRUE(scene.findings.empty()) << findingsOf(scene);
    SurfacePoint at;
    at.frame = frameFromNormal(at.ng = Vec3f(0, 0, 1));
    at.material = scene.instances.at(0).material;
    for (const float z : {0.8f, -0.8f}) {
      const Vec3f wo{0.6f, 0, z};
      const Bsdf bsdf = makeBsdf(scene, at, wo, 0.08f);
      expectNear(albedo(bsdf, wo), c.reflected + c.transmitted, 1e-5f);
      Rgb same{}, other{};
      constexpr int kN = 64;  // strata of the cosine and, alike, of the azimuth
      for (int i = 0; i < kN * kN; ++i) {
        const float cosine = (static_cast<float>(i % kN) + .5f) / kN;
        const float phi = (static_cast<float>(i / kN) + .5f) / kN * kTwoPi;
        const float sine = std::sqrt(1 - cosine * cosine);
        const Vec3f wi{sine * std::cos(phi), sine * std::sin(phi), std::copysign(cosine, z)};
        same += evaluate(bsdf, wo, wi) * (kTwoPi / (kN * kN));
        other += evaluate(bsdf, wo, -wi) * (kTwoPi / (kN * kN));
      }
      expectNear(same, c.reflected, 1e-3f);
      expectNear(other, c.transmitted, 1e-3f);
    }
  }
}

TEST(PbrtMaterials, AbsorbingMediaFillGlass) {
  const std::string medium =
      "MakeNamedMedium \"green\" \"string type\" \"homogeneous\" \"rgb "
      "sigma_a\" [.5 .2 .4] \"rgb sigma_s\" [0 0 0] \"float scale\" 2\n";
  const Scene glass =
      withMaterial(medium + "MediumInterface \"green\" \"\" Material \"dielectric\" ");
  expectNear(onlyMaterial(glass).absorption, {1, .4f, .8f});
  EXPECT_TRUE(glass.findings.empty()) << findingsOf(glass);
  EXPECT_TRUE(
      contains(findingsOf(withMaterial(medium + "MediumInterface \"green\" \"\" ")), "not glass"));
  EXPECT_TRUE(contains(findingsOf(readPbrtWorld("MakeNamedMedium \"fog\" \"string type\" "
                                                "\"homogeneous\"")),
                       "not supported"));
  EXPECT_TRUE(contains(pbrtRefusal(std::string("MediumInterface \"grean\" \"\"\n") + kTriangle),
                       "unknown medium"));
}

class PbrtTextures : public testing::Test {
 protected:
  TemporaryFolder folder;
  // Two by two texels; the top row is red, green.
  void SetUp() override {
    io::writePng(folder.path("t.png"), {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}, 2, 2);
  }
  Rgb diffuseAt(const std::string& textures, Vec2f uv, bool expectSilence = true) {
    const Scene scene = readPbrtText(folder, "Camera \"perspective\" WorldBegin\n" + textures +
                                                 "\nMaterial \"diffuse\" \"texture reflectance\" "
                                                 "\"t\"\n" +
                                                 kTriangle);
    EXPECT_EQ(scene.findings.empty(), expectSilence) << findingsOf(scene);
    TextureContext at;
    at.uv = uv;
    return evaluate(scene, onlyMaterial(scene).diffuse, at);
  }
  static std::string spectrum(const std::string& rest) {
    return "Texture \"t\" \"spectrum\" " + rest + "\n";
  }
};

TEST_F(PbrtTextures, ImagesStandUpright) {
  const std::string map = "\"imagemap\" \"string filename\" \"t.png\" \"string filter\" \"point\" ";
  expectNear(diffuseAt(spectrum(map), {.25f, .75f}), {1, 0, 0});  // v grows upwards
  expectNear(diffuseAt(spectrum(map), {.75f, .75f}), {0, 1, 0});
  expectNear(diffuseAt(spectrum(map), {.25f, .25f}), {0, 0, 1});
  expectNear(diffuseAt(spectrum(map + "\"float uscale\" 2 "), {.375f, .75f}), {0, 1, 0});
  expectNear(diffuseAt(spectrum(map + "\"float vdelta\" .5 "), {.25f, .25f}), {1, 0, 0});
  expectNear(diffuseAt(spectrum(map + "\"string wrap\" \"black\" "), {1.25f, .75f}), {0, 0, 0});
  expectNear(diffuseAt(spectrum(map + "\"float scale\" .5 "), {.25f, .75f}), {.5f, 0, 0});
  expectNear(diffuseAt(spectrum(map + "\"bool invert\" true "), {.25f, .75f}), {0, 1, 1});
  EXPECT_TRUE(contains(pbrtRefusal("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
                                   "\"none.png\""),
                       "there is no image file 'none.png'"));
}

TEST_F(PbrtTextures, EveryKind) {
  expectNear(diffuseAt(spectrum("\"constant\" \"rgb value\" [.1 .2 .3]"), {}), {.1f, .2f, .3f});
  const std::string checker = "\"checkerboard\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 1 0] ";
  expectNear(diffuseAt(spectrum(checker), {.5f, .5f}), {1, 0, 0});
  expectNear(diffuseAt(spectrum(checker), {1.5f, .5f}), {0, 1, 0});
  expectNear(diffuseAt(spectrum(checker), {1.5f, 1.5f}), {1, 0, 0});
  expectNear(diffuseAt(spectrum(checker + "\"float uscale\" 4 "), {.3f, .5f}), {0, 1, 0});
  const std::string c = "Texture \"c\" \"spectrum\" " + checker + "\n";
  expectNear(
      diffuseAt(c + spectrum("\"scale\" \"texture tex\" \"c\" \"float scale\" .5"), {.5f, .5f}),
      {.5f, 0, 0});
  expectNear(diffuseAt(c + spectrum("\"mix\" \"texture tex1\" \"c\" \"rgb tex2\" [0 0 1] \"float "
                                    "amount\" .25"),
                       {.5f, .5f}),
             {.75f, 0, .25f});
  const std::string f =
      "Texture \"f\" \"float\" \"checkerboard\" \"float tex1\" .5 \"float tex2\" 1\n";
  expectNear(diffuseAt(c + f + spectrum("\"scale\" \"texture tex\" \"c\" \"texture scale\" \"f\""),
                       {.5f, .5f}),
             {.5f, 0, 0});
  for (const char* type : {"fbm", "wrinkled", "windy", "marble", "dots", "ptex"})
    diffuseAt(spectrum(std::string("\"") + type + "\""), {}, false);
  expectNear(
      diffuseAt(spectrum("\"bilerp\" \"rgb v00\" [1 0 0] \"rgb v01\" [1 0 0] \"rgb v10\" [1 0 "
                         "0] \"rgb v11\" [1 0 0]"),
                {}, false),
      {1, 0, 0});
  expectNear(
      diffuseAt(spectrum("\"directionmix\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 0 1]"), {}, false),
      {.5f, 0, .5f});
  EXPECT_TRUE(contains(pbrtRefusal("Texture \"t\" \"spectrum\" \"chequerboard\""),
                       "unknown texture 'chequerboard'"));
  EXPECT_TRUE(contains(pbrtRefusal("Material \"diffuse\" \"texture reflectance\" \"none\""),
                       "unknown spectrum texture"));
  EXPECT_TRUE(contains(pbrtRefusal("Texture \"f\" \"float\" \"constant\" Material \"diffuse\" "
                                   "\"texture reflectance\" \"f\""),
                       "is a float texture"));
}

TEST_F(PbrtTextures, RoughnessIsRemappedAndMapsPerturb) {
  const Scene scene = readPbrtText(
      folder, std::string("Camera \"perspective\" WorldBegin Texture \"r\" \"float\" "
                          "\"checkerboard\" \"float tex1\" .25 "
                          "\"float tex2\" .04\nMaterial \"conductor\" \"texture roughness\" \"r\" "
                          "\"string normalmap\" \"t.png\"\n") +
                  kTriangle);
  EXPECT_TRUE(scene.findings.empty()) << findingsOf(scene);
  const Material& map = onlyMaterial(scene);
  ASSERT_EQ(map.type, MaterialType::normalMap);
  const Material& metal = scene[map.a];
  TextureContext at;
  at.uv = {.5f, .5f};
  EXPECT_NEAR(evaluate(scene, metal.alphaU, at), 0.5f, 1e-5f);
  at.uv = {1.5f, .5f};
  EXPECT_NEAR(evaluate(scene, metal.alphaV, at), 0.2f, 1e-5f);
  const Scene bump = readPbrtText(
      folder, std::string("Camera \"perspective\" WorldBegin Texture \"d\" \"float\" \"imagemap\" "
                          "\"string filename\" "
                          "\"t.png\"\nMaterial \"diffuse\" \"texture displacement\" \"d\"\n") +
                  kTriangle);
  EXPECT_EQ(onlyMaterial(bump).type, MaterialType::bump);
  EXPECT_EQ(bump.images.at(0).channels, 1);
}

}  // namespace
}  // namespace lobelia::test

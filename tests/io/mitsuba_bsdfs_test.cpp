// Materials and textures of both dialects.
#include "io/mitsuba_scene.h"

namespace lobelia {
namespace {

using test::onlyFinding;
using test::readLegacy;
using test::readModern;
using test::refusal;

std::string bsdf(const std::string& type, const std::string& body = "") {
  return "<bsdf type=\"" + type + "\">" + body + "</bsdf>";
}
Material modernMaterial(const std::string& type, const std::string& body = "") {
  const Scene scene = readModern(bsdf(type, body));
  EXPECT_TRUE(scene.findings.empty()) << scene.findings[0].message;
  return scene.materials.back();
}
Material legacyMaterial(const std::string& type, const std::string& body = "") {
  const Scene scene = readLegacy(bsdf(type, body));
  EXPECT_TRUE(scene.findings.empty()) << scene.findings[0].message;
  return scene.materials.back();
}

TEST(MitsubaBsdf, DefaultsOfMitsuba3) {
  EXPECT_EQ(modernMaterial("diffuse").diffuse.value, Rgb(0.5f));
  const Material mirror = modernMaterial("conductor");
  EXPECT_EQ(mirror.eta.value, Rgb(0.f));
  EXPECT_EQ(mirror.k.value, Rgb(1.f));
  const Material metal = modernMaterial("roughconductor");
  EXPECT_EQ(metal.type, MaterialType::roughConductor);
  EXPECT_EQ(metal.distribution, Distribution::beckmann);
  EXPECT_FLOAT_EQ(metal.alphaU.value, 0.1f);
  EXPECT_FLOAT_EQ(metal.alphaV.value, 0.1f);
  EXPECT_NEAR(modernMaterial("dielectric").ior, 1.5046f / 1.000277f, 1e-6f);
  EXPECT_NEAR(modernMaterial("thindielectric").ior, 1.5046f / 1.000277f, 1e-6f);
  EXPECT_NEAR(modernMaterial("plastic").ior, 1.49f / 1.000277f, 1e-6f);
  const Material plastic = modernMaterial("roughplastic");
  EXPECT_FALSE(plastic.nonlinear);
  EXPECT_EQ(plastic.diffuse.value, Rgb(0.5f));
  EXPECT_EQ(plastic.specular.value, Rgb(1.f));
  EXPECT_EQ(modernMaterial("null").type, MaterialType::null);
}

TEST(MitsubaBsdf, DefaultsOfMitsuba06) {
  // Copper in air.
  const Material copper = legacyMaterial("roughconductor");
  EXPECT_NEAR(copper.eta.value.x, 0.200438f / 1.000277f, 1e-5f);
  EXPECT_NEAR(copper.k.value.z, 2.142188f / 1.000277f, 1e-5f);
  const Material phong = legacyMaterial("phong");
  EXPECT_EQ(phong.alphaU.value, 30);
  EXPECT_EQ(phong.specular.value, Rgb(0.2f));
  EXPECT_EQ(phong.diffuse.value, Rgb(0.5f));
  const Material ward = legacyMaterial("ward");
  EXPECT_EQ(ward.wardVariant, 2);
  EXPECT_FLOAT_EQ(ward.alphaU.value, 0.1f);
  EXPECT_EQ(legacyMaterial("difftrans").transmittance.value, Rgb(0.5f));
}

TEST(MitsubaBsdf, CamelCaseIsTheSame) {
  const std::string snake =
      "<float name=\"int_ior\" value=\"1.7\"/><float name=\"ext_ior\" value=\"1.2\"/>"
      "<rgb name=\"diffuse_reflectance\" value=\"0.1 0.2 0.3\"/><float name=\"alpha\" "
      "value=\"0.3\"/><string name=\"distribution\" value=\"ggx\"/>"
      "<boolean name=\"nonlinear\" value=\"true\"/>";
  const std::string camel =
      "<float name=\"intIOR\" value=\"1.7\"/><float name=\"extIOR\" value=\"1.2\"/>"
      "<rgb name=\"diffuseReflectance\" value=\"0.1 0.2 0.3\"/><float name=\"alpha\" "
      "value=\"0.3\"/><string name=\"distribution\" value=\"ggx\"/>"
      "<boolean name=\"nonlinear\" value=\"true\"/>";
  for (const Material& m :
       {modernMaterial("roughplastic", snake), legacyMaterial("roughplastic", camel)}) {
    EXPECT_FLOAT_EQ(m.ior, 1.7f / 1.2f);
    EXPECT_EQ(m.diffuse.value, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.distribution, Distribution::ggx);
    EXPECT_FLOAT_EQ(m.alphaV.value, 0.3f);
    EXPECT_TRUE(m.nonlinear);
  }
}

TEST(MitsubaBsdf, NamedMaterials) {
  EXPECT_NEAR(modernMaterial("dielectric",
                             "<string name=\"int_ior\" value=\"diamond\"/><string "
                             "name=\"ext_ior\" value=\"water\"/>")
                  .ior,
              2.419f / 1.333f, 1e-6f);
  EXPECT_NEAR(modernMaterial("conductor", "<string name=\"material\" value=\"Au\"/>").k.value.x,
              3.98316f, 1e-4f);
  const Material mirror = legacyMaterial("conductor", "<string name=\"material\" value=\"none\"/>");
  EXPECT_EQ(mirror.k.value, Rgb(1.f));
  const Material given = legacyMaterial(
      "conductor",
      "<float name=\"extEta\" value=\"2\"/><rgb name=\"eta\" value=\"1 2 3\"/><rgb name=\"k\" "
      "value=\"4\"/>");
  EXPECT_EQ(given.eta.value, Rgb(0.5f, 1.f, 1.5f));
  EXPECT_EQ(given.k.value, Rgb(2.f));
  EXPECT_TRUE(contains(refusal(bsdf("dielectric", "<string name=\"int_ior\" value=\"diamnd\"/>")),
                       "did you mean 'diamond'?"));
  EXPECT_TRUE(contains(refusal(bsdf("conductor", "<string name=\"material\" value=\"Zzzzz\"/>")),
                       "known are"));
}

TEST(MitsubaBsdf, Anisotropy) {
  const Material m = modernMaterial(
      "roughconductor",
      "<float name=\"alpha_u\" value=\"0.05\"/><float name=\"alpha_v\" value=\"0.3\"/>");
  EXPECT_FLOAT_EQ(m.alphaU.value, 0.05f);
  EXPECT_FLOAT_EQ(m.alphaV.value, 0.3f);
  EXPECT_TRUE(contains(refusal(bsdf("roughconductor",
                                    "<float name=\"alpha\" value=\"0.1\"/>"
                                    "<float name=\"alpha_u\" value=\"0.1\"/>")),
                       "give one"));
  EXPECT_TRUE(
      contains(refusal(bsdf("roughplastic", "<string name=\"distribution\" value=\"beckman\"/>")),
               "did you mean 'beckmann'?"));
}

TEST(MitsubaBsdf, PrincipledSpecularAndEta) {
  // specular 0.5 is F0 = 0.04, an index of 1.5.
  EXPECT_NEAR(modernMaterial("principled").ior, 1.5f, 1e-5f);
  EXPECT_NEAR(modernMaterial("principled", "<float name=\"eta\" value=\"1.33\"/>").ior, 1.33f,
              1e-6f);
  EXPECT_FLOAT_EQ(modernMaterial("principled", "<float name=\"specular\" value=\"0\"/>").ior, 1);
  EXPECT_GT(modernMaterial("principled",
                           "<float name=\"specular\" value=\"0\"/><float "
                           "name=\"spec_trans\" value=\"1\"/>")
                .ior,
            1);
  EXPECT_TRUE(contains(refusal(bsdf("principled",
                                    "<float name=\"eta\" value=\"1.5\"/><float "
                                    "name=\"specular\" value=\"0.5\"/>")),
                       "one of them"));
  const Scene thin = readModern(bsdf("principledthin"));
  EXPECT_EQ(thin.materials[0].type, MaterialType::principled);
  EXPECT_TRUE(contains(onlyFinding(thin), "principledthin"));
}

TEST(MitsubaBsdf, Wrappers) {
  Scene scene = readModern(bsdf("twosided", bsdf("diffuse") + bsdf("plastic")));
  Material outer = scene.materials.back();
  EXPECT_EQ(outer.type, MaterialType::twoSided);
  EXPECT_EQ(scene[outer.a].type, MaterialType::diffuse);
  EXPECT_EQ(scene[outer.b].type, MaterialType::plastic);
  outer = readModern(bsdf("twosided", bsdf("diffuse"))).materials.back();
  EXPECT_FALSE(outer.b.valid());
  outer = readModern(bsdf("mask", bsdf("diffuse"))).materials.back();
  EXPECT_FLOAT_EQ(outer.opacity.value, 0.5f);
  outer = readModern(bsdf("blendbsdf", "<float name=\"weight\" value=\"0.2\"/>" + bsdf("diffuse") +
                                           bsdf("plastic")))
              .materials.back();
  EXPECT_FLOAT_EQ(outer.weight.value, 0.2f);
  EXPECT_TRUE(contains(refusal(bsdf("twosided")), "holds 0 bsdfs"));
  EXPECT_TRUE(contains(refusal(bsdf("blendbsdf", bsdf("diffuse"))), "holds 1 bsdfs"));
  EXPECT_TRUE(contains(refusal(bsdf("bumpmap", bsdf("diffuse"))), "textures"));
}

// The chain of blends has the weights of the mixture.
TEST(MitsubaBsdf, MixturesBecomeBlends) {
  const Scene scene = readLegacy(
      bsdf("mixturebsdf", "<string name=\"weights\" value=\"0.5, 0.3, 0.1\"/>" +
                              bsdf("diffuse", "<float name=\"reflectance\" value=\"0.1\"/>") +
                              bsdf("diffuse", "<float name=\"reflectance\" value=\"0.2\"/>") +
                              bsdf("diffuse", "<float name=\"reflectance\" value=\"0.4\"/>")));
  const auto albedo = [&](const auto& self, const Material& m) -> float {
    if (m.type == MaterialType::diffuse) return m.diffuse.value.x;
    EXPECT_EQ(m.type, MaterialType::blend);
    return self(self, scene[m.a]) * (1 - m.weight.value) + self(self, scene[m.b]) * m.weight.value;
  };
  EXPECT_NEAR(albedo(albedo, scene.materials.back()), 0.5f * 0.1f + 0.3f * 0.2f + 0.1f * 0.4f,
              1e-6f);
  EXPECT_TRUE(contains(refusal(bsdf("mixturebsdf", "<string name=\"weights\" value=\"1\"/>" +
                                                       bsdf("diffuse") + bsdf("diffuse"))),
                       "1 weights for 2 bsdfs"));
}

TEST(MitsubaBsdf, UnknownTypesAreErrors) {
  EXPECT_TRUE(contains(refusal(bsdf("rougplastic")), "did you mean 'roughplastic'?"));
  EXPECT_TRUE(contains(refusal(bsdf("irawan")), "unknown bsdf 'irawan'; known are diffuse"));
  EXPECT_TRUE(contains(refusal("\n<bsdf/>"), "scene.xml:3"));
}

class MitsubaTexture : public testing::Test {
 protected:
  MitsubaTexture() {
    // Two pixels, black and white, as a portable grey map.
    folder_.write("t.pgm", std::string("P5 2 1 255\n\x00\xff", 13));
  }
  Scene read(const std::string& texture, bool legacy = false) {
    const std::string body = bsdf("diffuse", texture);
    return test::readText(folder_, legacy ? test::legacy(body) : test::modern(body));
  }
  static std::string bitmap(const std::string& body = "") {
    return "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "
           "value=\"t.pgm\"/>" +
           body + "</texture>";
  }
  TemporaryFolder folder_;
};

TEST_F(MitsubaTexture, BitmapDefaults) {
  const Scene scene = read(bitmap());
  const Texture& t = scene[scene.materials[0].diffuse.texture];
  EXPECT_EQ(t.type, TextureType::bitmap);
  EXPECT_EQ(t.filter, Filter::bilinear);
  EXPECT_EQ(t.wrapU, Wrap::repeat);
  EXPECT_EQ(t.wrapV, Wrap::repeat);
  EXPECT_FALSE(t.alphaChannel);
  EXPECT_EQ(scene[t.image].width, 2);
}

TEST_F(MitsubaTexture, BitmapOptions) {
  const Scene scene = read(bitmap(
      "<string name=\"filter_type\" value=\"nearest\"/><string name=\"wrap_mode\" "
      "value=\"clamp\"/><boolean name=\"raw\" value=\"true\"/><transform name=\"to_uv\"><scale "
      "x=\"2\" y=\"3\"/><translate x=\"0.5\"/></transform>"));
  const Texture& t = scene[scene.materials[0].diffuse.texture];
  EXPECT_EQ(t.filter, Filter::nearest);
  EXPECT_EQ(t.wrapU, Wrap::clamp);
  EXPECT_EQ(t.wrapV, Wrap::clamp);
  EXPECT_FLOAT_EQ(t.uvMatrix[0][0], 2);
  EXPECT_FLOAT_EQ(t.uvMatrix[1][1], 3);
  EXPECT_FLOAT_EQ(t.uvMatrix[0][2], 0.5f);
  EXPECT_TRUE(scene.findings.empty());
  // A matrix of nine values is homogeneous.
  const Scene matrix = read(
      bitmap("<transform name=\"to_uv\"><matrix value=\"1 0 0.25 0 1 0.5 0 0 1\"/></transform>"));
  EXPECT_FLOAT_EQ(matrix.textures[0].uvMatrix[0][2], 0.25f);
  EXPECT_FLOAT_EQ(matrix.textures[0].uvMatrix[1][2], 0.5f);
  EXPECT_THROW(read(bitmap("<string name=\"wrap_mode\" value=\"repaet\"/>")), InputError);
  EXPECT_THROW(read(bitmap("<string name=\"filter_type\" value=\"cubic\"/>")), InputError);
}

TEST_F(MitsubaTexture, LegacyBitmap) {
  const Scene scene =
      read(bitmap("<string name=\"filterType\" value=\"ewa\"/><string name=\"wrapMode\" "
                  "value=\"mirror\"/><float name=\"uscale\" value=\"4\"/><float name=\"voffset\" "
                  "value=\"0.1\"/><float name=\"gamma\" value=\"1\"/><string name=\"channel\" "
                  "value=\"a\"/>"),
           true);
  const Texture& t = scene.textures[0];
  EXPECT_EQ(t.wrapU, Wrap::mirror);
  EXPECT_EQ(t.wrapV, Wrap::mirror);
  EXPECT_FLOAT_EQ(t.uvMatrix[0][0], 4);
  EXPECT_FLOAT_EQ(t.uvMatrix[1][2], 0.1f);
  const Scene axes = read(bitmap("<string name=\"wrapModeU\" value=\"clamp\"/><string "
                                 "name=\"wrapModeV\" value=\"mirror\"/>"),
                          true);
  EXPECT_EQ(axes.textures[0].wrapU, Wrap::clamp);
  EXPECT_EQ(axes.textures[0].wrapV, Wrap::mirror);
  EXPECT_TRUE(axes.findings.empty());
  EXPECT_TRUE(t.alphaChannel);
  EXPECT_TRUE(scene.findings.empty());
}

TEST_F(MitsubaTexture, ImagesAreShared) {
  const Scene scene = test::readText(
      folder_, test::modern(bsdf("diffuse", bitmap()) + bsdf("diffuse", bitmap()) +
                            bsdf("diffuse", bitmap("<boolean name=\"raw\" value=\"true\"/>"))));
  EXPECT_EQ(scene.textures.size(), 3u);
  EXPECT_EQ(scene.images.size(), 2u);
}

TEST_F(MitsubaTexture, ReferencesShareTextures) {
  const Scene scene = test::readText(
      folder_, test::modern("<texture type=\"bitmap\" id=\"t\"><string name=\"filename\" "
                            "value=\"t.pgm\"/></texture>" +
                            bsdf("diffuse", "<ref name=\"reflectance\" id=\"t\"/>") +
                            bsdf("plastic", "<ref name=\"diffuse_reflectance\" id=\"t\"/>")));
  EXPECT_EQ(scene.textures.size(), 1u);
  EXPECT_TRUE(scene.materials[0].diffuse.texture == scene.materials[1].diffuse.texture);
}

TEST_F(MitsubaTexture, Checkerboards) {
  const std::string board =
      "<texture type=\"checkerboard\" name=\"NAME\"><float name=\"color0\" value=\"0.9\"/>"
      "<rgb name=\"color1\" value=\"0.1\"/></texture>";
  std::string colour = board, number = board;
  colour.replace(board.find("NAME"), 4, "reflectance");
  number.replace(board.find("NAME"), 4, "alpha");
  Scene scene = read(colour);
  const Texture t = scene[scene.materials[0].diffuse.texture];
  EXPECT_EQ(scene[t.a].value, Rgb(0.9f));
  EXPECT_EQ(scene[t.b].value, Rgb(0.1f));
  // Mitsuba 2 and 3 exchange the colours where a number is asked for; 0.6 does not.
  scene = readModern(bsdf("roughplastic", number));
  EXPECT_EQ(scene[scene[scene.materials[0].alphaU.texture].a].value, Rgb(0.1f));
  EXPECT_TRUE(scene.materials[0].alphaU.texture == scene.materials[0].alphaV.texture);
  scene = readLegacy(bsdf("roughplastic", number));
  EXPECT_EQ(scene[scene[scene.materials[0].alphaU.texture].a].value, Rgb(0.9f));
}

TEST_F(MitsubaTexture, MeshAttributesAndScale) {
  Scene scene = read(
      "<texture type=\"mesh_attribute\" name=\"reflectance\"><string name=\"name\" "
      "value=\"face_tint\"/></texture>");
  EXPECT_EQ(scene.textures.back().attribute, "face_tint");
  EXPECT_THROW(read("<texture type=\"mesh_attribute\" name=\"reflectance\"/>"), InputError);
  scene =
      read("<texture type=\"scale\" name=\"reflectance\"><float name=\"scale\" value=\"0.5\"/>" +
               bitmap() + "</texture>",
           true);
  const Texture& t = scene[scene.materials[0].diffuse.texture];
  EXPECT_EQ(t.type, TextureType::scale);
  EXPECT_FLOAT_EQ(t.scale, 0.5f);
  EXPECT_EQ(scene[t.a].type, TextureType::bitmap);
}

TEST_F(MitsubaTexture, MistakesAreLocated) {
  EXPECT_TRUE(contains(refusal(bsdf("diffuse",
                                    "\n<texture name=\"reflectance\" "
                                    "type=\"bitmpa\"/>")),
                       "scene.xml:3"));
  EXPECT_TRUE(contains(refusal(bsdf("diffuse", "<texture name=\"reflectance\" type=\"bitmap\"/>")),
                       "no filename"));
  EXPECT_TRUE(contains(refusal(bsdf("diffuse",
                                    "\n<texture name=\"reflectance\" type=\"bitmap\"><string "
                                    "name=\"filename\" value=\"gone.png\"/></texture>")),
                       "gone.png"));
}

}  // namespace
}  // namespace lobelia

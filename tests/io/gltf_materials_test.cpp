// Materials and textures of glTF files.
#include "io/gltf_builder.h"
#include "lobelia/io/image_io.h"

namespace lobelia {
namespace {

using test::GltfBuilder;
using test::kOneNode;

class GltfMaterials : public test::GltfTest {
 protected:
  // The square with one material, given as the members of its object.
  Scene withMaterial(const std::string& material, const std::string& more = "") {
    return read(square_.json(kOneNode + GltfBuilder::squareMesh(R"("material":0)") +
                             R"(,"materials":[{)" + material + "}]" + more));
  }
  const Material& inner(const Scene& s) {
    const Material* m = &s[s.instances.at(0).material];
    while (m->a.valid()) m = &s[m->a];
    return *m;
  }
  GltfBuilder square_ = GltfBuilder::square();
};

TEST_F(GltfMaterials, MaterialFactors) {
  const Scene s = withMaterial(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1],"metallicFactor":0.4,)"
      R"("roughnessFactor":0.5},"extensions":{"KHR_materials_ior":{"ior":1.7},)"
      R"("KHR_materials_specular":{"specularFactor":0.6,"specularColorFactor":[1,0.5,1]},)"
      R"("KHR_materials_clearcoat":{"clearcoatFactor":0.7,"clearcoatRoughnessFactor":0.1},)"
      R"("KHR_materials_sheen":{"sheenColorFactor":[0.2,0,0],"sheenRoughnessFactor":0.3},)"
      R"("KHR_materials_anisotropy":{"anisotropyStrength":0.8,"anisotropyRotation":1}})");
  const Material& m = inner(s);
  EXPECT_EQ(s[s.instances[0].material].type, MaterialType::twoSided);
  EXPECT_EQ(m.type, MaterialType::metallicRoughness);
  EXPECT_EQ(m.diffuse.value, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_FLOAT_EQ(m.metallic.value, 0.4f);
  EXPECT_FLOAT_EQ(m.roughness.value, 0.5f);
  EXPECT_FLOAT_EQ(m.ior, 1.7f);
  EXPECT_FLOAT_EQ(m.specularStrength.value, 0.6f);
  EXPECT_EQ(m.specular.value, Rgb(1, 0.5f, 1));
  EXPECT_FLOAT_EQ(m.clearcoat.value, 0.7f);
  EXPECT_FLOAT_EQ(m.clearcoatRoughness.value, 0.1f);
  EXPECT_EQ(m.sheenColor.value, Rgb(0.2f, 0, 0));
  EXPECT_FLOAT_EQ(m.sheenRoughness.value, 0.3f);
  EXPECT_FLOAT_EQ(m.anisotropic.value, 0.8f);
  EXPECT_FLOAT_EQ(m.anisotropicRotation.value, 1);  // the square's uv are not mirrored
}

TEST_F(GltfMaterials, GlassGlossinessUnlitAndEmission) {
  const Scene glass =
      withMaterial(R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":1},)"
                   R"("KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,)"
                   R"("attenuationColor":[0.5,1,1]}})");
  EXPECT_EQ(inner(glass).specTrans.value, 1);
  EXPECT_FALSE(inner(glass).thin);
  EXPECT_NEAR(inner(glass).absorption.x, std::log(2.0) / 2, 1e-6);
  EXPECT_TRUE(
      inner(withMaterial(R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":1}})"))
          .thin);
  const Scene glossy = withMaterial(
      R"("extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.5,0,0,1],)"
      R"("specularFactor":[0.2,0.2,0.2],"glossinessFactor":0.75}})");
  EXPECT_TRUE(inner(glossy).isSpecularGlossiness);
  EXPECT_FLOAT_EQ(inner(glossy).roughness.value, 0.25f);
  EXPECT_EQ(inner(glossy).specular.value, Rgb(0.2f));
  const Scene lamp =
      withMaterial(R"("emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":)"
                   R"({"emissiveStrength":8}})");
  ASSERT_EQ(lamp.emitters.size(), 1u);
  EXPECT_EQ(lamp[lamp.instances[0].emitter].radiance.value, Rgb(8, 4, 0));
  const Scene display = withMaterial(R"("emissiveFactor":[1,1,1])");
  EXPECT_EQ(display.emitters.size(), 2u);  // and the studio
  const Scene unlit = withMaterial(R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,0,0,1]},)"
                                   R"("extensions":{"KHR_materials_unlit":{}})");
  EXPECT_EQ(unlit[unlit.instances[0].emitter].radiance.value, Rgb(0.5f, 0, 0));
  EXPECT_EQ(inner(unlit).diffuse.value, Rgb(0.f));
}

TEST_F(GltfMaterials, DoubleSidedEmissionLeavesBothSides) {
  const std::string shines = R"("emissiveFactor":[1,1,1],"doubleSided":true)";
  const Scene both = withMaterial(shines);
  ASSERT_EQ(both.instances.size(), 2u);
  EXPECT_EQ(both.instances[0].emitter, both.instances[1].emitter);
  EXPECT_FALSE(both.instances[0].flipNormals);
  EXPECT_TRUE(both.instances[1].flipNormals);
  EXPECT_LT(both[both.instances[1].mesh].positions[0].z, 0);
  EXPECT_EQ(withMaterial(R"("emissiveFactor":[1,1,1])").instances.size(), 1u);
  EXPECT_EQ(withMaterial(R"("doubleSided":true)").instances.size(), 1u);
  EXPECT_EQ(withMaterial(R"("doubleSided":true,"extensions":{"KHR_materials_unlit":{}})")
                .instances.size(),
            2u);
  const Scene blend = withMaterial(shines + R"(,"alphaMode":"BLEND")");
  EXPECT_EQ(blend.instances.size(), 1u);
  EXPECT_TRUE(finds(blend, Severity::info, "materials[0]: is doubleSided, but half-transparent"));

  // Two nodes with one mesh: two lights, and one mesh for the backs of both.
  const Scene twice = read(square_.json(R"("nodes":[{"mesh":0},{"mesh":0,"scale":[-1,1,1]}],)" +
                                        GltfBuilder::squareMesh(R"("material":0)") +
                                        R"(,"materials":[{)" + shines + "}]"));
  ASSERT_EQ(twice.instances.size(), 4u);
  EXPECT_EQ(twice.meshes.size(), 2u);
  EXPECT_EQ(twice.instances[1].mesh, twice.instances[3].mesh);
  EXPECT_EQ(twice.instances[2].emitter, twice.instances[3].emitter);
  EXPECT_NE(twice.instances[0].emitter, twice.instances[2].emitter);
}

TEST_F(GltfMaterials, AlphaModes) {
  const std::string base = R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]})";
  EXPECT_EQ(withMaterial(base).materials.back().type, MaterialType::twoSided);
  const Scene blend = withMaterial(base + R"(,"alphaMode":"BLEND")");
  EXPECT_FLOAT_EQ(blend[blend.instances[0].material].opacity.value, 0.3f);
  const Scene mask = withMaterial(base + R"(,"alphaMode":"MASK")");
  EXPECT_EQ(mask[mask.instances[0].material].opacity.value, 0);
  EXPECT_EQ(withMaterial(base + R"(,"alphaMode":"MASK","alphaCutoff":0.2)").materials.back().type,
            MaterialType::twoSided);
  const std::string message =
      messageOf<InputError>([&] { withMaterial(base + R"(,"alphaMode":"MASKS")"); });
  EXPECT_TRUE(contains(message, "materials[0].alphaMode: 'MASKS'")) << message;
}

TEST_F(GltfMaterials, TexturesFromMemoryWithTransformsAndChannels) {
  // 2 x 1 pixels: (255, 128, 64) and (0, 255, 0), alpha 255 and 0.
  io::writePng(folder.path("t.png"), {255, 128, 64, 255, 0, 255, 0, 0}, 2, 1, 4);
  const std::vector<std::byte> png = [&] {
    std::ifstream in(folder.path("t.png"), std::ios::binary);
    const std::string s((std::istreambuf_iterator<char>(in)), {});
    const auto* first = reinterpret_cast<const std::byte*>(s.data());
    return std::vector<std::byte>(first, first + s.size());
  }();
  const size_t view = square_.view(png);
  const Scene s = withMaterial(
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":)"
      R"({"index":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[0.5,1]}}},)"
      R"("roughnessFactor":0.5},"alphaMode":"MASK","normalTexture":{"index":1,"scale":0.5})",
      fmt::format(R"(,"textures":[{{"source":0}},{{"source":1,"sampler":0}}],"samplers":)"
                  R"([{{"magFilter":9728,"wrapS":33071,"wrapT":33648}}],"images":)"
                  R"([{{"bufferView":{},"mimeType":"image/png"}},{{"uri":"t.png"}}])",
                  view));
  const Material& m = inner(s);
  TextureContext left, right;
  left.uv = {0.25f, 0.5f}, right.uv = {0.75f, 0.5f};
  EXPECT_NEAR(evaluate(s, m.diffuse, left).y, 0.2158605f, 1e-5);  // 128 in sRGB
  EXPECT_NEAR(evaluate(s, m.roughness, left), 0.5f, 1e-6);        // both at the right texel
  EXPECT_NEAR(evaluate(s, m.metallic, left), 0, 1e-6);
  const Texture& wrapped = s[m.metallic.texture];
  ASSERT_EQ(wrapped.type, TextureType::bitmap);
  EXPECT_EQ(wrapped.wrapU, Wrap::clamp);
  EXPECT_EQ(wrapped.wrapV, Wrap::mirror);
  const FloatParam& opacity = s[s.instances[0].material].opacity;
  EXPECT_GE(evaluate(s, opacity, left), 1);
  EXPECT_NEAR(evaluate(s, opacity, right), 0, 1e-6);
  for (const Material& map : s.materials) {
    if (map.type != MaterialType::normalMap) continue;
    const Rgb n = evaluate(s, map.map, left);  // x, y halved about 1/2, z as it is
    EXPECT_NEAR(n.x, 0.75f, 1e-5);
    EXPECT_NEAR(n.z, 64 / 255.f, 1e-5);
  }
}

TEST_F(GltfMaterials, MirroredUvGetAMirroredNormalMap) {
  io::writePng(folder.path("n.png"), {128, 255, 255}, 1, 1, 3);
  GltfBuilder b = GltfBuilder::square();
  b.accessor<float>({1, 1, 0, 1, 0, 0, 1, 0}, "VEC2", 2);  // 4: u runs to the left
  const auto greenOf = [&](int uv, const std::string& node) {
    const Scene s = read(
        b.json("\"nodes\":[{\"mesh\":0" + node + "}]," +
               fmt::format(R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,)"
                           R"("TEXCOORD_0":{}}},"indices":3,"material":0}}]}}],)",
                           uv) +
               R"("materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}],)"
               R"("images":[{"uri":"n.png"}])"));
    const Material& map = s[s[s.instances.at(0).material].a];
    EXPECT_EQ(map.type, MaterialType::normalMap);
    return evaluate(s, map.map, TextureContext{}).y;
  };
  EXPECT_FLOAT_EQ(greenOf(2, ""), 1);
  EXPECT_NEAR(greenOf(4, ""), 0, 1e-6);
  EXPECT_NEAR(greenOf(2, R"(,"scale":[-1,1,1])"), 0, 1e-6);
}

TEST_F(GltfMaterials, VertexColoursAndSecondUvSet) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<uint8_t>({255, 0, 0, 255, 255, 0, 0, 51, 255, 0, 0, 255, 255, 0, 0, 255}, "VEC4", 4,
                      R"("normalized":true)");
  io::writePng(folder.path("t.png"), {255, 255, 255}, 1, 1, 3);
  const Scene s = read(
      b.json(kOneNode +
             R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_1":2,"COLOR_0":4},)"
             R"("indices":3,"material":0}]}],"textures":[{"source":0}],"images":[{"uri":"t.png"}],)"
             R"("materials":[{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorTexture":)"
             R"({"index":0,"texCoord":1}}}])"));
  EXPECT_EQ(s.meshes[0].uvs[0], Vec2f(0, 1));
  TextureContext at;
  at.mesh = &s.meshes[0];
  at.barycentrics = {1, 0};
  EXPECT_EQ(evaluate(s, inner(s).diffuse, at), Rgb(1, 0, 0));
  EXPECT_NEAR(evaluate(s, s[s.instances[0].material].opacity, at), 0.2f, 1e-6);
}

TEST_F(GltfMaterials, Variants) {
  const std::string text = square_.json(
      kOneNode +
      GltfBuilder::squareMesh(R"("material":0,"extensions":{"KHR_materials_variants":{"mappings":)"
                              R"([{"material":1,"variants":[1]}]}})") +
      R"(,"materials":[{"name":"plain"},{"name":"fancy"}],"extensions":)"
      R"({"KHR_materials_variants":{"variants":[{"name":"day"},{"name":"night"}]}})");
  io::ReadSettings settings;
  EXPECT_EQ(inner(read(text)).name, "plain");
  settings.variant = "night";
  EXPECT_EQ(inner(read(text, settings)).name, "fancy");
  settings.variant = "day";
  EXPECT_EQ(inner(read(text, settings)).name, "plain");
  settings.variant = "nigth";
  const std::string message = messageOf<UsageError>([&] { read(text, settings); });
  EXPECT_TRUE(contains(message, "did you mean 'night'")) << message;
  EXPECT_EQ(read(text).variants, (std::vector<std::string>{"day", "night"}));
}

}  // namespace
}  // namespace lobelia

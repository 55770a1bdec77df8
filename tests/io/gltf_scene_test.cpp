// Nodes, animations, skins, cameras, lights of glTF files.
#include "io/gltf_builder.h"
#include "lobelia/io/image_io.h"

namespace lobelia {
namespace {

using test::GltfBuilder;
using test::kOneNode;

class GltfScene : public test::GltfTest {
 protected:
  Vec3f originOf(const Scene& s, size_t i = 0) { return s.instances.at(i).toWorld.point({}); }
  GltfBuilder square_ = GltfBuilder::square();
};

TEST_F(GltfScene, NodesFormTrees) {
  const std::string mesh = fmt::format(",{}", GltfBuilder::squareMesh());
  const Scene s = read(square_.json(
      R"("nodes":[{"translation":[1,2,3],"children":[1]},)"
      R"({"mesh":0,"rotation":[0,0,0.70710678,0.70710678],"scale":[2,2,2],"children":[2]},)"
      R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]},{"mesh":0}],)"
      R"("scenes":[{"nodes":[3]},{"nodes":[0],"name":"second"}],"scene":1)" +
      mesh));
  ASSERT_EQ(s.instances.size(), 2u);
  EXPECT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(s.name, "second");
  const Vec3f corner = s.instances[0].toWorld.point({1, 0, 0});
  EXPECT_NEAR(corner.x, 1, 1e-5);
  EXPECT_NEAR(corner.y, 4, 1e-5);
  EXPECT_NEAR(originOf(s, 1).z, 13, 1e-5);
  expectError(square_.json(R"("nodes":[{"children":[1]},{"children":[0]}])" + mesh),
              "nodes[0].children", "descendant of itself");
  expectError(square_.json(R"("nodes":[{"children":[2]},{"children":[2]},{}])" + mesh),
              "nodes[1].children[0]", "parent already");
  expectError(square_.json(R"("nodes":[{"children":[9]}])" + mesh), "nodes[0].children[0]",
              "out of range");
  expectError(square_.json(R"("nodes":[{"mesh":0,"scale":[1,"2",3]}])" + mesh), "nodes[0].scale[1]",
              "number");
  expectError(square_.json(R"("nodes":[{}],"scenes":[{"nodes":[0,0]}])" + mesh), "nodes[0]",
              "more than once");
  expectError(square_.json(R"("nodes":{"a":1})" + mesh), "nodes", "array");
}

TEST_F(GltfScene, ExtensionsRequiredAndUsed) {
  const std::string scene = kOneNode + GltfBuilder::squareMesh();
  expectError(square_.json(scene + R"(,"extensionsRequired":["KHR_materials_ir"])"),
              "extensionsRequired[0]", "did you mean 'KHR_materials_ior'");
  EXPECT_TRUE(warns(read(square_.json(scene + R"(,"extensionsUsed":["ACME_x"])")),
                    "extensionsUsed[0]: extension 'ACME_x'"));
  std::string old = square_.json(scene);
  old.replace(old.find("2.0"), 3, "1.0");
  expectError(old, "asset.version", "1.0");
}

TEST_F(GltfScene, AnimationsAtATime) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<float>({1, 2, 3}, "SCALAR", 1);                           // 4 times
  b.accessor<float>({0, 0, 0, 10, 0, 0, 10, 20, 0}, "VEC3", 3);        // 5
  b.accessor<float>({0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC4", 4);  // 6: half a turn, stays
  b.accessor<float>({0, 0, 0, 0, 0, 0, 4, 0, 0,                        // 7: in, value, out
                     4, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0},
                    "VEC3", 3);
  const auto text = [&](const std::string& path, int output, const std::string& mode) {
    return b.json(kOneNode + GltfBuilder::squareMesh() +
                  fmt::format(R"(,"animations":[{{"channels":[{{"sampler":0,"target":)"
                              R"({{"node":0,"path":"{}"}}}}],"samplers":[{{"input":4,)"
                              R"("output":{},"interpolation":"{}"}}]}}])",
                              path, output, mode));
  };
  const auto at = [&](float time, const std::string& path, int output, const std::string& mode,
                      Vec3f point = {}) {
    io::ReadSettings settings;
    settings.time = time;
    return read(text(path, output, mode), settings).instances[0].toWorld.point(point);
  };
  EXPECT_EQ(at(0, "translation", 5, "LINEAR"), Vec3f(0, 0, 0));
  EXPECT_EQ(at(1.5f, "translation", 5, "LINEAR"), Vec3f(5, 0, 0));
  EXPECT_EQ(at(2.25f, "translation", 5, "LINEAR"), Vec3f(10, 5, 0));
  EXPECT_EQ(at(9, "translation", 5, "LINEAR"), Vec3f(10, 20, 0));
  EXPECT_EQ(at(1.99f, "translation", 5, "STEP"), Vec3f(0, 0, 0));
  EXPECT_EQ(at(2, "translation", 5, "STEP"), Vec3f(10, 0, 0));
  // Hermite with both tangents 4: 0 + (1/8) 4 + 1/2 - (1/8) 4
  EXPECT_NEAR(at(1.5f, "translation", 7, "CUBICSPLINE").x, 0.5f, 1e-6f);
  // (t^3 - 2 t^2 + t) 4 + (3 t^2 - 2 t^3) + (t^3 - t^2) 4 at t = 1/4
  EXPECT_NEAR(at(1.25f, "translation", 7, "CUBICSPLINE").x,
              4 * 0.140625f + 0.15625f - 4 * 0.046875f, 1e-6f);
  const Vec3f turned = at(1.5f, "rotation", 6, "LINEAR", {1, 0, 0});  // a quarter about z
  EXPECT_NEAR(turned.x, 0, 1e-6f);
  EXPECT_NEAR(turned.y, 1, 1e-6f);
  expectError(text("translation", 6, "LINEAR"), "animations[0].samplers[0].output", "VEC3");
  expectError(text("translate", 5, "LINEAR"), "animations[0].channels[0].target.path",
              "did you mean 'translation'");
  expectError(text("translation", 5, "CUBICSPLINE"), "animations[0].samplers[0].output", "a key");
}

TEST_F(GltfScene, MorphTargets) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<float>({0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3);  // 4
  const std::string mesh = GltfBuilder::squareMesh(R"("targets":[{"POSITION":4}])");
  const Scene rest = read(b.json(kOneNode + mesh));
  EXPECT_EQ(rest.meshes[0].positions[0], Vec3f(0, 0, 0));
  const Scene bent = read(b.json(R"("nodes":[{"mesh":0,"weights":[0.5]},{"mesh":0}],)" + mesh));
  ASSERT_EQ(bent.instances.size(), 2u);
  EXPECT_EQ(bent[bent.instances[0].mesh].positions[0], Vec3f(0, 0, 0.5f));
  EXPECT_EQ(bent[bent.instances[1].mesh].positions[0], Vec3f(0, 0, 0));
}

TEST_F(GltfScene, SkinsPlaceVerticesByTheirJoints) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", 4);      // 4
  b.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", 4);  // 5
  b.accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
                    "MAT4", 16);                                                     // 6
  b.accessor<uint8_t>({0, 0, 0, 0, 9, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", 4);  // 7
  const auto text = [&](int joints) {
    return b.json(
        R"("nodes":[{"mesh":0,"skin":0,"translation":[100,0,0]},{"translation":[0,0,2]},)"
        R"({"translation":[5,0,0]}],"skins":[{"joints":[1,2],"inverseBindMatrices":6}],)" +
        fmt::format(R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,)"
                    R"("JOINTS_0":{},"WEIGHTS_0":5}},"indices":3}}]}}])",
                    joints));
  };
  const Scene s = read(text(4));
  EXPECT_TRUE(s.instances[0].toWorld.to.isIdentity());
  const std::vector<Vec3f>& p = s.meshes[0].positions;
  EXPECT_EQ(p[0], Vec3f(0, 0, 2));
  EXPECT_EQ(p[1], Vec3f(5, 0, 0));
  EXPECT_EQ(p[3], Vec3f(2, 1, 1));
  EXPECT_EQ(s.meshes[0].normals[3], Vec3f(0, 0, 1));
  const std::string path = "meshes[0].primitives[0].attributes.JOINTS_0";
  expectError(text(7), path, "joint 9; the skin has 2");
  expectError(text(5), path, "its componentType is 5126");
  b.accessor<uint8_t>(std::vector<uint8_t>(16), "VEC4", 4, R"("normalized":true)");  // 8
  expectError(text(8), path, "normalized");
}

TEST_F(GltfScene, GpuInstancingAndFlattenedNodes) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<float>({1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3", 3);  // 4
  b.accessor<float>({1, 1, 1, 2, 2, 2, 0, 0, 0}, "VEC3", 3);  // 5
  const Scene s = read(
      b.json(R"("nodes":[{"mesh":0,"translation":[0,7,0],"extensions":{"EXT_mesh_gpu_instancing":)"
             R"({"attributes":{"TRANSLATION":4,"SCALE":5}}}}],)" +
             GltfBuilder::squareMesh()));
  ASSERT_EQ(s.instances.size(), 2u);
  EXPECT_EQ(s.instances[1].toWorld.point({1, 0, 0}), Vec3f(4, 7, 0));
  EXPECT_TRUE(finds(s, Severity::info, "nodes[0]: 1 instances are left out"));
}

TEST_F(GltfScene, GpuInstancingByCustomAttributes) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<float>({4, 5, 6}, "SCALAR", 1);                                 // 4
  b.accessor<float>({1, 0, 0, 2, 0, 0}, "VEC3", 3);                          // 5
  b.rawAccessor(R"("componentType":5126,"count":9000000,"type":"SCALAR")");  // 6
  const auto text = [&](const std::string& attributes) {
    return b.json(R"("nodes":[{"mesh":0,"translation":[0,7,0],"extensions":)"
                  R"({"EXT_mesh_gpu_instancing":{"attributes":{)" +
                  attributes + "}}}}]," + GltfBuilder::squareMesh());
  };
  const Scene s = read(text(R"("_ID":4)"));
  ASSERT_EQ(s.instances.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(originOf(s, i), Vec3f(0, 7, 0));
  const std::string path = "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.";
  expectError(text(R"("_ID":4,"TRANSLATION":5)"), path + "_ID", "has 3 elements; another");
  expectError(text(R"("_ID":6)"), path + "_ID", "places 9000000 instances");
}

// Turned over by scales, instances of one primitive take the material of their side.
TEST_F(GltfScene, InstancesOfAPrimitiveShareTheirMaterials) {
  io::writePng(folder.path("n.png"), {128, 255, 255}, 1, 1, 3);
  GltfBuilder b = GltfBuilder::square();
  b.accessor<float>({1, 1, 1, -1, 1, 1, 1, 2, 1, 1, -1, 1}, "VEC3", 3);  // 4
  const Scene s = read(b.json(
      R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"SCALE":4}}}}],)" +
      GltfBuilder::squareMesh(R"("material":0)") +
      R"(,"materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}],)"
      R"("images":[{"uri":"n.png"}])"));
  ASSERT_EQ(s.instances.size(), 4u);
  const auto of = [&](size_t i) { return s.instances[i].material.index; };
  EXPECT_EQ(of(0), of(2));
  EXPECT_EQ(of(1), of(3));
  EXPECT_NE(of(0), of(1));
}

TEST_F(GltfScene, CamerasLookAlongMinusZAndFollowTheirPath) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<float>({0, 2}, "SCALAR", 1);            // 4
  b.accessor<float>({0, 0, 5, 0, 0, 9}, "VEC3", 3);  // 5
  const Scene s = read(b.json(
      R"("nodes":[{"mesh":0},{"camera":0,"scale":[3,3,3],"name":"eye"},{"camera":1}],)"
      R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"aspectRatio":2,"znear":0.1}},)"
      R"({"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"znear":0,"zfar":9}}],)"
      R"("animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],)"
      R"("samplers":[{"input":4,"output":5}]}],)" +
      GltfBuilder::squareMesh()));
  ASSERT_EQ(s.cameras.size(), 2u);
  const Camera& c = s.cameras[0];
  EXPECT_EQ(c.name, "eye");
  EXPECT_EQ(c.width, 2 * c.height);
  EXPECT_NEAR(std::tan(c.fovX / 2), 2 * std::tan(0.5), 1e-5);
  const auto w = static_cast<float>(c.width), h = static_cast<float>(c.height);
  const Ray middle = generateRay(c, {w / 2, h / 2}, {});
  EXPECT_NEAR(middle.o.z, 5, 1e-5);
  EXPECT_NEAR(middle.d.z, -1, 1e-6);
  EXPECT_GT(generateRay(c, {w, h / 2}, {}).d.x, 0);
  EXPECT_GT(generateRay(c, {w / 2, 0}, {}).d.y, 0);
  ASSERT_EQ(c.path.size(), 2u);
  EXPECT_EQ(c.path[1].time, 2);
  EXPECT_NEAR(c.path[1].toWorld.point({}).z, 9, 1e-5);
  EXPECT_NEAR(generateRay(s.cameras[1], {0, h / 2}, {}).o.x, -2, 1e-5);
  EXPECT_TRUE(s.cameras[1].path.empty());
}

TEST_F(GltfScene, PunctualLights) {
  const Scene s = read(
      square_.json(R"("nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}},)"
                   R"({"translation":[0,3,0],"extensions":{"KHR_lights_punctual":{"light":1}}},)"
                   R"({"extensions":{"KHR_lights_punctual":{"light":2}}}],)"
                   R"("extensions":{"KHR_lights_punctual":{"lights":[)"
                   R"({"type":"directional","color":[1,0.5,0],"intensity":4},{"type":"point"},)"
                   R"({"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}]}},)" +
                   GltfBuilder::squareMesh()));
  ASSERT_EQ(s.emitters.size(), 3u);
  EXPECT_EQ(s.emitters[0].type, EmitterType::directional);
  EXPECT_EQ(s.emitters[0].radiance.value, Rgb(4, 2, 0));
  EXPECT_NEAR(s.emitters[0].direction.z, -1, 1e-6);
  EXPECT_EQ(s.emitters[1].toWorld.point({}), Vec3f(0, 3, 0));
  EXPECT_NEAR(s.emitters[2].toWorld.vector({0, 0, 1}).z, -1, 1e-6);
  EXPECT_FLOAT_EQ(s.emitters[2].cutoff, 0.2f);
}

// KHR_lights_punctual's reference: saturate(cosine scale + offset) squared.
TEST_F(GltfScene, SpotsFallOffAsTheReference) {
  const auto text = [&](const std::string& spot) {
    return square_.json(R"("nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}},)"
                        R"({"extensions":{"KHR_lights_punctual":{"light":0}}}],"extensions":)"
                        R"({"KHR_lights_punctual":{"lights":[{"type":"spot","range":5,"spot":{)" +
                        spot + "}}]}}," + GltfBuilder::squareMesh());
  };
  const Scene s = read(text(R"("innerConeAngle":0.2,"outerConeAngle":0.6)"));
  ASSERT_EQ(s.emitters.size(), 2u);
  EXPECT_TRUE(finds(s, Severity::info, "lights[0].range: is not used"));
  const Emitter& spot = s.emitters[0];
  EXPECT_EQ(spot.type, EmitterType::spot);
  EXPECT_EQ(spot.cutoff, spot.beamWidth);
  EXPECT_EQ(spot.pattern, s.emitters[1].pattern);
  for (const double angle : {0.0, 0.1, 0.25, 0.4, 0.5, 0.58}) {
    TextureContext at;
    at.uv = {0.5f, 0.5f + 0.5f * static_cast<float>(std::tan(angle) / std::tan(0.6))};
    const double ramp = (std::cos(angle) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    EXPECT_NEAR(evaluate(s, spot.pattern, at).x, std::pow(std::min(ramp, 1.0), 2), 0.005) << angle;
  }
  const Scene wide = read(text(R"("outerConeAngle":1.57)"));
  EXPECT_EQ(wide.emitters[0].type, EmitterType::goniometric);
  const Image& rows = wide[wide.emitters[0].image];
  EXPECT_NEAR(rows.at(0, rows.height / 3, 0), 0.25f, 0.005f);  // 60 degrees: cosine 1/2
  EXPECT_EQ(rows.at(0, rows.height * 2 / 3, 0), 0);
  expectError(text(R"("innerConeAngle":0.6,"outerConeAngle":0.6)"),
              "extensions.KHR_lights_punctual.lights[0].spot.outerConeAngle", "larger");
}

TEST_F(GltfScene, ViewAndLightAreAdded) {
  const Scene s = read(square_.json(kOneNode + GltfBuilder::squareMesh()));
  ASSERT_EQ(s.cameras.size(), 1u);
  ASSERT_EQ(s.emitters.size(), 1u);
  EXPECT_EQ(s.emitters[0].type, EmitterType::environment);
  EXPECT_TRUE(finds(s, Severity::info, "there is no camera"));
  EXPECT_TRUE(finds(s, Severity::info, "nothing shines"));
  for (const Vec3f p : s.meshes[0].positions) {
    FilmConnection on;
    EXPECT_TRUE(connectToCamera(s.cameras[0], p, {}, &on));
  }
}

TEST_F(GltfScene, BareMeshWithMtl) {
  io::writePng(folder.path("k.png"), {255, 0, 0}, 1, 1, 3);
  folder.write("m.mtl",
               "newmtl red\nKd 1 1 1\nmap_Kd k.png\nNs 98\nKs 0.5 0.5 0.5\n"
               "newmtl lamp\nKd 0 0 0\nKe 3 2 1\nnewmtl metal\nKd 0.5 0.5 0.5\nPm 1\nPr 0.25\n");
  Context context;
  const Scene s = io::readScene(
      folder.write("m.obj",
                   "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl lamp\n"
                   "f 3 2 1\nusemtl metal\nf 1 3 2\nusemtl none\nf 2 1 3\n"),
      {}, context);
  ASSERT_EQ(s.instances.size(), 4u);
  const auto material = [&](size_t i) { return s[s[s.instances[i].material].a]; };
  EXPECT_EQ(evaluate(s, material(0).diffuse, TextureContext{}), Rgb(1, 0, 0));
  EXPECT_NEAR(material(0).roughness.value * material(0).roughness.value, std::sqrt(0.02), 1e-6);
  EXPECT_EQ(s[s.instances[1].emitter].radiance.value, Rgb(3, 2, 1));
  EXPECT_EQ(material(2).metallic.value, 1);
  EXPECT_EQ(material(2).roughness.value, 0.25f);
  EXPECT_TRUE(warns(s, "no MTL file has the material 'none'"));
  EXPECT_EQ(s.cameras.size(), 1u);
}

}  // namespace
}  // namespace lobelia

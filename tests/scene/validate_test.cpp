// Every kind of damage gives a finding that names its place; a sound scene gives none.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "support/shapes.h"

namespace lobelia {
namespace {

Scene soundScene() {
  Scene s;
  s.file = "room.xml";
  s.materials.resize(2);
  s.materials[0].name = "paint";
  s.materials[1].name = "cloth";
  s.materials[1].type = MaterialType::twoSided;
  s.materials[1].a = {0};
  s.textures.resize(2);
  s.textures[1].type = TextureType::scale;
  s.textures[1].a = {0};
  test::place(s, test::squareMesh()).emitter = {0};
  s.emitters.emplace_back();
  s.emitters[0].type = EmitterType::area;
  s.emitters[0].radiance = Rgb(1.f);
  s.cameras.emplace_back();
  s.cameras[0].name = "front";
  return s;
}

TEST(Validate, SoundSceneHasNoFindings) {
  const auto findings = validate(soundScene());
  EXPECT_TRUE(findings.empty()) << findings[0].message;
}

// The warning is for what is ignored, on lights that have directions.
TEST(Validate, LightsOutOfShape) {
  for (const EmitterType type :
       {EmitterType::spot, EmitterType::projector, EmitterType::goniometric, EmitterType::point}) {
    Scene s = soundScene();
    s.images.resize(1);
    s.images[0].width = s.images[0].height = 1;
    s.images[0].pixels = {1, 1, 1};
    Emitter light;
    light.type = type;
    light.name = "lamp";
    light.image = {0};
    s.emitters.push_back(light);
    const Mat4 turn = translation({1, 2, 3}) * rotation({1, 2, 3}, 50);
    for (const Mat4& sound : {turn, turn * scaling({4, 4, 4}), turn * scaling({-3e-9, 3e-9, 3e-9}),
                              scaling({3, 3, -3}) * turn, scaling({1, 1.00001, 1})}) {
      s.emitters.back().toWorld = Transform(sound);
      EXPECT_TRUE(validate(s).empty());
    }
    Mat4 sheared = turn;
    sheared.m[0][1] += 0.01;
    for (const Mat4& bent : {turn * scaling({1, 1, 3}), turn * scaling({1, -2, 1}), sheared}) {
      s.emitters.back().toWorld = Transform(bent);
      const auto findings = validate(s);
      ASSERT_EQ(findings.size(), type == EmitterType::point ? 0u : 1u);
      for (const Finding& f : findings) {
        EXPECT_EQ(f.severity, Severity::warning);
        EXPECT_NE(f.message.find("emitter 'lamp'"), std::string::npos) << f.message;
        EXPECT_NE(f.message.find("ignored"), std::string::npos) << f.message;
      }
    }
  }
}

struct Damage {
  const char* name;
  std::function<void(Scene&)> apply;
  Severity severity;
  std::vector<const char*> words;
};

const float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<Damage> damages() {
  const Severity error = Severity::error, warning = Severity::warning;
  return {
      {"nan",
       [](Scene& s) { s.meshes[0].positions[2].y = kNan; },
       error,
       {"mesh 'square'", "1 of 4 vertices", "finite"}},
      {"camera keys",
       [](Scene& s) {
         s.cameras[0].path = {{1, {}}, {2, {}}, {2, {}}};
       },
       error,
       {"camera 'front'", "must rise", "key 2"}},
      {"camera key",
       [](Scene& s) {
         s.cameras[0].path.resize(1);
         s.cameras[0].path[0].toWorld.to.m[0][3] = static_cast<double>(kNan);
       },
       error,
       {"camera 'front', key 0", "finite"}},
      {"index",
       [](Scene& s) { s.meshes[0].triangles[1].z = 4; },
       error,
       {"mesh 'square'", "do not exist"}},
      {"normals",
       [](Scene& s) { s.meshes[0].normals.resize(3); },
       error,
       {"mesh 'square'", "3 normals for 4 vertices"}},
      {"uvs", [](Scene& s) { s.meshes[0].uvs.resize(5); }, error, {"5 uvs for 4 vertices"}},
      {"attribute",
       [](Scene& s) {
         s.meshes[0].attributes.push_back({"face_x", true, 1, {1, 2, 3}});
       },
       error,
       {"mesh 'square'", "'face_x'", "3 values"}},
      {"degenerate",
       [](Scene& s) {
         s.meshes[0].triangles[1] = {0, 2, 2};
       },
       warning,
       {"mesh 'square'", "1 of 2 triangles are degenerate"}},
      {"singular",
       [](Scene& s) { s.instances[0].toWorld.to.m[1][1] = 0; },
       error,
       {"instance 'square'", "singular"}},
      {"infinite transform",
       [](Scene& s) { s.instances[0].toWorld.to.m[1][3] = double{kNan}; },
       error,
       {"instance 'square'", "not finite"}},
      {"mesh handle",
       [](Scene& s) { s.instances[0].mesh = {7}; },
       error,
       {"instance 'square'", "mesh 7 does not exist"}},
      {"material handle",
       [](Scene& s) { s.instances[0].material = {9}; },
       error,
       {"instance 'square'", "material 9 does not exist"}},
      {"no material", [](Scene& s) { s.instances[0].material = {}; }, error, {"has no material"}},
      {"emitter handle",
       [](Scene& s) { s.instances[0].emitter = {3}; },
       error,
       {"emitter 3 does not exist"}},
      {"emitter type",
       [](Scene& s) { s.emitters[0].type = EmitterType::point; },
       error,
       {"not an area emitter"}},
      {"null emitter",
       [](Scene& s) { s.materials[0].type = MaterialType::null; },
       warning,
       {"instance 'square'", "null"}},
      {"albedo",
       [](Scene& s) { s.materials[0].diffuse = Rgb(0.2f, 1.5f, 0.f); },
       warning,
       {"material 'paint'", "diffuse reflectance", "1.5"}},
      {"albedo texture",
       [](Scene& s) {
         s.textures[0].value = Rgb(0.8f), s.textures[1].scale = 2;
         s.materials[0].diffuse = TextureHandle{1};
       },
       warning,
       {"material 'paint'", "1.6"}},
      {"negative",
       [](Scene& s) { s.materials[0].diffuse = Rgb(-0.5f); },
       warning,
       {"material 'paint'", "negative"}},
      {"nan albedo",
       [](Scene& s) { s.materials[0].diffuse = Rgb(kNan); },
       error,
       {"material 'paint'", "not finite"}},
      {"texture handle",
       [](Scene& s) { s.materials[0].alphaU = TextureHandle{5}; },
       error,
       {"material 'paint'", "texture 5", "alpha u"}},
      {"wrapped", [](Scene& s) { s.materials[1].a = {}; }, error, {"material 'cloth'", "lacks"}},
      {"cycle",
       [](Scene& s) { s.materials[1].a = {1}; },
       error,
       {"material 'cloth'", "contains itself"}},
      {"lobes",
       [](Scene& s) {  // 1 + 2 + 2 + 4 lobes where all blends mix
         s.materials.resize(8);
         s.materials[2].type = MaterialType::principled;
         s.materials[2].clearcoat = 1.f, s.materials[2].specTrans = 0.5f;
         s.materials[3].type = MaterialType::plastic;
         for (const uint32_t i : {4u, 5u, 6u}) s.materials[i].type = MaterialType::blend;
         s.materials[4].a = {0}, s.materials[4].b = {3};
         s.materials[5].a = {4}, s.materials[5].b = {3};
         s.materials[6].a = {5}, s.materials[6].b = {2};
         s.materials[6].name = "mixture";
         s.instances[0].material = {6};
       },
       warning,
       {"material 'mixture'", "9 lobes", "8 are kept"}},
      {"nesting",
       [](Scene& s) {
         for (uint32_t i = 2; i < 40; ++i) {
           Material m;
           m.type = MaterialType::mask;
           m.a = {i - 1};
           s.materials.push_back(m);
         }
         s.instances[0].material = {39};
       },
       warning,
       {"material 39", "nested", "32"}},
      {"texture cycle", [](Scene& s) { s.textures[1].a = {1}; }, error, {"texture 1", "itself"}},
      {"bitmap",
       [](Scene& s) { s.textures[0].type = TextureType::bitmap; },
       error,
       {"texture 0", "no image"}},
      {"attribute name",
       [](Scene& s) {
         s.meshes[0].attributes.push_back({"vertex_color", false, 1, {1, 2, 3, 4}});
         s.textures[0].type = TextureType::meshAttribute;
         s.textures[0].attribute = "vertex_colour";
       },
       warning,
       {"'vertex_colour'", "vertex_color'"}},
      {"image size",
       [](Scene& s) {
         s.images.emplace_back();
         s.images[0].name = "wood.png";
         s.images[0].width = s.images[0].height = 2;
       },
       error,
       {"image 'wood.png'", "2x2"}},
      {"no emitter",
       [](Scene& s) { s.emitters.clear(), s.instances[0].emitter = {}; },
       warning,
       {"no emitter"}},
      {"loose emitter",
       [](Scene& s) { s.instances[0].emitter = {}; },
       warning,
       {"emitter 0", "no surface"}},
      {"nan radiance",
       [](Scene& s) { s.emitters[0].radiance = Rgb(kNan); },
       error,
       {"emitter 0", "not finite"}},
      {"film", [](Scene& s) { s.cameras[0].width = 0; }, error, {"camera 'front'", "0x576"}},
      {"fov", [](Scene& s) { s.cameras[0].fovX = 4; }, error, {"camera 'front'", "field of view"}},
      {"clip", [](Scene& s) { s.cameras[0].farClip = 0; }, error, {"camera 'front'", "far clip"}},
      {"crop", [](Scene& s) { s.cameras[0].cropX1 = 9999; }, error, {"camera 'front'", "crop"}},
      {"no camera", [](Scene& s) { s.cameras.clear(); }, warning, {"no camera"}},
  };
}

TEST(Validate, EveryDamageIsNamed) {
  for (const Damage& damage : damages()) {
    Scene s = soundScene();
    damage.apply(s);
    const auto findings = validate(s);
    const bool found = std::any_of(findings.begin(), findings.end(), [&](const Finding& f) {
      return f.severity == damage.severity && f.where.file == "room.xml" &&
             std::all_of(damage.words.begin(), damage.words.end(), [&](const char* word) {
               return f.message.find(word) != std::string::npos;
             });
    });
    EXPECT_TRUE(found) << damage.name << ": "
                       << (findings.empty() ? std::string("nothing") : findings[0].message);
  }
}

}  // namespace
}  // namespace lobelia

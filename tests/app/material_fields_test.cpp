// The table of what materials and lights have, and changes of type.
#include "lobelia/app/studio/material_fields.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/app/studio/emitter_fields.h"
#include "lobelia/app/studio/material_edits.h"

namespace lobelia::app {
namespace {

constexpr int kTypes = static_cast<int>(MaterialType::null) + 1;

Scene oneMaterial(MaterialType type) {
  Scene scene;
  scene.materials.resize(3);
  Material& m = scene.materials[0];
  m.type = type;
  m.a = {1}, m.b = {2};
  m.capturedLobes.resize(1);
  scene.textures.resize(1);
  m.map = {0};
  return scene;
}
size_t errors(const Design& design) {
  const Scene scene = sceneOf(design);
  size_t count = 0;
  for (const Finding& f : validate(scene)) count += f.severity == Severity::error ? 1 : 0;
  return count;
}

// Every value in range is kept and leaves a material that can be rendered; values out of it are
// brought into it.
TEST(MaterialFields, AllCanBeSetAndReadBack) {
  for (int type = 0; type < kTypes; ++type) {
    Design design = designOf(oneMaterial(static_cast<MaterialType>(type)));
    ASSERT_EQ(errors(design), 0u) << type;
    for (const MaterialField& f : fieldsOf(static_cast<MaterialType>(type))) {
      Material& m = design.materials[0];
      for (const float value : {f.least, f.most, std::floor((f.least + f.most) / 2)}) {
        if (f.kind == FieldKind::map) continue;
        if (value < f.least) continue;
        setField(m, f, Rgb(value));
        EXPECT_EQ(fieldValue(m, f).x, value) << f.word;
        EXPECT_EQ(errors(design), 0u) << typeWord(m.type) << " " << f.word << " " << value;
      }
      for (const float wild : {NAN, -INFINITY, INFINITY, -1e30f}) {
        setField(m, f, Rgb(wild));
        if (f.kind == FieldKind::map) continue;
        EXPECT_GE(fieldValue(m, f).x, f.least) << f.word;
        EXPECT_LE(fieldValue(m, f).x, f.most) << f.word;
      }
      EXPECT_EQ(f.texturable, [&] {
        Material textured = m;
        setFieldTexture(textured, f, {0});
        return fieldTexture(textured, f).valid();
      }()) << f.word;
    }
  }
}

TEST(MaterialFields, WordsAreFoundThroughWhatWraps) {
  Scene scene = oneMaterial(MaterialType::twoSided);
  scene.materials[2].type = MaterialType::roughConductor;
  const Design design = designOf(scene);
  EXPECT_EQ(findField(design, 0, "reflectance", {}).material, 1u);
  EXPECT_EQ(findField(design, 0, "back.alpha", {}).material, 2u);
  try {
    findField(design, 0, "back.alpa", {"script", 3, 0});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("script:3"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("did you mean 'back.alpha'"), std::string::npos);
  }
}

TEST(MaterialEdits, EveryTypeBecomesEveryOther) {
  for (int from = 0; from < kTypes; ++from)
    for (const MaterialType to : simpleTypes()) {
      Design design = designOf(oneMaterial(static_cast<MaterialType>(from)));
      changeType(design, 0, to);
      EXPECT_EQ(design.materials[shownMaterial(design, 0)].type, to) << from;
      EXPECT_EQ(errors(design), 0u) << from << " " << typeWord(to);
      EXPECT_EQ(simpleType(typeWord(to)), to);
    }
}

TEST(MaterialEdits, ColoursAndRoughnessStayWithTheType) {
  Design design = designOf(oneMaterial(MaterialType::principled));
  Material& m = design.materials[0];
  m.diffuse = Rgb(0.7f, 0.2f, 0.1f);
  m.roughness = 0.5f;
  changeType(design, 0, MaterialType::roughConductor);
  EXPECT_EQ(m.specular.value, Rgb(0.7f, 0.2f, 0.1f));
  EXPECT_FLOAT_EQ(m.alphaU.value, 0.25f);
  changeType(design, 0, MaterialType::metallicRoughness);
  EXPECT_EQ(m.diffuse.value, Rgb(0.7f, 0.2f, 0.1f));
  EXPECT_FLOAT_EQ(m.roughness.value, 0.5f);
  EXPECT_EQ(m.metallic.value, 1.f);
}

// Inside what is two-sided, where it works from behind, too; the handle that surfaces have stays.
TEST(MaterialEdits, MapsGoAroundWhatIsSeen) {
  Design design = designOf(oneMaterial(MaterialType::twoSided));
  design.materials[1].name = "paint";
  setBump(design, 0, {0}, 0.5f);
  EXPECT_EQ(design.materials[0].type, MaterialType::twoSided);
  EXPECT_EQ(design.materials[1].type, MaterialType::bump);
  EXPECT_EQ(design.materials[1].name, "paint");
  EXPECT_EQ(design.materials[shownMaterial(design, 0)].type, MaterialType::diffuse);
  const size_t count = design.materials.size();
  setNormalMap(design, 0, {0});
  EXPECT_EQ(design.materials.size(), count) << "in the place of the other";
  EXPECT_EQ(design.materials[1].type, MaterialType::normalMap);
  EXPECT_EQ(errors(design), 0u);
  setNormalMap(design, 0, {});
  EXPECT_EQ(design.materials[1].type, MaterialType::diffuse);
  EXPECT_EQ(design.materials[1].name, "paint");
}

TEST(EmitterFields, AllCanBeSetAndReadBack) {
  for (int type = 0; type <= static_cast<int>(EmitterType::sun); ++type) {
    Design design = designOf(oneMaterial(MaterialType::diffuse));
    Emitter& e = design.emitters.emplace_back();
    e.type = static_cast<EmitterType>(type);
    e.radiance = Rgb(1, 2, 4);
    for (const EmitterFieldInfo& f : emitterFields(e.type)) {
      const Vec3f value = f.values == 3 ? Vec3f(0.6f, 0, 0.8f) : Vec3f(std::min(f.most, 12.f));
      setEmitterValue(e, f.field, value);
      if (f.field == EmitterField::color) {
        EXPECT_NEAR(emitterValue(e, f.field).x, 0.75f, 1e-6f);
        EXPECT_NEAR(emitterValue(e, EmitterField::strength).x, 4, 1e-5f);
      } else {
        for (int i = 0; i < f.values; ++i)
          EXPECT_NEAR(emitterValue(e, f.field)[i], value[i], 1e-5f) << typeWord(e.type) << f.word;
      }
      setEmitterValue(e, f.field, Vec3f(NAN));
      const Vec3f kept = emitterValue(e, f.field);
      EXPECT_TRUE(std::isfinite(kept.x + kept.y + kept.z)) << typeWord(e.type) << f.word;
    }
    if (e.type == EmitterType::spot) {
      EXPECT_EQ(errors(design), 0u);
    }
  }
}

TEST(EmitterFields, ALightThatIsTurnedOffKeepsItsColour) {
  Emitter e = newEmitter(EmitterType::point, "lamp", {1, 2, 3}, Rgb(1, 2, 4));
  setEmitterValue(e, EmitterField::strength, Vec3f(0.f));
  EXPECT_LT(e.radiance.value.z, 1e-19f);
  setEmitterValue(e, EmitterField::strength, Vec3f(4.f));
  EXPECT_NEAR(e.radiance.value.x, 1, 1e-5f);
  EXPECT_EQ(emitterValue(e, EmitterField::position), Vec3f(1, 2, 3));
}

}  // namespace
}  // namespace lobelia::app

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "lobelia/base/error.h"
#include "lobelia/base/random.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

class LightFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() /
        ("lobelia-lights-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
         ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
    file_ = (folder_ / "lights.dat").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  static VirtualLights someLights() {
    VirtualLights lights;
    lights.model = "glossy";
    lights.sceneHash = 0x1234567890abcdefull;
    lights.seed = 17;
    lights.particles = 4711;
    lights.maxDepth = 6;
    lights.specularLimit = 0.125f;
    lights.direct = true;
    lights.omni.push_back({{1, 2, 3}, {4, 5, 6}, 7});
    lights.directional.push_back({{0, 1, 0}, {1, 2, 3}});
    Rng random(3);
    for (uint32_t i = 0; i < 1000; ++i) {
      const Vec3f p(random.next1D(), random.next1D(), random.next1D());
      lights.diffuse.push_back({p, p * 2.f, random.nextUint(), i < 600 ? 1u : 3u});
      lights.glossy.push_back({p, {0, 0, 1}, {1, 0, 0}, p, 100 * random.next1D()});
      SphericalLight sphere{};
      sphere.p = sphere.power = p;
      sphere.radius = 0.1f + random.next1D();
      sphere.arriving = random.nextUint();
      sphere.triangle = i;
      sphere.coverage[0] = random.nextUint(), sphere.coverage[1] = random.nextUint();
      sphere.depth = i < 300 ? 1 : 2;
      lights.spherical.push_back(sphere);
      GaussianLight gaussian;
      gaussian.mean = gaussian.diffuse = p;
      gaussian.covariance[0] = gaussian.covariance[5] = random.next1D();
      gaussian.normal = {0, 1, 0}, gaussian.normalSharpness = 3;
      gaussian.glossy = p * 2.f, gaussian.sharpness = 100 * random.next1D();
      gaussian.places[3] = {p, random.nextUint()};
      gaussian.depth = i < 200 ? 1 : 2;
      lights.gaussian.push_back(gaussian);
    }
    lights.diffuseDepthEnds = {0, 600, 600, 1000};
    lights.glossyDepthEnds = {0, 1000};
    lights.sphericalDepthEnds = {0, 300, 1000};
    lights.gaussianDepthEnds = {0, 200, 1000};
    return lights;
  }

  std::string message(uint64_t hash) const {
    try {
      loadLights(file_, hash);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  fs::path folder_;
  std::string file_;
};

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST_F(LightFile, RoundTrip) {
  const VirtualLights lights = someLights();
  saveLights(file_, lights);
  const VirtualLights read = loadLights(file_, lights.sceneHash);
  EXPECT_EQ(read.model, "glossy");
  EXPECT_EQ(read.sceneHash, lights.sceneHash);
  EXPECT_EQ(read.seed, 17u);
  EXPECT_EQ(read.particles, 4711u);
  EXPECT_EQ(read.maxDepth, 6);
  EXPECT_EQ(read.specularLimit, 0.125f);
  EXPECT_TRUE(read.direct);
  EXPECT_TRUE(sameBytes(read.omni, lights.omni));
  EXPECT_TRUE(sameBytes(read.directional, lights.directional));
  EXPECT_TRUE(sameBytes(read.diffuse, lights.diffuse));
  EXPECT_TRUE(sameBytes(read.glossy, lights.glossy));
  EXPECT_TRUE(sameBytes(read.spherical, lights.spherical));
  EXPECT_TRUE(sameBytes(read.gaussian, lights.gaussian));
  EXPECT_EQ(read.gaussianDepthEnds, lights.gaussianDepthEnds);
  EXPECT_EQ(read.sphericalDepthEnds, lights.sphericalDepthEnds);
  EXPECT_EQ(read.diffuseDepthEnds, lights.diffuseDepthEnds);
  EXPECT_EQ(read.glossyDepthEnds, lights.glossyDepthEnds);
}

TEST_F(LightFile, NoLightsAtAll) {
  VirtualLights none;
  none.model = "vpl";
  saveLights(file_, none);
  EXPECT_EQ(loadLights(file_, 0).size(), 0u);
}

TEST_F(LightFile, RefusesAnotherScene) {
  saveLights(file_, someLights());
  const std::string text = message(1);
  EXPECT_NE(text.find("another scene"), std::string::npos) << text;
  EXPECT_NE(text.find("lights.dat"), std::string::npos) << text;
}

// Lights made in another way would count light twice or lose it, silently.
TEST_F(LightFile, RefusesOtherSettings) {
  VirtualLights lights = someLights();
  Scene scene;
  scene.emitters.resize(8);
  scene.meshes.resize(1);
  scene.meshes[0].triangles.resize(1000);
  scene.instances.resize(1);
  scene.instances[0].mesh.index = 0;
  LightSettings settings;
  settings.maxDepth = 6;
  settings.specularLimit = 0.125f;
  settings.directAsLights = true;
  const auto refusal = [&] {
    try {
      requireFit("lights.dat", lights, settings, scene);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(), "");
  lights.spherical[7].triangle = 1000;
  EXPECT_NE(refusal().find("triangle 1000 of instance 0"), std::string::npos) << refusal();
  lights.spherical[7].triangle = 7;
  settings.maxDepth = 3, settings.directAsLights = false;  // a part of them is left out
  EXPECT_EQ(refusal(), "");
  settings.maxDepth = 7;
  EXPECT_NE(refusal().find("--max-depth 6"), std::string::npos) << refusal();
  settings.maxDepth = -1;
  EXPECT_NE(refusal().find("--max-depth 6"), std::string::npos) << refusal();
  lights.maxDepth = -1;
  EXPECT_EQ(refusal(), "");
  settings.specularLimit = 0.25f;
  EXPECT_NE(refusal().find("--specular-limit 0.125"), std::string::npos) << refusal();
  settings.specularLimit = 0.125f;
  settings.directAsLights = true, lights.direct = false;
  EXPECT_NE(refusal().find("--direct lights"), std::string::npos) << refusal();
  lights.direct = true;
  scene.emitters.resize(7);  // a light of someLights() names emitter 7
  EXPECT_NE(refusal().find("emitter 7"), std::string::npos) << refusal();
}

TEST_F(LightFile, RefusesDamagedAndCutFiles) {
  const VirtualLights lights = someLights();
  saveLights(file_, lights);
  std::string bytes;
  {
    std::ifstream in(file_, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  ASSERT_GT(bytes.size(), 1000u);
  const auto write = [&](const std::string& content) {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << content;
  };
  for (size_t at = 0; at < bytes.size(); at += bytes.size() / 97) {
    std::string broken = bytes;
    broken[at] = static_cast<char>(broken[at] ^ 0x10);
    write(broken);
    EXPECT_THROW(loadLights(file_, lights.sceneHash), InputError) << "byte " << at;
  }
  for (const size_t size : {size_t{0}, size_t{5}, bytes.size() / 2, bytes.size() - 1}) {
    write(bytes.substr(0, size));
    EXPECT_THROW(loadLights(file_, lights.sceneHash), InputError) << "cut to " << size;
  }
  EXPECT_THROW(loadLights((folder_ / "absent").string(), 0), InputError);
}

TEST_F(LightFile, RefusesGaussianLightsThatMakeNoSense) {
  const auto refused = [&](auto&& change, const char* what) {
    VirtualLights lights = someLights();
    change(&lights);
    saveLights(file_, lights);
    return message(lights.sceneHash).find(what) != std::string::npos;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([&](auto* l) { l->gaussianDepthEnds.back() = 999; }, "depths of the Gauss"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].group = 1; }, "light group 1"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].mean.x = nan; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].glossy.x = nan; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].covariance[4] = nan; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].covariance[1] = -1; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].normal = {}; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].axis.x = 1; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].normalSharpness = -1; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].sharpness = nan; }, "record"));
  EXPECT_TRUE(refused([&](auto* l) { l->gaussian[7].places[2].p.z = nan; }, "record"));
}

TEST_F(LightFile, RefusesRecordsThatMakeNoSense) {
  VirtualLights lights = someLights();
  lights.diffuseDepthEnds = {0, 900};
  saveLights(file_, lights);
  EXPECT_NE(message(lights.sceneHash).find("depths of the diffuse"), std::string::npos);

  lights = someLights();
  lights.glossy[5].axis = {0, 0, 3};
  saveLights(file_, lights);
  EXPECT_NE(message(lights.sceneHash).find("record"), std::string::npos);

  lights = someLights();
  lights.diffuse[5].intensity.y = std::numeric_limits<float>::quiet_NaN();
  saveLights(file_, lights);
  EXPECT_NE(message(lights.sceneHash).find("record"), std::string::npos);
}

}  // namespace
}  // namespace lobelia

// Keys that glTF does not know are said, with the nearest that it does.
#include "io/gltf_builder.h"
#include "lobelia/io/gltf/import.h"
#include "support/data.h"

namespace lobelia {
namespace {

using test::GltfBuilder;
using test::kOneNode;

class GltfKeys : public test::GltfTest {
 protected:
  std::vector<std::string> warningsOf(const Scene& scene) {
    std::vector<std::string> out;
    for (const Finding& f : scene.findings)
      if (f.severity == Severity::warning) out.push_back(toString(f.where) + ": " + f.message);
    return out;
  }
  // The one warning of a file with a material.
  void expectWarning(const std::string& material, const std::string& path,
                     const std::string& nearest) {
    const Scene s = read(square_.json(kOneNode + GltfBuilder::squareMesh(R"("material":0)") +
                                      R"(,"materials":[{)" + material + "}]"));
    const std::vector<std::string> warnings = warningsOf(s);
    ASSERT_EQ(warnings.size(), 1u) << material;
    EXPECT_NE(warnings[0].find(": " + path + ": "), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("did you mean '" + nearest + "'"), std::string::npos) << warnings[0];
  }
  GltfBuilder square_ = GltfBuilder::square();
};

TEST_F(GltfKeys, MisspeltOnesAreSaid) {
  expectWarning(R"("pbrMetallicRoughness":{"roughnesFactor":0.5})",
                "materials[0].pbrMetallicRoughness.roughnesFactor", "roughnessFactor");
  expectWarning(R"("doublesided":true)", "materials[0].doublesided", "doubleSided");
  expectWarning(R"("extensions":{"KHR_materials_ior":{"iro":1.3}})",
                "materials[0].extensions.KHR_materials_ior.iro", "ior");
  expectWarning(R"("extensions":{"KHR_materials_irr":{"ior":1.3}})",
                "materials[0].extensions.KHR_materials_irr", "KHR_materials_ior");
  const Scene s = read(square_.json(
      R"("nodes":[{"mesh":0,"scal":[1,1,1]},{"scal":[2,2,2]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAAL":1,"_MINE":1},"indices":3}]}])"));
  const std::vector<std::string> warnings = warningsOf(s);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("did you mean 'NORMAL'"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("nodes[0].scal: is not known here and is ignored; did you mean "
                             "'scale'? (here and 1 times more)"),
            std::string::npos)
      << warnings[1];
}

TEST_F(GltfKeys, ExtrasAndForeignExtensionsMayHoldAnything) {
  const Scene s = read(square_.json(
      R"("nodes":[{"mesh":0,"extras":{"scal":1},"extensions":{"ACME_x":{"scal":1}}}],)" +
      GltfBuilder::squareMesh() + R"(,"extras":[{"a":1}],"extensionsUsed":["ACME_x"])"));
  const std::vector<std::string> warnings = warningsOf(s);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("extensionsUsed[0]"), std::string::npos) << warnings[0];
}

// Files of several exporters and of Khronos: the table lacks none of the keys in use.
TEST_F(GltfKeys, RealFilesHaveNone) {
  const std::filesystem::path files = test::sharedFolder() + "/data/scenes/gltf";
  if (!std::filesystem::exists(files)) GTEST_SKIP() << "skipped: no " << files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(files)) {
    if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
    io::gltf::Document document(entry.path().string());
    Scene scene;
    io::gltf::warnOfUnknownKeys({document, scene, {}});
    for (const std::string& warning : warningsOf(scene)) ADD_FAILURE() << warning;
  }
}

}  // namespace
}  // namespace lobelia

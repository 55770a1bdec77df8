#include "lobelia/builtin/real_meshes.h"

#include <gtest/gtest.h>

#include "io/temporary_folder.h"
#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia {
namespace {

const Mesh& meshNamed(const Scene& scene, const std::string& name) {
  for (const Mesh& mesh : scene.meshes)
    if (mesh.name == name) return mesh;
  throw UsageError(name);
}
Bounds3f boundsOf(const Mesh& mesh) {
  Bounds3f box;
  for (const Vec3f p : mesh.positions) box.add(p);
  return box;
}
void writeBox(const std::string& file, Vec3f size, Vec3f at) {
  Mesh box = io::unitCube();
  for (Vec3f& p : box.positions) p = at + Vec3f(p.x * size.x, p.y * size.y, p.z * size.z) * 0.5f;
  io::writePly(file, box);
}

TEST(RealMeshes, FitTheStandInWhateverTheirUnits) {
  const Scene before = builtin::builtinScene("box", 0.05f);
  const Bounds3f place = boundsOf(meshNamed(before, "dragon"));
  // Wide and low, in metres; the same in millimetres.
  for (const float unit : {1.f, 1000.f}) {
    const TemporaryFolder folder;
    writeBox(folder.path("dragon.ply"), Vec3f(4, 1, 0.5f) * unit, Vec3f(70, -3, 9) * unit);
    const Scene after = builtin::builtinScene("box", 0.05f, folder.path(""));
    const Mesh& dragon = meshNamed(after, "dragon");
    EXPECT_EQ(dragon.triangles.size(), 12u);
    const Bounds3f box = boundsOf(dragon);
    const Vec3f extent = box.extent(), room = place.extent();
    EXPECT_NEAR(extent.x, room.x, 1e-4f);
    EXPECT_NEAR(extent.y, room.x / 4, 1e-4f);  // scaled alike in all directions
    EXPECT_NEAR(extent.z, room.x / 8, 1e-4f);
    EXPECT_NEAR(box.lo.y, place.lo.y, 1e-4f);
    EXPECT_NEAR(box.centre().x, place.centre().x, 1e-4f);
    EXPECT_NEAR(box.centre().z, place.centre().z, 1e-4f);
    EXPECT_TRUE(validate(after).empty());
  }
}

TEST(RealMeshes, MissingFilesAreReportedAndTheStandInStays) {
  const TemporaryFolder folder;
  writeBox(folder.path("suzanne.ply"), Vec3f(1), {});
  const Scene scene = builtin::builtinScene("tableau", 0.05f, folder.path(""));
  EXPECT_EQ(meshNamed(scene, "monkey").triangles.size(), 12u);
  EXPECT_GT(meshNamed(scene, "dragon").triangles.size(), 100u);
  std::vector<std::string> warnings;
  for (const Finding& f : scene.findings)
    if (f.severity == Severity::warning) warnings.push_back(f.message);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("'dragon'"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("'hare'"), std::string::npos) << warnings[1];
}

TEST(RealMeshes, WrongFoldersAndMeshesAreInputErrors) {
  EXPECT_THROW(builtin::builtinScene("box", 0.05f, "/no/such/folder"), InputError);
  const TemporaryFolder folder;
  writeBox(folder.path("dragon.ply"), {1, 0, 1}, {});  // flat
  EXPECT_THROW(builtin::builtinScene("box", 0.05f, folder.path("")), InputError);
  const Scene hall = builtin::builtinScene("hall", 0.05f, folder.path(""));
  ASSERT_FALSE(hall.findings.empty());
  EXPECT_EQ(hall.findings.back().severity, Severity::warning);
}

}  // namespace
}  // namespace lobelia

#include "lobelia/builtin/real_meshes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <span>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

namespace fs = std::filesystem;

// A mesh of the scenes, and what files of the real one are called, best first.
struct StandIn {
  const char* mesh;
  std::span<const char* const> files;
};
constexpr const char* kDragon[] = {"dragon", "stanford-dragon", "dragon_vrip", "dragon_vrip_res2"};
constexpr const char* kMonkey[] = {"monkey", "suzanne"};
constexpr const char* kHare[] = {"hare", "bunny", "stanford-bunny", "buddha", "happy-buddha"};
constexpr const char* kTeapot[] = {"teapot", "utah-teapot"};
constexpr StandIn kStandIns[] = {
    {"dragon", kDragon}, {"monkey", kMonkey}, {"hare", kHare}, {"teapot", kTeapot}};

fs::path findFile(const std::string& folder, const StandIn& standIn) {
  for (const char* stem : standIn.files)
    for (const char* extension : {".ply", ".obj"}) {
      const fs::path path = fs::path(folder) / (std::string(stem) + extension);
      if (fs::is_regular_file(path)) return path;
    }
  return {};
}

Bounds3f bounds(const Mesh& mesh) {
  Bounds3f box;
  for (const Vec3u& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) box.add(mesh.positions[t[c]]);
  return box;
}

Mesh fitted(Mesh mesh, const Bounds3f& place, const Location& from) {
  const Bounds3f box = bounds(mesh);
  if (box.empty() || !isFinite(box.lo) || !isFinite(box.hi) || !(minComponent(box.extent()) > 0))
    throw InputError(from, "the mesh has no extent in some direction; a solid body is needed");
  const Vec3f room = place.extent(), size = box.extent();
  const double scale =
      static_cast<double>(std::min({room.x / size.x, room.y / size.y, room.z / size.z}));
  const auto foot = [](const Bounds3f& b) {
    const Vec3f c = b.centre();
    return Vec3d(static_cast<double>(c.x), static_cast<double>(b.lo.y), static_cast<double>(c.z));
  };
  return transformed(std::move(mesh),
                     translation(foot(place)) * scaling(Vec3d(scale)) * translation(-foot(box)));
}

}  // namespace

void useRealMeshes(Scene& scene, const std::string& folder) {
  const Location where{folder, 0, 0};
  const auto report = [&](Severity severity, const Location& at, std::string message) {
    Finding finding;
    finding.severity = severity;
    finding.where = at;
    finding.message = std::move(message);
    scene.findings.push_back(std::move(finding));
  };
  if (!fs::is_directory(folder))
    throw InputError(where, "no such folder of meshes; scripts/assets makes one");
  bool any = false;
  for (Mesh& mesh : scene.meshes)
    for (const StandIn& standIn : kStandIns) {
      if (mesh.name != standIn.mesh) continue;
      any = true;
      const fs::path file = findFile(folder, standIn);
      if (file.empty()) {
        report(
            Severity::warning, where,
            fmt::format(
                "no mesh for '{}' (looked for {} as .ply and .obj); the stand-in stays", mesh.name,
                fmt::join(std::vector<std::string>(standIn.files.begin(), standIn.files.end()),
                          ", ")));
        continue;
      }
      const Location from{file.string(), 0, 0};
      Mesh real = file.extension() == ".ply" ? io::readPly(file.string(), {}, from, scene.findings)
                                             : io::readObj(file.string(), {}, from, scene.findings);
      real = fitted(std::move(real), bounds(mesh), from);
      real.name = mesh.name;
      mesh = std::move(real);
      report(Severity::info, from, fmt::format("stands for '{}'", mesh.name));
    }
  if (!any)
    report(Severity::warning, where,
           "the scene has no stand-in for a real mesh; --meshes changes nothing");
}

}  // namespace lobelia::builtin

// A mesh file as a scene: OBJ with the materials of its MTL files, a mesh for each; PLY with its
// vertex colours. What has no material is made of a neutral one. y is taken for up.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "lobelia/io/mesh_checks.h"
#include "lobelia/io/mesh_subset.h"
#include "lobelia/io/obj_materials.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::io {
namespace {

constexpr float kNeutralGrey = 0.5f, kNeutralRoughness = 0.45f;
constexpr float kHeightUnit = 0.01f;  // of the mesh's radius: MTL's bump maps have no unit

MaterialHandle addMaterial(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return {static_cast<uint32_t>(scene.materials.size() - 1)};
}

MaterialHandle neutralMaterial(Scene& scene, const Mesh& mesh) {
  Material material;
  material.type = MaterialType::metallicRoughness;
  material.name = "neutral";
  material.ior = 1.5f;
  material.diffuse = Rgb(kNeutralGrey);
  material.roughness = kNeutralRoughness;
  for (const MeshAttribute& attribute : mesh.attributes) {
    if (attribute.name != "vertex_color" || attribute.size < 3) continue;
    Texture texture;
    texture.type = TextureType::meshAttribute;
    texture.attribute = attribute.name;
    scene.textures.push_back(texture);
    material.diffuse = TextureHandle{static_cast<uint32_t>(scene.textures.size() - 1)};
  }
  Material both;
  both.type = MaterialType::twoSided;
  both.a = addMaterial(scene, std::move(material));
  return addMaterial(scene, both);
}

void addInstance(Scene& scene, Mesh mesh, const MtlMaterial& material) {
  Instance instance;
  instance.name = mesh.name;
  scene.meshes.push_back(std::move(mesh));
  instance.mesh = {static_cast<uint32_t>(scene.meshes.size() - 1)};
  instance.material = material.material;
  if (material.emission) {
    Emitter emitter;
    emitter.type = EmitterType::area;
    emitter.name = instance.name;
    emitter.radiance = *material.emission;
    scene.emitters.push_back(std::move(emitter));
    instance.emitter = {static_cast<uint32_t>(scene.emitters.size() - 1)};
  }
  scene.instances.push_back(std::move(instance));
}

void addObj(const std::string& file, Scene& scene) {
  const ObjMesh obj = readObjWithMaterials(file, {}, {}, scene.findings);
  Bounds3f box;
  for (const Vec3f p : obj.mesh.positions) box.add(p);
  std::map<std::string, MtlMaterial> known;
  for (const std::string& library : obj.libraries) {
    const std::filesystem::path path = std::filesystem::path(file).parent_path() / library;
    known.merge(readMtl(path.string(), kHeightUnit * box.radius(), scene));
  }
  // Triangles by material; those without come last.
  std::vector<std::vector<uint32_t>> groups(obj.materials.size() + 1);
  for (uint32_t t = 0; t < obj.triangleMaterials.size(); ++t)
    groups[std::min<size_t>(obj.triangleMaterials[t], obj.materials.size())].push_back(t);
  for (size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].empty()) continue;
    Mesh mesh =
        groups[g].size() == obj.mesh.triangles.size() ? obj.mesh : subset(obj.mesh, groups[g]);
    const bool named = g < obj.materials.size();
    const auto found = named ? known.find(obj.materials[g]) : known.end();
    if (named) mesh.name = obj.materials[g];
    if (named && found == known.end())
      addWarning(scene.findings, {file, 0, 0},
                 fmt::format("no MTL file has the material '{}'; a neutral one is used",
                             obj.materials[g]));
    const MtlMaterial material =
        found != known.end() ? found->second : MtlMaterial{neutralMaterial(scene, mesh), {}};
    addInstance(scene, std::move(mesh), material);
  }
}

}  // namespace

Scene readBareMesh(const std::string& file, const ReadSettings& settings, Context&) {
  Scene scene;
  scene.file = file;
  scene.name = std::filesystem::path(file).stem().string();
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".obj") {
    addObj(file, scene);
  } else {
    Mesh mesh = readPly(file, {}, {}, scene.findings);
    const MtlMaterial neutral{neutralMaterial(scene, mesh), {}};
    addInstance(scene, std::move(mesh), neutral);
  }
  applyEnvironment(scene, settings);
  addDefaultView(scene);
  return scene;
}

}  // namespace lobelia::io

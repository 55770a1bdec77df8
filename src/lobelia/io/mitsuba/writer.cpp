// A scene as a Mitsuba 3 file: scene.xml, meshes/*.ply, textures/*.exr and *.png. Reading it again
// gives the same scene: numbers are written with all their digits, images losslessly.
//
// What the format cannot say is left out: textures, materials and area emitters that nothing uses
// may move or go, radii of the Mitchell and Catmull-Rom filters, names of odd characters.
#include "lobelia/io/mitsuba/writer.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/mesh_io.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::io {
namespace mitsuba {
namespace {

bool sameGeometry(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.uvs == b.uvs &&
         a.triangles == b.triangles && a.attributes.empty() && b.attributes.empty();
}

// Degrees as a float which the reader's float arithmetic turns into exactly these radians; the
// nearest when there is none.
float degrees(float radians) {
  constexpr float kDegree = kPi / 180;
  float d = radians / kDegree;
  for (const float direction : {-1e30f, 1e30f}) {
    float candidate = d;
    for (int i = 0; i < 4; ++i, candidate = std::nextafter(candidate, direction))
      if (candidate * kDegree == radians) return candidate;
  }
  return d;
}

double exactDegrees(float radians) {
  return static_cast<double>(radians) * 180 / static_cast<double>(kPi);
}

const char* filterName(PixelFilter filter) {
  constexpr const char* kNames[] = {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"};
  return kNames[static_cast<size_t>(filter)];
}

// The name of the plugin, ours where Mitsuba has none.
const char* pluginName(EmitterType type) {
  switch (type) {
    case EmitterType::area:
      return "area";
    case EmitterType::point:
      return "point";
    case EmitterType::spot:
      return "spot";
    case EmitterType::directional:
      return "directional";
    case EmitterType::constant:
      return "constant";
    case EmitterType::environment:
      return "envmap";
    case EmitterType::projector:
      return "projector";
    case EmitterType::goniometric:
      return "goniometric";
    case EmitterType::sun:
      break;
  }
  return "sun";
}

void createFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw RuntimeError(fmt::format("cannot create folder '{}': {}", folder, error.message()));
}

}  // namespace

std::string cleanName(const std::string& wanted) {
  std::string clean;
  for (const char c : wanted) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    clean += plain ? c : '_';
  }
  while (!clean.empty() && clean[0] == '.')
    clean.erase(0, 1);  // hidden files, "..", names of nothing
  if (clean.size() > 80) clean.resize(80);
  return clean;
}

std::string Names::make(const std::string& wanted, const std::string& otherwise) {
  std::string clean = cleanName(wanted);
  if (clean.empty()) clean = otherwise;
  std::string name = clean;
  for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}_{}", clean, i);
  return name;
}

std::string text(float value) { return fmt::format("{}", value); }
std::string text(double value) { return fmt::format("{}", value); }
std::string text(Rgb v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); }

pugi::xml_node object(pugi::xml_node parent, const char* tag, const char* type,
                      const std::string& id) {
  pugi::xml_node node = parent.append_child(tag);
  node.append_attribute("type") = type;
  if (!id.empty()) node.append_attribute("id") = id.c_str();
  return node;
}

void property(pugi::xml_node parent, const char* tag, const char* name, const std::string& value) {
  pugi::xml_node node = parent.append_child(tag);
  node.append_attribute("name") = name;
  node.append_attribute("value") = value.c_str();
}

void appendMatrix(pugi::xml_node transform, const Mat4& matrix) {
  std::string numbers;
  for (const auto& row : matrix.m)
    for (const double v : row) numbers += fmt::format("{}{}", numbers.empty() ? "" : " ", v);
  transform.append_child("matrix").append_attribute("value") = numbers.c_str();
}

void transform(pugi::xml_node parent, const char* name, const Mat4& matrix) {
  if (matrix.isIdentity()) return;
  pugi::xml_node node = parent.append_child("transform");
  node.append_attribute("name") = name;
  appendMatrix(node, matrix);
}

// As Mitsuba 0.6 has it; Mitsuba 3 knows no moving sensors.
void animation(pugi::xml_node parent, const char* name, const std::vector<CameraKey>& keys) {
  pugi::xml_node node = parent.append_child("animation");
  node.append_attribute("name") = name;
  for (const CameraKey& key : keys) {
    pugi::xml_node transform = node.append_child("transform");
    transform.append_attribute("time") = fmt::format("{}", key.time).c_str();
    appendMatrix(transform, key.toWorld.to);
  }
}

Writer::Writer(const Scene& scene, std::string folder)
    : scene_(scene), folder_(std::move(folder)) {}

void Writer::write() {
  createFolder(folder_);
  root_ = document_.append_child("scene");
  root_.append_attribute("version") = "3.0.0";
  writeIntegrator();
  writeCameras();
  writeImages();
  writeTextures();
  writeMaterials();
  writeMeshes();
  writeInstances();
  writeEmitters();
  std::ostringstream xml;
  document_.save(xml, "  ");
  writeFileAtomically(folder_ + "/scene.xml", std::move(xml).str());
}

void Writer::writeIntegrator() {
  Node node =
      object(root_, "integrator", scene_.integrator.empty() ? "path" : scene_.integrator.c_str());
  property(node, "integer", "max_depth", std::to_string(scene_.maxDepth));
  if (scene_.hideEmitters) property(node, "boolean", "hide_emitters", "true");
}

void Writer::writeCameras() {
  for (const Camera& camera : scene_.cameras) writeCamera(camera, ids_.make(camera.name, "camera"));
}

void Writer::writeCamera(const Camera& camera, const std::string& id) {
  const bool perspective = camera.type == CameraType::perspective, lens = camera.apertureRadius > 0;
  Node node = object(root_, "sensor",
                     !perspective ? "orthographic"
                     : lens       ? "thinlens"
                                  : "perspective",
                     id);
  if (perspective) {
    property(node, "float", "fov", text(exactDegrees(camera.fovX)));
    property(node, "string", "fov_axis", "x");
    property(node, "float", "principal_point_offset_x", text(camera.principalPointOffset.x));
    property(node, "float", "principal_point_offset_y", text(camera.principalPointOffset.y));
  }
  property(node, "float", "near_clip", text(camera.nearClip));
  property(node, "float", "far_clip", text(camera.farClip));
  if (camera.focusDistance > 0)
    property(node, "float", "focus_distance", text(camera.focusDistance));
  if (perspective && lens) property(node, "float", "aperture_radius", text(camera.apertureRadius));
  if (camera.path.empty()) {
    transform(node, "to_world", camera.toWorld.to);
  } else {
    animation(node, "to_world", camera.path);
  }
  if (camera.spp > 0)
    property(object(node, "sampler", "independent"), "integer", "sample_count",
             std::to_string(camera.spp));
  writeFilm(node, camera);
}

void Writer::writeFilm(Node sensor, const Camera& camera) {
  Node film = object(sensor, "film", "hdrfilm");
  property(film, "integer", "width", std::to_string(camera.width));
  property(film, "integer", "height", std::to_string(camera.height));
  if (camera.cropX1 > 0) {
    property(film, "integer", "crop_offset_x", std::to_string(camera.cropX0));
    property(film, "integer", "crop_offset_y", std::to_string(camera.cropY0));
    property(film, "integer", "crop_width", std::to_string(camera.cropX1 - camera.cropX0));
    property(film, "integer", "crop_height", std::to_string(camera.cropY1 - camera.cropY0));
  }
  Node filter = object(film, "rfilter", filterName(camera.filter));
  if (!(camera.filterRadius > 0)) return;
  if (camera.filter == PixelFilter::box || camera.filter == PixelFilter::tent)
    property(filter, "float", "radius", text(camera.filterRadius));
  if (camera.filter == PixelFilter::gaussian)  // Mitsuba cuts it at four standard deviations
    property(filter, "float", "stddev", text(camera.filterRadius / 4));
  if (camera.filter == PixelFilter::lanczos)
    property(filter, "integer", "lobes", std::to_string(std::lround(camera.filterRadius)));
}

// Meshes that are one of Mitsuba's shapes are written as such, the rest as files.
void Writer::writeMeshes() {
  const Mesh shapes[] = {unitRectangle(), unitCube(), unitDisk(), unitCylinder()};
  Names files;
  for (const Mesh& mesh : scene_.meshes) {
    std::string type = mesh.isUnitSphere ? "sphere" : mesh.triangles.empty() ? "" : "ply", file;
    if (type == "ply")
      for (const Mesh& shape : shapes)
        if (sameGeometry(mesh, shape)) type = shape.name;
    if (type == "ply") {
      file = fmt::format("meshes/{}.ply", files.make(mesh.name, "mesh"));
      createFolder(folder_ + "/meshes");
      writePly(folder_ + "/" + file, mesh);
    }
    meshTypes_.push_back(type);
    meshFiles_.push_back(file);
  }
}

void Writer::writeInstances() {
  emitterIds_.resize(scene_.emitters.size());
  for (const Instance& instance : scene_.instances) {
    const Mesh& mesh = scene_[instance.mesh];
    const std::string& type = meshTypes_[instance.mesh.index];
    if (type.empty()) continue;  // no triangles
    Node node = object(root_, "shape", type.c_str(), ids_.make(instance.name, "shape"));
    bool flip = instance.flipNormals;
    if (type == "ply") {
      property(node, "string", "filename", meshFiles_[instance.mesh.index]);
      if (mesh.normals.empty()) {
        property(node, "boolean", "face_normals", "true");
        // Mitsuba 3 finds the normal of such a mesh from the transformed triangles.
        if (instance.toWorld.to.determinant3() < 0) flip = !flip;
      }
    }
    if (flip) property(node, "boolean", "flip_normals", "true");
    transform(node, "to_world", instance.toWorld.to);
    if (instance.material.valid()) reference(node, materialIds_[instance.material.index]);
    if (!instance.emitter.valid()) continue;
    std::string& id = emitterIds_[instance.emitter.index];
    if (!id.empty()) {
      reference(node, id);
      continue;
    }
    const Emitter& emitter = scene_[instance.emitter];
    id = ids_.make(emitter.name, "emitter");
    emitterProperties(object(node, "emitter", "area", id), emitter);
  }
}

void Writer::writeEmitters() {
  for (const Emitter& emitter : scene_.emitters) {
    if (emitter.type == EmitterType::area) continue;  // written with its shapes
    writeEmitter(emitter, ids_.make(emitter.name, "emitter"));
  }
}

void Writer::writeEmitter(const Emitter& emitter, const std::string& id) {
  emitterProperties(object(root_, "emitter", pluginName(emitter.type), id), emitter);
}

void Writer::emitterProperties(Node node, const Emitter& e) {
  if (!e.group.empty()) property(node, "string", "group", e.group);
  switch (e.type) {
    case EmitterType::area:
      color(node, "radiance", e.radiance);
      break;
    case EmitterType::point:
      transform(node, "to_world", e.toWorld.to);
      color(node, "intensity", e.radiance);
      break;
    case EmitterType::spot:
      transform(node, "to_world", e.toWorld.to);
      color(node, "intensity", e.radiance);
      property(node, "float", "cutoff_angle", text(degrees(e.cutoff)));
      property(node, "float", "beam_width", text(degrees(e.beamWidth)));
      if (e.pattern.valid()) reference(node, textureId(e.pattern, false), "texture");
      break;
    case EmitterType::sun:
      property(node, "float", "angular_radius", text(exactDegrees(e.angularRadius)));
      [[fallthrough]];
    case EmitterType::directional:
      color(node, "irradiance", e.radiance);
      if (normalize(e.toWorld.vector({0, 0, 1})) == e.direction) {
        transform(node, "to_world", e.toWorld.to);
      } else {
        property(node, "vector", "direction", text(e.direction));
      }
      break;
    case EmitterType::constant:
      color(node, "radiance", e.radiance);
      break;
    case EmitterType::environment:
      property(node, "string", "filename", imageFile(e.image));
      property(node, "float", "scale", text(e.scale));
      transform(node, "to_world", e.toWorld.to);
      break;
    case EmitterType::goniometric:
      property(node, "string", "filename", imageFile(e.image));
      color(node, "intensity", e.radiance);
      property(node, "float", "scale", text(e.scale));
      transform(node, "to_world", e.toWorld.to);
      break;
    case EmitterType::projector:
      if (e.radiance.texture.valid())
        reference(node, textureId(e.radiance.texture, false), "irradiance");
      else
        color(node, "irradiance", e.radiance);
      property(node, "float", "scale", text(e.scale));
      property(node, "float", "fov", text(exactDegrees(e.fov)));
      transform(node, "to_world", e.toWorld.to);
      break;
  }
}

}  // namespace mitsuba

void writeMitsuba(const std::string& folder, const Scene& scene) {
  mitsuba::Writer(scene, folder).write();
}

}  // namespace lobelia::io

// Reads glTF 2.0 (Khronos, ISO/IEC 12113:2022), text and binary. Units are metres, y is up, as
// here. The scene read is the one that the file names, else the first, else all root nodes;
// animations are taken at ReadSettings::time.
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "lobelia/io/default_view.h"
#include "lobelia/io/gltf/materials.h"
#include "lobelia/io/gltf/primitives.h"
#include "lobelia/io/gltf/views.h"
#include "lobelia/io/light_backs.h"

namespace lobelia::io {
namespace gltf {
namespace {

constexpr size_t kMaxInstances = 1u << 20;  // of a node, by EXT_mesh_gpu_instancing

class Reader {
 public:
  Reader(Document& document, const ReadSettings& settings, Scene& scene)
      : import_{document, scene, settings}, materials_(import_), backs_(scene) {}

  void read(Context& context);

 private:
  std::vector<size_t> sceneNodes() const;
  void addNode(size_t node);
  void addMesh(size_t node);
  std::vector<Mat4> placements(size_t node) const;
  std::vector<Mat4> joints(const Json& skin) const;
  const Primitive& primitive(const Json& mesh, size_t index);
  void addInstances(const Json& node, const Json& primitiveJson, const Primitive& primitive,
                    const std::vector<Mat4>& toWorld);

  Import import_;
  Materials materials_;
  LightBacks backs_;
  std::vector<Node> nodes_;
  std::vector<Channel> channels_;
  std::vector<Pose> poses_;
  std::vector<Mat4> world_;
  std::map<std::string, Primitive> primitives_;  // by path; those that nothing deforms
};

void Reader::read(Context& context) {
  nodes_ = readNodes(import_.document);
  channels_ = readChannels(import_, nodes_);
  poses_ = posesAt(nodes_, channels_, static_cast<double>(import_.settings.time));
  world_ = worldMatrices(nodes_, poses_);
  for (size_t i = 0; i < world_.size(); ++i)
    if (!world_[i].isFinite()) nodes_[i].json.fail("its transform to the world is not finite");
  informOfRanges(import_);
  for (const size_t node : sceneNodes()) {
    if (context.cancelled()) return;
    addNode(node);
  }
}

// In the order of the file, each node before its children.
std::vector<size_t> Reader::sceneNodes() const {
  const Json root = import_.document.root(), scenes = root["scenes"];
  std::vector<size_t> open, out;
  if (scenes.size() > 0) {
    const Json scene =
        scenes.at(root["scene"].exists() ? root["scene"].index(scenes.size(), "scenes") : 0);
    const Json items = scene["nodes"];
    for (size_t i = items.size(); i-- > 0;)
      open.push_back(items.at(i).index(nodes_.size(), "nodes"));
    import_.scene.name = scene["name"].text("");
  } else {
    for (size_t i = nodes_.size(); i-- > 0;)
      if (nodes_[i].parent < 0) open.push_back(i);
  }
  std::vector<bool> seen(nodes_.size());
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    const Node& node = nodes_[i];
    if (seen[i]) node.json.fail("the scene lists it more than once");
    seen[i] = true;
    if (!node.json.extension("KHR_node_visibility")["visible"].boolean(true)) continue;
    out.push_back(i);
    open.insert(open.end(), node.children.rbegin(), node.children.rend());
  }
  return out;
}

void Reader::addNode(size_t node) {
  const Json& json = nodes_[node].json;
  if (json["mesh"].exists()) addMesh(node);
  if (json["camera"].exists()) addCamera(import_, {nodes_, channels_}, node, world_[node]);
  if (json.extension("KHR_lights_punctual").exists()) addLight(import_, json, world_[node]);
}

// The node's own place, or those of its instances (EXT_mesh_gpu_instancing).
std::vector<Mat4> Reader::placements(size_t node) const {
  const Json& json = nodes_[node].json;
  const Json attributes = json.extension("EXT_mesh_gpu_instancing")["attributes"];
  if (!attributes.exists()) return {world_[node]};
  std::map<std::string, FloatArray> values;
  std::optional<size_t> count;
  for (const std::string& name : attributes.members()) {
    const bool own = name.starts_with("_");  // an application's: only says how many there are
    if (!own && name != "TRANSLATION" && name != "ROTATION" && name != "SCALE")
      attributes[name].fail("is unknown; it must be TRANSLATION, ROTATION or SCALE");
    FloatArray array;
    if (own) {
      array.count = static_cast<size_t>(
          import_.document.item("accessors", attributes[name])["count"].count());
    } else {
      array = readFloats(import_.document, attributes[name], name == "ROTATION" ? "VEC4" : "VEC3");
    }
    if (array.count > kMaxInstances)
      attributes[name].fail(
          fmt::format("places {} instances; at most {} are read", array.count, kMaxInstances));
    if (count && *count != array.count)
      attributes[name].fail(
          fmt::format("has {} elements; another attribute has {}", array.count, *count));
    count = array.count;
    values[name] = std::move(array);
  }
  std::vector<Mat4> out;
  const auto vector = [&](const char* name, size_t i, double fallback) {
    const auto found = values.find(name);
    if (found == values.end()) return Vec3d(fallback);
    const Vec3f v = found->second.vec3(i);
    return Vec3d(v.x, v.y, v.z);
  };
  for (size_t i = 0; i < count.value_or(0); ++i) {
    Pose pose;
    pose.translation = vector("TRANSLATION", i, 0);
    pose.scale = vector("SCALE", i, 1);
    if (const auto found = values.find("ROTATION"); found != values.end())
      for (size_t c = 0; c < 4; ++c) pose.rotation[c] = static_cast<double>(found->second[i][c]);
    out.push_back(world_[node] * pose.toParent());
  }
  return out;
}

// Joint to world times the inverse bind matrix, for each joint (glTF 2.0, 3.7.3).
std::vector<Mat4> Reader::joints(const Json& skin) const {
  const Json items = skin["joints"];
  if (items.size() == 0) items.fail("is empty; a skin has at least one joint");
  std::vector<Mat4> out;
  for (size_t i = 0; i < items.size(); ++i)
    out.push_back(world_[items.at(i).index(nodes_.size(), "nodes")]);
  const Json inverse = skin["inverseBindMatrices"];
  if (!inverse.exists()) return out;
  const FloatArray matrices = readFloats(import_.document, inverse, "MAT4");
  if (matrices.count < out.size())
    inverse.fail(fmt::format("has {} matrices; there are {} joints", matrices.count, out.size()));
  for (size_t i = 0; i < out.size(); ++i) {
    Mat4 m;
    for (size_t r = 0; r < 4; ++r)
      for (size_t c = 0; c < 4; ++c) m.m[r][c] = static_cast<double>(matrices[i][c * 4 + r]);
    m.m[3] = {0, 0, 0, 1};
    out[i] = out[i] * m;
  }
  return out;
}

const Primitive& Reader::primitive(const Json& mesh, size_t index) {
  const Json json = mesh["primitives"].at(index);
  const auto found = primitives_.find(json.path());
  if (found != primitives_.end()) return found->second;
  return primitives_[json.path()] = addPrimitive(import_, materials_, mesh, json, {});
}

void Reader::addMesh(size_t node) {
  const Json& json = nodes_[node].json;
  const Json mesh = import_.document.item("meshes", json["mesh"]);
  const Json list = mesh["primitives"];
  if (list.size() == 0) list.fail("is missing or empty; a mesh has at least one primitive");
  Deformation deformation;
  deformation.weights = poses_[node].weights;
  if (const Json weights = mesh["weights"]; deformation.weights.empty() && weights.exists())
    deformation.weights = weights.numbers(weights.size());
  std::vector<Mat4> toWorld;
  if (json["skin"].exists()) {
    // The joints alone say where the mesh is; the node's own transform is not used.
    deformation.joints = joints(import_.document.item("skins", json["skin"]));
    toWorld = {Mat4{}};
  } else {
    toWorld = placements(node);
  }
  bool morphs = false;
  for (const double w : deformation.weights) morphs = morphs || w != 0;
  for (size_t p = 0; p < list.size(); ++p) {
    const Json primitiveJson = list.at(p);
    const bool deforms =
        !deformation.joints.empty() || (morphs && primitiveJson["targets"].size() > 0);
    if (deforms) {
      addInstances(json, primitiveJson,
                   addPrimitive(import_, materials_, mesh, primitiveJson, deformation), toWorld);
    } else {
      addInstances(json, primitiveJson, primitive(mesh, p), toWorld);
    }
  }
}

void Reader::addInstances(const Json& node, const Json& primitiveJson, const Primitive& primitive,
                          const std::vector<Mat4>& toWorld) {
  Scene& scene = import_.scene;
  const Json material = materials_.of(primitiveJson);
  const bool tangents = materials_.uvSets(material).tangents;
  const BuiltMaterial* builds[2] = {};  // for parts that are mirrored or not
  const std::string name = node["name"].text("");
  size_t flat = 0;
  for (const Mat4& matrix : toWorld) {
    if (!inverse(matrix)) {
      ++flat;
      continue;
    }
    for (const Part& part : primitive.parts) {
      const bool mirrored = tangents && part.mirrored != (matrix.determinant3() < 0);
      const BuiltMaterial*& built = builds[mirrored ? 1 : 0];
      if (!built)
        built =
            &materials_.build(material, {primitive.vertexColor, primitive.vertexAlpha, mirrored});
      Instance instance;
      instance.mesh = part.mesh;
      instance.toWorld = Transform(matrix);
      instance.material = built->material;
      instance.name = name;
      if (built->emission) {
        Emitter emitter;
        emitter.type = EmitterType::area;
        emitter.name = instance.name;
        emitter.radiance = *built->emission;
        scene.emitters.push_back(std::move(emitter));
        instance.emitter = {static_cast<uint32_t>(scene.emitters.size() - 1)};
      }
      scene.instances.push_back(std::move(instance));
      if (built->emission && built->shinesBothWays) backs_.add(scene.instances.size() - 1);
    }
  }
  if (flat > 0)
    import_.inform(node, fmt::format("{} instances are left out: their transform flattens space (a "
                                     "scale of 0)",
                                     flat));
}

// glTF's core has emission up to 1 for displays and signs: files with nothing else expect the light
// of a viewer.
bool onlyGlows(const Scene& scene) {
  for (const Emitter& emitter : scene.emitters) {
    const ColorParam& radiance = emitter.radiance;
    if (emitter.type != EmitterType::area) return false;
    const bool scaled =
        radiance.texture.valid() && scene[radiance.texture].type == TextureType::scale;
    const float most = scaled ? scene[radiance.texture].scale : maxComponent(radiance.value);
    if (most > 1) return false;
  }
  return true;
}

}  // namespace
}  // namespace gltf

Scene readGltf(const std::string& file, const ReadSettings& settings, Context& context) {
  gltf::Document document(file);
  Scene scene;
  scene.file = file;
  gltf::checkAsset({document, scene, settings});
  gltf::warnOfUnknownKeys({document, scene, settings});
  scene.variants = gltf::variantNames(document);
  gltf::Reader(document, settings, scene).read(context);
  if (scene.name.empty()) scene.name = std::filesystem::path(file).stem().string();
  applyEnvironment(scene, settings);
  const bool glows = !scene.emitters.empty() && gltf::onlyGlows(scene);
  addDefaultView(scene);
  if (glows) addStudio(scene, "surfaces glow, but none brighter than white, and there is no light");
  return scene;
}

}  // namespace lobelia::io

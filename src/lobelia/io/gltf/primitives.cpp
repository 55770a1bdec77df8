// A primitive without NORMAL is flat, as glTF 2.0, 3.7.2.1 has it. TANGENT is not read: see
// materials.h.
#include "lobelia/io/gltf/primitives.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "lobelia/io/gltf/accessors.h"
#include "lobelia/io/gltf/draco.h"
#include "lobelia/io/gltf/topology.h"
#include "lobelia/io/mesh_checks.h"
#include "lobelia/io/mesh_subset.h"

namespace lobelia::io::gltf {
namespace {

// A primitive's vertex data, wherever they lie.
class Attributes {
 public:
  Attributes(Document& document, const Json& primitive)
      : document_(document), primitive_(primitive), draco_(decodeDraco(document, primitive)) {}

  bool has(const std::string& name) const { return primitive_["attributes"][name].exists(); }
  FloatArray read(const std::string& name, std::string_view types) const {
    const Json where = primitive_["attributes"][name];
    FloatArray values;
    if (draco_ && draco_->attributes.contains(name)) {
      values = draco_->attributes.at(name);
      const std::string type = document_.item("accessors", where)["type"].text();
      if (types.find(type) == types.npos)
        where.fail(fmt::format("is of type {}; it must be {}", type, types));
    } else {
      values = readFloats(document_, where, types);
    }
    if (count_ && values.count != *count_)
      where.fail(fmt::format("has {} elements; POSITION has {}", values.count, *count_));
    return values;
  }
  FloatArray readPositions() {
    const FloatArray values = read("POSITION", "VEC3");
    count_ = values.count;
    return values;
  }
  // KHR_draco_mesh_compression decodes to faces, also those of strips.
  bool areFaces() const { return draco_.has_value(); }
  // glTF 2.0, 3.7.3.3: joints are unsigned bytes or shorts, not normalised.
  FloatArray readJoints(const std::string& name) const {
    const Json where = primitive_["attributes"][name];
    const Json accessor = document_.item("accessors", where);
    const uint64_t type = accessor["componentType"].count();
    if (type != 5121 && type != 5123)
      where.fail(
          fmt::format("its componentType is {}; it must be 5121 or 5123 (unsigned byte or "
                      "short)",
                      type));
    if (accessor["normalized"].boolean(false)) where.fail("is normalized; joints must not be");
    return read(name, "VEC4");
  }
  std::vector<uint32_t> readIndices() const {
    const Json where = primitive_["indices"];
    std::vector<uint32_t> indices;
    if (draco_) {
      indices = draco_->indices;
    } else if (where.exists()) {
      indices = readIntegers(document_, where, "SCALAR");
    } else {
      if (*count_ > 0xfffffffeu) primitive_.fail("has more vertices than are read");
      indices.resize(*count_);
      std::iota(indices.begin(), indices.end(), 0u);
    }
    for (size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= *count_)
        where.fail(fmt::format("index {} is {}; there are {} vertices (counted from 0)", i,
                               indices[i], *count_));
    return indices;
  }

 private:
  Document& document_;
  Json primitive_;
  std::optional<DracoPrimitive> draco_;
  std::optional<size_t> count_;
};

std::vector<Vec3f> vectors(const FloatArray& values) {
  std::vector<Vec3f> out(values.count);
  for (size_t i = 0; i < values.count; ++i) out[i] = values.vec3(i);
  return out;
}

void morph(Document& document, const Json& targets, const std::string& attribute,
           const std::vector<double>& weights, std::vector<Vec3f>& values) {
  for (size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
    const Json where = targets.at(t)[attribute];
    if (weights[t] == 0 || !where.exists()) continue;
    const FloatArray delta = readFloats(document, where, "VEC3");
    if (delta.count != values.size())
      where.fail(fmt::format("has {} elements; the primitive has {} vertices", delta.count,
                             values.size()));
    for (size_t i = 0; i < values.size(); ++i)
      values[i] += delta.vec3(i) * static_cast<float>(weights[t]);
  }
}

// Directions that stay perpendicular to surfaces: cofactors, the inverse transpose times |det|.
Vec3f transformNormal(const Mat4& m, Vec3f n) {
  const auto column = [&](size_t c) { return Vec3d(m.m[0][c], m.m[1][c], m.m[2][c]); };
  const Vec3d a = column(0), b = column(1), c = column(2);
  const double sign = m.determinant3() < 0 ? -1 : 1;
  const Vec3d r = (cross(b, c) * static_cast<double>(n.x) + cross(c, a) * static_cast<double>(n.y) +
                   cross(a, b) * static_cast<double>(n.z)) *
                  sign;
  const double len = length(r);
  if (!(len > 0)) return n;
  return {static_cast<float>(r.x / len), static_cast<float>(r.y / len),
          static_cast<float>(r.z / len)};
}

// Linear blend skinning by all JOINTS_n and WEIGHTS_n; weights are normalised to a sum of 1.
void skin(const Attributes& attributes, const Json& primitive, const std::vector<Mat4>& joints,
          Mesh& mesh) {
  std::vector<FloatArray> indices, weights;
  for (int set = 0; attributes.has(fmt::format("JOINTS_{}", set)); ++set) {
    indices.push_back(attributes.readJoints(fmt::format("JOINTS_{}", set)));
    weights.push_back(attributes.read(fmt::format("WEIGHTS_{}", set), "VEC4"));
  }
  if (indices.empty())
    primitive["attributes"]["JOINTS_0"].fail("is missing; the node that shows the mesh has a skin");
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    Mat4 blended;
    for (auto& row : blended.m) row = {0, 0, 0, 0};
    double sum = 0;
    for (size_t s = 0; s < indices.size(); ++s)
      for (size_t k = 0; k < 4; ++k) {
        const double w = static_cast<double>(weights[s][v][k]);
        if (w == 0) continue;
        const auto joint = static_cast<size_t>(indices[s][v][k]);
        if (indices[s][v][k] < 0 || joint >= joints.size())
          primitive["attributes"][fmt::format("JOINTS_{}", s)].fail(fmt::format(
              "vertex {} is moved by joint {}; the skin has {}", v, joint, joints.size()));
        for (size_t r = 0; r < 4; ++r)
          for (size_t c = 0; c < 4; ++c) blended.m[r][c] += w * joints[joint].m[r][c];
        sum += w;
      }
    if (!(std::abs(sum) > 1e-12)) continue;  // moved by nothing: stays
    for (size_t r = 0; r < 3; ++r)
      for (size_t c = 0; c < 4; ++c) blended.m[r][c] /= sum;
    blended.m[3] = {0, 0, 0, 1};
    mesh.positions[v] = blended.point(mesh.positions[v]);
    if (!mesh.normals.empty()) mesh.normals[v] = transformNormal(blended, mesh.normals[v]);
  }
}

void addUvs(const Import& import, const Attributes& attributes, const Json& primitive,
            const UvSets& uv, Mesh& mesh) {
  const auto read = [&](size_t set) {
    const std::string name = fmt::format("TEXCOORD_{}", set);
    if (attributes.has(name)) return attributes.read(name, "VEC2").values;
    if (uv.needed)
      import.warn(primitive["attributes"][name],
                  "is missing, but a texture of the material needs it; taken for 0, 0");
    return uv.needed ? std::vector<float>(mesh.positions.size() * 2) : std::vector<float>();
  };
  const std::vector<float> first = read(uv.first);
  for (size_t i = 0; i + 1 < first.size(); i += 2) mesh.uvs.push_back({first[i], first[i + 1]});
  for (const size_t set : uv.others) {
    MeshAttribute attribute;
    attribute.name = uvAttribute(set);
    attribute.size = 2;
    attribute.values = read(set);
    mesh.attributes.push_back(std::move(attribute));
  }
}

void addColors(const Attributes& attributes, bool usesAlpha, Mesh& mesh, Primitive& out) {
  if (!attributes.has("COLOR_0")) return;
  const FloatArray colors = attributes.read("COLOR_0", "VEC3 VEC4");
  MeshAttribute color, alpha;
  color.name = "vertex_color", alpha.name = "vertex_alpha";
  alpha.size = 1;
  for (size_t i = 0; i < colors.count; ++i) {
    color.values.insert(color.values.end(), colors[i], colors[i] + 3);
    if (colors.components == 4) alpha.values.push_back(colors[i][3]);
  }
  out.vertexColor = true;
  mesh.attributes.push_back(std::move(color));
  out.vertexAlpha = usesAlpha && colors.components == 4;
  if (out.vertexAlpha) mesh.attributes.push_back(std::move(alpha));
}

// Do the uv of a triangle, seen from outside, run as in a mirror? In glTF v points down.
bool isMirrored(const Mesh& mesh, Vec3u t) {
  const Vec2f a = mesh.uvs[t.y] - mesh.uvs[t.x], b = mesh.uvs[t.z] - mesh.uvs[t.x];
  const float uvArea = a.x * b.y - a.y * b.x;
  if (mesh.normals.empty()) return uvArea > 0;
  const Vec3f n =
      cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
  return uvArea * dot(n, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) > 0;
}

MeshHandle addMesh(Scene& scene, Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  return {static_cast<uint32_t>(scene.meshes.size() - 1)};
}

void addParts(Scene& scene, const UvSets& uv, Mesh mesh, Primitive& out) {
  std::vector<uint32_t> sides[2];  // triangles that are not mirrored, and that are
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    sides[uv.tangents && !mesh.uvs.empty() && isMirrored(mesh, mesh.triangles[i]) ? 1 : 0]
        .push_back(i);
  const bool split = !sides[0].empty() && !sides[1].empty();
  for (const bool mirrored : {false, true}) {
    const std::vector<uint32_t>& triangles = sides[mirrored ? 1 : 0];
    if (triangles.empty()) continue;
    out.parts.push_back(
        {addMesh(scene, split ? subset(mesh, triangles) : std::move(mesh)), mirrored});
  }
}

}  // namespace

Primitive addPrimitive(const Import& import, const Materials& materials, const Json& meshJson,
                       const Json& primitive, const Deformation& deformation) {
  Primitive out;
  const Json attributesJson = primitive["attributes"];
  if (!attributesJson["POSITION"].exists()) {
    import.warn(attributesJson, "a primitive without POSITION is left out");
    return out;
  }
  Attributes attributes(import.document, primitive);
  const Json material = materials.of(primitive);
  Mesh mesh;
  mesh.name = meshJson["name"].text("");
  if (mesh.name.empty()) mesh.name = "mesh";
  mesh.positions = vectors(attributes.readPositions());
  mesh.triangles = trianglesOf(import, primitive, attributes.readIndices(), attributes.areFaces());
  if (mesh.triangles.empty()) return out;
  if (attributes.has("NORMAL")) mesh.normals = vectors(attributes.read("NORMAL", "VEC3"));
  const UvSets uv = materials.uvSets(material);
  addUvs(import, attributes, primitive, uv, mesh);
  addColors(attributes, materials.usesAlpha(material), mesh, out);

  const Json targets = primitive["targets"];
  morph(import.document, targets, "POSITION", deformation.weights, mesh.positions);
  if (!mesh.normals.empty())
    morph(import.document, targets, "NORMAL", deformation.weights, mesh.normals);
  if (!deformation.joints.empty()) skin(attributes, primitive, deformation.joints, mesh);

  MeshOptions options;
  options.faceNormals = mesh.normals.empty();
  finishMesh(mesh, primitive.where().file, options, import.scene.findings);
  addParts(import.scene, uv, std::move(mesh), out);
  return out;
}

}  // namespace lobelia::io::gltf

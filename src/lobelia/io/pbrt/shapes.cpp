// Shapes: all become meshes in object space, placed by the current transformation.
//
// Orientation follows from the parametrisation or the vertex normals, turned by ReverseOrientation;
// a mirroring transformation keeps inside and outside, in PBRT and here. Meshes without normals are
// flat. Files of meshes are read in parallel when the whole scene is known; shapes that name the
// same file share its mesh.
#include <fmt/format.h>

#include <exception>
#include <filesystem>

#include "lobelia/base/parallel.h"
#include "lobelia/io/mesh_checks.h"
#include "lobelia/io/mesh_io.h"
#include "lobelia/io/pbrt/reader.h"
#include "lobelia/io/pbrt/tessellation.h"

namespace lobelia::io::pbrt {
namespace {

constexpr int kMaxLevels = 10;
constexpr size_t kMaxSubdivided = size_t{1} << 20;  // triangles

const std::vector<std::string>& shapeTypes() {
  static const std::vector<std::string> types{"trianglemesh", "plymesh",  "bilinearmesh", "sphere",
                                              "disk",         "cylinder", "loopsubdiv",   "curve"};
  return types;
}

void checkLength(size_t found, size_t expected, const char* name, const Location& where) {
  if (found != 0 && found != expected)
    throw InputError(where,
                     fmt::format("{} values of '{}' for {} vertices", found, name, expected));
}

void checkRange(const std::vector<uint32_t>& indices, size_t count, const Location& where) {
  for (const uint32_t i : indices)
    if (i >= count)
      throw InputError(where,
                       fmt::format("'indices' has {}; there are {} points (from 0)", i, count));
}

std::vector<Vec2f> textureCoordinates(Parameters& in) {
  for (const char* name : {"uv", "st"})
    if (in.has(name)) return in.vectors2(name);
  return in.vectors2("uv");
}

void fillTriangles(Mesh& mesh, const std::vector<uint32_t>& indices, const Location& where) {
  if (indices.empty() || indices.size() % 3 != 0)
    throw InputError(
        where, fmt::format("{} indices; triangles take a multiple of 3 above 0", indices.size()));
  checkRange(indices, mesh.positions.size(), where);
  mesh.triangles.reserve(indices.size() / 3);
  for (size_t i = 0; i < indices.size(); i += 3)
    mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
}

float positive(Parameters& in, const char* name, float otherwise) {
  const float v = in.number(name, otherwise);
  if (!(v > 0))
    throw InputError(in.where(), fmt::format("'{}' is {}; it must be above 0", name, v));
  return v;
}

float sweep(Parameters& in) {
  const float degrees = in.number("phimax", kFullTurn);
  if (!(degrees > 0)) throw InputError(in.where(), "'phimax' must be above 0");
  return std::min(degrees, kFullTurn);
}

// Shapes of PBRT's in this one; 0: as many as triangles.
size_t partsOf(const std::string& type, Parameters& in) {
  if (type == "bilinearmesh") return std::max<size_t>(in.indices("indices").size() / 4, 1);
  return type == "sphere" || type == "disk" || type == "cylinder" ? 1 : 0;
}

}  // namespace

void Reader::shape(const Token& token) {
  const std::string type = quoted(token, "type");
  Parameters in = parameters(token, "shape");
  Mat4 toWorld = state_.ctm;
  MeshHandle mesh;
  if (type == "trianglemesh") {
    mesh = triangleMesh(in);
  } else if (type == "plymesh") {
    mesh = plyMesh(in);
  } else if (type == "bilinearmesh") {
    mesh = bilinearMesh(in);
  } else if (type == "loopsubdiv") {
    mesh = loopSubdivision(in);
  } else if (type == "sphere") {
    mesh = sphere(in, &toWorld);
  } else if (type == "disk") {
    mesh = disk(in);
  } else if (type == "cylinder") {
    mesh = cylinder(in);
  } else if (type == "curve") {
    return warnOnce(token.where, "the shape 'curve' (hair) is not supported; curves are left out");
  } else {
    throw InputError(token.where, unknownName("shape", type, shapeTypes()));
  }
  const std::optional<FloatParam> alpha = optionalFloat(in, "alpha");
  in.ignore({"displacement.edgelength"});
  in.unsupported("displacement", "the mesh is read as it is", findings_);
  in.finish(fmt::format("shape '{}'", type), findings_);

  Instance instance;
  instance.mesh = mesh;
  instance.toWorld = placement(toWorld, token.where);
  instance.flipNormals = state_.reverseOrientation;
  instance.material = surfaceMaterial(token.where, alpha);
  instance.name = scene_[mesh].name;
  if (state_.areaLight) {
    const bool isInvisible = scene_[instance.material].type == MaterialType::null ||
                             (alpha && !alpha->texture.valid() && alpha->value <= 0);
    if (inObject_) {
      warnOnce(token.where, "area lights in objects do not shine, as in PBRT");
    } else if (isInvisible) {
      warnOnce(token.where, "an invisible area light is not supported; it does not shine");
    } else {
      instance.emitter = areaEmitter(partsOf(type, in));
    }
  }
  (inObject_ ? objects_[openObject_] : scene_.instances).push_back(std::move(instance));
}

MeshHandle Reader::add(Mesh mesh) {
  scene_.meshes.push_back(std::move(mesh));
  return {static_cast<uint32_t>(scene_.meshes.size() - 1)};
}

MeshHandle Reader::triangleMesh(Parameters& in) {
  Mesh mesh;
  mesh.name = "trianglemesh";
  mesh.positions = in.vectors3("P");
  if (mesh.positions.empty()) throw InputError(in.where(), "the trianglemesh has no 'point3 P'");
  mesh.normals = in.vectors3("N");
  mesh.uvs = textureCoordinates(in);
  const size_t count = mesh.positions.size();
  checkLength(mesh.normals.size(), count, "N", in.where());
  checkLength(mesh.uvs.size(), count, "uv", in.where());
  std::vector<uint32_t> indices = in.indices("indices");
  if (!in.has("indices")) {
    if (count != 3)
      throw InputError(in.where(), "a trianglemesh of other than three points needs 'indices'");
    indices = {0, 1, 2};
  }
  fillTriangles(mesh, indices, in.where());
  in.ignore({"S", "faceIndices"});
  MeshOptions options;
  options.smooth = false;
  std::vector<Finding> found;
  finishMesh(mesh, in.where().file, options, found);
  for (Finding& f : found) f.where = in.where();
  findings_.add(found);
  return add(std::move(mesh));
}

MeshHandle Reader::bilinearMesh(Parameters& in) {
  const std::vector<Vec3f> positions = in.vectors3("P"), normals = in.vectors3("N");
  const std::vector<Vec2f> uvs = textureCoordinates(in);
  if (positions.empty()) throw InputError(in.where(), "the bilinearmesh has no 'point3 P'");
  checkLength(normals.size(), positions.size(), "N", in.where());
  checkLength(uvs.size(), positions.size(), "uv", in.where());
  std::vector<uint32_t> indices = in.indices("indices");
  if (!in.has("indices")) indices = {0, 1, 2, 3};
  if (indices.empty() || indices.size() % 4 != 0)
    throw InputError(in.where(), fmt::format("{} indices; patches take a multiple of 4 above 0",
                                             indices.size()));
  checkRange(indices, positions.size(), in.where());
  in.ignore({"faceIndices"});
  in.unsupported("emissionfilename", "the light shines evenly", findings_);
  return add(tessellatePatches(positions, indices, normals, uvs));
}

MeshHandle Reader::loopSubdivision(Parameters& in) {
  Mesh control;
  control.positions = in.vectors3("P");
  if (control.positions.empty()) throw InputError(in.where(), "the loopsubdiv has no 'point3 P'");
  fillTriangles(control, in.indices("indices"), in.where());
  const int levels = in.integer("levels", 3);
  in.ignore({"scheme"});
  if (levels < 0 || levels > kMaxLevels ||
      control.triangles.size() << (2 * levels) > kMaxSubdivided) {
    throw InputError(in.where(),
                     fmt::format("{} levels of subdivision of {} triangles; at most {} "
                                 "levels and {} triangles in the end",
                                 levels, control.triangles.size(), kMaxLevels, kMaxSubdivided));
  }
  return add(subdivideLoop(control, levels));
}

MeshHandle Reader::sphere(Parameters& in, Mat4* toWorld) {
  SphereShape s;
  s.radius = positive(in, "radius", 1);
  const float z0 = in.number("zmin", -s.radius), z1 = in.number("zmax", s.radius);
  s.zMin = std::clamp(std::min(z0, z1), -s.radius, s.radius);
  s.zMax = std::clamp(std::max(z0, z1), -s.radius, s.radius);
  s.phiMax = sweep(in);
  if (s.zMin > -s.radius || s.zMax < s.radius || s.phiMax < kFullTurn) {
    if (!(s.zMin < s.zMax)) throw InputError(in.where(), "the sphere's zmin and zmax are equal");
    return add(tessellateSphere(s));
  }
  MeshHandle& whole = meshes_["|sphere"];
  if (!whole.valid()) whole = add(wholeUnitSphere());
  *toWorld = *toWorld * scaling(Vec3d(static_cast<double>(s.radius)));
  return whole;
}

MeshHandle Reader::disk(Parameters& in) {
  DiskShape s;
  s.height = in.number("height", 0.f);
  s.radius = positive(in, "radius", 1);
  s.innerRadius = in.number("innerradius", 0.f);
  s.phiMax = sweep(in);
  if (!(s.innerRadius >= 0 && s.innerRadius < s.radius))
    throw InputError(in.where(), "the disk's innerradius must be 0 or more and below its radius");
  return add(tessellateDisk(s));
}

MeshHandle Reader::cylinder(Parameters& in) {
  CylinderShape s;
  s.radius = positive(in, "radius", 1);
  const float z0 = in.number("zmin", -1.f), z1 = in.number("zmax", 1.f);
  s.zMin = std::min(z0, z1), s.zMax = std::max(z0, z1);
  s.phiMax = sweep(in);
  if (!(s.zMin < s.zMax)) throw InputError(in.where(), "the cylinder's zmin and zmax are equal");
  return add(tessellateCylinder(s));
}

MeshHandle Reader::plyMesh(Parameters& in) {
  const std::optional<std::string> file = in.string("filename");
  if (!file) throw InputError(in.where(), "the plymesh has no filename");
  const std::string path = resolve(*file, "mesh", in.where());
  MeshHandle& mesh = meshes_[path];
  if (!mesh.valid()) {
    Mesh later;
    std::filesystem::path stem = std::filesystem::path(path).stem();
    if (stem.extension() == ".ply") stem = stem.stem();  // .ply.gz
    later.name = stem.string();
    mesh = add(std::move(later));
    pendingMeshes_.push_back({mesh, path, in.where()});
  }
  return mesh;
}

void Reader::loadMeshes() {
  struct Result {
    Mesh mesh;
    std::vector<Finding> findings;
    std::exception_ptr error;
  };
  std::vector<Result> results(pendingMeshes_.size());
  parallelFor(results.size(), 1, [&](size_t i) {
    const PendingMesh& pending = pendingMeshes_[i];
    if (context_.cancelled()) return;
    try {
      MeshOptions options;
      options.smooth = false;
      results[i].mesh = readPly(pending.file, options, pending.where, results[i].findings);
    } catch (...) {
      results[i].error = std::current_exception();
    }
  });
  // In the file's order, whatever the threads did.
  for (size_t i = 0; i < results.size(); ++i) {
    if (results[i].error) std::rethrow_exception(results[i].error);
    findings_.add(results[i].findings);
    Mesh& mesh = scene_.meshes[pendingMeshes_[i].mesh.index];
    results[i].mesh.name = mesh.name;
    mesh = std::move(results[i].mesh);
  }
  pendingMeshes_.clear();
}

}  // namespace lobelia::io::pbrt

// Shapes of Mitsuba scenes: every one becomes an Instance of a mesh. Shapes that name the same file
// with the same options share a mesh; a shapegroup's shapes are flattened into instances.
//
// Which side is outside after a to_world that mirrors: normals of an Instance go by the inverse
// transpose, so that they keep the mesh's outside. Mitsuba 0.6 (which turns the triangles around)
// and the analytic shapes and vertex normals of Mitsuba 3 agree. In Mitsuba 3 the normal of a mesh
// without vertex normals follows from its transformed triangles, which points inwards: such
// instances are flipped.

#include <filesystem>

#include "lobelia/io/mesh_io.h"
#include "lobelia/io/mitsuba/read_at.h"
#include "lobelia/io/mitsuba/reader.h"

namespace lobelia::io::mitsuba {
namespace {

const std::vector<std::string>& shapeTypes() {
  static const std::vector<std::string> types{"obj",        "ply",     "serialized", "rectangle",
                                              "cube",       "sphere",  "disk",       "cylinder",
                                              "shapegroup", "instance"};
  return types;
}

bool isFile(const std::string& type) {
  return type == "obj" || type == "ply" || type == "serialized";
}

// From the unit sphere to center and radius.
Mat4 sphereTransform(Object& object) {
  const Vec3d center = object.vector("center").value_or(Vec3d{});
  const double radius = object.number("radius").value_or(1.0);
  if (radius <= 0) throw InputError(object.where(), "the sphere's radius must be above 0");
  return translation(center) * scaling(Vec3d(radius));
}

// From the unit cylinder (z from 0 to 1) to the axis p0, p1.
Mat4 cylinderTransform(Object& object) {
  const Vec3d p0 = object.vector("p0").value_or(Vec3d{});
  const Vec3d p1 = object.vector("p1").value_or(Vec3d{0, 0, 1});
  const double radius = object.number("radius").value_or(1.0);
  const double height = length(p1 - p0);
  if (radius <= 0 || height <= 0) {
    throw InputError(object.where(), "the cylinder needs a radius above 0 and p0 other than p1");
  }
  const Vec3d axis = (p1 - p0) / height;
  const Frame frame = frameFromNormal(
      {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z)});
  Mat4 m;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<size_t>(i);
    m.m[row] = {static_cast<double>(frame.s[i]), static_cast<double>(frame.t[i]), axis[i], p0[i]};
  }
  return m * scaling({radius, radius, height});
}

}  // namespace

void Reader::shape(const Element& element) {
  Object object = open(element);
  const std::string& type = object.type();
  if (type == "shapegroup") {
    group(element);
  } else if (type == "instance") {
    instance(object);
  } else {
    scene_.instances.push_back(simpleShape(object));
  }
}

const std::vector<Instance>& Reader::group(const Element& element) {
  if (const auto known = groups_.find(&element); known != groups_.end()) return known->second;
  Object object = open(element);
  std::vector<Instance> shapes;
  for (const Element* e : object.nested("shape")) {
    Object inner = open(*e);
    if (inner.type() == "instance" || inner.type() == "shapegroup") {
      throw InputError(e->where, "a shapegroup cannot hold a " + inner.type());
    }
    shapes.push_back(simpleShape(inner));
  }
  if (shapes.empty()) findings_.warn(object.where(), "the shapegroup is empty");
  object.finish();
  return groups_.emplace(&element, std::move(shapes)).first->second;
}

void Reader::instance(Object& object) {
  const std::vector<const Element*> groups = object.nested("shape");
  if (groups.size() != 1 || groups[0]->valueOr("type", "") != "shapegroup") {
    throw InputError(object.where(), "an instance needs a <ref> to one shapegroup");
  }
  const Mat4 toWorld = object.transform("to_world").value_or(Mat4{});
  object.finish();
  for (Instance copy : group(*groups[0])) {
    copy.toWorld = makeTransform(toWorld * copy.toWorld.to, object.where());
    scene_.instances.push_back(std::move(copy));
  }
}

Instance Reader::simpleShape(Object& object) {
  const std::string& type = object.type();
  Instance out;
  out.name = object.id();
  Mat4 toWorld = object.transform("to_world").value_or(Mat4{});
  out.flipNormals = object.boolean("flip_normals", false);
  if (isFile(type)) {
    out.mesh = fileMesh(object, type);
    const Mesh& mesh = scene_[out.mesh];
    if (out.name.empty()) out.name = mesh.name;
    const bool mirrored = toWorld.determinant3() < 0;
    if (mirrored && !object.legacy() && mesh.normals.empty()) out.flipNormals = !out.flipNormals;
  } else if (type == "rectangle" || type == "cube" || type == "disk") {
    out.mesh = unitMesh(type);
  } else if (type == "sphere") {
    out.mesh = unitMesh(type);
    toWorld = toWorld * sphereTransform(object);
  } else if (type == "cylinder") {
    out.mesh = unitMesh(type);
    toWorld = toWorld * cylinderTransform(object);
  } else {
    unknownType(object, shapeTypes());
  }
  if (!inverse(toWorld)) throw InputError(object.where(), "the shape is flattened to nothing");
  out.toWorld = makeTransform(toWorld, object.where());
  surface(object, &out);
  object.ignore({"silhouette_sampling_weight", "id"});
  object.finish();
  return out;
}

MeshHandle Reader::fileMesh(Object& object, const std::string& type) {
  const std::optional<std::string> file = object.string("filename");
  if (!file) throw InputError(object.where(), "the " + type + " has no filename");
  MeshOptions options;
  options.faceNormals = object.boolean("face_normals", false);
  const bool flipTexCoords = object.boolean("flip_tex_coords", type == "obj");
  options.flipTexCoords = flipTexCoords;
  options.maxSmoothAngle = object.number("max_smooth_angle", -1.f);
  options.shapeIndex = type == "serialized" ? object.integer("shape_index", 0) : 0;
  object.ignore({"collapse", "srgb"});
  const std::string path = document_.resolve(*file, object.where());
  const std::string key = type + "|" + path + "|" + std::to_string(options.faceNormals) +
                          std::to_string(flipTexCoords) + "|" +
                          std::to_string(options.maxSmoothAngle) + "|" +
                          std::to_string(options.shapeIndex);
  if (const auto known = meshes_.find(key); known != meshes_.end()) return known->second;
  std::vector<Finding> found;
  Mesh mesh = readAt(object.where(), [&] {
    return type == "obj"   ? readObj(path, options, object.where(), found)
           : type == "ply" ? readPly(path, options, object.where(), found)
                           : readSerialized(path, options, object.where(), found);
  });
  findings_.add(found);
  if (mesh.name.empty()) mesh.name = std::filesystem::path(path).stem().string();
  scene_.meshes.push_back(std::move(mesh));
  const MeshHandle handle{static_cast<uint32_t>(scene_.meshes.size() - 1)};
  meshes_.emplace(key, handle);
  return handle;
}

MeshHandle Reader::unitMesh(const std::string& type) {
  if (const auto known = meshes_.find(type); known != meshes_.end()) return known->second;
  Mesh mesh = type == "rectangle" ? unitRectangle()
              : type == "cube"    ? unitCube()
              : type == "disk"    ? unitDisk()
              : type == "sphere"  ? unitSphere()
                                  : unitCylinder();
  if (mesh.name.empty()) mesh.name = type;
  scene_.meshes.push_back(std::move(mesh));
  const MeshHandle handle{static_cast<uint32_t>(scene_.meshes.size() - 1)};
  meshes_.emplace(type, handle);
  return handle;
}

// Material, emitter and media of a shape.
void Reader::surface(Object& object, Instance* out) {
  const std::vector<const Element*> bsdfs = object.nested("bsdf");
  const std::vector<const Element*> emitters = object.nested("emitter");
  const std::vector<const Element*> media = object.nested("medium");
  if (bsdfs.size() > 1) throw InputError(bsdfs[1]->where, "a shape can have only one bsdf");
  if (emitters.size() > 1) throw InputError(emitters[1]->where, "a shape can have one emitter");
  for (const char* tag : {"medium", "subsurface"}) {
    const auto& elements = std::string(tag) == "medium" ? media : object.nested(tag);
    for (const Element* e : elements) {
      findings_.warn(e->where, std::string("participating media are not supported; the ") + tag +
                                   " is ignored, the surface kept");
    }
  }
  for (const Element* e : object.nested("sensor")) {
    Object sensor = open(*e);
    throw InputError(e->where, "the sensor '" + sensor.type() + "' on a shape is not supported");
  }
  if (!emitters.empty()) out->emitter = areaEmitter(*emitters[0]);
  if (!bsdfs.empty()) {
    out->material = material(*bsdfs[0]);
    if (out->emitter.valid() && scene_[out->material].type == MaterialType::null) {
      findings_.warn(bsdfs[0]->where,
                     "a shape that emits cannot be see-through; its null material is taken as "
                     "black");
      out->material = defaultMaterial("black");
    }
    return;
  }
  // Without a bsdf an emitter is black, in 0.6 a boundary between media invisible, the rest grey.
  out->material = defaultMaterial(!media.empty() && object.legacy() ? "invisible"
                                  : out->emitter.valid()            ? "black"
                                                                    : "grey");
}

MaterialHandle Reader::defaultMaterial(const std::string& kind) {
  const auto [at, inserted] = defaultMaterials_.emplace(kind, MaterialHandle{});
  if (inserted) {
    Material m;
    m.name = "default " + kind;
    if (kind == "invisible") m.type = MaterialType::null;
    if (kind == "black") m.diffuse = Rgb(0.f);
    at->second = add(std::move(m));
  }
  return at->second;
}

}  // namespace lobelia::io::mitsuba

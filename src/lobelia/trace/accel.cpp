// Building Embree's scenes.
//
// One scene holds all triangles in world space, so that packets meet one tree. A mesh that is
// placed once, or so seldom that the copies are small, is transformed into that scene; the rest
// become Embree instances of a scene per mesh, built once. World-space vertices are rounded by the
// same function as in surfacePoint(), so both see the same triangles.
//
// Vertices are copied into Embree's buffers: its loads run 4 bytes past the last vertex, which
// shared buffers would have to be padded for. Indices are shared.
#include "lobelia/trace/accel.h"

#include <fmt/format.h>

#include "lobelia/base/parallel.h"
#include "lobelia/trace/mask.h"

namespace lobelia::embree {
namespace {

// Copies of a mesh with more triangles than this in all become instances (about 200 bytes each).
constexpr size_t kMaxCopiedTriangles = 1 << 18;

std::string label(const Scene& scene, MeshHandle h) {
  const std::string& name = scene[h].name;
  return name.empty() ? fmt::format("mesh {}", h.index) : fmt::format("mesh '{}'", name);
}

// What would make Embree read outside its buffers, or overflow its ids.
void checkScene(const Scene& scene) {
  constexpr uint64_t kMaxId = RTC_INVALID_GEOMETRY_ID;
  if (scene.instances.size() >= kMaxId) {
    throw InputError({scene.file, 0, 0}, fmt::format("{} instances are too many; {} is the limit",
                                                     scene.instances.size(), kMaxId - 1));
  }
  for (uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    const size_t vertices = mesh.positions.size();
    if (mesh.triangles.size() >= kMaxId || vertices >= kMaxId) {
      throw InputError({scene.file, 0, 0},
                       fmt::format("{}: {} triangles and {} vertices are too many; {} is the limit",
                                   label(scene, {m}), mesh.triangles.size(), vertices, kMaxId - 1));
    }
    for (const Vec3u& t : mesh.triangles) {
      if (t.x < vertices && t.y < vertices && t.z < vertices) continue;
      throw InputError({scene.file, 0, 0},
                       fmt::format("{}: a triangle names vertex {}; there are {}",
                                   label(scene, {m}), std::max(t.x, std::max(t.y, t.z)), vertices));
    }
  }
  for (const Instance& instance : scene.instances) {
    if (instance.mesh.index >= scene.meshes.size()) {
      throw InputError({scene.file, 0, 0},
                       fmt::format("instance '{}': mesh {} does not exist; there are {}",
                                   instance.name, instance.mesh.index, scene.meshes.size()));
    }
  }
}

// Surfaces that no ray ever stops at are left out.
bool isInvisible(const Scene& scene, MaterialHandle h) {
  while (h.valid()) {
    switch (scene[h].type) {
      case MaterialType::null:
        return true;
      case MaterialType::twoSided:
      case MaterialType::bump:
      case MaterialType::normalMap:
        h = scene[h].a;
        break;
      default:
        return false;
    }
  }
  return false;
}

struct Use {
  size_t count = 0;     // visible instances with a transform
  bool masked = false;  // is the material of any of them ever transparent?
};

std::vector<Use> countUses(const Scene& scene) {
  std::vector<Use> uses(scene.meshes.size());
  for (const Instance& i : scene.instances) {
    if (i.toWorld.to.isIdentity() || isInvisible(scene, i.material)) continue;
    ++uses[i.mesh.index].count;
    uses[i.mesh.index].masked |= hasOpacity(scene, i.material);
  }
  return uses;
}

}  // namespace

Accel::Accel(const Scene& scene, Context& context) : device_(context) {
  checkScene(scene);
  try {
    build(scene);
  } catch (...) {
    release();
    throw;
  }
  device_.stopWatching();
}

Accel::~Accel() { release(); }

void Accel::release() {
  if (top_) rtcReleaseScene(top_);
  for (RTCScene s : shared_) {
    if (s) rtcReleaseScene(s);
  }
  top_ = nullptr;
  shared_.clear();
}

RTCScene Accel::newScene() {
  const RTCScene scene = rtcNewScene(device_);
  device_.check();
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  device_.watchBuild(scene);
  return scene;
}

void Accel::commit(RTCScene scene) {
  rtcCommitScene(scene);
  device_.check();
}

RTCGeometry Accel::newTriangles(const Scene& scene, const Mesh& mesh, const Transform* transform,
                                bool masked) {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const vertices = static_cast<Vec3f*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                              std::max<size_t>(mesh.positions.size(), 1)));
  if (vertices) {
    parallelFor(mesh.positions.size(), 4096, [&](size_t i) {
      vertices[i] = transform ? transform->point(mesh.positions[i]) : mesh.positions[i];
    });
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(Vec3u), mesh.triangles.size());
    if (masked) {
      rtcSetGeometryUserData(geometry, const_cast<Scene*>(&scene));
      rtcSetGeometryIntersectFilterFunction(geometry, filterMask);
      rtcSetGeometryOccludedFilterFunction(geometry, filterMask);
    }
  }
  return geometry;
}

// Errors wait until here, where nothing is left to release.
void Accel::attach(RTCScene scene, RTCGeometry geometry, uint32_t id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
  device_.check();
}

void Accel::build(const Scene& scene) {
  const std::vector<Use> uses = countUses(scene);
  shared_.resize(scene.meshes.size(), nullptr);
  top_ = newScene();
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene[instance.mesh];
    if (mesh.triangles.empty() || isInvisible(scene, instance.material)) continue;
    const Use& use = uses[instance.mesh.index];
    const bool identity = instance.toWorld.to.isIdentity();
    if (identity || use.count == 1 || use.count * mesh.triangles.size() <= kMaxCopiedTriangles) {
      attach(top_,
             newTriangles(scene, mesh, identity ? nullptr : &instance.toWorld,
                          hasOpacity(scene, instance.material)),
             i);
      continue;
    }
    RTCScene& shared = shared_[instance.mesh.index];
    if (!shared) {
      shared = newScene();
      attach(shared, newTriangles(scene, mesh, nullptr, use.masked), 0);
      commit(shared);
    }
    instanced_ = true;
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, shared);
    float matrix[12];
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c) {
        matrix[r * 4 + c] = static_cast<float>(instance.toWorld.to.m[r][c]);
      }
    }
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, matrix);
    attach(top_, geometry, i);
  }
  commit(top_);
}

}  // namespace lobelia::embree

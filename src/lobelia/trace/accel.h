// The acceleration structure over a scene; private to the room.
#pragma once

#include "lobelia/trace/device.h"

namespace lobelia::embree {

// Top-level geometry ids are indices of Scene::instances, whether a hit lies in plain geometry
// (instID invalid) or inside an instance (instID[0] is the id).
class Accel {
 public:
  Accel(const Scene& scene, Context& context);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  RTCScene top() const { return top_; }
  bool instanced() const { return instanced_; }  // are there Embree instances?
  int64_t bytes() const { return device_.bytes(); }

 private:
  void build(const Scene& scene);
  void release();
  RTCScene newScene();
  void commit(RTCScene scene);
  // Triangles of one instance in world space (vertices transformed), or of a mesh in its own space.
  RTCGeometry newTriangles(const Scene& scene, const Mesh& mesh, const Transform* transform,
                           bool masked);
  void attach(RTCScene scene, RTCGeometry geometry, uint32_t id);

  Device device_;
  RTCScene top_ = nullptr;
  bool instanced_ = false;
  std::vector<RTCScene> shared_;  // by mesh; null where the mesh is not instanced
};

}  // namespace lobelia::embree

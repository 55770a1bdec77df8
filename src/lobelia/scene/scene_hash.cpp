// Hash of everything in a scene that an image and its layers depend on: what saved lights and
// checkpoints are checked against. Names (but for those of light groups, which name layers) and
// findings do not count. Not cryptographic.
#include <bit>
#include <cstring>
#include <type_traits>

#include "lobelia/base/random.h"
#include "lobelia/scene/light_groups.h"
#include "lobelia/scene/material_parameters.h"
#include "lobelia/scene/scene.h"

namespace lobelia {
namespace {

// Chains mixBits over 8-byte words; arrays put their length first, so that moving a boundary
// between two neighbouring arrays changes the hash.
class StreamHash {
 public:
  void word(uint64_t w) { state_ = mixBits(state_ + 0x9e3779b97f4a7c15ull + w); }
  void bytes(const void* data, size_t size) {
    word(size);
    const char* const p = static_cast<const char*>(data);
    size_t i = 0;
    for (; i + 8 <= size; i += 8) {
      uint64_t w;
      std::memcpy(&w, p + i, 8);
      word(w);
    }
    if (i < size) {
      uint64_t w = 0;
      std::memcpy(&w, p + i, size - i);
      word(w);
    }
  }
  template <class T>
  void array(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
    bytes(v.data(), v.size() * sizeof(T));
  }
  void add(float v) { word(std::bit_cast<uint32_t>(v)); }
  void add(double v) { word(std::bit_cast<uint64_t>(v)); }
  void add(bool v) { word(v ? 1 : 0); }
  void add(int v) { word(static_cast<uint64_t>(static_cast<int64_t>(v))); }
  template <class E>
  requires std::is_enum_v<E>
  void add(E v) { word(static_cast<uint64_t>(v)); }
  template <class Tag>
  void add(Handle<Tag> h) {
    word(h.index);
  }
  void add(Vec2f v) { add(v.x), add(v.y); }
  void add(Vec3f v) { add(v.x), add(v.y), add(v.z); }
  void add(const std::string& s) { bytes(s.data(), s.size()); }
  void add(const ColorParam& p) { add(p.value), add(p.texture); }
  void add(const FloatParam& p) { add(p.value), add(p.texture); }
  void add(const Transform& t) {
    for (const auto& row : t.to.m) {
      for (double v : row) add(v);
    }
  }

  void add(const Image& i) {
    add(i.width), add(i.height), add(i.channels);
    array(i.pixels);
  }
  void add(const Texture& t) {
    add(t.type), add(t.value), add(t.image), add(t.filter), add(t.wrapU), add(t.wrapV),
        add(t.alphaChannel);
    for (const auto& row : t.uvMatrix) {
      for (float v : row) add(v);
    }
    add(t.channel), add(t.a), add(t.b), add(t.c), add(t.scale), add(t.attribute);
  }
  void add(const Material& m) {
    add(m.type), add(m.a), add(m.b);
    eachColorParam(m, [&](const ColorParam& p) { add(p); });
    add(m.isSpecularGlossiness), add(m.clearcoatNormal), add(m.anisotropicDirection), add(m.thin);
    add(m.coatIor), add(m.absorption);
    add(m.ior), add(m.distribution), add(m.wardVariant), add(m.nonlinear), add(m.map), add(m.scale);
    eachFloatParam(m, [&](const FloatParam& p) { add(p); });
    word(m.capturedLobes.size());
    for (const CapturedLobe& lobe : m.capturedLobes) add(lobe.amplitude), add(lobe.sharpness);
  }
  void add(const Emitter& e) {
    add(e.type), add(e.toWorld), add(e.radiance), add(e.scale), add(e.image), add(e.cutoff);
    add(e.beamWidth), add(e.pattern), add(e.fov), add(e.direction), add(e.angularRadius);
    add(e.group == LightGroups::kDefaultGroup ? std::string() : e.group);
  }
  void add(const Mesh& m) {
    array(m.positions), array(m.normals), array(m.uvs), array(m.triangles);
    word(m.attributes.size());
    for (const MeshAttribute& a : m.attributes) {
      add(a.name), add(a.perFace), add(a.size);
      array(a.values);
    }
    add(m.isUnitSphere);
  }
  void add(const Instance& i) {
    add(i.mesh), add(i.toWorld), add(i.material), add(i.emitter), add(i.flipNormals);
  }
  void add(const Camera& c) {
    add(c.type), add(c.toWorld), add(c.fovX), add(c.principalPointOffset), add(c.nearClip);
    add(c.farClip), add(c.apertureRadius), add(c.focusDistance), add(c.width), add(c.height);
    add(c.cropX0), add(c.cropY0), add(c.cropX1), add(c.cropY1), add(c.filter), add(c.filterRadius);
  }
  template <class T>
  void all(const std::vector<T>& items) {
    word(items.size());
    for (const T& item : items) add(item);
  }
  uint64_t value() const { return mixBits(state_); }

 private:
  uint64_t state_ = 0;
};

}  // namespace

uint64_t hash(const Scene& scene) {
  StreamHash h;
  h.all(scene.images), h.all(scene.textures), h.all(scene.materials), h.all(scene.emitters);
  h.all(scene.meshes), h.all(scene.instances), h.all(scene.cameras);
  h.add(scene.maxDepth), h.add(scene.hideEmitters);
  return h.value();
}

uint64_t surfaceHash(const Scene& scene) {
  StreamHash h;
  // Images by what is in them: their numbers change with those of the emitters.
  for (Texture texture : scene.textures) {
    const ImageHandle image = texture.image;
    texture.image = {};
    h.add(texture);
    if (image.valid()) h.add(scene[image]);
  }
  h.all(scene.materials), h.all(scene.meshes);
  for (Instance instance : scene.instances) {
    instance.emitter = {};
    h.add(instance);
  }
  return h.value();
}

}  // namespace lobelia

#include "lobelia/builtin/refine.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace lobelia::builtin {
namespace {

// One pass: every edge that is too long gets a vertex in its middle.
class Pass {
 public:
  Pass(Mesh& mesh, float longest) : mesh_(mesh), longest2_(longest * longest) {}

  // False when there was nothing to do.
  bool run() {
    std::vector<Vec3u> finer;
    finer.reserve(mesh_.triangles.size() * 2);
    for (const Vec3u t : mesh_.triangles) split(t, finer);
    mesh_.triangles = std::move(finer);
    return !middles_.empty();
  }

 private:
  float length2(uint32_t a, uint32_t b) const {
    return lengthSquared(mesh_.positions[a] - mesh_.positions[b]);
  }

  std::optional<uint32_t> middle(uint32_t a, uint32_t b) {
    if (length2(a, b) <= longest2_) return {};  // the same from both sides, to the bit
    const uint64_t key = uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    const auto [it, isNew] =
        middles_.try_emplace(key, static_cast<uint32_t>(mesh_.positions.size()));
    if (isNew) {
      const auto half = [a, b](auto& all) {
        if (!all.empty()) all.push_back((all[a] + all[b]) * 0.5f);
      };
      half(mesh_.positions);
      half(mesh_.uvs);
      if (!mesh_.normals.empty())
        mesh_.normals.push_back(normalize(mesh_.normals[a] + mesh_.normals[b]));
    }
    return it->second;
  }

  void split(Vec3u t, std::vector<Vec3u>& to) {
    std::optional<uint32_t> m[3];
    int count = 0;
    for (int c = 0; c < 3; ++c) count += (m[c] = middle(t[c], t[(c + 1) % 3])).has_value();
    if (count == 0) {
      to.push_back(t);
    } else if (count == 3) {
      for (const Vec3u part : {Vec3u(t.x, *m[0], *m[2]), Vec3u(*m[0], t.y, *m[1]),
                               Vec3u(*m[2], *m[1], t.z), Vec3u(*m[0], *m[1], *m[2])})
        to.push_back(part);
    } else {
      splitPartly(t, m, count, to);
    }
  }

  void splitPartly(Vec3u t, const std::optional<uint32_t> (&m)[3], int count,
                   std::vector<Vec3u>& to) {
    // Turned so that edge ab is halved and, of two, bc is the other.
    int first = 0;
    while (!m[first] || (count == 2 && !m[(first + 1) % 3])) ++first;
    const uint32_t a = t[first], b = t[(first + 1) % 3], c = t[(first + 2) % 3], ab = *m[first];
    if (count == 1) {
      to.push_back({a, ab, c});
      to.push_back({ab, b, c});
      return;
    }
    const uint32_t bc = *m[(first + 1) % 3];
    to.push_back({ab, b, bc});
    if (length2(a, bc) < length2(ab, c)) {
      to.push_back({a, ab, bc});
      to.push_back({a, bc, c});
    } else {
      to.push_back({a, ab, c});
      to.push_back({ab, bc, c});
    }
  }

  Mesh& mesh_;
  float longest2_;
  std::unordered_map<uint64_t, uint32_t> middles_;
};

// How much longer a vector can become, at most: of the squared map's eigenvalues none is above the
// largest sum of a row's sizes. Without shear it is the longest of the axes' images; what rounding
// leaves of right angles is none.
float longestStretch(const Transform& toWorld) {
  const Vec3f axes[] = {toWorld.vector({1, 0, 0}), toWorld.vector({0, 1, 0}),
                        toWorld.vector({0, 0, 1})};
  float longest = 0;
  for (const Vec3f& a : axes) {
    const float own = dot(a, a);
    float others = 0;
    for (const Vec3f& b : axes) {
      const float both = std::abs(dot(a, b));
      if (&a != &b && both > 1e-5f * std::sqrt(own * dot(b, b))) others += both;
    }
    longest = std::max(longest, others > 0 ? std::sqrt(own + others) : length(a));
  }
  return longest;
}

}  // namespace

Mesh refined(Mesh mesh, float longest) {
  while (Pass(mesh, longest).run()) continue;
  return mesh;
}

void refine(Scene& scene, float longest) {
  std::vector<float> scales(scene.meshes.size(), 0.f);
  for (const Instance& instance : scene.instances) {
    float& scale = scales[instance.mesh.index];
    scale = std::max(scale, longestStretch(instance.toWorld));
  }
  for (size_t i = 0; i < scales.size(); ++i)
    if (scales[i] > 0) scene.meshes[i] = refined(std::move(scene.meshes[i]), longest / scales[i]);
}

}  // namespace lobelia::builtin

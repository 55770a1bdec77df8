// Polygons of sculptures. The grid is refined only where the surface may pass, and in each block
// only the parts near it are evaluated.
#include <algorithm>
#include <array>
#include <unordered_map>

#include "lobelia/base/parallel.h"
#include "lobelia/builtin/sculpture.h"

namespace lobelia::builtin {

class SurfaceNets {
 public:
  SurfaceNets(const Sculpture& sculpture, int cells) : sculpture_(sculpture) {
    Bounds3f box;
    for (const Part& part : sculpture.parts_) {
      if (part.carved) continue;
      const float reach = std::max(part.ra, part.rb) + part.scales.height + part.blend / 4;
      const auto add = [&](Vec3f p, Vec3f r) { box.add(p - r), box.add(p + r); };
      if (part.shape == Part::Shape::ellipsoid) {
        add(part.a, Vec3f(maxComponent(part.b) + part.blend / 4));
      } else {
        add(part.a, Vec3f(reach)), add(part.b, Vec3f(reach));
        if (part.shape == Part::Shape::sheet) add(part.c, Vec3f(reach));
      }
      maxBlend_ = std::max(maxBlend_, part.blend);
    }
    if (sculpture.floor_) box.lo.y = std::max(box.lo.y, *sculpture.floor_);
    size_ = maxComponent(box.extent()) / static_cast<float>(cells);
    // Half a cell off, so that a flat base does not fall onto grid points.
    origin_ = box.lo - Vec3f(2.5f * size_);
    const Vec3f extent = box.extent() / (size_ * kBlock) + Vec3f(2);
    blocks_ = {static_cast<int>(extent.x) + 1, static_cast<int>(extent.y) + 1,
               static_cast<int>(extent.z) + 1};
  }

  Mesh make() {
    const int most = std::max({blocks_.x, blocks_.y, blocks_.z});
    int rootSize = 1;
    while (rootSize * 8 < most) rootSize *= 2;
    const Vec3<int> roots{(blocks_.x + rootSize - 1) / rootSize,
                          (blocks_.y + rootSize - 1) / rootSize,
                          (blocks_.z + rootSize - 1) / rootSize};
    const auto count = static_cast<size_t>(roots.x * roots.y * roots.z);
    std::vector<uint32_t> all(sculpture_.parts_.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<uint32_t>(i);
    std::vector<Piece> pieces(count);
    parallelFor(count, 1, [&](size_t i) {
      const int n = static_cast<int>(i);
      refine({n % roots.x * rootSize, n / roots.x % roots.y * rootSize,
              n / (roots.x * roots.y) * rootSize},
             rootSize, all, pieces[i]);
    });
    return join(pieces);
  }

 private:
  static constexpr int kBlock = 4;  // cells along the side of a block
  using Cell = Vec3<int>;
  struct Edge {
    Cell cell;  // at its lower end
    int axis;
    bool outward;  // leaves the sculpture along +axis
  };
  struct Piece {
    std::vector<Cell> cells;
    std::vector<Vec3f> positions, normals;
    std::vector<Edge> edges;
  };

  Vec3f corner(Cell c) const {
    return origin_ +
           Vec3f(static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)) * size_;
  }
  static uint64_t key(Cell c) {
    const auto bits = [](int x) {
      return static_cast<uint64_t>(static_cast<uint32_t>(x)) & 0x1fffff;
    };
    return bits(c.x) | bits(c.y) << 21 | bits(c.z) << 42;
  }

  void refine(Cell block, int size, const std::vector<uint32_t>& parts, Piece& piece) const {
    if (block.x >= blocks_.x || block.y >= blocks_.y || block.z >= blocks_.z) return;
    const float half = 0.5f * size_ * static_cast<float>(kBlock * size);
    const Vec3f centre =
        corner({block.x * kBlock, block.y * kBlock, block.z * kBlock}) + Vec3f(half);
    const float radius = half * std::sqrt(3.f);
    // The distances of ellipsoids and scales are not exact, hence the margin.
    constexpr float kMargin = 2;
    const float d = sculpture_.distance(centre, parts);
    if (std::abs(d) > kMargin * radius) return;
    std::vector<uint32_t> near;
    for (const uint32_t i : parts) {
      const Part& part = sculpture_.parts_[i];
      if (part.distance(centre) < std::abs(d) + 1.5f * kMargin * radius + part.blend + maxBlend_)
        near.push_back(i);
    }
    if (size == 1) return polygonise(block, near, piece);
    const int h = size / 2;
    for (int i = 0; i < 8; ++i)
      refine({block.x + (i & 1) * h, block.y + (i >> 1 & 1) * h, block.z + (i >> 2) * h}, h, near,
             piece);
  }

  void polygonise(Cell block, const std::vector<uint32_t>& parts, Piece& piece) const {
    constexpr int n = kBlock + 1;
    const Cell base{block.x * kBlock, block.y * kBlock, block.z * kBlock};
    std::array<float, n * n * n> values;
    const auto at = [&](int x, int y, int z) -> float& {
      return values[static_cast<size_t>((z * n + y) * n + x)];
    };
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          at(x, y, z) = sculpture_.distance(corner({base.x + x, base.y + y, base.z + z}), parts);
    for (int z = 0; z < kBlock; ++z)
      for (int y = 0; y < kBlock; ++y)
        for (int x = 0; x < kBlock; ++x) {
          const Cell cell{base.x + x, base.y + y, base.z + z};
          Vec3f sum;
          int crossings = 0;
          for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 4; ++side) {
              Cell from{x, y, z};
              from[(axis + 1) % 3] += side & 1, from[(axis + 2) % 3] += side >> 1;
              Cell to = from;
              ++to[axis];
              const float a = at(from.x, from.y, from.z), b = at(to.x, to.y, to.z);
              if ((a < 0) == (b < 0)) continue;
              Vec3f p(static_cast<float>(from.x - x), static_cast<float>(from.y - y),
                      static_cast<float>(from.z - z));
              p[axis] = a / (a - b);
              sum += p, ++crossings;
              if (side == 0) piece.edges.push_back({cell, axis, a < 0});
            }
          if (crossings == 0) continue;
          const Vec3f p = corner(cell) + sum * (size_ / static_cast<float>(crossings));
          piece.cells.push_back(cell);
          piece.positions.push_back(p);
          piece.normals.push_back(gradient(p, parts));
        }
  }

  Vec3f gradient(Vec3f p, const std::vector<uint32_t>& parts) const {
    Vec3f g;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3f step;
      step[axis] = 0.5f * size_;
      g[axis] = sculpture_.distance(p + step, parts) - sculpture_.distance(p - step, parts);
    }
    const float len = length(g);
    return len > 0 ? g / len : Vec3f(0, 1, 0);
  }

  static Mesh join(const std::vector<Piece>& pieces) {
    Mesh mesh;
    std::unordered_map<uint64_t, uint32_t> vertexOf;
    for (const Piece& piece : pieces) {
      for (const Cell& cell : piece.cells)
        vertexOf.emplace(key(cell), static_cast<uint32_t>(vertexOf.size()));
      mesh.positions.insert(mesh.positions.end(), piece.positions.begin(), piece.positions.end());
      mesh.normals.insert(mesh.normals.end(), piece.normals.begin(), piece.normals.end());
    }
    for (const Piece& piece : pieces)
      for (const Edge& edge : piece.edges) {
        // The four cells around the edge, counter-clockwise seen from its upper end.
        std::array<uint32_t, 4> quad;
        bool whole = true;
        for (int i = 0; i < 4; ++i) {
          Cell cell = edge.cell;
          cell[(edge.axis + 1) % 3] -= i == 0 || i == 3 ? 1 : 0;
          cell[(edge.axis + 2) % 3] -= i < 2 ? 1 : 0;
          const auto found = vertexOf.find(key(cell));
          whole = whole && found != vertexOf.end();
          if (whole) quad[static_cast<size_t>(edge.outward ? i : 3 - i)] = found->second;
        }
        if (whole) addQuad(mesh, quad);
      }
    return mesh;
  }

  // Along its shorter diagonal.
  static void addQuad(Mesh& mesh, std::array<uint32_t, 4> q) {
    const auto d = [&](size_t i, size_t j) {
      return lengthSquared(mesh.positions[q[i]] - mesh.positions[q[j]]);
    };
    if (d(1, 3) < d(0, 2)) q = {q[1], q[2], q[3], q[0]};
    for (const Vec3u t : {Vec3u(q[0], q[1], q[2]), Vec3u(q[0], q[2], q[3])}) {
      const Vec3f n = cross(mesh.positions[t.y] - mesh.positions[t.x],
                            mesh.positions[t.z] - mesh.positions[t.x]);
      if (lengthSquared(n) > 0) mesh.triangles.push_back(t);
    }
  }

  const Sculpture& sculpture_;
  float maxBlend_ = 0, size_ = 0;
  Vec3f origin_;
  Vec3<int> blocks_;
};

Mesh Sculpture::mesh(int cells) const { return SurfaceNets(*this, cells).make(); }

}  // namespace lobelia::builtin

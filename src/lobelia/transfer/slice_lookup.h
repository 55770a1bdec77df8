// Slices of transfer between the directions and the vertices at which they are known; one
// implementation for frames and for gathering the next pass [P002 sections 5.2, 7.1].
//
// Between the three directions around the eye's first, at each vertex; then between the three
// vertices around a place. Directions behind a vertex's surface are left out.
#pragma once

#include "lobelia/transfer/lobe_sum.h"
#include "lobelia/transfer/reflection.h"
#include "lobelia/transfer/transfer_data.h"
#include "lobelia/transfer/visible_part.h"

namespace lobelia::transfer {

// wo, or where it is in front of a place's surface and behind its interpolated normal, which
// happens along silhouettes, the direction just above the horizon next to it.
Vec3f aboveHorizon(Vec3f wo, const SurfaceNormals& at);

// A vertex as it is seen from somewhere.
struct VertexView {
  uint32_t vertex = 0;
  MaterialHandle material;
  Vec3f n{}, wo{}, mirror{};  // unit; n on the side that is seen, and wo not behind it
  // Of the grid of directions to the eye; weight 0 for those behind the surface.
  GridPlace place;
};

// A place between three vertices, seen from one direction.
struct PlaceView {
  std::array<VertexView, 3> vertices;
  std::array<float, 3> weight{};
  Reflection own;  // what it reflects where nothing is in the way (lobes are not looked at)
};

class SliceLookup {
 public:
  // Keeps references. Passes may be added to the data afterwards, but not during a call.
  SliceLookup(const Scene& scene, const TransferData& data, const ReflectionTables& tables);

  const GeodesicGrid& directions() const { return grid_; }
  // Of a place of the scene, towards wo. The front for all that scatter nothing behind.
  Side sideOf(const Hit& hit, Vec3f wo) const;
  // The same, with the place's normal at hand.
  Side sideOf(MaterialHandle material, Vec3f ng, Vec3f wo) const {
    return reflectsBehind(material) && dot(ng, wo) < 0 ? Side::back : Side::front;
  }
  // wo: unit, world, to the eye. place: where directions() locates it. side: of the place that is
  // looked up, the same for all vertices around it; taken for the front where only that reflects.
  // From behind the vertex's own horizon, as if from just above it.
  VertexView view(uint32_t vertex, Vec3f wo, Side side, const GridPlace& place) const;
  VertexView view(uint32_t vertex, Vec3f wo, Side side) const {
    return view(vertex, wo, side, grid_.locate(wo));
  }
  // own: of the place, towards wo (ReflectionTables::summary() is enough).
  PlaceView view(const relight::SurroundingVertices& around, const Reflection& own, Vec3f wo,
                 Side side, const GridPlace& place) const;
  PlaceView view(const relight::SurroundingVertices& around, const Reflection& own, Vec3f wo,
                 Side side) const {
    return view(around, own, wo, side, grid_.locate(wo));
  }

  // At a vertex. Of pass 0, and of a class of a pass after it: share 0 where there is nothing.
  VisiblePart visible(const VertexView& view) const;
  TransferLobe glossy(const VertexView& view, size_t pass, size_t lobeClass) const;
  // Mean r of the vertex's glossy lobes where nothing is in the way; 0 where it has none.
  Vec3f ownResultant(const VertexView& view) const;

  // What a place's glossy lobes reflect where nothing is in the way, between what is known of its
  // vertices: for materials that have no table, and sums of many.
  TransferLobe ownLobe(const PlaceView& view) const;

  // At a place: what its glossy lobes reflect of a pass, by class (passes[pass].glossy.size()).
  void glossy(const PlaceView& view, size_t pass, std::span<LobeMoment> byClass) const;
  // What its diffuse lobes of this albedo reflect of a pass, by the octant the light comes from;
  // nothing where the data have none of that side.
  std::array<LobeMoment, kOctants> diffuse(const relight::SurroundingVertices& around, Side side,
                                           size_t pass, Rgb albedo) const;

 private:
  bool reflectsBehind(MaterialHandle material) const {
    return material.valid() && reflectsBehind_[material.index] != 0;
  }
  const SliceRecord* find(const VertexView& view, size_t pass, size_t lobeClass, size_t k) const {
    return data_.passes[pass].glossy[lobeClass].find(view.vertex, view.place.index[k]);
  }
  TransferLobe ownLobe(const VertexView& view) const;  // of a material without table
  // ownResultant() towards corner k of the view's triangle of directions.
  Vec3f ownResultant(const VertexView& view, size_t k) const;

  const Scene& scene_;
  const TransferData& data_;
  const ReflectionTables& tables_;
  GeodesicGrid grid_;
  std::vector<uint8_t> reflectsBehind_;  // by material
};

}  // namespace lobelia::transfer

// The vertices around the pixels of tiles of a frame with their slices towards the eye and their
// diffuse light. For one thread.
#pragma once

#include "lobelia/path/direction_rows.h"
#include "lobelia/relight/number_table.h"
#include "lobelia/scene/camera.h"
#include "lobelia/transfer/irradiance.h"
#include "lobelia/transfer/pixel_packet.h"
#include "lobelia/transfer/slice_lookup.h"

namespace lobelia::transfer {

// The light of a frame and what is shown of it.
struct FrameLight {
  const PrefilteredLight& prefiltered;
  const Irradiance& irradiance;
  std::span<const DiffuseLobes> unoccluded;  // by diffuse side; empty where nothing is diffuse
  DirectionRows toLight;                     // from the world to the light as the scene has it
  size_t firstPass = 0, endPass = 0;         // passes shown, of those there are
  PacketLight forPackets() const {
    return {prefiltered.levels(),
            {toLight.rows[0], toLight.rows[1], toLight.rows[2]},
            firstPass == 0 && endPass > 0};
  }
};

// Where a camera's rays come from, seen from p: unit. Lenses are taken to be their middles, because
// slices vary slowly.
class EyeDirection {
 public:
  explicit EyeDirection(const Camera& camera);
  Vec3f from(Vec3f p, Vec3f n) const;

 private:
  bool parallel_;
  Vec3f eye_;  // place, or direction where rays are parallel
};

class FrameVertices {
 public:
  // Forgets all vertices. Keeps references.
  void begin(const SliceLookup& lookup, const TransferData& data, const FrameLight& light,
             const EyeDirection& eye);
  void forget();
  size_t count() const { return vertices_.size(); }
  // Number of a side of a vertex; what it has is there after mergeNew().
  uint32_t slotOf(uint32_t vertex, Side side);
  void mergeNew();

  // By slot; lobes of passes after the first, class after class.
  VertexRows rows() const {
    return {visible_.data(), diffuse_.data(), lobes_.data(), hasLobes_.data(), lobeCount_};
  }

  uint64_t merged = 0, lightLookups = 0;  // since begin()

 private:
  struct SeenVertex {
    uint32_t vertex = 0;
    Side side = Side::front;
  };
  Rgb diffuseLight(SeenVertex at);
  // Sums of light by each of the two.
  std::array<Rgb, 2> lightOf(const DiffuseLobes& first, const DiffuseLobes& second);

  const SliceLookup* lookup_ = nullptr;
  const TransferData* data_ = nullptr;
  const FrameLight* light_ = nullptr;
  const EyeDirection* eye_ = nullptr;
  size_t lobeCount_ = 0;
  relight::NumberTable slots_;
  std::vector<SeenVertex> vertices_;  // by slot, as all that follow
  std::vector<VisibleRow> visible_;
  std::vector<LightRow> diffuse_;
  std::vector<uint8_t> hasLobes_;
  std::vector<LobeRow> lobes_;
};

}  // namespace lobelia::transfer

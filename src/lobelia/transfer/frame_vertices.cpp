#include "lobelia/transfer/frame_vertices.h"

#include <algorithm>

#include "lobelia/transfer/packet_kernels.h"

namespace lobelia::transfer {

EyeDirection::EyeDirection(const Camera& camera)
    : parallel_(camera.type == CameraType::orthographic),
      eye_(parallel_ ? -normalize(camera.toWorld.to.vector({0, 0, 1}))
                     : camera.toWorld.to.point({0, 0, 0})) {}

Vec3f EyeDirection::from(Vec3f p, Vec3f n) const {
  if (parallel_) return eye_;
  const Vec3f d = eye_ - p;
  const float size = length(d);
  return size > 0 ? d / size : n;
}

void FrameVertices::begin(const SliceLookup& lookup, const TransferData& data,
                          const FrameLight& light, const EyeDirection& eye) {
  lookup_ = &lookup, data_ = &data, light_ = &light, eye_ = &eye;
  lobeCount_ = 0;
  for (size_t pass = std::max<size_t>(light.firstPass, 1); pass < light.endPass; ++pass)
    lobeCount_ += data.passes[pass].glossy.size();
  forget();
  merged = 0, lightLookups = 0;
}

void FrameVertices::forget() {
  slots_.clear();
  vertices_.clear(), visible_.clear(), diffuse_.clear(), hasLobes_.clear(), lobes_.clear();
}

uint32_t FrameVertices::slotOf(uint32_t vertex, Side side) {
  uint32_t& slot = slots_[uint64_t{2} * vertex + static_cast<uint64_t>(side)];
  if (slot == relight::NumberTable::kNone) {
    slot = static_cast<uint32_t>(vertices_.size());
    vertices_.push_back({vertex, side});
  }
  return slot;
}

void FrameVertices::mergeNew() {
  for (size_t slot = visible_.size(); slot < vertices_.size(); ++slot) {
    const auto [vertex, side] = vertices_[slot];
    const TransferVertex& at = data_->mesh.vertices[vertex];
    const VertexView view = lookup_->view(vertex, eye_->from(at.p, at.n), side);
    visible_.emplace_back(light_->firstPass == 0 ? lookup_->visible(view) : VisiblePart{});
    diffuse_.push_back({diffuseLight({vertex, side})});
    bool any = false;
    for (size_t pass = std::max<size_t>(light_->firstPass, 1); pass < light_->endPass; ++pass)
      for (size_t c = 0; c < data_->passes[pass].glossy.size(); ++c) {
        lobes_.emplace_back(lookup_->glossy(view, pass, c), view.mirror);
        any = any || lobes_.back().energy > 0;
      }
    hasLobes_.push_back(any ? 1 : 0);
    ++merged;
  }
}

std::array<Rgb, 2> FrameVertices::lightOf(const DiffuseLobes& first, const DiffuseLobes& second) {
  static_assert(2 * kOctants == PixelPacket::kSize);
  LobePacket packet;
  for (size_t i = 0; i < PixelPacket::kSize; ++i) {
    const SliceRecord record = i < kOctants ? first[i] : second[i - kOctants];
    const TransferLobe lobe = unpack(record);
    packet.share.set(i, lobe.share), packet.r.set(i, lobe.r);
    if (lobe.share != Rgb{}) ++lightLookups;
  }
  lookUpLight(light_->forPackets(), &packet);
  std::array<Rgb, 2> sums{};
  for (size_t i = 0; i < PixelPacket::kSize; ++i) sums[i / kOctants] += packet.light.get(i);
  return sums;
}

Rgb FrameVertices::diffuseLight(SeenVertex at) {
  Rgb sum{};
  const size_t number = data_->diffuseSides.find(at.vertex, at.side);
  if (number == DiffuseSides::kNone) return sum;
  size_t pass = light_->firstPass;
  if (pass == 0 && light_->endPass > 0 && !data_->passes[0].diffuse.empty()) {
    // Direct light: octants say which part of what would arrive does.
    const Vec3f outside = data_->mesh.vertices[at.vertex].n;
    const Vec3f n = at.side == Side::back ? -outside : outside;
    const auto [light, whole] =
        lightOf(data_->passes[0].diffuse[number], light_->unoccluded[number]);
    const Rgb exact = light_->irradiance.at(light_->toLight * n);
    for (int c = 0; c < 3; ++c)
      sum[c] += whole[c] > 0 ? std::min(light[c] / whole[c], 1.f) * exact[c] : light[c];
  }
  for (pass = std::max<size_t>(pass, 1); pass < light_->endPass; pass += 2) {
    const auto lobesOf = [&](size_t of) {
      const bool any = of < light_->endPass && !data_->passes[of].diffuse.empty();
      return any ? data_->passes[of].diffuse[number] : DiffuseLobes{};
    };
    const auto [first, second] = lightOf(lobesOf(pass), lobesOf(pass + 1));
    sum += first + second;
  }
  return sum;
}

}  // namespace lobelia::transfer

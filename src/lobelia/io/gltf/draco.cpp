// libdraco decodes. Each attribute must have the count and the number of components that its
// accessor states, and is normalised as the accessor says.
#include "lobelia/io/gltf/draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobelia::io::gltf {
namespace {

// What the largest stored integer stands for in a normalised attribute.
float normalizedScale(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 1 / 127.f;
    case draco::DT_UINT8:
      return 1 / 255.f;
    case draco::DT_INT16:
      return 1 / 32767.f;
    case draco::DT_UINT16:
      return 1 / 65535.f;
    default:
      return 1;
  }
}

// Counts that the start of the data states (Draco bitstream specification, 3.2 to 3.4 and 6). The
// library allocates for them before it has seen a face.
class Start {
 public:
  explicit Start(Bytes bytes) : bytes_(bytes) {}
  uint64_t byte() { return at_ < bytes_.size() ? static_cast<uint64_t>(bytes_[at_++]) : 0; }
  uint64_t word(int count) {
    uint64_t value = 0;
    for (int i = 0; i < count; ++i) value |= byte() << (8 * i);
    return value;
  }
  bool atEnd() const { return at_ >= bytes_.size(); }
  void skip(uint64_t count) {
    at_ += static_cast<size_t>(std::min<uint64_t>(count, bytes_.size() - at_));
  }
  uint64_t varint() {  // LEB128
    uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const uint64_t b = byte();
      value |= (b & 0x7f) << shift;
      if (b < 0x80) break;
    }
    return value;
  }

 private:
  Bytes bytes_;
  size_t at_ = 0;
};

// Entries of a name and a value each, then what is below, in the order of a walk down.
void skipMetadata(Start& start) {
  uint64_t open = 1;
  for (bool isFirst = true; open > 0 && !start.atEnd(); isFirst = false) {
    --open;
    if (!isFirst) start.skip(start.byte());
    for (uint64_t entries = start.varint(); entries > 0 && !start.atEnd(); --entries) {
      start.skip(start.byte());
      start.skip(start.varint());
    }
    open += start.varint();
  }
}

void checkCounts(Bytes bytes, const Json& extension) {
  constexpr uint64_t kMagic = 0x4f43415244;  // "DRACO"
  constexpr uint64_t kMetadata = 0x8000, kMesh = 1, kEdgebreaker = 1;
  constexpr uint64_t kMostPerByte = 256;  // even a flat grid takes more
  Start start(bytes);
  const bool isDraco = start.word(5) == kMagic;
  const uint64_t major = start.byte(), minor = start.byte(), version = major << 8 | minor;
  const uint64_t type = start.byte(), method = start.byte(), flags = start.word(2);
  if (!isDraco || type != kMesh) return;  // the library refuses it
  if ((flags & kMetadata) != 0 && version >= 0x103) {
    for (uint64_t attributes = start.varint(); attributes > 0 && !start.atEnd(); --attributes) {
      start.varint();  // whose they are
      skipMetadata(start);
    }
    skipMetadata(start);  // the mesh's
  }
  uint64_t counts[2];
  const bool edgebreaker = method == kEdgebreaker;
  if (edgebreaker) {
    start.byte();  // how the connectivity is coded
    if (version < 0x200) start.word(4);
    if (version >= 0x200 && version < 0x202) start.varint();
  }
  const bool words = version < (edgebreaker ? 0x200u : 0x202u);
  for (uint64_t& count : counts) count = words ? start.word(4) : start.varint();
  for (const uint64_t count : counts)
    if (count > bytes.size() * kMostPerByte)
      extension.fail(
          fmt::format("the Draco data state {} faces or vertices; their {} bytes cannot "
                      "hold that many",
                      count, bytes.size()));
}

FloatArray readAttribute(const draco::PointAttribute& attribute, size_t pointCount,
                         const Json& accessor, const Json& where) {
  FloatArray out;
  out.count = pointCount, out.components = componentCount(accessor);
  if (accessor["count"].count() != pointCount ||
      out.components != static_cast<size_t>(attribute.num_components()))
    where.fail(
        fmt::format("the compressed data hold {} vertices of {} components; {} states {} "
                    "of {}",
                    pointCount, attribute.num_components(), accessor.path(),
                    accessor["count"].count(), out.components));
  const bool scales = accessor["normalized"].boolean(false) && !attribute.normalized();
  const float scale = scales ? normalizedScale(attribute.data_type()) : 1;
  out.values.resize(pointCount * out.components);
  for (size_t i = 0; i < pointCount; ++i) {
    const draco::PointIndex point(static_cast<uint32_t>(i));
    float* const value = &out.values[i * out.components];
    if (!attribute.ConvertValue<float>(attribute.mapped_index(point),
                                       static_cast<int8_t>(out.components), value))
      where.fail(fmt::format("vertex {} cannot be read from the compressed data", i));
    for (size_t c = 0; c < out.components; ++c) {
      value[c] = scales ? std::max(value[c] * scale, -1.f) : value[c];
      if (!std::isfinite(value[c])) where.fail(fmt::format("vertex {} is not finite", i));
    }
  }
  return out;
}

}  // namespace

std::optional<DracoPrimitive> decodeDraco(Document& document, const Json& primitive) {
  const Json extension = primitive.extension("KHR_draco_mesh_compression");
  if (!extension.exists()) return {};
  const Bytes bytes = document.view(extension["bufferView"]).bytes;
  checkCounts(bytes, extension);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  draco::StatusOr<std::unique_ptr<draco::Mesh>> result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok())
    extension.fail(
        fmt::format("the Draco data are damaged: {}", result.status().error_msg_string()));
  const draco::Mesh& mesh = *result.value();
  DracoPrimitive out;
  for (uint32_t f = 0; f < mesh.num_faces(); ++f)
    for (const draco::PointIndex& i : mesh.face(draco::FaceIndex(f)))
      out.indices.push_back(i.value());
  for (const std::string& name : extension["attributes"].members()) {
    const Json where = extension["attributes"][name];
    const Json accessor = document.item("accessors", primitive["attributes"][name]);
    const uint64_t id = where.count();
    const draco::PointAttribute* const attribute =
        id <= 0xffffffffu ? mesh.GetAttributeByUniqueId(static_cast<uint32_t>(id)) : nullptr;
    if (!attribute) where.fail(fmt::format("the compressed data have no attribute {}", id));
    out.attributes[name] = readAttribute(*attribute, mesh.num_points(), accessor, where);
  }
  return out;
}

}  // namespace lobelia::io::gltf

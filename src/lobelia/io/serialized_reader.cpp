// Mitsuba's serialized meshes: https://mitsuba.readthedocs.io, "Serialized mesh loader". Little
// endian. Per mesh: uint16 0x041C, uint16 version (3 or 4), then a zlib stream of uint32 flags, the
// name (zero-terminated, version 4 only), uint64 vertex and triangle counts, arrays of positions,
// normals, uvs, colours (float or double), uint32 indices. The file ends with the offsets of all
// its meshes (uint64; uint32 in version 3) and their number (uint32).
#include <fmt/format.h>
#include <zlib.h>

#include <cstring>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/mesh_checks.h"

namespace lobelia::io {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers are read as they are stored");

enum Flags : uint32_t {
  kHasNormals = 0x0001,
  kHasUvs = 0x0002,
  kHasColors = 0x0008,
  kFaceNormals = 0x0010,
  kDouble = 0x2000,
};

template <class T>
T load(const std::string& bytes, size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// A zlib stream inside a file's bytes.
class Inflater {
 public:
  Inflater(const std::string& bytes, size_t offset, const Location& where)
      : where_(where), compressed_(bytes.size() - offset) {
    // The interface takes non-const input, which it does not change. Files above 4 GiB are cut:
    // a mesh that reaches there is reported as truncated.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + offset));
    stream_.avail_in = static_cast<uInt>(std::min<size_t>(compressed_, 0xffffffffu));
    if (inflateInit(&stream_) != Z_OK) throw RuntimeError("zlib cannot be initialised");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  void read(void* target, size_t size, const char* what) {
    auto* out = static_cast<Bytef*>(target);
    while (size > 0) {
      const auto part = static_cast<uInt>(std::min<size_t>(size, 1u << 30));
      stream_.next_out = out;
      stream_.avail_out = part;
      const int result = inflate(&stream_, Z_SYNC_FLUSH);
      const size_t got = part - stream_.avail_out;
      out += got, size -= got;
      if (size > 0 && got == 0)
        throw InputError(where_,
                         fmt::format("{} in the {}; the file is damaged or truncated",
                                     result == Z_DATA_ERROR ? "corrupt data" : "data ends", what));
    }
  }
  template <class T>
  T read(const char* what) {
    T value;
    read(&value, sizeof value, what);
    return value;
  }
  // zlib cannot expand by more than a factor of 1032 (its documentation, "Technical Details"): no
  // more bytes than this can follow. Counts in the header are refused by it before allocating.
  uint64_t mostBytes() const { return 1032 * static_cast<uint64_t>(compressed_) + 1024; }

 private:
  Location where_;
  size_t compressed_;
  z_stream stream_{};
};

// Appends `count` values of T, each of several floats or integers stored as Stored. The vector
// grows as data arrives, so that a wrong count in a header costs no memory.
template <class Stored, class Component, class T>
void readArray(Inflater& in, std::vector<T>& out, uint64_t count, const char* what) {
  constexpr size_t kComponents = sizeof(T) / sizeof(Component);
  std::vector<Stored> part(std::min<uint64_t>(count, 1u << 14) * kComponents);
  for (size_t done = 0; done < count;) {
    const size_t n = std::min<uint64_t>(part.size() / kComponents, count - done);
    in.read(part.data(), n * kComponents * sizeof(Stored), what);
    for (size_t i = 0; i < n; ++i) {
      T value;
      Component components[kComponents];
      for (size_t k = 0; k < kComponents; ++k)
        components[k] = static_cast<Component>(part[i * kComponents + k]);
      std::memcpy(&value, components, sizeof value);
      out.push_back(value);
    }
    done += n;
  }
}

template <class T>
void readFloats(Inflater& in, bool isDouble, std::vector<T>& out, uint64_t count,
                const char* what) {
  if (isDouble)
    readArray<double, float>(in, out, count, what);
  else
    readArray<float, float>(in, out, count, what);
}

size_t meshOffset(const std::string& bytes, int index, const Location& where) {
  if (index < 0) throw InputError(where, "the shape index is negative; it counts from 0");
  if (index == 0) return 0;  // readable even when the dictionary is missing
  const bool wide = load<uint16_t>(bytes, 2) == 4;
  const size_t entry = wide ? 8 : 4;
  const uint64_t count = load<uint32_t>(bytes, bytes.size() - 4);
  if (count > (bytes.size() - 4) / entry)
    throw InputError(where, "the dictionary at the end is damaged; the file may be truncated");
  if (static_cast<uint64_t>(index) >= count)
    throw InputError(where,
                     fmt::format("there is no shape {}; the file has {} (from 0)", index, count));
  const size_t at = bytes.size() - 4 - entry * (count - static_cast<uint64_t>(index));
  const uint64_t offset = wide ? load<uint64_t>(bytes, at) : load<uint32_t>(bytes, at);
  if (offset > bytes.size() - 8)
    throw InputError(where,
                     fmt::format("shape {} is said to start behind the end of the file", index));
  return static_cast<size_t>(offset);
}

}  // namespace

Mesh readSerialized(const std::string& file, const MeshOptions& options, const Location& from,
                    std::vector<Finding>& findings) {
  const std::string bytes = readFileBytes(file, "mesh", from);
  const Location where{file, 0, 0};
  if (bytes.size() < 8) throw InputError(where, "too short for a serialized mesh");
  size_t offset = meshOffset(bytes, options.shapeIndex, where);
  const auto magic = load<uint16_t>(bytes, offset), version = load<uint16_t>(bytes, offset + 2);
  if (magic != 0x041c)
    throw InputError(where, "not a serialized mesh of Mitsuba; it would start with 1C 04");
  if (version != 3 && version != 4)
    throw InputError(where, fmt::format("serialized version {}; known are 3 and 4", version));

  Inflater in(bytes, offset + 4, where);
  const auto flags = in.read<uint32_t>("flags");
  Mesh mesh;
  if (version == 4)
    for (char c = in.read<char>("name"); c != 0; c = in.read<char>("name")) {
      if (mesh.name.size() > 4096) throw InputError(where, "the shape's name does not end");
      mesh.name += c;
    }
  const auto vertexCount = in.read<uint64_t>("vertex count");
  const auto triangleCount = in.read<uint64_t>("triangle count");
  const bool isDouble = (flags & kDouble) != 0;
  const uint64_t floats = 3u + ((flags & kHasNormals) ? 3u : 0u) + ((flags & kHasUvs) ? 2u : 0u) +
                          ((flags & kHasColors) ? 3u : 0u);
  const uint64_t vertexBytes = floats * (isDouble ? 8 : 4);
  if (vertexCount > in.mostBytes() / vertexBytes || triangleCount > in.mostBytes() / 12 ||
      vertexCount > 0xffffffffu || triangleCount > 0xffffffffu)
    throw InputError(where, fmt::format("{} vertices and {} triangles are more than a file of {} "
                                        "bytes can hold",
                                        vertexCount, triangleCount, bytes.size()));

  readFloats(in, isDouble, mesh.positions, vertexCount, "positions");
  if (flags & kHasNormals) readFloats(in, isDouble, mesh.normals, vertexCount, "normals");
  if (flags & kHasUvs) readFloats(in, isDouble, mesh.uvs, vertexCount, "uvs");
  if (options.flipTexCoords.value_or(false))
    for (Vec2f& uv : mesh.uvs) uv.y = 1 - uv.y;
  if (flags & kHasColors) {
    MeshAttribute color{"vertex_color", false, 3, {}};
    readFloats(in, isDouble, color.values, 3 * vertexCount, "colours");
    mesh.attributes.push_back(std::move(color));
  }
  readArray<uint32_t, uint32_t>(in, mesh.triangles, triangleCount, "triangles");

  MeshOptions finishing = options;
  finishing.faceNormals |= (flags & kFaceNormals) != 0;
  finishMesh(mesh, file, finishing, findings);
  return mesh;
}

}  // namespace lobelia::io

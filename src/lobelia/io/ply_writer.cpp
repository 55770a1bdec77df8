// Binary little-endian PLY, with attributes named so that readPly() finds them again.
#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::io {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are stored");

template <class T>
void append(std::string& bytes, const T& value) {
  const size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

// The property lines of an attribute: vertex_color -> r g b, vertex_NAME_color -> NAME_r NAME_g
// NAME_b, vertex_NAME -> NAME_x NAME_y NAME_z.
std::string propertyLines(const MeshAttribute& attribute) {
  const std::string prefix = attribute.perFace ? "face_" : "vertex_";
  std::string name = attribute.name;
  if (name.starts_with(prefix)) name.erase(0, prefix.size());
  const char* endings = "xyzw";
  std::string stem = name + "_";
  if (name == "color" && attribute.size >= 3) {
    endings = "rgba", stem.clear();
  } else if (name.size() > 6 && name.ends_with("_color")) {
    endings = "rgba", stem = name.substr(0, name.size() - 5);
  }
  if (attribute.size < 1 || attribute.size > 4 || name.find_first_of(" \t\r\n") != name.npos)
    throw RuntimeError(
        fmt::format("mesh attribute '{}' of {} components cannot be written as PLY; "
                    "it may have 1 to 4 and no blanks in its name",
                    attribute.name, attribute.size));
  std::string lines;
  for (int i = 0; i < attribute.size; ++i)
    lines += fmt::format("property float {}{}\n", stem, endings[i]);
  return lines;
}

std::string header(const Mesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      mesh.positions.size());
  if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.uvs.empty()) text += "property float u\nproperty float v\n";
  for (const MeshAttribute& a : mesh.attributes)
    if (!a.perFace) text += propertyLines(a);
  text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n",
                      mesh.triangles.size());
  for (const MeshAttribute& a : mesh.attributes)
    if (a.perFace) text += propertyLines(a);
  return text + "end_header\n";
}

void appendAttributes(std::string& bytes, const Mesh& mesh, bool perFace, size_t i) {
  for (const MeshAttribute& a : mesh.attributes) {
    if (a.perFace != perFace) continue;
    const auto size = static_cast<size_t>(a.size);
    for (size_t k = 0; k < size; ++k) append(bytes, a.values[i * size + k]);
  }
}

}  // namespace

void writePly(const std::string& file, const Mesh& mesh) {
  std::string bytes = header(mesh);
  bytes.reserve(bytes.size() + 32 * mesh.positions.size() + 13 * mesh.triangles.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    append(bytes, mesh.positions[i]);
    if (!mesh.normals.empty()) append(bytes, mesh.normals[i]);
    if (!mesh.uvs.empty()) append(bytes, mesh.uvs[i]);
    appendAttributes(bytes, mesh, false, i);
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    append(bytes, uint8_t{3});
    append(bytes, mesh.triangles[i]);
    appendAttributes(bytes, mesh, true, i);
  }
  writeFileAtomically(file, bytes);
}

}  // namespace lobelia::io

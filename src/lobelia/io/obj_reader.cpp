// Wavefront OBJ, parsed by tinyobjloader's callback interface, with Mitsuba 3's conventions: all
// groups make one mesh, vertices are the distinct (position, uv, normal) triples in order of first
// use, polygons become fans, v is flipped by default. Which material a triangle uses is told by
// readObjWithMaterials(); readObj() ignores it, as Mitsuba does.
//
// tinyobjloader accepts anything as a number and knows no line numbers. So it reads through a
// stream buffer that hands out one line at a time, counts lines and checks each line's syntax
// before tinyobjloader sees it; at a callback, the current line is the one being parsed.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <limits>
#include <streambuf>
#include <string_view>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/mesh_checks.h"
#include "lobelia/io/obj_materials.h"

namespace lobelia::io {
namespace {

constexpr std::string_view kBlank = " \t\r";

// Next blank-separated word of `line`, removed from it; empty at the end.
std::string_view nextWord(std::string_view& line) {
  const size_t begin = std::min(line.find_first_not_of(kBlank), line.size());
  const size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::string trimmed(std::string_view line) {
  const size_t begin = std::min(line.find_first_not_of(kBlank), line.size());
  line.remove_prefix(begin);
  while (!line.empty() && kBlank.find(line.back()) != kBlank.npos) line.remove_suffix(1);
  return std::string(line);
}

bool isFiniteNumber(std::string_view word) {
  if (!word.empty() && word[0] == '+') word.remove_prefix(1);
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // Too small for a float is a zero; too large is not finite.
  const bool tiny = error == std::errc::result_out_of_range &&
                    (word.find("e-") != word.npos || word.find("E-") != word.npos);
  return end == word.data() + word.size() &&
         (tiny || (error == std::errc() && std::isfinite(value)));
}

// "7", "7/1", "7//2", "7/1/2", indices positive or negative, of int's range.
bool isVertexReference(std::string_view word) {
  for (int part = 0; part < 3; ++part) {
    const size_t end = std::min(word.find('/'), word.size());
    int value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + end, value);
    const bool empty = part == 1 && end == 0 && end < word.size();
    if (!empty && (error != std::errc() || stop != word.data() + end || value == 0)) return false;
    if (end == word.size()) return true;
    word.remove_prefix(end + 1);
  }
  return false;
}

// Serves a file line by line, checked. Lines continued by a backslash are joined.
class LineBuffer : public std::streambuf {
 public:
  LineBuffer(std::string bytes, const std::string& file)
      : bytes_(std::move(bytes)), where_{file, 0, 0} {
    // Old line ends (a lone carriage return) become new ones, so that lines are counted alike.
    for (size_t i = 0; i < bytes_.size(); ++i)
      if (bytes_[i] == '\r' && (i + 1 == bytes_.size() || bytes_[i + 1] != '\n')) bytes_[i] = '\n';
  }
  const Location& where() const { return where_; }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(where_, message); }
  const std::string& unknownStatement() const { return unknown_; }
  const Location& unknownWhere() const { return unknownWhere_; }
  // Index in materials() that usemtl named for the current line.
  uint32_t material() const { return material_; }
  const std::vector<std::string>& materials() const { return materials_; }
  const std::vector<std::string>& libraries() const { return libraries_; }

 protected:
  int_type underflow() override {
    if (next_ >= bytes_.size()) return traits_type::eof();
    const size_t begin = next_;
    where_.line += linesOfNext_;
    linesOfNext_ = 0;
    for (bool more = true; more;) {
      const size_t end = std::min(bytes_.find('\n', next_), bytes_.size());
      size_t last = end;
      if (last > begin && bytes_[last - 1] == '\r') --last;
      more = last > begin && bytes_[last - 1] == '\\' && end < bytes_.size();
      if (more)
        std::fill(bytes_.begin() + static_cast<long>(last) - 1,
                  bytes_.begin() + static_cast<long>(end) + 1, ' ');
      next_ = std::min(end + 1, bytes_.size());
      ++linesOfNext_;
    }
    ++where_.line;  // first line of this statement
    --linesOfNext_;
    check(std::string_view(bytes_).substr(begin, next_ - begin));
    char* data = bytes_.data();
    setg(data + begin, data + begin, data + next_);
    return traits_type::to_int_type(data[begin]);
  }

 private:
  void check(std::string_view line) {
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    const std::string_view keyword = nextWord(line);
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "v") return checkNumbers(line, keyword, 3, 8);
    if (keyword == "vn") return checkNumbers(line, keyword, 3, 3);
    if (keyword == "vt") return checkNumbers(line, keyword, 1, 3);
    if (keyword == "f") return checkFace(line);
    if (keyword == "usemtl") return useMaterial(trimmed(line));
    if (keyword == "mtllib") libraries_.push_back(trimmed(line));
    static constexpr std::array<std::string_view, 11> kIgnored{
        "g", "o", "s", "usemtl", "mtllib", "l", "p", "vp", "mg", "usemap", "maplib"};
    if (std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end() && unknown_.empty())
      unknown_ = std::string(keyword.substr(0, 40)), unknownWhere_ = where_;
  }
  void useMaterial(const std::string& name) {
    const auto found = std::find(materials_.begin(), materials_.end(), name);
    material_ = static_cast<uint32_t>(found - materials_.begin());
    if (found == materials_.end()) materials_.push_back(name);
  }
  void checkNumbers(std::string_view line, std::string_view keyword, int least, int most) const {
    int count = 0;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
      if (word[0] == '#') break;
      if (!isFiniteNumber(word))
        fail(fmt::format("'{}' is not a finite number; '{}' is followed by at least {}", word,
                         keyword, least));
      ++count;
    }
    if (count < least || count > most)
      fail(fmt::format("{} numbers after '{}'; there must be {} to {}", count, keyword, least,
                       most));
  }
  void checkFace(std::string_view line) const {
    int count = 0;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line), ++count)
      if (!isVertexReference(word))
        fail(
            fmt::format("'{}' is not a vertex of a face; write 1, 1/1, 1//1 or 1/1/1 with indices "
                        "other than 0",
                        word));
    if (count < 3) fail(fmt::format("a face with {} vertices; it needs at least 3", count));
  }

  std::string bytes_;
  Location where_;
  size_t next_ = 0;
  int linesOfNext_ = 0;  // continuation lines of the current statement
  std::string unknown_;
  Location unknownWhere_;
  uint32_t material_ = ObjMesh::kNoMaterial;
  std::vector<std::string> materials_, libraries_;
};

// Collects what tinyobjloader calls back with, as an indexed mesh.
class Builder {
 public:
  Builder(const LineBuffer& lines, bool flip) : lines_(lines), flip_(flip) {}

  void addPosition(Vec3f p) { positions_.push_back(p); }
  void addNormal(Vec3f n) { normals_.push_back(n); }
  void addUv(float u, float v) { uvs_.push_back({u, flip_ ? 1 - v : v}); }
  void addFace(const tinyobj::index_t* corners, int count) {
    uint32_t fan[2] = {};
    for (int i = 0; i < count; ++i) {
      const uint32_t v = vertex({resolve(corners[i].vertex_index, positions_.size(), "vertex"),
                                 resolve(corners[i].texcoord_index, uvs_.size(), "uv"),
                                 resolve(corners[i].normal_index, normals_.size(), "normal")});
      if (i >= 2) {
        mesh_.triangles.push_back({fan[0], fan[1], v});
        materials_.push_back(lines_.material());
      }
      fan[i == 0 ? 0 : 1] = v;
    }
  }
  std::vector<uint32_t> takeMaterials() { return std::move(materials_); }
  Mesh take() {
    if (!usesNormals_) mesh_.normals.clear();
    if (!usesUvs_) mesh_.uvs.clear();
    return std::move(mesh_);
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;
  struct Key {
    uint32_t position, uv, normal;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Entry {
    Key key;
    uint32_t next;  // other vertex with the same position
  };

  // 1-based or, negative, from the end; 0: not given. To 0-based.
  uint32_t resolve(int index, size_t count, const char* what) const {
    if (index == 0) return kNone;
    const auto size = static_cast<int64_t>(count);
    const int64_t i = index > 0 ? int64_t{index} - 1 : size + index;
    if (i < 0 || i >= size)
      lines_.fail(
          fmt::format("there is no {} {}; {} are defined before this line", what, index, size));
    return static_cast<uint32_t>(i);
  }
  uint32_t vertex(const Key& key) {
    first_.resize(positions_.size(), kNone);
    uint32_t* link = &first_[key.position];
    while (*link != kNone && !(entries_[*link].key == key)) link = &entries_[*link].next;
    if (*link != kNone) return *link;
    const auto index = static_cast<uint32_t>(entries_.size());
    *link = index;
    entries_.push_back({key, kNone});
    mesh_.positions.push_back(positions_[key.position]);
    mesh_.uvs.push_back(key.uv == kNone ? Vec2f() : uvs_[key.uv]);
    mesh_.normals.push_back(key.normal == kNone ? Vec3f() : normals_[key.normal]);
    usesUvs_ |= key.uv != kNone;
    usesNormals_ |= key.normal != kNone;
    return index;
  }

  const LineBuffer& lines_;
  bool flip_, usesUvs_ = false, usesNormals_ = false;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec2f> uvs_;
  std::vector<uint32_t> first_;  // first vertex of each position
  std::vector<Entry> entries_;
  std::vector<uint32_t> materials_;  // of each triangle
  Mesh mesh_;
};

}  // namespace

ObjMesh readObjWithMaterials(const std::string& file, const MeshOptions& options,
                             const Location& from, std::vector<Finding>& findings) {
  LineBuffer lines(readFileBytes(file, "mesh", from), file);
  Builder builder(lines, options.flipTexCoords.value_or(true));
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* user, float x, float y, float z, float) {
    static_cast<Builder*>(user)->addPosition({x, y, z});
  };
  callbacks.normal_cb = [](void* user, float x, float y, float z) {
    static_cast<Builder*>(user)->addNormal({x, y, z});
  };
  callbacks.texcoord_cb = [](void* user, float u, float v, float) {
    static_cast<Builder*>(user)->addUv(u, v);
  };
  callbacks.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
    static_cast<Builder*>(user)->addFace(corners, count);
  };
  std::istream stream(&lines);
  // Errors found by the line buffer must pass through the stream, which else would swallow them.
  stream.exceptions(std::ios::badbit);
  std::string error;
  if (!tinyobj::LoadObjWithCallback(stream, callbacks, &builder, nullptr, nullptr, &error))
    lines.fail(error);
  ObjMesh out;
  out.mesh = builder.take();
  out.triangleMaterials = builder.takeMaterials();
  out.materials = lines.materials(), out.libraries = lines.libraries();
  Mesh& mesh = out.mesh;
  if (!lines.unknownStatement().empty())
    addWarning(findings, lines.unknownWhere(),
               fmt::format("unknown statement '{}' (and perhaps others) ignored",
                           lines.unknownStatement()));
  if (mesh.triangles.empty())
    throw InputError({file, 0, 0}, "no faces; an OBJ mesh has 'v' and 'f' statements");
  finishMesh(mesh, file, options, findings);
  return out;
}

Mesh readObj(const std::string& file, const MeshOptions& options, const Location& from,
             std::vector<Finding>& findings) {
  return std::move(readObjWithMaterials(file, options, from, findings).mesh);
}

}  // namespace lobelia::io

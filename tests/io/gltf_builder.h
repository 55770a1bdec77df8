// Small glTF files for tests: binary data gathered in one buffer, JSON as text.
#pragma once

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "io/temporary_folder.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::test {

inline std::string base64(const std::string& bytes) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t v = 0;
    for (size_t k = 0; k < 3; ++k)
      v = v << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[v >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

class GltfBuilder {
 public:
  // Adds data with a buffer view and an accessor of its own; returns the accessor's index.
  template <class T>
  size_t accessor(const std::vector<T>& values, const std::string& type, size_t components,
                  const std::string& more = "") {
    const size_t v = view(values);
    return rawAccessor(fmt::format(R"("bufferView":{},"componentType":{},"count":{},"type":"{}"{})",
                                   v, componentType<T>(), values.size() / components, type,
                                   more.empty() ? "" : "," + more));
  }
  size_t rawAccessor(const std::string& members) {
    accessors_.push_back("{" + members + "}");
    return accessors_.size() - 1;
  }
  template <class T>
  size_t view(const std::vector<T>& values, const std::string& more = "") {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    views_.push_back(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}{}}})",
                                 bytes_.size(), values.size() * sizeof(T),
                                 more.empty() ? "" : "," + more));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return views_.size() - 1;
  }
  size_t bytesBefore() const { return bytes_.size(); }

  // A unit square in the plane z = 0 with normals and uv; positions, normals, uv, indices are
  // accessors 0 to 3.
  static GltfBuilder square() {
    GltfBuilder b;
    b.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
    b.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    b.accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
    b.accessor<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 1);
    return b;
  }
  static std::string squareMesh(const std::string& more = "") {
    return R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},)"
           R"("indices":3)" +
           (more.empty() ? "" : "," + more) + "}]}]";
  }

  // `members`: what the top-level object has besides asset and the data.
  std::string json(const std::string& members, bool embedded = true) const {
    std::string out = R"({"asset":{"version":"2.0"})";
    if (!accessors_.empty()) out += R"(,"accessors":[)" + joined(accessors_) + "]";
    if (!views_.empty()) out += R"(,"bufferViews":[)" + joined(views_) + "]";
    if (!bytes_.empty()) {
      out += fmt::format(R"(,"buffers":[{{"byteLength":{})", bytes_.size());
      if (embedded)
        out += R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes_) + "\"";
      out += "}]";
    }
    return out + (members.empty() ? "" : ",") + members + "}";
  }
  std::string glb(const std::string& members) const {
    std::string text = json(members, false);
    while (text.size() % 4 != 0) text += ' ';
    std::string data = bytes_;
    while (data.size() % 4 != 0) data += '\0';
    std::string out = "glTF" + word(2) + word(28 + text.size() + data.size());
    out += word(text.size()) + "JSON" + text + word(data.size()) + std::string("BIN\0", 4) + data;
    return out;
  }
  const std::string& bytes() const { return bytes_; }
  static std::string word(size_t value) {
    const auto v = static_cast<uint32_t>(value);
    std::string out(4, '\0');
    std::memcpy(out.data(), &v, 4);
    return out;
  }

 private:
  template <class T>
  static int componentType() {
    if (std::is_same_v<T, float>) return 5126;
    const int base = sizeof(T) == 1 ? 5120 : sizeof(T) == 2 ? 5122 : 5124;
    return base + (std::is_unsigned_v<T> ? 1 : 0);
  }
  static std::string joined(const std::vector<std::string>& items) {
    std::string out;
    for (const std::string& item : items) out += (out.empty() ? "" : ",") + item;
    return out;
  }
  std::string bytes_;
  std::vector<std::string> views_, accessors_;
};

// Reads glTF texts; the message of what goes wrong must name the JSON path.
class GltfTest : public testing::Test {
 protected:
  Scene read(const std::string& text, const io::ReadSettings& settings = {}) {
    Context context;
    return io::readScene(folder.write(text.starts_with("glTF") ? "a.glb" : "a.gltf", text),
                         settings, context);
  }
  void expectError(const std::string& text, const std::string& path, const std::string& part) {
    const std::string message = messageOf<InputError>([&] { read(text); });
    EXPECT_TRUE(contains(message, path + ": ")) << message;
    EXPECT_TRUE(contains(message, part)) << message;
  }
  static bool finds(const Scene& scene, Severity severity, const std::string& part) {
    for (const Finding& f : scene.findings)
      if (f.severity == severity && contains(toString(f.where) + ": " + f.message, part))
        return true;
    return false;
  }
  static bool warns(const Scene& scene, const std::string& part) {
    return finds(scene, Severity::warning, part);
  }
  TemporaryFolder folder;
};

inline const std::string kOneNode = R"("nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0,)";

}  // namespace lobelia::test

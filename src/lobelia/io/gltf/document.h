// A glTF file's JSON and the bytes of its buffers and buffer views (glTF 2.0, sections 3.6 and 4).
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobelia/io/gltf/json.h"

namespace lobelia::io::gltf {

using Bytes = std::span<const std::byte>;

struct BufferView {
  Bytes bytes;
  size_t stride = 0;  // 0: elements follow each other
};

// What an URI stands for: a file beside the document, or data in the URI itself.
struct Resource {
  std::string name;  // file, or what to call embedded data in messages
  std::vector<std::byte> bytes;
};

class Document {
 public:
  // Reads .gltf and .glb, told apart by their contents. Throws InputError.
  explicit Document(const std::string& file);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  const std::string& file() const { return file_; }
  Json root() const;
  size_t size(std::string_view array) const { return root()[array].size(); }
  // The item of a top-level array ("meshes") that `index` names.
  Json item(std::string_view array, const Json& index) const;
  BufferView view(const Json& index);  // decompressed when it has EXT_meshopt_compression
  Resource resource(const Json& uri) const;
  // byteLength bytes of a buffer from byteOffset on; `where` holds both members.
  Bytes slice(const Json& where);

 private:
  Bytes buffer(const Json& index);

  std::string file_;
  std::vector<std::byte> contents_;
  Bytes binaryChunk_;
  bool hasBinaryChunk_ = false;
  std::unique_ptr<nlohmann::json> json_;
  std::map<size_t, std::vector<std::byte>> buffers_, decompressed_;
};

// EXT_meshopt_compression (meshopt.cpp): the bytes of the buffer view.
std::vector<std::byte> decodeMeshopt(const Json& extension, Bytes compressed);

}  // namespace lobelia::io::gltf

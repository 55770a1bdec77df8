// Containers and buffers: glTF 2.0, 3.6.1 (buffers and views), 4.4 (binary glTF).
// Deviation: chunks of unknown type are skipped, as the specification asks, and so is what follows
// the length that a .glb states.
#include "lobelia/io/gltf/document.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lobelia/base/file.h"
#include "lobelia/io/gltf/uri.h"

namespace lobelia::io::gltf {
namespace {

constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

uint32_t word(Bytes bytes, size_t offset) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

struct Chunks {
  Bytes json, binary;
  bool hasBinary = false;
};

Chunks splitBinary(Bytes bytes, const Location& where) {
  if (bytes.size() < 20) throw InputError(where, "a truncated .glb; its header takes 20 bytes");
  if (const uint32_t version = word(bytes, 4); version != 2)
    throw InputError(where, fmt::format("glb version {}; only version 2 is read", version));
  const uint32_t length = word(bytes, 8);
  if (length > bytes.size() || length < 20)
    throw InputError(where, fmt::format("the header states {} bytes, the file has {}; it is "
                                        "truncated or damaged",
                                        length, bytes.size()));
  bytes = bytes.first(length);
  Chunks chunks;
  bool hasJson = false;
  for (size_t at = 12; at < bytes.size();) {
    if (bytes.size() - at < 8)
      throw InputError(where, fmt::format("a truncated chunk header at byte {}", at));
    const uint32_t size = word(bytes, at), type = word(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at)
      throw InputError(where, fmt::format("the chunk at byte {} states {} bytes; {} are left",
                                          at - 8, size, bytes.size() - at));
    const Bytes chunk = bytes.subspan(at, size);
    if (!hasJson && type != kJsonChunk)
      throw InputError(where, "the first chunk of a .glb must be JSON");
    if (!hasJson) {
      chunks.json = chunk, hasJson = true;
    } else if (type == kBinaryChunk && !chunks.hasBinary) {
      chunks.binary = chunk, chunks.hasBinary = true;
    }
    at += std::min(bytes.size() - at, (size_t{size} + 3) / 4 * 4);
  }
  return chunks;
}

}  // namespace

Document::~Document() = default;

Document::Document(const std::string& file) : file_(file), contents_(readFile(file)) {
  const Location where{file_, 0, 0};
  Chunks chunks;
  chunks.json = contents_;
  if (contents_.size() >= 4 && word(contents_, 0) == kMagic) {
    chunks = splitBinary(contents_, where);
  } else if (contents_.empty()) {
    throw InputError(where, "the file is empty; a glTF file is JSON or a binary .glb");
  }
  binaryChunk_ = chunks.binary, hasBinaryChunk_ = chunks.hasBinary;
  const char* text = reinterpret_cast<const char*>(chunks.json.data());
  try {
    json_ = std::make_unique<nlohmann::json>(
        nlohmann::json::parse(text, text + chunks.json.size(), nullptr, true));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(where, fmt::format("not valid JSON: {}", error.what()));
  }
  if (!json_->is_object()) throw InputError(where, "not glTF; the JSON must be an object");
}

Json Document::root() const { return {json_.get(), "", file_}; }

Json Document::item(std::string_view array, const Json& index) const {
  const Json items = root()[array];
  return items.at(index.index(items.size(), array));
}

Resource Document::resource(const Json& uri) const {
  const std::string text = uri.text();
  if (isDataUri(text)) {
    std::optional<std::vector<std::byte>> bytes = decodeDataUri(text);
    if (!bytes) uri.fail("a damaged data URI; it must read data:TYPE;base64,DATA");
    return {file_ + ": " + uri.path(), std::move(*bytes)};
  }
  if (hasScheme(text))
    uri.fail("only files beside the scene and data: URIs are read; download what it names");
  const std::filesystem::path relative = percentDecoded(text);
  const std::string path = (std::filesystem::path(file_).parent_path() / relative).string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    uri.fail(fmt::format("there is no file '{}'", path));
  return {path, readFile(path)};
}

Bytes Document::buffer(const Json& index) {
  const Json where = item("buffers", index);
  const size_t i = index.index(size("buffers"), "buffers");
  const uint64_t length = where["byteLength"].count();
  Bytes bytes;
  if (where["uri"].exists()) {
    auto found = buffers_.find(i);
    if (found == buffers_.end()) found = buffers_.emplace(i, resource(where["uri"]).bytes).first;
    bytes = found->second;
  } else if (i == 0 && hasBinaryChunk_) {
    bytes = binaryChunk_;
  } else {
    where.fail("has no uri; only buffer 0 of a .glb with a binary chunk may lack one");
  }
  if (length > bytes.size())
    where["byteLength"].fail(
        fmt::format("states {} bytes; there are {} (truncated?)", length, bytes.size()));
  return bytes.first(static_cast<size_t>(length));
}

Bytes Document::slice(const Json& where) {
  const Bytes bytes = buffer(where["buffer"]);
  const uint64_t offset = where["byteOffset"].count(0), length = where["byteLength"].count();
  if (offset > bytes.size() || length > bytes.size() - offset)
    where.fail(fmt::format("spans bytes {} to {}; its buffer has {}", offset, offset + length,
                           bytes.size()));
  return bytes.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
}

BufferView Document::view(const Json& index) {
  const Json where = item("bufferViews", index);
  if (const Json extension = where.extension("EXT_meshopt_compression"); extension.exists()) {
    const size_t i = index.index(size("bufferViews"), "bufferViews");
    auto found = decompressed_.find(i);
    if (found == decompressed_.end())
      found = decompressed_.emplace(i, decodeMeshopt(extension, slice(extension))).first;
    const bool isVertices = extension["mode"].text() == "ATTRIBUTES";
    return {found->second, isVertices ? static_cast<size_t>(extension["byteStride"].count()) : 0};
  }
  BufferView view{slice(where), 0};
  if (where["byteStride"].exists()) {
    view.stride = static_cast<size_t>(where["byteStride"].count());
    if (view.stride < 1 || view.stride > 252)
      where["byteStride"].fail(fmt::format("is {}; it must be from 4 to 252", view.stride));
  }
  return view;
}

}  // namespace lobelia::io::gltf

// Our data files: magic, version, named chunks (zstd), one checksum (XXH3), written atomically
// (base/file.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lobelia::store {

// Collects named chunks and writes them as one file (layout: container.cpp). `kind` says what the
// file holds, in at most 16 bytes; `version` is that of the kind's chunks. Chunks are packed, and
// kept, as they are added; those that are large come later: nothing is kept of them.
class Writer {
 public:
  Writer(std::string_view kind, uint32_t version, uint64_t sceneHash);
  template <class T>
  void add(std::string_view chunk, std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    addBytes(chunk, std::as_bytes(values), sizeof(T));
  }
  // make(first, out) gives the items from `first` on, as many as `out` has; asked by save(), twice
  // for each in turn, from one thread. It must give the same both times.
  template <class T, class Make>
  void addLater(std::string_view chunk, uint64_t count, const Make& make) {
    static_assert(std::is_trivially_copyable_v<T>);
    addSource({std::string(chunk), sizeof(T), count,
               [make, buffer = std::vector<T>()](uint64_t first, uint64_t items) mutable {
                 buffer.resize(static_cast<size_t>(items));
                 make(first, std::span<T>(buffer));
                 return std::as_bytes(std::span<const T>(buffer));
               }});
  }
  void save(const std::string& file) const;

  // A chunk whose bytes are asked for when they are written.
  struct Source {
    std::string chunk;
    size_t itemSize;
    uint64_t count;  // of items
    // Bytes of some items, good until the next call.
    std::function<std::span<const std::byte>(uint64_t first, uint64_t items)> items;
  };

 private:
  void addBytes(std::string_view chunk, std::span<const std::byte> bytes, size_t itemSize);
  void addSource(Source source);
  std::string kind_;
  uint32_t version_;
  uint64_t sceneHash_;
  // Chunks in their order: bytes of some, then one that comes later.
  struct Part {
    std::vector<std::byte> bytes;
    std::vector<Source> later;  // one at most
  };
  std::vector<Part> parts_;
};

class Reader {
 public:
  // Throws InputError: not this kind, another version, truncated, checksum differs.
  Reader(const std::string& file, std::string_view kind, uint32_t version);
  uint64_t sceneHash() const { return sceneHash_; }
  bool has(std::string_view chunk) const;
  // Throws InputError: no such chunk, items of another size, data that does not unpack.
  template <class T>
  std::vector<T> get(std::string_view chunk) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::vector<std::byte> bytes = getBytes(chunk, sizeof(T));
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return values;
  }

 private:
  std::vector<std::byte> getBytes(std::string_view chunk, size_t itemSize) const;
  struct Chunk {
    std::string name;
    uint32_t itemSize = 0;
    uint64_t size = 0;             // bytes when unpacked
    size_t begin = 0, packed = 0;  // place and bytes in data_
  };
  const Chunk* find(std::string_view chunk) const;
  std::string file_;
  uint64_t sceneHash_ = 0;
  std::vector<std::byte> data_;  // the whole file; chunks are unpacked when asked for
  std::vector<Chunk> chunks_;
};

// What the file holds, by its header alone; "": it is none of ours. Throws RuntimeError where it
// cannot be read.
std::string kindOf(const std::string& file);
// The scene hash of a file of ours, by its header alone; the rest may be damaged. Throws as
// kindOf() does, InputError where it is none of ours.
uint64_t sceneHashOf(const std::string& file);

// XXH3, 64 bits.
uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t seed = 0);

}  // namespace lobelia::store

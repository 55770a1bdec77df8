// Our data files: magic, version, named chunks (zstd), one checksum (XXH3), written atomically.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lobelia::store {

// Writes to FILE.tmp-PID, syncs, renames. Throws RuntimeError and leaves nothing half-written.
void writeFileAtomically(const std::string& file, std::span<const std::byte> bytes);
std::vector<std::byte> readFile(const std::string& file, uint64_t maxBytes = 1ull << 36);  // InputError

class Writer {
 public:
  Writer(std::string_view kind, uint32_t version, uint64_t sceneHash);
  template <class T>
  void add(std::string_view chunk, std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    addBytes(chunk, std::as_bytes(values), sizeof(T));
  }
  void save(const std::string& file) const;

 private:
  void addBytes(std::string_view chunk, std::span<const std::byte> bytes, size_t itemSize);
  std::vector<std::byte> data_;
};

class Reader {
 public:
  // Throws InputError: not this kind, another version, truncated, checksum differs.
  Reader(const std::string& file, std::string_view kind, uint32_t version);
  uint64_t sceneHash() const { return sceneHash_; }
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
  struct Chunk { std::string name; uint32_t itemSize; std::vector<std::byte> bytes; };
  std::string file_;
  uint64_t sceneHash_ = 0;
  std::vector<Chunk> chunks_;
};

uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t seed = 0);

}  // namespace lobelia::store

// Writing; the layout is that of container.h.
//
// The header, which comes first and is part of the checksum, tells how long the chunks are. So
// chunks that come later are packed twice: to know how long they become, and to write them. Their
// items are asked for by the megabyte, so that a file may be larger than the memory that is left.
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <memory>
#include <stdexcept>

#include "lobelia/base/atomic_file.h"
#include "lobelia/base/error.h"
#include "lobelia/store/container.h"
#include "lobelia/store/store.h"

namespace lobelia::store {
namespace {

constexpr int kCompressionLevel = 1;  // floats gain little from higher ones
constexpr size_t kPiece = 1 << 20;    // bytes that are asked for at a time

using Bytes = std::span<const std::byte>;

template <class T>
void put(std::vector<std::byte>& out, const T& value) {
  const auto* begin = reinterpret_cast<const std::byte*>(&value);
  out.insert(out.end(), begin, begin + sizeof(T));
}

[[noreturn]] void failPacking(std::string_view chunk, size_t result) {
  throw RuntimeError("cannot compress chunk '" + std::string(chunk) +
                     "': " + ZSTD_getErrorName(result));
}

void putChunkHead(std::vector<std::byte>& out, std::string_view chunk, size_t itemSize,
                  uint64_t size, uint64_t packed) {
  assert(chunk.size() <= kMaxNameLength && itemSize <= std::numeric_limits<uint32_t>::max());
  put(out, static_cast<uint32_t>(chunk.size()));
  put(out, static_cast<uint32_t>(itemSize));
  put(out, size);
  put(out, packed);
  const auto name = std::as_bytes(std::span(chunk));
  out.insert(out.end(), name.begin(), name.end());
}

// One zstd frame of all items, piece by piece to take(bytes).
template <class Take>
void pack(const Writer::Source& source, const Take& take) {
  const std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> packer(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!packer) throw RuntimeError("cannot compress chunk '" + source.chunk + "': out of memory");
  const auto check = [&](size_t result) {
    if (ZSTD_isError(result)) failPacking(source.chunk, result);
    return result;
  };
  check(ZSTD_CCtx_setParameter(packer.get(), ZSTD_c_compressionLevel, kCompressionLevel));
  check(ZSTD_CCtx_setPledgedSrcSize(packer.get(), source.count * source.itemSize));
  std::vector<std::byte> out(ZSTD_CStreamOutSize());
  const uint64_t step = std::max<uint64_t>(kPiece / source.itemSize, 1);
  uint64_t first = 0;
  do {
    const uint64_t items = std::min(step, source.count - first);
    const Bytes piece = items > 0 ? source.items(first, items) : Bytes();
    assert(piece.size() == items * source.itemSize);
    first += items;
    const bool last = first == source.count;
    ZSTD_inBuffer in{piece.data(), piece.size(), 0};
    for (bool done = false; !done;) {
      ZSTD_outBuffer to{out.data(), out.size(), 0};
      const size_t left =
          check(ZSTD_compressStream2(packer.get(), &to, &in, last ? ZSTD_e_end : ZSTD_e_continue));
      take(Bytes(out).first(to.pos));
      done = last ? left == 0 : in.pos == in.size;
    }
  } while (first < source.count);
}

uint64_t packedSize(const Writer::Source& source) {
  uint64_t size = 0;
  pack(source, [&](Bytes bytes) { size += bytes.size(); });
  return size;
}

// A file and the checksum of what has been written to it.
class CheckedFile {
 public:
  explicit CheckedFile(const std::string& file) : out_(file), state_(XXH3_createState(), free) {
    if (!state_) throw RuntimeError("cannot write " + file + ": out of memory");
    XXH3_64bits_reset(state_.get());
  }
  void write(Bytes bytes) {
    if (bytes.empty()) return;
    XXH3_64bits_update(state_.get(), bytes.data(), bytes.size());
    out_.write(bytes);
    written_ += bytes.size();
  }
  uint64_t written() const { return written_; }
  void finish() {
    std::vector<std::byte> checksum;
    put(checksum, uint64_t{XXH3_64bits_digest(state_.get())});
    out_.write(checksum);
    out_.commit();
  }

 private:
  static void free(XXH3_state_t* state) { XXH3_freeState(state); }
  AtomicFile out_;
  uint64_t written_ = 0;
  std::unique_ptr<XXH3_state_t, void (*)(XXH3_state_t*)> state_;
};

}  // namespace

Writer::Writer(std::string_view kind, uint32_t version, uint64_t sceneHash)
    : kind_(kind), version_(version), sceneHash_(sceneHash), parts_(1) {
  assert(kind.size() <= kKindSize);
}

void Writer::addBytes(std::string_view chunk, Bytes bytes, size_t itemSize) {
  std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
  const size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kCompressionLevel);
  if (ZSTD_isError(size)) failPacking(chunk, size);
  std::vector<std::byte>& data = parts_.back().bytes;
  putChunkHead(data, chunk, itemSize, bytes.size(), size);
  data.insert(data.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
}

void Writer::addSource(Source source) {
  parts_.back().later.push_back(std::move(source));
  parts_.emplace_back();
}

void Writer::save(const std::string& file) const {
  std::vector<std::vector<std::byte>> heads;  // of chunks that come later
  uint64_t size = 0;
  for (const Part& part : parts_) {
    size += part.bytes.size();
    for (const Source& source : part.later) {
      const uint64_t packed = packedSize(source);
      putChunkHead(heads.emplace_back(), source.chunk, source.itemSize,
                   source.count * source.itemSize, packed);
      size += heads.back().size() + packed;
    }
  }
  std::vector<std::byte> header;
  for (char c : kMagic) put(header, c);
  put(header, kLayoutVersion);
  for (size_t i = 0; i < kKindSize; ++i) put(header, i < kind_.size() ? kind_[i] : '\0');
  put(header, version_);
  put(header, sceneHash_);
  put(header, size);

  CheckedFile out(file);
  out.write(header);
  size_t next = 0;
  for (const Part& part : parts_) {
    out.write(part.bytes);
    for (const Source& source : part.later) {
      out.write(heads[next++]);
      pack(source, [&](Bytes bytes) { out.write(bytes); });
    }
  }
  // The sizes in the file are those of the first packing.
  if (out.written() != header.size() + size)
    throw std::logic_error(file +
                           ": a chunk was another when it was written than when it was measured");
  out.finish();
}

}  // namespace lobelia::store

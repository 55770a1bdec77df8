// Reading; the layout is that of container.h.
#include "lobelia/store/container.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <memory>

#include "lobelia/base/error.h"
#include "lobelia/base/file.h"
#include "lobelia/store/store.h"

namespace lobelia::store {
namespace {

// A zstd block holds at most 128 KiB and takes at least 4 bytes.
constexpr uint64_t kMaxPackingRatio = 1 << 15;

// Reads values one after the other; the caller has made sure that they are there.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes, size_t position = 0)
      : bytes_(bytes), position_(position) {}
  template <class T>
  T get() {
    assert(left() >= sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }
  std::string text(size_t length) {
    assert(left() >= length);
    std::string value(reinterpret_cast<const char*>(bytes_.data()) + position_, length);
    position_ += length;
    return value;
  }
  void skip(size_t n) { position_ += n; }
  size_t left() const { return bytes_.size() - position_; }
  size_t position() const { return position_; }

 private:
  std::span<const std::byte> bytes_;
  size_t position_;
};

// Names from files may hold anything; messages show only what is printable.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

struct Header {
  uint32_t layout = 0;
  std::string kind;
  uint32_t version = 0;
  uint64_t sceneHash = 0, chunkBytes = 0;
};

Header readHeader(const std::string& file, std::span<const std::byte> bytes) {
  if (bytes.empty()) throw InputError({file}, "the file is empty");
  const size_t magic = std::min(bytes.size(), sizeof(kMagic));
  if (std::memcmp(bytes.data(), kMagic, magic) != 0) {
    throw InputError({file}, "is not a Lobelia data file; it should start with 'LOBELIA'");
  }
  if (bytes.size() < kHeaderSize) {
    throw InputError({file}, "is truncated inside its header; write it again");
  }
  Cursor in(bytes, sizeof(kMagic));
  Header h;
  h.layout = in.get<uint32_t>();
  h.kind = in.text(kKindSize);
  h.kind.resize(std::min(h.kind.find('\0'), kKindSize));
  h.version = in.get<uint32_t>();
  h.sceneHash = in.get<uint64_t>();
  h.chunkBytes = in.get<uint64_t>();
  return h;
}

void checkHeader(const std::string& file, const Header& h, std::string_view kind,
                 uint32_t version) {
  if (h.layout != kLayoutVersion) {
    throw InputError({file}, "has file layout version " + std::to_string(h.layout) +
                                 "; this program reads version " + std::to_string(kLayoutVersion));
  }
  if (h.kind != kind) {
    throw InputError({file}, "holds '" + printable(h.kind) + "'; a file of '" + std::string(kind) +
                                 "' is needed");
  }
  if (h.version != version) {
    throw InputError({file}, "has version " + std::to_string(h.version) + " of '" +
                                 std::string(kind) + "'; this program reads version " +
                                 std::to_string(version));
  }
}

std::vector<std::byte> unpack(const std::string& file, const std::string& name,
                              std::span<const std::byte> packed, uint64_t size) {
  const auto fail = [&] {
    throw InputError({file}, "chunk '" + printable(name) + "' does not unpack; write it again");
  };
  const std::unique_ptr<ZSTD_DStream, size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                        ZSTD_freeDStream);
  if (!stream) throw RuntimeError("cannot read " + file + ": out of memory");
  // Grows with the data that come, not with what the file promises.
  std::vector<std::byte> out;
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  size_t filled = 0;
  for (;;) {
    if (filled == out.size()) {
      const uint64_t room = std::max<uint64_t>(uint64_t{out.size()} * 2, ZSTD_DStreamOutSize());
      // One byte more than promised, to see data that should not be there.
      out.resize(static_cast<size_t>(std::min(room, size + 1)));
    }
    ZSTD_outBuffer to{out.data(), out.size(), filled};
    const size_t result = ZSTD_decompressStream(stream.get(), &to, &in);
    const bool progressed = to.pos != filled;
    filled = to.pos;
    if (ZSTD_isError(result) || filled > size) fail();
    if (result == 0) break;
    if (!progressed && in.pos == in.size) fail();  // the frame ends too early
  }
  if (filled != size || in.pos != in.size) fail();
  out.resize(filled);
  return out;
}

}  // namespace

std::string kindOf(const std::string& file) {
  const std::vector<std::byte> start = readFileStart(file, kHeaderSize);
  if (start.size() < kHeaderSize || std::memcmp(start.data(), kMagic, sizeof(kMagic)) != 0)
    return "";
  return readHeader(file, start).kind;
}

uint64_t sceneHashOf(const std::string& file) {
  return readHeader(file, readFileStart(file, kHeaderSize)).sceneHash;
}

Reader::Reader(const std::string& file, std::string_view kind, uint32_t version) : file_(file) {
  // The header first: a file that is not ours may be of any size.
  checkHeader(file, readHeader(file, readFileStart(file, kHeaderSize)), kind, version);
  data_ = readFile(file);
  const Header header = readHeader(file, data_);
  checkHeader(file, header, kind, version);
  sceneHash_ = header.sceneHash;

  constexpr size_t kFixed = kHeaderSize + kChecksumSize;
  if (data_.size() < kFixed || data_.size() - kFixed != header.chunkBytes) {
    throw InputError({file}, "is truncated or has bytes too many: " + std::to_string(data_.size()) +
                                 " bytes, its header says " + std::to_string(header.chunkBytes) +
                                 " besides " + std::to_string(kFixed) + "; write it again");
  }
  const size_t end = data_.size() - kChecksumSize;
  const std::span<const std::byte> checked(data_.data(), end);
  if (Cursor(data_, end).get<uint64_t>() != hashBytes(checked)) {
    throw InputError({file}, "is corrupt: its checksum differs; write it again");
  }

  Cursor in(checked, kHeaderSize);
  while (in.left() > 0) {
    const auto fail = [&] { throw InputError({file}, "is corrupt: a chunk has a wrong size"); };
    if (in.left() < 2 * sizeof(uint32_t) + 2 * sizeof(uint64_t)) fail();
    Chunk chunk;
    const auto nameLength = in.get<uint32_t>();
    chunk.itemSize = in.get<uint32_t>();
    chunk.size = in.get<uint64_t>();
    const auto packed = in.get<uint64_t>();
    if (nameLength > kMaxNameLength || nameLength > in.left()) fail();
    chunk.name = in.text(nameLength);
    if (packed > in.left() || chunk.itemSize == 0 || chunk.size % chunk.itemSize != 0) fail();
    if (chunk.size / kMaxPackingRatio > packed) fail();
    chunk.begin = in.position(), chunk.packed = static_cast<size_t>(packed);
    in.skip(chunk.packed);
    chunks_.push_back(std::move(chunk));
  }
}

const Reader::Chunk* Reader::find(std::string_view chunk) const {
  const auto it =
      std::find_if(chunks_.begin(), chunks_.end(), [&](const Chunk& c) { return c.name == chunk; });
  return it != chunks_.end() ? &*it : nullptr;
}

bool Reader::has(std::string_view chunk) const { return find(chunk) != nullptr; }

std::vector<std::byte> Reader::getBytes(std::string_view chunk, size_t itemSize) const {
  const Chunk* found = find(chunk);
  if (!found) {
    std::vector<std::string> names;
    for (const Chunk& c : chunks_) names.push_back(printable(c.name));
    throw InputError({file_},
                     "has no chunk '" + std::string(chunk) + "'" + suggestion(chunk, names));
  }
  if (found->itemSize != itemSize) {
    throw InputError({file_}, "chunk '" + std::string(chunk) + "' has items of " +
                                  std::to_string(found->itemSize) + " bytes; " +
                                  std::to_string(itemSize) + " are expected");
  }
  return unpack(file_, found->name, std::span(data_).subspan(found->begin, found->packed),
                found->size);
}

uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

}  // namespace lobelia::store

// Layout of our data files, little-endian, unaligned:
//
//   header    8 bytes   magic "LOBELIA" 0
//             u32       version of this layout
//             16 bytes  kind, padded with zeros
//             u32       version of the kind
//             u64       hash of the scene that the data belong to
//             u64       bytes of all chunks together
//   chunks    u32 name length, u32 item size, u64 bytes unpacked, u64 bytes packed, name, data
//             (one zstd frame)
//   checksum  u64       XXH3 of all the bytes before it
//
// A reader checks the header, then the length, then the checksum, and only then looks at the
// chunks; so that sizes in them are wrong only in files made to be wrong. Those are refused as
// well: no size is believed before there are bytes for it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lobelia::store {

static_assert(std::endian::native == std::endian::little, "our files are little-endian");

inline constexpr char kMagic[8] = {'L', 'O', 'B', 'E', 'L', 'I', 'A', '\0'};
inline constexpr uint32_t kLayoutVersion = 1;
inline constexpr size_t kKindSize = 16;
inline constexpr size_t kHeaderSize = 8 + 4 + kKindSize + 4 + 8 + 8;
inline constexpr size_t kChecksumSize = 8;
inline constexpr size_t kMaxNameLength = 255;

}  // namespace lobelia::store

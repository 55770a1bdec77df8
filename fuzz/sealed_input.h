// Mutations of our own data files (store/) that keep the checksum true: otherwise fuzzing would
// never reach what lies behind it. To be included by one file of a target.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "lobelia/store/store.h"

namespace lobelia::fuzz {

// Sets the length and the checksum of a data file (layout: store/container.cpp); false where it is
// too short to have them.
inline bool seal(uint8_t* data, size_t size) {
  constexpr size_t kLength = 40, kHeader = kLength + sizeof(uint64_t), kChecksum = sizeof(uint64_t);
  if (size < kHeader + kChecksum) return false;
  const uint64_t length = size - kHeader - kChecksum;
  std::memcpy(data + kLength, &length, sizeof(length));
  const uint64_t sum =
      store::hashBytes(std::as_bytes(std::span<const uint8_t>(data, size - kChecksum)));
  std::memcpy(data + size - kChecksum, &sum, sizeof(sum));
  return true;
}

}  // namespace lobelia::fuzz

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize,
                                          unsigned seed) {
  size = LLVMFuzzerMutate(data, size, maxSize);
  if (seed % 16 != 0) lobelia::fuzz::seal(data, size);
  return size;
}

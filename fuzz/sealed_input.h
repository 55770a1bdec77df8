// Mutations of our own data files (store/) that keep the checksum true: otherwise fuzzing would never
// reach what lies behind it. To be included by one file of a target.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "lobelia/store/store.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize,
                                          unsigned seed) {
  // Layout: store/container.cpp.
  constexpr size_t kLength = 40, kHeader = kLength + sizeof(uint64_t), kChecksum = sizeof(uint64_t);
  size = LLVMFuzzerMutate(data, size, maxSize);
  if (size < kHeader + kChecksum || seed % 16 == 0) return size;
  const uint64_t length = size - kHeader - kChecksum;
  std::memcpy(data + kLength, &length, sizeof(length));
  const uint64_t sum =
      lobelia::store::hashBytes(std::as_bytes(std::span<const uint8_t>(data, size - kChecksum)));
  std::memcpy(data + size - kChecksum, &sum, sizeof(sum));
  return size;
}

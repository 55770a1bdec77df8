// Leaves of a tree as bits of words, 64 to each; private to the room.
#pragma once

#include <cstdint>

namespace lobelia::relight {

inline uint64_t bit(uint32_t leaf) { return uint64_t{1} << (leaf % 64); }

// The part of a word that a node of at most 64 leaves takes.
inline uint64_t nodeMask(int level, uint32_t begin) {
  return level >= 6 ? ~uint64_t{0} : ((uint64_t{1} << (1u << level)) - 1) << (begin % 64);
}

// use(word, mask) for the words of a node.
template <class Use>
void forWords(int level, uint32_t place, const Use& use) {
  const uint32_t begin = place << level, end = (place + 1) << level;
  for (uint32_t word = begin / 64; word * 64 < end; ++word) use(word, nodeMask(level, begin));
}

}  // namespace lobelia::relight

// What a file of transfer holds, without the scene that it is of.
#pragma once

#include <cstdint>
#include <string>

namespace lobelia::transfer {

struct TransferSummary {
  uint64_t sceneHash = 0;  // transferHash() of its scene
  size_t directions = 0, passes = 0, classes = 0, vertices = 0;
  size_t records = 0;  // of slices
  size_t bytes = 0;    // of what is looked up, in memory
};
// Throws InputError as load() does, but for the scene.
TransferSummary summaryOf(const std::string& file);

}  // namespace lobelia::transfer

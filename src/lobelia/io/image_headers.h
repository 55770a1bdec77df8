// Sizes in headers that the libraries below OpenImageIO allocate for before anybody can ask about
// them (internal to io; EXR has exr_header.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lobelia::io {

// What is wrong with a PNG, JPEG or BMP file for certain, or "": a chunk longer than the file, more
// than maxValues numbers. `bytes` is the whole file.
std::string imageHeaderProblem(std::span<const std::byte> bytes, uint64_t maxValues);

}  // namespace lobelia::io

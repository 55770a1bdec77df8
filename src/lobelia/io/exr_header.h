// OpenEXR believes what a header says and allocates it; damaged files are found out before
// (internal to io).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lobelia::io {

// What is wrong with the header of an OpenEXR file, or "": attributes larger than the file, images
// with sides outside [1, maxSide]. `start`: the first bytes of the file, all of it or a good part;
// fileSize: in bytes. Bytes of another format: "". Layout: "OpenEXR File Layout", openexr.com.
std::string exrHeaderProblem(std::span<const std::byte> start, uint64_t fileSize, int maxSide);

}  // namespace lobelia::io

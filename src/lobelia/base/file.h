// Whole files in and out: reading with a limit, writing so that a file is there whole or not at
// all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lobelia {

// Writes to FILE.tmp-PID in the same folder, syncs, renames. Throws RuntimeError that names the
// file and the reason, and leaves nothing half-written. A link is followed; a device or a pipe is
// written to directly.
void writeFileAtomically(const std::string& file, std::span<const std::byte> bytes);
// The same for a file in several parts, one after the other.
void writeFileAtomically(const std::string& file,
                         std::span<const std::span<const std::byte>> parts);
// Why that would fail now, or "": a file is made beside it and taken away again. Disks that fill up
// later show only when writing.
std::string whyNotWritable(const std::string& file);
// Throws InputError, also when the file holds more than maxBytes.
std::vector<std::byte> readFile(const std::string& file, uint64_t maxBytes = 1ull << 36);
// Up to the first `bytes` bytes. Throws InputError.
std::vector<std::byte> readFileStart(const std::string& file, size_t bytes);

}  // namespace lobelia

// A file that is there whole or not at all, written piece by piece.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lobelia/base/descriptor.h"

namespace lobelia {

// Written as FILE.tmp-PID in the same folder, synced and renamed by commit(); without that nothing
// is left of it. A link is followed; a device or a pipe is written to directly. All throw
// RuntimeError that names the file and the reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void write(std::span<const std::byte> bytes);
  void commit();  // nothing may be written afterwards

 private:
  const std::string file_;          // as it was asked for
  std::string target_, temporary_;  // links followed; "" for devices, and when it is done
  Descriptor out_;
};

}  // namespace lobelia

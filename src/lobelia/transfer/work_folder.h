// What an interrupted precomputation leaves behind: a folder of blocks, each a file of its own,
// written whole or not at all, of one scene and one choice of settings.
#pragma once

#include <optional>
#include <string>

#include "lobelia/base/context.h"
#include "lobelia/store/store.h"

namespace lobelia::transfer {

class WorkFolder {
 public:
  // Makes the folder, or goes on with the one that is there. hash: of scene and settings. Throws
  // InputError where blocks are of another hash or the folder holds other things, RuntimeError
  // where it cannot be made.
  WorkFolder(const std::string& path, uint64_t hash, Context& context);

  // From any thread, for different names. A block that is damaged is none, with a warning.
  std::optional<store::Reader> find(const std::string& name) const;
  store::Writer writer() const;
  void put(const std::string& name, const store::Writer& block) const;
  std::string fileOf(const std::string& name) const;
  // Deletes the blocks, and the folder if nothing else is in it; then likewise the folders above it
  // that were made for it, by this run or by one before.
  void remove();

 private:
  std::string path_;
  uint64_t hash_;
  Context& context_;
};

}  // namespace lobelia::transfer

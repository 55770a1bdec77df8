#include "lobelia/transfer/work_folder.h"

#include <fmt/format.h>

#include <filesystem>

#include "lobelia/base/error.h"

namespace lobelia::transfer {
namespace {

namespace fs = std::filesystem;
constexpr const char* kSuffix = ".block";

}  // namespace

WorkFolder::WorkFolder(const std::string& path, uint64_t hash, Context& context)
    : path_(path), hash_(hash), context_(context) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path))
    throw RuntimeError(fmt::format("the work folder {} cannot be made: {}", path,
                                   error ? error.message() : "something else has that name"));
  size_t found = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    const std::string file = entry.path().string();
    const std::string name = entry.path().filename().string();
    if (name.find(std::string(kSuffix) + ".tmp") != std::string::npos) {
      fs::remove(entry.path(), error);  // what a killed run was writing
      continue;
    }
    if (entry.path().extension() != kSuffix)
      throw InputError({file},
                       "this is no block of a precomputation; give --work a folder of its own");
    try {
      if (store::Reader(file, kKind, kVersion).sceneHash() == hash) {
        ++found;
        continue;
      }
    } catch (const InputError&) {
      continue;  // find() warns
    }
    throw InputError({path},
                     "what is done there is of another scene or of other settings; delete the "
                     "folder, or give --work another");
  }
  if (found > 0) context.info(fmt::format("going on from {}: {} blocks are done", path, found));
}

std::string WorkFolder::fileOf(const std::string& name) const {
  return (fs::path(path_) / (name + kSuffix)).string();
}

std::optional<store::Reader> WorkFolder::find(const std::string& name) const {
  const std::string file = fileOf(name);
  if (!fs::exists(file)) return {};
  try {
    store::Reader reader(file, kKind, kVersion);
    if (reader.sceneHash() == hash_) return reader;
  } catch (const InputError& e) {
    context_.warning(fmt::format("{}; the block is made again", e.what()));
  }
  return {};
}

void WorkFolder::put(const std::string& name, const store::Writer& block) const {
  block.save(fileOf(name));
}

void WorkFolder::remove() {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, error))
    if (entry.path().extension() == kSuffix) fs::remove(entry.path(), error);
  fs::remove(path_, error);
}

}  // namespace lobelia::transfer

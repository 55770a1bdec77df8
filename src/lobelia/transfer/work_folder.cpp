#include "lobelia/transfer/work_folder.h"

#include <fmt/format.h>

#include <filesystem>

#include "lobelia/base/error.h"
#include "lobelia/base/file.h"

namespace lobelia::transfer {
namespace {

namespace fs = std::filesystem;
constexpr const char* kSuffix = ".block";
constexpr const char* kKind = "transfer-block";
constexpr uint32_t kVersion = 1;

[[noreturn]] void refuse(const std::string& file) {
  throw InputError({file}, "this is no block of a precomputation; give --work a folder of its own");
}

// By headers alone: blocks are many and large, and those that are damaged inside are found out when
// they are needed. An empty file is a damaged block. Throws InputError where a block is of another
// hash, or something else that only has a block's name, and would be overwritten.
void requireOf(const std::string& file, const std::string& folder, uint64_t hash) {
  if (!fs::is_regular_file(file)) refuse(file);
  if (readFileStart(file, 1).empty()) return;
  if (store::kindOf(file) != kKind) refuse(file);
  if (store::sceneHashOf(file) != hash)
    throw InputError({folder},
                     "what is done there is of another scene or of other settings; delete the "
                     "folder, or give --work another");
}

}  // namespace

WorkFolder::WorkFolder(const std::string& path, uint64_t hash, Context& context)
    : path_(path), hash_(hash), context_(context) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path))
    throw RuntimeError(fmt::format("the work folder {} cannot be made: {}", path,
                                   error ? error.message() : "something else has that name"));
  size_t found = 0;
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    const std::string file = entry.path().string();
    if (entry.path().filename().string().find(std::string(kSuffix) + ".tmp") != std::string::npos)
      leftovers.push_back(entry.path());
    else if (entry.path().extension() != kSuffix)
      refuse(file);
    else
      requireOf(file, path, hash), ++found;
  }
  // Of a killed run. Only now: before, the folder might have been somebody else's.
  for (const fs::path& file : leftovers) fs::remove(file, error);
  if (found > 0) context.info(fmt::format("going on from {}: {} blocks are there", path, found));
}

store::Writer WorkFolder::writer() const { return {kKind, kVersion, hash_}; }

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

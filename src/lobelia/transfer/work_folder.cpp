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
// To be raised whenever the same settings give other blocks. 1: diffuse light in front alone; 2:
// weights of all rays where bounces now gather in cells.
constexpr uint32_t kVersion = 3;
constexpr const char* kParents = "parents";  // block of how many folders above were made

[[noreturn]] void refuse(const std::string& file) {
  throw InputError({file}, "this is no block of a precomputation; delete it, or give --work a folder of its own");
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

fs::path wholePath(const std::string& path) {
  const fs::path folder = fs::absolute(path).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();  // of "a/"
}

// How many folders of the path are not there.
uint32_t countMissing(const std::string& path) {
  fs::path folder = wholePath(path);
  uint32_t missing = 0;
  std::error_code error;
  for (; !fs::exists(folder, error) && folder.has_relative_path(); folder = folder.parent_path())
    ++missing;
  return missing;
}

}  // namespace

WorkFolder::WorkFolder(const std::string& path, uint64_t hash, Context& context)
    : path_(path), hash_(hash), context_(context) {
  std::error_code error;
  const uint32_t missing = countMissing(path);
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
      requireOf(file, path, hash), found += file != fileOf(kParents) ? 1 : 0;
  }
  // Of a killed run. Only now: before, the folder might have been somebody else's.
  for (const fs::path& file : leftovers) fs::remove(file, error);
  if (missing > 1) {
    const uint32_t parents = missing - 1;
    store::Writer block = writer();
    block.add("count", std::span(&parents, 1));
    put(kParents, block);
  }
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
  uint32_t parents = 0;
  if (const auto block = find(kParents)) parents = block->get<uint32_t>("count").at(0);
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, error))
    if (entry.path().extension() == kSuffix) fs::remove(entry.path(), error);
  fs::path folder = wholePath(path_);
  // The first that something else is in stays, and with it those above.
  for (uint32_t i = 0; i <= parents && fs::remove(folder, error); ++i)
    folder = folder.parent_path();
}

}  // namespace lobelia::transfer

// What the fuzz targets have in common: the input as a file (readers take names), and the rule that
// every target checks: a reader returns, or throws InputError; anything else is a finding.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "lobelia/base/context.h"
#include "lobelia/base/error.h"
#include "lobelia/scene/scene.h"

namespace lobelia::fuzz {

// A file of one name in a folder of its own, in memory where the system offers that.
class FuzzFile {
 public:
  explicit FuzzFile(const std::string& name) {
    const bool memory = std::filesystem::is_directory("/dev/shm");
    std::string pattern = memory ? "/dev/shm/lobelia-fuzz-XXXXXX" : "/tmp/lobelia-fuzz-XXXXXX";
    if (!::mkdtemp(pattern.data())) std::abort();
    folder_ = pattern;
    path_ = (folder_ / name).string();
  }
  ~FuzzFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  const std::string& write(const uint8_t* data, size_t size) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (!file || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0) std::abort();
    return path_;
  }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

template <class Read>
int check(const FuzzFile& file, const uint8_t* data, size_t size, const Read& read) {
  const std::string& path = file.write(data, size);
  try {
    read(path);
  } catch (const InputError&) {
    // what is wrong with the file was said
  }
  return 0;
}

// A scene that was read must stand being looked at.
template <class Read>
int checkScene(const FuzzFile& file, const uint8_t* data, size_t size, const Read& read) {
  return check(file, data, size, [&](const std::string& path) {
    Context context;
    const Scene scene = read(path, context);
    validate(scene);
    hash(scene);
    bounds(scene);
  });
}

}  // namespace lobelia::fuzz

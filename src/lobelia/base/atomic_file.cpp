#include "lobelia/base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "lobelia/base/error.h"
#include "lobelia/base/file.h"

namespace lobelia {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

// Where the bytes of a file go: links are followed.
struct Target {
  std::string file;
  bool device = false;  // or a pipe: written to directly
  int error = 0;
};

Target targetOf(const std::string& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_directory(status)) return {file, false, EISDIR};
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    return {file, true};
  if (std::filesystem::is_symlink(file, ignored)) {
    const auto real = std::filesystem::weakly_canonical(file, ignored);
    if (!ignored) return {real.string()};
  }
  return {file};
}

[[noreturn]] void failWriting(const std::string& file, int error) {
  throw RuntimeError("cannot write " + file + ": " + reason(error));
}

// 0, or the error number.
int writeAll(int fd, std::span<const std::byte> bytes) {
  constexpr size_t kStep = size_t{1} << 30;  // some systems refuse to write 2 GiB at once
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), kStep));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return EIO;
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
  return 0;
}

// Makes the rename itself survive a power cut, where the system can.
void syncFolder(const std::string& file) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  const char* name = folder.empty() ? "." : folder.c_str();
  const Descriptor fd(::open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() >= 0) (void)::fsync(fd.get());
}

// A new file beside `file`. Its name says whose it is; another number follows where a process with
// the same id left one behind or another thread writes the same file.
int openTemporary(const std::string& file, std::string& name) {
  for (int i = 0;; ++i) {
    name = file + ".tmp-" + std::to_string(::getpid());
    if (i > 0) name.append(1, '-').append(std::to_string(i));
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0 || errno != EEXIST || i == 1000) return fd;
  }
}

// target: of regular files, else "". temporary: of those, its name.
int openToWrite(const std::string& file, std::string* target, std::string* temporary) {
  const Target to = targetOf(file);
  if (to.error) failWriting(file, to.error);
  if (!to.device) *target = to.file;
  const int fd =
      to.device ? ::open(file.c_str(), O_WRONLY | O_CLOEXEC) : openTemporary(to.file, *temporary);
  if (fd < 0) failWriting(file, errno);
  return fd;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& file)
    : file_(file), out_(openToWrite(file, &target_, &temporary_)) {}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (const int error = writeAll(out_.get(), bytes)) failWriting(file_, error);
}

void AtomicFile::commit() {
  // EINVAL: a file system that cannot sync.
  if (!target_.empty() && ::fsync(out_.get()) != 0 && errno != EINVAL) failWriting(file_, errno);
  if (out_.close() != 0) failWriting(file_, errno);
  if (target_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) failWriting(file_, errno);
  temporary_.clear();
  syncFolder(target_);
}

std::string whyNotWritable(const std::string& file) {
  const Target target = targetOf(file);
  if (target.error) return reason(target.error);
  if (target.device) return ::access(file.c_str(), W_OK) == 0 ? "" : reason(errno);
  std::string temporary;
  const Descriptor out(openTemporary(target.file, temporary));
  if (out.get() < 0) return reason(errno);
  ::unlink(temporary.c_str());
  return "";
}

}  // namespace lobelia

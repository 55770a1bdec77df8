#include "lobelia/io/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace lobelia::io {
namespace {

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  // Closes now, because only close() tells of some delayed write errors.
  bool close() {
    const int fd = fd_;
    fd_ = -1;
    return ::close(fd) == 0;
  }

 private:
  int fd_;
};

std::string reason() { return std::generic_category().message(errno); }

[[noreturn]] void failWriting(const std::string& file, const std::string& why) {
  throw RuntimeError(fmt::format("cannot write '{}': {}", file, why));
}

// Waits until a file or folder is on disk.
bool syncPath(const std::string& path, int flags) {
  Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags));
  return fd.get() >= 0 && ::fsync(fd.get()) == 0 && fd.close();
}

// "folder/.name.PID.N.ext": unique among threads and processes, hidden, and of the extension by
// which image libraries choose the format.
std::string temporaryName(const std::filesystem::path& file) {
  static std::atomic<unsigned> counter{0};
  const std::string name = fmt::format(".{}.{}.{}{}", file.stem().string(), ::getpid(),
                                       counter.fetch_add(1), file.extension().string());
  return (file.parent_path() / name).string();
}

}  // namespace

std::string readFileBytes(const std::string& file, const std::string& what, const Location& from) {
  const auto fail = [&](const std::string& why) {
    throw InputError(from, fmt::format("cannot read {} file '{}': {}", what, file, why));
  };
  Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (fd.get() < 0) fail(reason());
  struct stat info {};
  if (::fstat(fd.get(), &info) != 0) fail(reason());
  if (!S_ISREG(info.st_mode)) fail("not a regular file");
  std::string bytes(static_cast<size_t>(info.st_size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(fd.get(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(reason());
    if (n == 0) break;  // became shorter meanwhile
    done += static_cast<size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

void writeAtomically(const std::string& file,
                     const std::function<void(const std::string& temporary)>& write) {
  namespace fs = std::filesystem;
  std::error_code error;
  // Through links, so that a link stays a link to the new contents.
  fs::path target = fs::weakly_canonical(file, error);
  if (error) target = file;
  if (fs::is_directory(target, error)) failWriting(file, "it is a folder");
  // Devices and pipes cannot be replaced by renaming: they are written to directly.
  const bool special = fs::exists(target, error) && !fs::is_regular_file(target, error);
  const std::string temporary = special ? target.string() : temporaryName(target);
  const auto clean = [&] {
    if (!special) ::unlink(temporary.c_str());
  };
  try {
    write(temporary);
    if (special) return;
    if (!syncPath(temporary, 0)) failWriting(file, reason());
    // The permissions that a newly created file would have, or those of the file it replaces.
    struct stat old {};
    if (::stat(target.c_str(), &old) == 0) ::chmod(temporary.c_str(), old.st_mode & 07777);
    if (::rename(temporary.c_str(), target.c_str()) != 0) failWriting(file, reason());
  } catch (...) {
    clean();
    throw;
  }
  const fs::path folder = target.parent_path();
  // Folders of some file systems cannot be synced; the file itself is.
  (void)syncPath(folder.empty() ? "." : folder.string(), O_DIRECTORY);
}

void writeFileAtomically(const std::string& file, const std::string& bytes) {
  writeAtomically(file, [&](const std::string& temporary) {
    Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (fd.get() < 0) failWriting(file, reason());
    size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t n = ::write(fd.get(), bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) failWriting(file, reason());
      done += static_cast<size_t>(n);
    }
    if (!fd.close()) failWriting(file, reason());
  });
}

}  // namespace lobelia::io

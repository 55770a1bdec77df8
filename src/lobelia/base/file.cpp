#include "lobelia/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "lobelia/base/error.h"

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

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  // Reports what the kernel could only find out when closing (network file systems, quotas).
  int close() {
    const int result = ::close(fd_);
    fd_ = -1;
    return result;
  }

 private:
  int fd_;
};

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

int writeParts(Descriptor& out, std::span<const std::span<const std::byte>> parts, bool sync) {
  for (const auto& part : parts) {
    if (const int error = writeAll(out.get(), part)) return error;
  }
  // EINVAL: a file system that cannot sync.
  if (sync && ::fsync(out.get()) != 0 && errno != EINVAL) return errno;
  return out.close() != 0 ? errno : 0;
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

Descriptor openToRead(const std::string& file) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const int error = errno;
  if (fd < 0) throw InputError({file}, "cannot be opened: " + reason(error));
  return Descriptor(fd);
}

// Reads on until `bytes` is full or the file ends; the number of bytes read.
size_t readInto(const std::string& file, int fd, std::span<std::byte> bytes) {
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n =
        ::read(fd, bytes.data() + done, std::min(bytes.size() - done, size_t{1} << 30));
    const int error = errno;
    if (n < 0 && error == EINTR) continue;
    if (n < 0) throw InputError({file}, "cannot be read: " + reason(error));
    if (n == 0) break;
    done += static_cast<size_t>(n);
  }
  return done;
}

}  // namespace

void writeFileAtomically(const std::string& file, std::span<const std::byte> bytes) {
  const std::span<const std::byte> parts[] = {bytes};
  writeFileAtomically(file, parts);
}

void writeFileAtomically(const std::string& file,
                         std::span<const std::span<const std::byte>> parts) {
  const Target target = targetOf(file);
  if (target.error) failWriting(file, target.error);
  if (target.device) {
    Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
    if (out.get() < 0) failWriting(file, errno);
    if (const int error = writeParts(out, parts, false)) failWriting(file, error);
    return;
  }
  std::string temporary;
  Descriptor out(openTemporary(target.file, temporary));
  if (out.get() < 0) failWriting(file, errno);
  int error = writeParts(out, parts, true);
  if (!error && ::rename(temporary.c_str(), target.file.c_str()) != 0) error = errno;
  if (error) {
    ::unlink(temporary.c_str());
    failWriting(file, error);
  }
  syncFolder(target.file);
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

std::vector<std::byte> readFile(const std::string& file, uint64_t maxBytes) {
  const Descriptor in = openToRead(file);
  // The size that the system reports is only a hint: pipes have none, files may grow.
  struct stat info {};
  uint64_t expected = 0;
  if (::fstat(in.get(), &info) == 0 && S_ISREG(info.st_mode)) {
    expected = static_cast<uint64_t>(info.st_size);
  }
  maxBytes = std::min(maxBytes, uint64_t{1} << 62);  // so that one more is a number
  std::vector<std::byte> bytes;
  size_t done = 0;
  while (expected <= maxBytes) {
    // One byte more than expected tells the end of the file without another round.
    const uint64_t room = std::max({expected + 1, uint64_t{done + done / 2}, uint64_t{4096}});
    bytes.resize(static_cast<size_t>(std::min(room, maxBytes + 1)));
    done += readInto(file, in.get(), std::span(bytes).subspan(done));
    if (done < bytes.size() || done > maxBytes) break;
  }
  if (expected > maxBytes || done > maxBytes) {
    throw InputError({file},
                     "is too large; at most " + std::to_string(maxBytes) + " bytes can be read");
  }
  bytes.resize(done);
  return bytes;
}

std::vector<std::byte> readFileStart(const std::string& file, size_t bytes) {
  const Descriptor in = openToRead(file);
  std::vector<std::byte> start(bytes);
  start.resize(readInto(file, in.get(), start));
  return start;
}

}  // namespace lobelia

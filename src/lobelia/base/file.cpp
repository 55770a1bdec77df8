#include "lobelia/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "lobelia/base/atomic_file.h"
#include "lobelia/base/descriptor.h"
#include "lobelia/base/error.h"

namespace lobelia {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

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
  AtomicFile out(file);
  for (const auto& part : parts) out.write(part);
  out.commit();
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

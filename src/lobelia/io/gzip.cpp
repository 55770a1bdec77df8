// A gzip file may have several members one after the other (RFC 1952, 2.2); their contents are
// joined.
#include "lobelia/io/gzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <vector>

namespace lobelia::io {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;  // zlib: window size, and the gzip format alone

struct Stream {
  z_stream z{};
  Stream() {
    if (inflateInit2(&z, kGzipOnly) != Z_OK) throw RuntimeError("zlib cannot be initialised");
  }
  ~Stream() { inflateEnd(&z); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};

}  // namespace

bool isGzip(const std::string& bytes) {
  return bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

std::string gunzip(const std::string& bytes, const Location& where, uint64_t maxBytes) {
  Stream stream;
  z_stream& z = stream.z;
  std::string out;
  std::vector<Bytef> part(size_t{1} << 18);
  size_t taken = 0;
  while (taken < bytes.size()) {
    const size_t offered = std::min<size_t>(bytes.size() - taken, size_t{1} << 30);
    // The interface takes input that is not const, which it does not change.
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
    z.avail_in = static_cast<uInt>(offered);
    int result = Z_OK;
    do {
      z.next_out = part.data();
      z.avail_out = static_cast<uInt>(part.size());
      result = inflate(&z, Z_NO_FLUSH);
      if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
        throw InputError(where, "the gzip data are damaged");
      out.append(reinterpret_cast<const char*>(part.data()), part.size() - z.avail_out);
      if (out.size() > maxBytes)
        throw InputError(where, fmt::format("unpacks to more than {} bytes", maxBytes));
    } while (result == Z_OK && (z.avail_in > 0 || z.avail_out == 0));
    taken += offered - z.avail_in;
    if (result == Z_STREAM_END) {
      // Anything but a further member behind the end is padding.
      if (taken + 2 > bytes.size() || bytes[taken] != '\x1f' || bytes[taken + 1] != '\x8b')
        return out;
      inflateReset2(&z, kGzipOnly);
    } else if (taken == bytes.size()) {
      throw InputError(where, "the gzip data end early; the file is truncated");
    }
  }
  return out;
}

}  // namespace lobelia::io

#include "lobelia/io/image_pixels.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "lobelia/base/file.h"
#include "lobelia/io/exr_header.h"

namespace lobelia::io {
namespace {

constexpr int kMaxSide = 1 << 16;
constexpr uint64_t kMaxBytes = uint64_t{1} << 31;  // of decoded floats

void checkRegularFile(const std::string& file, const Location& from) {
  struct stat info {};
  const bool exists = ::stat(file.c_str(), &info) == 0;
  if (exists && S_ISREG(info.st_mode)) return;
  throw InputError(from, fmt::format("cannot read image file '{}': {}", file,
                                     exists ? "not a regular file" : std::strerror(errno)));
}

void checkExrHeader(std::span<const std::byte> start, uint64_t fileSize, const std::string& name) {
  const std::string problem = exrHeaderProblem(start, fileSize, kMaxSide);
  if (!problem.empty())
    throw InputError({name, 0, 0}, fmt::format("cannot read the image: {}", problem));
}

void checkSpec(const OIIO::ImageSpec& spec, const std::string& file) {
  const Location where{file, 0, 0};
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
      spec.width > kMaxSide || spec.height > kMaxSide)
    throw InputError(
        where, fmt::format("an image of {} x {} x {} pixels with {} channels; sides may be 1 to {}",
                           spec.width, spec.height, spec.depth, spec.nchannels, kMaxSide));
  const uint64_t bytes =
      spec.image_pixels() * static_cast<uint64_t>(spec.nchannels) * sizeof(float);
  if (bytes > kMaxBytes)
    throw InputError(
        where,
        fmt::format("an image of {} x {} pixels with {} channels takes {} MiB; at most {} are read",
                    spec.width, spec.height, spec.nchannels, bytes >> 20, kMaxBytes >> 20));
  for (const char* key : {"jpeg:ColorSpace", "tiff:ColorSpace"})
    if (const std::string space = spec.get_string_attribute(key);
        space == "CMYK" || space == "YCbCrK" || space == "YCCK" || space == "color separated")
      throw InputError(where,
                       fmt::format("colours are stored as {}; convert the image to RGB", space));
}

// In bands that the result grows by, so that a small damaged file that promises a large image does
// not make us allocate it.
bool readPixels(OIIO::ImageInput& in, const OIIO::ImageSpec& spec, int subimage,
                std::vector<float>& pixels) {
  const auto rowValues = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels);
  if (spec.tile_width > 0) {
    pixels.resize(rowValues * static_cast<size_t>(spec.height));
    return in.read_image(subimage, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data());
  }
  constexpr int kBand = 64;
  for (int y = 0; y < spec.height; y += kBand) {
    const int rows = std::min(kBand, spec.height - y);
    const size_t begin = pixels.size();
    pixels.resize(begin + rowValues * static_cast<size_t>(rows));
    if (!in.read_scanlines(subimage, 0, spec.y + y, spec.y + y + rows, 0, 0, spec.nchannels,
                           OIIO::TypeFloat, pixels.data() + begin))
      return false;
  }
  return true;
}

StoredImage describe(const OIIO::ImageSpec& spec) {
  StoredImage image;
  image.part = spec.get_string_attribute("oiio:subimagename");
  image.width = spec.width, image.height = spec.height;
  image.x0 = spec.x - spec.full_x, image.y0 = spec.y - spec.full_y;
  image.fullWidth = spec.full_width, image.fullHeight = spec.full_height;
  if (!spec.format.is_floating_point())
    image.integerBits = static_cast<int>(8 * spec.format.basesize());
  image.channels.assign(spec.channelnames.begin(), spec.channelnames.end());
  for (const OIIO::ParamValue& p : spec.extra_attribs)
    if (p.type() == OIIO::TypeString) image.metadata[p.name().string()] = p.get_string();
  return image;
}

}  // namespace

namespace {

// From a file, or from memory: `proxy`, with `file` ending in the format's extension. `name` is
// what messages call it.
std::vector<StoredImage> readOpened(const std::string& file, OIIO::Filesystem::IOProxy* proxy,
                                    bool all, const std::string& name) {
  const Location where{name, 0, 0};
  const auto fail = [&](std::string why) {
    while (!why.empty() && (why.back() == '\n' || why.back() == '.')) why.pop_back();
    if (why.empty()) why = "the reader gives no reason";
    throw InputError(where, fmt::format("cannot read the image: {}", why));
  };
  std::vector<StoredImage> images;
  try {
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
    // As an attribute: open()'s own argument for it is lost when there are hints too.
    if (proxy) hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(file, &hints);
    if (!in) fail(OIIO::geterror());
    for (int i = 0; (i == 0 || all) && in->seek_subimage(i, 0); ++i) {
      const OIIO::ImageSpec spec = in->spec_dimensions(i).nchannels > 0 ? in->spec(i) : in->spec();
      checkSpec(spec, name);
      images.push_back(describe(spec));
      // Some formats report truncation only as a message.
      if (!readPixels(*in, spec, i, images.back().pixels) || in->has_error()) fail(in->geterror());
    }
    (void)in->geterror();  // of the seek behind the last image
    if (!in->close()) fail(in->geterror());
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // of the libraries below OpenImageIO
    fail(error.what());
  }
  if (images.empty()) fail("it holds no image");
  return images;
}

// Formats that may lie in memory, by their first bytes; "" for others.
std::string formatOf(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG")) return "png";
  if (text.starts_with("\xff\xd8\xff")) return "jpg";
  if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) return "webp";
  if (text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE")) return "hdr";
  if (text.starts_with("v/1\x01")) return "exr";
  return "";
}

}  // namespace

std::vector<StoredImage> readStoredImages(const std::string& file, bool all, const Location& from) {
  checkRegularFile(file, from);
  constexpr size_t kStart = 1 << 16;  // longer than headers are
  checkExrHeader(readFileStart(file, kStart), std::filesystem::file_size(file), file);
  return readOpened(file, nullptr, all, file);
}

StoredImage readStoredImage(std::span<const std::byte> bytes, const std::string& name) {
  const std::string format = formatOf(bytes);
  if (format.empty())
    throw InputError({name, 0, 0}, "unknown image format; PNG, JPEG, WebP, HDR and EXR are read");
  checkExrHeader(bytes, bytes.size(), name);
  OIIO::Filesystem::IOMemReader reader(
      const_cast<std::byte*>(bytes.data()),  // NOLINT: older releases take no pointer to const
      bytes.size());
  return std::move(readOpened("memory." + format, &reader, false, name).front());
}

void requireFinite(const StoredImage& image, const std::string& file) {
  const size_t channels = image.channels.size(), width = static_cast<size_t>(image.width);
  for (size_t i = 0; i < image.pixels.size(); ++i)
    if (!std::isfinite(image.pixels[i]))
      throw InputError(
          {file, 0, 0},
          fmt::format("pixel ({}, {}) is not finite in channel {}; all must be",
                      i / channels % width, i / channels / width, image.channels[i % channels]));
}

}  // namespace lobelia::io

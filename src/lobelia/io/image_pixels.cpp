#include "lobelia/io/image_pixels.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "lobelia/base/file.h"
#include "lobelia/io/exr_header.h"
#include "lobelia/io/image_headers.h"

namespace lobelia::io {
namespace {

constexpr int kMaxSide = 1 << 16;
constexpr uint64_t kMaxBytes = uint64_t{1} << 31;  // of decoded floats
constexpr size_t kBandValues = size_t{1} << 22;    // floats that are read at a time
constexpr uint64_t kMaxTileValues = 1 << 24;

void checkRegularFile(const std::string& file, const Location& from) {
  if (file.find('\0') != file.npos)
    throw InputError(from, "cannot read an image file: its name has a zero byte");
  struct stat info {};
  const bool exists = ::stat(file.c_str(), &info) == 0;
  if (exists && S_ISREG(info.st_mode)) return;
  throw InputError(from, fmt::format("cannot read image file '{}': {}", file,
                                     exists ? "not a regular file" : std::strerror(errno)));
}

uint64_t sizeOf(const std::string& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : size;
}

void checkExrHeader(std::span<const std::byte> start, uint64_t fileSize, const std::string& name) {
  const std::string problem = exrHeaderProblem(start, fileSize, kMaxSide);
  if (!problem.empty())
    throw InputError({name, 0, 0}, fmt::format("cannot read the image: {}", problem));
}

void checkHeader(std::span<const std::byte> bytes, const std::string& name) {
  const std::string problem = imageHeaderProblem(bytes, kMaxBytes / sizeof(float));
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
  if (spec.tile_width > 0) {
    const uint64_t values = static_cast<uint64_t>(spec.tile_width) *
                            static_cast<uint64_t>(std::max(spec.tile_height, 1)) *
                            static_cast<uint64_t>(spec.nchannels);
    if (spec.tile_width > kMaxSide || spec.tile_height < 1 || spec.tile_height > kMaxSide ||
        spec.tile_depth > 1 || values > kMaxTileValues)
      throw InputError(
          where, fmt::format("tiles of {} x {} x {} pixels with {} channels; at most {} "
                             "values are read",
                             spec.tile_width, spec.tile_height, spec.tile_depth, spec.nchannels,
                             kMaxTileValues));
  }
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
  const bool tiled = spec.tile_width > 0;
  const int fitting = static_cast<int>(std::max(kBandValues / rowValues, size_t{1}));
  const int band = tiled ? spec.tile_height : std::min(64, fitting);
  for (int y = 0; y < spec.height; y += band) {
    const int rows = std::min(band, spec.height - y);
    const size_t begin = pixels.size();
    pixels.resize(begin + rowValues * static_cast<size_t>(rows));
    const int y0 = spec.y + y, y1 = y0 + rows;
    const bool good =
        tiled ? in.read_tiles(subimage, 0, spec.x, spec.x + spec.width, y0, y1, spec.z, spec.z + 1,
                              0, spec.nchannels, OIIO::TypeFloat, pixels.data() + begin)
              : in.read_scanlines(subimage, 0, y0, y1, 0, 0, spec.nchannels, OIIO::TypeFloat,
                                  pixels.data() + begin);
    if (!good) return false;
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

constexpr const char* kFormats = "EXR, HDR, PNG, JPEG, TIFF, TGA, BMP, WebP, PFM and PNM are read";

// OpenImageIO's name of the format that the first bytes tell; "" for others. Only these: to let the
// library try all it knows would hand damaged files to readers that nobody tests.
std::string formatOf(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("v/1\x01")) return "openexr";
  if (text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE")) return "hdr";
  if (text.starts_with("\x89PNG")) return "png";
  if (text.starts_with("\xff\xd8\xff")) return "jpeg";
  if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) return "webp";
  for (const std::string_view tiff : {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                      std::string_view("II+\0", 4), std::string_view("MM\0+", 4)})
    if (text.starts_with(tiff)) return "tiff";
  if (text.starts_with("BM")) return "bmp";
  if (text.size() > 2 && text[0] == 'P' && std::isspace(static_cast<unsigned char>(text[2])) &&
      std::string_view("123456Ff").find(text[1]) != text.npos)
    return "pnm";
  return "";
}

// OpenImageIO 2.4 does not compare the indices of a TGA file with its palette: only palettes that
// hold every index of 8 bits are let through.
void requireWholePalette(const std::string& file, std::span<const std::byte> start) {
  constexpr size_t kHeader = 18;
  if (start.size() < kHeader)
    throw InputError({file, 0, 0}, "cannot read the image: its header ends too early");
  const auto byte = [&](size_t i) { return std::to_integer<int>(start[i]); };
  const int imageType = byte(2), first = byte(3) + 256 * byte(4), length = byte(5) + 256 * byte(6),
            indexBits = byte(16);
  const bool mapped = imageType == 1 || imageType == 9;
  if (mapped && (byte(1) != 1 || first != 0 || length < 256 || indexBits != 8))
    throw InputError({file, 0, 0},
                     "cannot read the image: a TGA palette must have all 256 colours of 8-bit "
                     "indices; save it as true colour");
}

// TGA begins with no magic: its name tells it.
std::string formatOf(const std::string& file, std::span<const std::byte> start) {
  const std::string format = formatOf(start);
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (format.empty() && extension == ".tga") {
    requireWholePalette(file, start);
    return "targa";
  }
  if (format.empty())
    throw InputError({file, 0, 0},
                     fmt::format("cannot read the image: unknown format; {}", kFormats));
  return format;
}

// From a file, or from memory: `proxy`. `name` is what messages call it.
std::vector<StoredImage> readOpened(const std::string& file, const std::string& format,
                                    OIIO::Filesystem::IOProxy* proxy, bool all,
                                    const std::string& name) {
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
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(format);
    if (!in) fail(OIIO::geterror());
    OIIO::ImageSpec ofFirst;
    if (!in->open(file, ofFirst, hints)) fail(in->geterror());
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

}  // namespace

std::vector<StoredImage> readStoredImages(const std::string& file, bool all, const Location& from) {
  checkRegularFile(file, from);
  constexpr size_t kStart = 1 << 16;  // longer than headers are
  const std::vector<std::byte> start = readFileStart(file, kStart);
  if (start.empty()) throw InputError({file}, "the file is empty");
  checkExrHeader(start, sizeOf(file), file);
  const std::string format = formatOf(file, start);
  if (format == "png" || format == "jpeg" || format == "bmp") checkHeader(readFile(file), file);
  return readOpened(file, format, nullptr, all, file);
}

StoredImage readStoredImage(std::span<const std::byte> bytes, const std::string& name) {
  const std::string format = formatOf(bytes);
  const bool inMemory = !format.empty() && format != "tiff" && format != "bmp" && format != "pnm";
  if (!inMemory)
    throw InputError({name, 0, 0}, "unknown image format; PNG, JPEG, WebP, HDR and EXR are read");
  checkExrHeader(bytes, bytes.size(), name);
  checkHeader(bytes, name);
  OIIO::Filesystem::IOMemReader reader(
      const_cast<std::byte*>(bytes.data()),  // NOLINT: older releases take no pointer to const
      bytes.size());
  return std::move(readOpened("memory." + format, format, &reader, false, name).front());
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

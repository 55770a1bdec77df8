#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <random>

#include "io/temporary_folder.h"
#include "lobelia/io/image_io.h"
#include "support/data.h"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace lobelia {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// BMP of 2 x 2 pixels, `bits` a pixel, with a palette of red, green, blue, white for up to 8 bits.
std::string bmp(uint16_t bits, int32_t width = 2, int32_t height = 2) {
  const uint32_t palette = bits <= 8 ? 4 : 0;
  std::string body;
  if (bits == 8) body = std::string("\2\3\0\0\0\1\0\0", 8);  // rows of 4 bytes, bottom up
  if (bits == 4) body = std::string("\x23\0\0\0\x01\0\0\0", 8);
  if (bits == 24) body = std::string("\xff\0\0\xff\xff\xff\0\0\0\0\xff\0\xff\0\0\0", 16);
  std::string bytes = "BM";
  append(bytes, static_cast<uint32_t>(54 + 4 * palette + body.size()));
  append(bytes, uint32_t{0});
  append(bytes, uint32_t{54 + 4 * palette});
  append(bytes, uint32_t{40});
  append(bytes, width), append(bytes, height);
  append(bytes, uint16_t{1}), append(bytes, bits);
  for (const uint32_t v : {0u, static_cast<uint32_t>(body.size()), 2835u, 2835u, palette, palette})
    append(bytes, v);
  if (palette) bytes += std::string("\0\0\xff\0\0\xff\0\0\xff\0\0\0\xff\xff\xff\0", 16);
  return bytes + body;
}

std::string tga(uint8_t type, uint8_t bits, const std::string& pixels, uint16_t width = 2,
                uint16_t height = 1) {
  std::string bytes(18, '\0');
  bytes[2] = static_cast<char>(type);
  bytes[12] = static_cast<char>(width & 255), bytes[13] = static_cast<char>(width >> 8);
  bytes[14] = static_cast<char>(height & 255), bytes[15] = static_cast<char>(height >> 8);
  bytes[16] = static_cast<char>(bits);
  bytes[17] = static_cast<char>(0x20 | (bits == 32 ? 8 : 0));  // top row first, 8 bits of alpha
  return bytes + pixels;
}

// OpenImageIO 2.4 leaks the text of a failed read of a PNG file, because libpng leaves it by
// longjmp.
class LeaksOfPng {
 public:
#if defined(__SANITIZE_ADDRESS__)
  LeaksOfPng() { __lsan_disable(); }
  ~LeaksOfPng() { __lsan_enable(); }
#else
  LeaksOfPng() {}  // not trivial: else its variables would be reported as unused
  ~LeaksOfPng() {}
#endif
  LeaksOfPng(const LeaksOfPng&) = delete;
  LeaksOfPng& operator=(const LeaksOfPng&) = delete;
};

class Images : public testing::Test {
 protected:
  Image read(const std::string& name, const std::string& bytes,
             const io::ImageOptions& options = {}) {
    return io::readImage(folder.write(name, bytes), options);
  }
  TemporaryFolder folder;
};

TEST_F(Images, PaletteBmp) {
  for (const uint16_t bits : {uint16_t{4}, uint16_t{8}, uint16_t{24}}) {
    const Image image = read("a.bmp", bmp(bits));
    ASSERT_EQ(image.channels, 3) << bits;
    ASSERT_EQ(image.width, 2);
    const float expected[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    for (size_t i = 0; i < 12; ++i) EXPECT_EQ(image.pixels[i], expected[i]) << bits << " " << i;
  }
}

TEST_F(Images, EightBitsAreDecodedFromSrgbUnlessRawOrGamma) {
  const std::string bytes = tga(2, 24, std::string("\x80\x40\xff\0\0\0", 6));  // blue, green, red
  const Image srgb = read("a.tga", bytes);
  EXPECT_EQ(srgb.pixels[0], 1);
  EXPECT_NEAR(srgb.pixels[1], 0.0512694f, 1e-6f);
  EXPECT_NEAR(srgb.pixels[2], 0.2158605f, 1e-6f);
  EXPECT_NEAR(read("a.tga", bytes, {true, 0}).pixels[2], 128 / 255.f, 1e-7f);
  EXPECT_NEAR(read("a.tga", bytes, {false, 2}).pixels[2], std::pow(128 / 255.f, 2.f), 1e-6f);
  EXPECT_NEAR(read("a.tga", bytes, {false, 1}).pixels[2], 128 / 255.f, 1e-7f);
}

TEST_F(Images, AlphaIsKeptAndNotMultiplied) {
  const Image image = read("a.tga", tga(2, 32, std::string("\xff\xff\xff\x80\xff\0\0\0", 8)));
  ASSERT_EQ(image.channels, 4);
  EXPECT_EQ(image.pixels[0], 1);
  EXPECT_NEAR(image.pixels[3], 128 / 255.f, 1e-6f);  // linear
  EXPECT_EQ(image.pixels[6], 1);                     // colour where alpha is zero
  EXPECT_EQ(image.pixels[7], 0);
}

TEST_F(Images, GreyIsOneChannel) {
  const Image image = read("a.tga", tga(3, 8, std::string("\xff\x80", 2)));
  EXPECT_EQ(image.channels, 1);
  EXPECT_NEAR(image.pixels[1], 0.2158605f, 1e-6f);
}

// A film with all that a file can hold.
Film sampleFilm() {
  Film film;
  film.fullWidth = 12, film.fullHeight = 9;
  film.x0 = 3, film.y0 = 2, film.width = 7, film.height = 5;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1e4f);
  for (const auto& [name, channels] :
       {std::pair{"", 3}, {"direct", 3}, {"depth", 1}, {"variance.direct", 3}}) {
    Layer& layer = film.layers[name];
    layer.channels = channels;
    for (size_t i = 0; i < film.pixelCount() * static_cast<size_t>(channels); ++i)
      layer.values.push_back(uniform(random));
  }
  for (size_t i = 0; i < film.pixelCount(); ++i) film.alpha.push_back(static_cast<float>(i % 2));
  film.metadata = {{"command", "lobelia render x.xml -o y.exr"},
                   {"seed", "7"},
                   {"seconds", "1.25"},
                   {"version", "0.1.0"},
                   {"scene", "x.xml"}};
  return film;
}

TEST_F(Images, ExrComesBackBitForBit) {
  const Film film = sampleFilm();
  const std::string file = folder.path("a.exr");
  io::writeExr(file, film);
  const Film copy = io::readFilm(file);
  EXPECT_EQ(copy.fullWidth, 12);
  EXPECT_EQ(copy.fullHeight, 9);
  EXPECT_EQ(copy.x0, 3);
  EXPECT_EQ(copy.y0, 2);
  EXPECT_EQ(copy.width, 7);
  EXPECT_EQ(copy.height, 5);
  ASSERT_EQ(copy.layers.size(), film.layers.size());
  for (const auto& [name, layer] : film.layers) {
    ASSERT_TRUE(copy.layers.contains(name)) << name;
    EXPECT_EQ(copy.layers.at(name).channels, layer.channels) << name;
    EXPECT_EQ(copy.layers.at(name).values, layer.values) << name;
  }
  EXPECT_EQ(copy.alpha, film.alpha);
  for (const auto& [key, value] : film.metadata) EXPECT_EQ(copy.metadata.at(key), value);
  EXPECT_EQ(folder.list().size(), 1u);  // no temporary left
  const Image image = io::readImage(file, {});
  EXPECT_EQ(image.channels, 4);
  EXPECT_EQ(image.pixels[1], film.layers.at("").values[1]);  // linear, not decoded
}

TEST_F(Images, NonFiniteValuesSurviveInFilmsAndAreErrorsInTextures) {
  Film film = sampleFilm();
  film.layers[""].values[3 * 8 + 1] = std::numeric_limits<float>::quiet_NaN();
  io::writeExr(folder.path("a.exr"), film);
  EXPECT_TRUE(std::isnan(io::readFilm(folder.path("a.exr")).layers.at("").values[3 * 8 + 1]));
  const std::string message =
      messageOf<InputError>([&] { io::readImage(folder.path("a.exr"), {}); });
  EXPECT_TRUE(contains(message, "pixel (1, 1) is not finite in channel G")) << message;
}

TEST_F(Images, PngComesBack) {
  std::vector<uint8_t> rgb(3 * 5 * 4);
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<uint8_t>(4 * i);
  const std::string file = folder.path("a.png");
  io::writePng(file, rgb, 5, 4);
  const Image image = io::readImage(file, {true, 0});
  ASSERT_EQ(image.width, 5);
  for (size_t i = 0; i < rgb.size(); ++i) EXPECT_EQ(std::lround(image.pixels[i] * 255), rgb[i]);
  const Film film = io::readFilm(file);
  EXPECT_NEAR(film.layers.at("").values[32], decodeSrgb(128 / 255.f), 1e-6f);
  EXPECT_THROW(io::writePng(file, rgb, 5, 5), RuntimeError);
}

TEST_F(Images, DamagedFilesAreErrorsThatNameTheFile) {
  const LeaksOfPng tolerated;
  io::writeExr(folder.path("whole.exr"), sampleFilm());
  io::writePng(folder.path("whole.png"), std::vector<uint8_t>(3 * 30 * 30, 99), 30, 30);
  std::vector<std::pair<std::string, std::string>> files = {{"a.bmp", bmp(8)},
                                                            {"a.tga", tga(2, 24, "abcdef")}};
  for (const char* name : {"whole.exr", "whole.png"}) {
    std::ifstream in(folder.path(name), std::ios::binary);
    files.emplace_back(std::string("a") + (name + 5),
                       std::string(std::istreambuf_iterator<char>(in), {}));
  }
  for (const auto& [name, bytes] : files) {
    for (const double part : {0.0, 0.02, 0.2, 0.5, 0.8}) {
      const auto size = static_cast<size_t>(part * static_cast<double>(bytes.size()));
      const std::string message =
          messageOf<InputError>([&, &n = name, &b = bytes] { read(n, b.substr(0, size)); });
      EXPECT_TRUE(contains(message, name + ": ")) << message;
    }
    std::mt19937 random(11);
    for (int k = 0; k < 100; ++k) {
      std::string damaged = bytes;
      for (int n = 0; n < 3; ++n) damaged[random() % damaged.size()] = static_cast<char>(random());
      try {
        read(name, damaged);
      } catch (const InputError&) {
      }
    }
  }
  EXPECT_THROW(read("text.png", "this is no image at all"), InputError);
  EXPECT_THROW(read("text.xyz", "this is no image at all"), InputError);
}

TEST_F(Images, AbsurdSizesAreRefused) {
  std::string message = messageOf<InputError>([&] { read("a.bmp", bmp(24, 60000, 60000)); });
  EXPECT_TRUE(contains(message, "a.bmp: ")) << message;
  message = messageOf<InputError>([&] { read("a.tga", tga(2, 24, "abc", 65535, 65535)); });
  EXPECT_TRUE(contains(message, "65535")) << message;
  // Below the limit, but the file is far too short for it.
  EXPECT_THROW(read("a.tga", tga(2, 24, "abc", 10000, 10000)), InputError);
}

TEST_F(Images, MissingFileIsAnErrorAtThePlaceThatNamesIt) {
  const std::string message = messageOf<InputError>([&] {
    io::readImage(folder.path("gone.png"), {}, {"scene.xml", 3, 0});
  });
  EXPECT_TRUE(contains(message, "scene.xml:3: ")) << message;
  EXPECT_TRUE(contains(message, "gone.png")) << message;
  EXPECT_THROW(io::readImage(folder.path(""), {}), InputError);
}

TEST_F(Images, UnwritableTargetsAreRuntimeErrorsAndLeaveNothing) {
  const Film film = sampleFilm();
  std::string target = folder.path("gone/a.exr");
  EXPECT_TRUE(contains(messageOf<RuntimeError>([&] { io::writeExr(target, film); }), target));
  std::filesystem::create_directory(folder.path("folder.exr"));
  EXPECT_THROW(io::writeExr(folder.path("folder.exr"), film), RuntimeError);
  EXPECT_EQ(folder.list().size(), 1u);
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  // A full disk: writing fails, and the link that stands for it stays.
  std::filesystem::create_symlink("/dev/full", folder.path("full.exr"));
  const std::string message =
      messageOf<RuntimeError>([&] { io::writeExr(folder.path("full.exr"), film); });
  EXPECT_TRUE(contains(message, "full.exr")) << message;
  EXPECT_TRUE(contains(message, "No space left")) << message;
  EXPECT_EQ(folder.list().size(), 2u);
}

// The file may not grow beyond some bytes: what a disk that fills up while writing looks like.
TEST_F(Images, DiskThatFillsUpLeavesNoPartialFile) {
  const Film film = sampleFilm();
  const std::string file = folder.path("a.exr");
  io::writeExr(file, film);
  Film larger = film;
  larger.metadata["padding"] = std::string(1 << 16, 'x');
  struct rlimit old {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit small { 1 << 15, old.rlim_max };
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = messageOf<RuntimeError>([&] { io::writeExr(file, larger); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(contains(message, "a.exr")) << message;
  EXPECT_EQ(folder.list().size(), 1u);
  EXPECT_EQ(io::readFilm(file).layers.at("").values, film.layers.at("").values);  // the old one
}

TEST_F(Images, WritingReplacesAWholeFileOrNothing) {
  Film film = sampleFilm();
  const std::string file = folder.path("a.exr");
  io::writeExr(file, film);
  film.layers["bad"].values.resize(1);
  EXPECT_THROW(io::writeExr(file, film), RuntimeError);
  EXPECT_EQ(io::readFilm(file).layers.size(), 4u);
  film = sampleFilm();
  film.layers.erase("depth");
  io::writeExr(file, film);
  EXPECT_EQ(io::readFilm(file).layers.size(), 3u);
  EXPECT_EQ(folder.list().size(), 1u);
}

TEST_F(Images, TruncatedJpegAndHdr) {
  const std::string data = test::sharedFolder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  for (const char* name : {"/data/textures/Tiles036", "/data/environments"})
    for (const auto& entry : std::filesystem::directory_iterator(data + name)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".jpg" && extension != ".hdr") continue;
      std::ifstream in(entry.path(), std::ios::binary);
      const std::string bytes(std::istreambuf_iterator<char>(in), {});
      const std::string file = folder.write("cut" + extension, bytes.substr(0, bytes.size() / 2));
      EXPECT_TRUE(contains(messageOf<InputError>([&] { io::readImage(file, {}); }),
                           "cut" + extension + ": "))
          << entry.path();
      break;
    }
}

TEST_F(Images, RealFiles) {
  const std::string data = test::sharedFolder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".exr" && extension != ".hdr" && extension != ".tga" && extension != ".bmp")
      continue;
    const Image image = io::readImage(entry.path().string(), {});
    EXPECT_GT(image.width, 0) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 10);
  const Image sunset = io::readImage(data + "/data/environments/sunset.hdr", {});
  EXPECT_EQ(sunset.width, 1024);
  float peak = 0;
  for (const float v : sunset.pixels) peak = std::max(peak, v);
  EXPECT_NEAR(peak, 2176, 1);  // the README of the data
}

}  // namespace
}  // namespace lobelia

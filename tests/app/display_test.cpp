// --display against a viewer of our own that understands tev's messages.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cstring>
#include <map>
#include <stdexcept>
#include <thread>
#include <vector>

#include "app/moving_scene.h"
#include "lobelia/app/bounded_call.h"
#include "lobelia/app/viewer_socket.h"
#include "lobelia/base/error.h"
#include "lobelia/io/image_io.h"

namespace lobelia {
namespace {

using test::ProgramResult;
using test::runProgram;
using test::TemporaryFolder;

struct ViewedImage {
  int width = 0, height = 0, updates = 0;
  std::vector<float> values;  // R, G, B
};

// Reads a message's fields; throws when it ends early.
class Fields {
 public:
  explicit Fields(const std::vector<unsigned char>& bytes) : bytes_(bytes) {}
  template <class T>
  T integer() {
    uint64_t value = 0;
    for (size_t i = 0; i < sizeof(T); ++i) value |= uint64_t{bytes_.at(at_++)} << (8 * i);
    return static_cast<T>(value);
  }
  std::string text() {
    std::string out;
    while (const unsigned char c = bytes_.at(at_++)) out.push_back(static_cast<char>(c));
    return out;
  }
  float number() { return std::bit_cast<float>(integer<uint32_t>()); }
  size_t left() const { return bytes_.size() - at_; }

 private:
  const std::vector<unsigned char>& bytes_;
  size_t at_ = 0;
};

// Listens for one program; `messages`: closes after so many.
class FakeViewer {
 public:
  explicit FakeViewer(int messages = 1 << 30) : messages_(messages) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        listen(listener_, 1) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("no socket to listen at");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~FakeViewer() { wait(); }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  // Until the program is gone; then the images can be looked at.
  void wait() {
    if (!thread_.joinable()) return;
    shutdown(listener_, SHUT_RDWR);  // when nobody has come
    thread_.join();
    close(listener_);
  }

  std::map<std::string, ViewedImage> images;
  std::string mistake;
  int created = 0;

 private:
  void serve() {
    const int connection = accept(listener_, nullptr, nullptr);
    if (connection < 0) return;
    try {
      for (int i = 0; i < messages_; ++i) {
        std::vector<unsigned char> message(4);
        if (!receive(connection, message, 0)) break;
        message.resize(Fields(message).integer<uint32_t>());
        if (message.size() < 5 || !receive(connection, message, 4))
          throw std::runtime_error("a message ends early");
        understand(message);
      }
    } catch (const std::exception& e) {
      mistake = e.what();
    }
    close(connection);
  }
  static bool receive(int connection, std::vector<unsigned char>& bytes, size_t at) {
    while (at < bytes.size()) {
      const ssize_t n = recv(connection, bytes.data() + at, bytes.size() - at, 0);
      if (n <= 0) return false;
      at += static_cast<size_t>(n);
    }
    return true;
  }
  void understand(const std::vector<unsigned char>& message) {
    Fields in(message);
    in.integer<uint32_t>();
    const int operation = in.integer<uint8_t>();
    in.integer<uint8_t>();  // focus
    const std::string name = in.text();
    if (operation == 4) {
      ViewedImage& image = images[name];
      ++created;
      image.width = in.integer<int32_t>(), image.height = in.integer<int32_t>();
      image.values.assign(static_cast<size_t>(image.width * image.height) * 3, 0.f);
      expectChannels(in);
    } else if (operation == 6) {
      update(images.at(name), in);
    } else {
      throw std::runtime_error("unknown operation " + std::to_string(operation));
    }
    if (in.left() != 0) throw std::runtime_error("a message is too long");
  }
  static void expectChannels(Fields& in) {
    if (in.integer<int32_t>() != 3) throw std::runtime_error("not three channels");
    for (const char* name : {"R", "G", "B"})
      if (in.text() != name) throw std::runtime_error("channels are not R, G, B");
  }
  static void update(ViewedImage& image, Fields& in) {
    expectChannels(in);
    const int x = in.integer<int32_t>(), y = in.integer<int32_t>(), w = in.integer<int32_t>(),
              h = in.integer<int32_t>();
    if (x < 0 || y < 0 || w < 1 || h < 1 || x + w > image.width || y + h > image.height)
      throw std::runtime_error("an update outside of the image");
    int64_t offsets[3], strides[3];
    for (int64_t& offset : offsets) offset = in.integer<int64_t>();
    for (int64_t& stride : strides) stride = in.integer<int64_t>();
    std::vector<float> data(in.left() / 4);
    for (float& value : data) value = in.number();
    for (int row = 0; row < h; ++row) {
      for (int column = 0; column < w; ++column) {
        for (size_t c = 0; c < 3; ++c) {
          const int64_t from = offsets[c] + (row * w + column) * strides[c];
          image.values[static_cast<size_t>((y + row) * image.width + x + column) * 3 + c] =
              data.at(static_cast<size_t>(from));
        }
      }
    }
    ++image.updates;
  }

  int messages_, listener_ = -1, port_ = 0;
  std::thread thread_;
};

class DisplayTest : public ::testing::Test {
 protected:
  ProgramResult render(const std::string& arguments, int spp = 4) const {
    return runProgram("render " + scene_ + " --num-lights 16 --spp " + std::to_string(spp) +
                      " -o " + (folder_ / "a.exr") + " " + arguments);
  }
  // Where the file has its window, the viewer has the file.
  void expectTheFile(const ViewedImage& image, const std::string& file = "a.exr") const {
    const Film film = io::readFilm(folder_ / file);
    ASSERT_EQ(image.width, film.fullWidth);
    ASSERT_EQ(image.height, film.fullHeight);
    for (int y = 0; y < film.height; ++y) {
      for (int x = 0; x < film.width; ++x) {
        const Rgb value = film.rgb(static_cast<size_t>(y * film.width + x));
        const size_t at = static_cast<size_t>((y + film.y0) * image.width + x + film.x0) * 3;
        ASSERT_EQ(value, Rgb(image.values[at], image.values[at + 1], image.values[at + 2]))
            << x << ", " << y;
      }
    }
  }
  const TemporaryFolder folder_;
  const std::string scene_ = test::writeMovingScene(folder_);
};

TEST(BoundedCall, WhatNeverEndsIsLeftAlone) {
  EXPECT_EQ(app::calledWithin(60, [] { return 7; }), 7);
  const auto gate = std::make_shared<std::promise<int>>();  // never opened while we wait
  EXPECT_EQ(app::calledWithin(0.01, [gate] { return gate->get_future().get(); }), std::nullopt);
  gate->set_value(1);
}

TEST_F(DisplayTest, ShowsThePictureOfEveryMethod) {
  for (const char* method :
       {"--lights glossy", "--lights vpl --component indirect", "--lights path", "--lights light",
        "--lights path --pixels 40", "--lights glossy --crop 3,2,20,11"}) {
    FakeViewer viewer;
    const ProgramResult r = render(std::string(method) + " --quiet --display " + viewer.address());
    viewer.wait();
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_EQ(r.err, "");
    EXPECT_EQ(viewer.mistake, "") << method;
    ASSERT_EQ(viewer.images.size(), 1u) << method;
    EXPECT_EQ(viewer.images.begin()->first, "lobelia: moving");
    expectTheFile(viewer.images.begin()->second);
  }
}

TEST_F(DisplayTest, ShowsMoreThanTheEnd) {
  FakeViewer viewer;
  // Seconds of work, so that there is something to show meanwhile.
  const ProgramResult r = render(
      "--lights path --size 120x80 --time-limit 1.5 --quiet --display " + viewer.address(), 100000);
  viewer.wait();
  EXPECT_EQ(r.exitCode, 0) << r.err;
  ASSERT_EQ(viewer.images.size(), 1u);
  EXPECT_GE(viewer.images.begin()->second.updates, 2);
  expectTheFile(viewer.images.begin()->second);
}

TEST_F(DisplayTest, FramesTakeEachOthersPlace) {
  FakeViewer viewer;
  const ProgramResult r = render("--frames 3 --quiet --display " + viewer.address());
  viewer.wait();
  EXPECT_EQ(r.exitCode, 0) << r.err;
  EXPECT_EQ(viewer.mistake, "");
  EXPECT_EQ(viewer.created, 1);
  ASSERT_EQ(viewer.images.size(), 1u);
  expectTheFile(viewer.images.begin()->second, "a.0002.exr");
}

// A viewer never changes or stops a render.
TEST_F(DisplayTest, AnAbsentOrLeavingViewerIsAWarning) {
  ASSERT_EQ(render("--quiet").exitCode, 0);
  const auto pixels = [&] { return io::readFilm(folder_ / "a.exr").layers.at("").values; };
  const std::vector<float> expected = pixels();
  std::string nobody;
  {
    const FakeViewer gone;  // a port at which nobody listens any more
    nobody = gone.address();
  }
  const ProgramResult absent = render("--display " + nobody);
  EXPECT_EQ(absent.exitCode, 0);
  EXPECT_NE(absent.err.find("no viewer at " + nobody), std::string::npos) << absent.err;
  EXPECT_EQ(pixels(), expected);
  // It goes after one message, while much is still to be sent.
  FakeViewer leaving(1);
  const ProgramResult left =
      render("--size 1024x1024 --lights path --max-depth 1 --display " + leaving.address(), 1);
  EXPECT_EQ(left.exitCode, 0);
  EXPECT_NE(left.err.find("no viewer at"), std::string::npos) << left.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.exr"));
}

TEST_F(DisplayTest, AddressesAreChecked) {
  for (const char* bad : {"here", ":14158", "here:", "here:0", "here:65536", "here:1x", "here:-1",
                          "::1:14158", "[]:14158", "a b:14158"}) {
    EXPECT_THROW(app::parseViewerAddress(bad), UsageError) << bad;
  }
  EXPECT_EQ(app::parseViewerAddress("[::1]:14158").host, "::1");
  EXPECT_EQ(app::parseViewerAddress("localhost:14158").port, "14158");
  const ProgramResult r = render("--display here");
  EXPECT_EQ(r.exitCode, 2);
  EXPECT_NE(r.err.find("HOST:PORT"), std::string::npos) << r.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
}

}  // namespace
}  // namespace lobelia

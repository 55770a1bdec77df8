#include "lobelia/app/tev_messages.h"

#include <bit>
#include <cstdint>

namespace lobelia::app {
namespace {

class Message {
 public:
  explicit Message(uint8_t operation, size_t expectedBytes) {
    bytes_.reserve(expectedBytes);
    integer(uint32_t{0});
    integer(operation);
  }
  template <class T>
  void integer(T value) {
    for (size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<std::byte>(static_cast<uint64_t>(value) >> (8 * i) & 0xff));
  }
  void text(const std::string& value) {
    for (const char c : value) bytes_.push_back(static_cast<std::byte>(c));
    bytes_.push_back(std::byte{0});
  }
  void number(float value) { integer(std::bit_cast<uint32_t>(value)); }
  void channels() {
    integer(int32_t{3});
    for (const char* name : {"R", "G", "B"}) text(name);
  }
  std::vector<std::byte> finish() {
    const size_t size = bytes_.size();
    for (size_t i = 0; i < 4; ++i) bytes_[i] = static_cast<std::byte>(size >> (8 * i) & 0xff);
    return std::move(bytes_);
  }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace

std::vector<std::byte> tevCreateImage(const std::string& name, int width, int height) {
  Message message(4, name.size() + 64);
  message.integer(uint8_t{1});
  message.text(name);
  message.integer(width);
  message.integer(height);
  message.channels();
  return message.finish();
}

std::vector<std::byte> tevUpdateImage(const std::string& name, int x, int y, int width, int height,
                                      std::span<const Rgb> values) {
  Message message(6, name.size() + 128 + values.size() * 12);
  message.integer(uint8_t{0});
  message.text(name);
  message.channels();
  for (const int value : {x, y, width, height}) message.integer(value);
  for (int64_t offset = 0; offset < 3; ++offset) message.integer(offset);
  for (int channel = 0; channel < 3; ++channel) message.integer(int64_t{3});
  for (const Rgb& value : values)
    for (int c = 0; c < 3; ++c) message.number(value[c]);
  return message.finish();
}

}  // namespace lobelia::app

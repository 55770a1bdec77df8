#include "lobelia/app/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "lobelia/app/tev_messages.h"

namespace lobelia::app {
namespace {

constexpr int64_t kInterval = 250'000'000;  // nanoseconds between updates
constexpr double kConnectSeconds = 2;       // for each address of the host
constexpr double kPatience = 5;             // seconds in which a viewer takes nothing
constexpr size_t kMessageValues = 1 << 16;  // about; a message holds whole rows

}  // namespace

Display::Display(const std::string& address, std::string name, Context& context)
    : address_(parseViewerAddress(address)),
      name_(std::move(name)),
      context_(context),
      thread_([this] { run(); }) {}

Display::~Display() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Display::begin(const Film& film) {
  const std::scoped_lock lock(mutex_);
  const bool same = created_ && fullWidth_ == film.fullWidth && fullHeight_ == film.fullHeight;
  fullWidth_ = film.fullWidth, fullHeight_ = film.fullHeight;
  x0_ = film.x0, y0_ = film.y0, width_ = film.width;
  values_.assign(film.pixelCount(), Rgb{});
  changed_.assign(static_cast<size_t>(film.height), 0);
  created_ = same;
}

void Display::update(std::span<const uint32_t> pixels, std::span<const Rgb> values) {
  if (gone_) return;
  const std::scoped_lock lock(mutex_);
  for (size_t i = 0; i < pixels.size(); ++i) {
    values_[pixels[i]] = values[i];
    changed_[pixels[i] / static_cast<uint32_t>(width_)] = 1;
  }
}

bool Display::due() const { return !gone_ && nanosecondsNow() - taken_ >= kInterval; }

void Display::finish(const Film& film) {
  std::unique_lock lock(mutex_);
  if (gone_) return;
  for (size_t i = 0; i < values_.size(); ++i) values_[i] = film.rgb(i);
  std::fill(changed_.begin(), changed_.end(), uint8_t{1});
  finishing_ = true;
  wake_.notify_all();
  idle_.wait(lock, [&] { return gone_ || !finishing_; });
  finishing_ = false;
}

bool Display::take(std::vector<std::byte>& create, std::vector<Rows>& rows) {
  create.clear(), rows.clear();
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, std::chrono::nanoseconds(kInterval), [&] { return stop_ || finishing_; });
  if (stop_) return false;
  taken_ = nanosecondsNow();
  if (width_ == 0) return true;  // nothing has begun
  if (!created_) create = tevCreateImage(name_, fullWidth_, fullHeight_);
  created_ = true;
  const size_t width = static_cast<size_t>(width_);
  const size_t longest = std::max<size_t>(kMessageValues / width, 1);
  for (size_t y = 0; y < changed_.size();) {
    size_t end = y;
    while (end < changed_.size() && changed_[end] != 0 && end - y < longest) changed_[end++] = 0;
    if (end > y) {
      const auto first = values_.begin() + static_cast<ptrdiff_t>(y * width);
      rows.push_back({x0_,
                      y0_ + static_cast<int>(y),
                      width_,
                      static_cast<int>(end - y),
                      {first, first + static_cast<ptrdiff_t>((end - y) * width)}});
    }
    y = std::max(end, y + 1);
  }
  // What was taken now is the last of the picture when it is finished.
  if (finishing_) sending_ = true;
  return true;
}

std::string Display::send(const std::vector<std::byte>& create, const std::vector<Rows>& rows) {
  std::string failure = socket_.send(create, kPatience);
  for (size_t i = 0; i < rows.size() && failure.empty(); ++i) {
    const Rows& r = rows[i];
    failure = socket_.send(tevUpdateImage(name_, r.x, r.y, r.width, r.count, r.values), kPatience);
  }
  return failure;
}

void Display::run() {
  std::string failure = socket_.connect(address_, kConnectSeconds);
  std::vector<std::byte> create;
  std::vector<Rows> rows;
  while (failure.empty() && take(create, rows)) {
    failure = send(create, rows);
    const std::scoped_lock lock(mutex_);
    if (sending_) finishing_ = sending_ = false;
    idle_.notify_all();
  }
  if (failure.empty()) return;
  context_.warning(fmt::format("--display: no viewer at {}:{} ({}); the render goes on without",
                               address_.host, address_.port, failure));
  const std::scoped_lock lock(mutex_);
  gone_ = true;
  idle_.notify_all();
}

}  // namespace lobelia::app

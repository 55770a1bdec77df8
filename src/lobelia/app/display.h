// `--display`: shows the picture in tev while it is made.
//
// A thread of its own sends what has changed, some times a second, and its picture when it is done.
// A viewer that is absent, slow or gone costs a warning, never the render.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "lobelia/app/viewer_socket.h"
#include "lobelia/base/context.h"
#include "lobelia/film/film.h"
#include "lobelia/film/film_preview.h"

namespace lobelia::app {

class Display : public FilmPreview {
 public:
  // name: of the image in the viewer. Throws UsageError when the address is none.
  Display(const std::string& address, std::string name, Context& context);
  ~Display() override;  // without waiting for pictures that are not sent yet
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  // A picture of the film's size and window begins; later ones (frames) take the place of earlier.
  void begin(const Film& film);
  void update(std::span<const uint32_t> pixels, std::span<const Rgb> values) override;
  bool due() const override;
  // The picture is done: returns when the viewer has all of it or was given up.
  void finish(const Film& film);

 private:
  struct Rows {  // to be sent
    int x = 0, y = 0, width = 0, count = 0;
    std::vector<Rgb> values;
  };
  void run();
  // Waits for what is to be sent; false: no more.
  bool take(std::vector<std::byte>& create, std::vector<Rows>& rows);
  std::string send(const std::vector<std::byte>& create, const std::vector<Rows>& rows);

  const ViewerAddress address_;
  const std::string name_;
  Context& context_;
  ViewerSocket socket_;
  std::atomic<bool> gone_{false};
  std::atomic<int64_t> taken_{0};  // when last something was

  std::mutex mutex_;
  std::condition_variable wake_, idle_;
  // Under the mutex:
  int fullWidth_ = 0, fullHeight_ = 0, x0_ = 0, y0_ = 0, width_ = 0;
  std::vector<Rgb> values_;
  std::vector<uint8_t> changed_;  // by row
  bool created_ = false, finishing_ = false, sending_ = false, stop_ = false;

  std::thread thread_;  // last: it uses the others
};

}  // namespace lobelia::app

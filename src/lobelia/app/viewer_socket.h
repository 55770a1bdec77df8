// A TCP connection to a viewer that may be absent, slow or gone: nothing here waits longer than it
// is told.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lobelia::app {

struct ViewerAddress {
  std::string host, port;
};
// HOST:PORT, [IPv6]:PORT. Throws UsageError.
ViewerAddress parseViewerAddress(const std::string& text);

class ViewerSocket {
 public:
  ViewerSocket() = default;
  ~ViewerSocket();
  ViewerSocket(const ViewerSocket&) = delete;
  ViewerSocket& operator=(const ViewerSocket&) = delete;

  // Tries all addresses of the host, each for so long, some seconds at most after it looks up its
  // name. Returns why it failed, or "".
  std::string connect(const ViewerAddress& address, double seconds);
  // Sends all; gives up when nothing could be sent for so long. Returns why it failed, or "".
  std::string send(std::span<const std::byte> bytes, double seconds);

 private:
  void close();
  int handle_ = -1;
};

}  // namespace lobelia::app

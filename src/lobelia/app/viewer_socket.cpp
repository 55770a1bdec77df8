#include "lobelia/app/viewer_socket.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <optional>

#include "lobelia/app/bounded_call.h"
#include "lobelia/base/context.h"
#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

// Whether the socket becomes writable in so long; a signal does not end the wait.
bool waitWritable(int handle, double seconds) {
  const int64_t end = nanosecondsNow() + static_cast<int64_t>(seconds * 1e9);
  for (;;) {
    const int64_t left = (end - nanosecondsNow()) / 1'000'000;
    pollfd wanted{handle, POLLOUT, 0};
    const int ready = poll(&wanted, 1, left > 0 ? static_cast<int>(left) : 0);
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

// errno, or what the connection came to.
int connectWithin(int handle, const addrinfo& to, double seconds) {
  if (::connect(handle, to.ai_addr, to.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (!waitWritable(handle, seconds)) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof(error);
  return getsockopt(handle, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

constexpr double kLookupSeconds = 5;

struct Addresses {
  int error = 0;  // getaddrinfo()'s
  std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> list{nullptr, &freeaddrinfo};
};

// Of a name server that does not answer: after half a minute or more.
Addresses addressesOf(const ViewerAddress& address) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  Addresses out;
  out.error = getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &found);
  if (out.error == 0) out.list.reset(found);
  return out;
}

}  // namespace

ViewerAddress parseViewerAddress(const std::string& text) {
  const size_t colon = text.rfind(':');
  const auto fail = [&] {
    throw UsageError(
        fmt::format("--display '{}' is not of the form HOST:PORT, as in localhost:14158", text));
  };
  if (colon == std::string::npos || colon == 0) fail();
  ViewerAddress address{text.substr(0, colon), text.substr(colon + 1)};
  uint16_t port = 0;
  const char* end = address.port.data() + address.port.size();
  const auto [next, error] = std::from_chars(address.port.data(), end, port);
  if (error != std::errc() || next != end || port == 0) fail();
  if (address.host.front() == '[' && address.host.back() == ']') {
    address.host = address.host.substr(1, address.host.size() - 2);
  } else if (address.host.find(':') != std::string::npos) {
    fail();  // of an IPv6 address nobody knows where the port begins
  }
  if (address.host.empty() || address.host.find_first_of("[] /\t\n") != std::string::npos) fail();
  return address;
}

ViewerSocket::~ViewerSocket() { close(); }

void ViewerSocket::close() {
  if (handle_ >= 0) ::close(handle_);
  handle_ = -1;
}

std::string ViewerSocket::connect(const ViewerAddress& address, double seconds) {
  const std::optional<Addresses> host =
      calledWithin(kLookupSeconds, [address] { return addressesOf(address); });
  if (!host) return "its name is not found in time";
  if (host->error != 0) return gai_strerror(host->error);
  std::string reason = "the host has no address";
  for (const addrinfo* a = host->list.get(); a != nullptr; a = a->ai_next) {
    handle_ = socket(a->ai_family, a->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, a->ai_protocol);
    const int error = handle_ < 0 ? errno : connectWithin(handle_, *a, seconds);
    if (error == 0) return "";
    reason = std::strerror(error);
    close();
  }
  return reason;
}

std::string ViewerSocket::send(std::span<const std::byte> bytes, double seconds) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      bytes = bytes.subspan(static_cast<size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!waitWritable(handle_, seconds)) return "it does not take the picture";
    } else if (errno != EINTR) {
      return std::strerror(errno);
    }
  }
  return "";
}

}  // namespace lobelia::app

/// A witness of attempts to reach the network.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace emscape::test {

/// A local server that never answers and records whether a client has connected.
class Listener {
 public:
  Listener() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const place = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_, place, size) != 0 || listen(socket_, 4) != 0 || getsockname(socket_, place, &size) != 0)
      throw std::runtime_error("no socket can be opened");
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/";
  }
  ~Listener() { close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  const std::string& url() const { return url_; }
  bool wasReached() const {
    const int connection = accept4(socket_, nullptr, nullptr, 0);
    if (connection >= 0) close(connection);
    return connection >= 0;
  }

 private:
  int socket_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  std::string url_;
};

}  // namespace emscape::test

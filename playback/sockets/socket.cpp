#include "playback/sockets/socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/base/work.h"

namespace emscape::playback {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kDatagrams = 64, kLargestDatagram = 65536;
constexpr int kBuffer_bytes = 16 << 20;  ///< of the system, for what arrives while it is not read
constexpr double kConnect_s = 5;

[[noreturn]] void fail(const std::string& what, const Address& address, int cause = errno) {
  std::string remedy;
  if (cause == EADDRINUSE) remedy = "; another program uses the port: end it, or choose another port";
  if (cause == EADDRNOTAVAIL) remedy = "; this computer has no such address (ip address lists them)";
  if (cause == ENETUNREACH) remedy = "; this computer has no way there (ip route lists them)";
  if (cause == EACCES) remedy = "; the system forbids it: ports below 1024 are the administrator's";
  if (cause == ECONNREFUSED) remedy = "; no program listens there";
  throw Error(ErrorCode::other,
              fmt::format("cannot {} {}: {}{}", what, address.text(), std::strerror(cause), remedy));
}

sockaddr_in systemAddress(const Address& address) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(address.host);
  at.sin_port = htons(address.port);
  return at;
}

template <class Value>
bool setOption(const Descriptor& socket, int level, int option, const Value& value) {
  return setsockopt(socket.number(), level, option, &value, sizeof value) == 0;
}

/// True for causes after which the next call may succeed at once.
bool isTransient(int cause) {
  return cause == EAGAIN || cause == EINTR || cause == ECONNABORTED || cause == ECONNREFUSED;
}

/// What cannot be taken stays ready: without a pause the callers would never wait.
void pauseAfterFailure(double seconds) {
  constexpr double kPause_s = 0.05;
  std::this_thread::sleep_for(std::chrono::duration<double>(std::clamp(seconds, 0.0, kPause_s)));
}

bool isReady(int number, short events, double seconds) {
  pollfd waiting{number, events, 0};
  return poll(&waiting, 1, static_cast<int>(seconds * 1000)) > 0;
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) close(number_);
}
Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}
bool Descriptor::waitToRead(double seconds) const {
  return isReady(number_, POLLIN, seconds);
}

DatagramReceiver::DatagramReceiver(const Address& address, std::uint32_t interface)
    : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      buffer_(kDatagrams * kLargestDatagram) {
  if (!socket_.isOpen()) fail("listen to", address);
  // Several programs may listen to a group.
  if (address.isMulticast() && !setOption(socket_, SOL_SOCKET, SO_REUSEADDR, 1)) fail("listen to", address);
  if (!setOption(socket_, SOL_SOCKET, SO_RCVBUFFORCE, kBuffer_bytes))  // allowed to administrators
    setOption(socket_, SOL_SOCKET, SO_RCVBUF, kBuffer_bytes);
  setOption(socket_, SOL_SOCKET, SO_RXQ_OVFL, 1);
  const sockaddr_in at = systemAddress(address);
  if (bind(socket_.number(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
    fail("listen to", address);
  if (!address.isMulticast()) return;
  ip_mreq group{};
  group.imr_multiaddr.s_addr = htonl(address.host);
  group.imr_interface.s_addr = htonl(interface);
  if (!setOption(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, group))
    fail(fmt::format("join on the interface {} the group", Address{interface, 0}.hostText()), address);
}

std::size_t DatagramReceiver::receive(double seconds, const Sink& sink) {
  if (!socket_.waitToRead(seconds)) return 0;
  std::array<mmsghdr, kDatagrams> messages{};
  std::array<iovec, kDatagrams> pieces{};
  std::array<std::array<char, CMSG_SPACE(sizeof(std::uint32_t))>, kDatagrams> controls{};
  for (std::size_t i = 0; i < kDatagrams; ++i) {
    pieces[i] = {buffer_.data() + i * kLargestDatagram, kLargestDatagram};
    messages[i].msg_hdr.msg_iov = &pieces[i];
    messages[i].msg_hdr.msg_iovlen = 1;
    messages[i].msg_hdr.msg_control = controls[i].data();
    messages[i].msg_hdr.msg_controllen = controls[i].size();
  }
  const int count = recvmmsg(socket_.number(), messages.data(), kDatagrams, MSG_DONTWAIT, nullptr);
  failure_.clear();
  if (count < 0 && !isTransient(errno)) {
    failure_ = fmt::format("datagrams cannot be received: {}", std::strerror(errno));
    pauseAfterFailure(seconds);
  }
  for (int i = 0; i < count; ++i) {
    msghdr& header = messages[static_cast<std::size_t>(i)].msg_hdr;
    for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
      if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SO_RXQ_OVFL) continue;
      std::uint32_t counter = 0;
      std::memcpy(&counter, CMSG_DATA(part), sizeof counter);
      lost_ += counter - lost_counter_;  // the system's counter wraps
      lost_counter_ = counter;
    }
    sink(buffer_.data() + static_cast<std::size_t>(i) * kLargestDatagram,
         messages[static_cast<std::size_t>(i)].msg_len);
  }
  return static_cast<std::size_t>(std::max(count, 0));
}

DatagramSender::DatagramSender(const Address& address, std::uint32_t interface, int ttl)
    : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (!socket_.isOpen() || !setOption(socket_, SOL_SOCKET, SO_BROADCAST, 1)) fail("send to", address);
  if (address.isMulticast()) {
    in_addr from{};
    from.s_addr = htonl(interface);
    if (!setOption(socket_, IPPROTO_IP, IP_MULTICAST_TTL, ttl) ||
        !setOption(socket_, IPPROTO_IP, IP_MULTICAST_IF, from))
      fail("send to", address);
  }
  const sockaddr_in at = systemAddress(address);
  if (connect(socket_.number(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
    fail("send to", address);
}

bool DatagramSender::send(const std::uint8_t* bytes, std::size_t size) {
  // That no program listens is told by an error of the next call.
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (::send(socket_.number(), bytes, size, 0) >= 0) return true;
    if (errno != ECONNREFUSED) return false;
  }
  return true;
}

Connection Connection::to(const Address& address, const StopFlag* stop) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket.isOpen()) fail("connect to", address);
  const sockaddr_in at = systemAddress(address);
  if (connect(socket.number(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) {
    if (errno != EINPROGRESS) fail("connect to", address);
    constexpr double kSlice_s = 0.1;
    double waited_s = 0;
    while (!isReady(socket.number(), POLLOUT, kSlice_s)) {
      throwIfStopped(stop);
      waited_s += kSlice_s;
      if (waited_s > kConnect_s) fail("connect to", address, ETIMEDOUT);
    }
    int cause = 0;
    socklen_t size = sizeof cause;
    if (getsockopt(socket.number(), SOL_SOCKET, SO_ERROR, &cause, &size) != 0 || cause != 0)
      fail("connect to", address, cause);
  }
  // A host that is gone without a word ends the connection, too.
  setOption(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  setOption(socket, IPPROTO_TCP, TCP_KEEPIDLE, 10);
  setOption(socket, IPPROTO_TCP, TCP_KEEPINTVL, 5);
  setOption(socket, IPPROTO_TCP, TCP_KEEPCNT, 3);
  return Connection(std::move(socket));
}

std::optional<std::size_t> Connection::read(double seconds, char* bytes, std::size_t size) {
  if (!socket_.waitToRead(seconds)) return 0;
  const ssize_t count = recv(socket_.number(), bytes, size, MSG_DONTWAIT);
  if (count > 0) return static_cast<std::size_t>(count);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  return std::nullopt;
}

std::optional<std::size_t> Connection::writeSome(const std::string& text) {
  const ssize_t count = ::send(socket_.number(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (count >= 0) return static_cast<std::size_t>(count);
  if (errno == EAGAIN || errno == EINTR) return 0;
  return std::nullopt;
}

bool Connection::write(std::string text, double seconds) {
  const auto end = SteadyClock::now() + std::chrono::duration<double>(seconds);
  while (!text.empty()) {
    const auto sent = writeSome(text);
    if (!sent) return false;
    text.erase(0, *sent);
    const std::chrono::duration<double> left = end - SteadyClock::now();
    if (!text.empty() && left.count() <= 0) return false;
    if (*sent == 0) isReady(socket_.number(), POLLOUT, left.count());
  }
  return true;
}

Listener::Listener(const Address& address)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const sockaddr_in at = systemAddress(address);
  if (!socket_.isOpen() || !setOption(socket_, SOL_SOCKET, SO_REUSEADDR, 1) ||
      bind(socket_.number(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
      listen(socket_.number(), 8) != 0)
    fail("listen to", address);
}

std::optional<Connection> Listener::accept(double seconds) {
  if (!socket_.waitToRead(seconds)) return std::nullopt;
  Descriptor accepted(accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!accepted.isOpen()) {
    if (!isTransient(errno)) pauseAfterFailure(seconds);  // too many open files
    return std::nullopt;
  }
  return Connection(std::move(accepted));
}

}  // namespace emscape::playback

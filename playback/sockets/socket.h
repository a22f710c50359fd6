/// Sockets of IPv4: the only ones of the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "playback/sockets/address.h"

namespace emscape::playback {

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  int number() const { return number_; }
  bool isOpen() const { return number_ >= 0; }
  /// Waits until it can be read. @return false after the time
  bool waitToRead(double seconds) const;

 private:
  int number_;
};

/// Receives UDP datagrams.
class DatagramReceiver {
 public:
  using Sink = std::function<void(const std::uint8_t* bytes, std::size_t size)>;

  /// @param address    of this computer, or a multicast group, which is joined
  /// @param interface  address of the interface on which a group is joined
  /// @throws Error (other) naming address and cause
  DatagramReceiver(const Address& address, std::uint32_t interface);
  /// Calls `sink` for the datagrams that have arrived, at most 64; waits for the first one.
  /// @return number of datagrams; 0 after the time
  std::size_t receive(double seconds, const Sink& sink);
  /// Datagrams that were dropped by the system since the begin because they came faster than they were read.
  std::uint64_t lost() const { return lost_; }
  /// Why the system did not give the datagrams at the last call; empty: it did.
  const std::string& failure() const { return failure_; }

 private:
  Descriptor socket_;
  std::vector<std::uint8_t> buffer_;
  std::string failure_;
  std::uint64_t lost_ = 0;
  std::uint32_t lost_counter_ = 0;  ///< of the system
};

/// Sends UDP datagrams, also to all computers of a network (broadcast).
class DatagramSender {
 public:
  /// @param ttl  of multicast: 0 stays on this computer
  DatagramSender(const Address& address, std::uint32_t interface, int ttl);
  /// @return false if the system did not take it
  bool send(const std::uint8_t* bytes, std::size_t size);

 private:
  Descriptor socket_;
};

/// A TCP connection.
class Connection {
 public:
  explicit Connection(Descriptor socket) : socket_(std::move(socket)) {}
  /// @param stop  ends the waiting; may be null
  /// @throws Error (other) naming address and cause, also after 5 s without an answer; Stopped
  static Connection to(const Address& address, const StopFlag* stop = nullptr);

  const Descriptor& descriptor() const { return socket_; }
  /// Reads what has arrived, waiting for the first byte.
  /// @return number of bytes, 0 after the time; none: the other side has ended it
  std::optional<std::size_t> read(double seconds, char* bytes, std::size_t size);
  /// Sends what can be sent now. @return number of bytes; none: the other side has ended it
  std::optional<std::size_t> writeSome(const std::string& text);
  /// Sends all, waiting at most so long. @return false if the other side does not take it
  bool write(std::string text, double seconds);

 private:
  Descriptor socket_;
};

/// Accepts TCP connections.
class Listener {
 public:
  /// @throws Error (other) naming address and cause
  explicit Listener(const Address& address);
  std::optional<Connection> accept(double seconds);

 private:
  Descriptor socket_;
};

}  // namespace emscape::playback

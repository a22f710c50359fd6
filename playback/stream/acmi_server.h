/// A host of Tacview's real-time protocol.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "playback/sockets/socket.h"

namespace emscape::playback {

/// Sends an ACMI text to all that connect; who comes later gets the present state first. For one thread,
/// which calls serve() often. At most 32 clients; one that reads too slowly is disconnected.
class AcmiServer {
 public:
  /// @param password  of clients; empty: none
  AcmiServer(const Address& address, std::string password)
      : listener_(address), password_(std::move(password)) {}

  /// Accepts and greets clients and sends what is due, for some time.
  void serve(double seconds);
  /// Takes one logical line of the text (interop::AcmiLines), without its end.
  void send(std::string_view line);

  std::size_t clientCount() const { return clients_.size(); }
  /// What happened since the last call: clients that came, went or were refused, one line each.
  std::vector<std::string> takeEvents() { return std::exchange(events_, {}); }

 private:
  struct Client {
    Connection connection;
    std::string hello;    ///< so far
    std::string backlog;  ///< not sent yet
    double since_s = 0;
  };

  void greet();
  void flush();
  std::string present() const;
  void keep(std::string_view line);

  Listener listener_;
  std::string password_;
  std::vector<Client> waiting_, clients_;
  std::vector<std::string> events_;
  std::string header_, frame_;  ///< lines before the first object; the present frame
  std::map<std::uint64_t, std::map<std::string, std::string>> objects_;  ///< present properties
};

}  // namespace emscape::playback

#include "playback/stream/acmi_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "playback/stream/steady_time.h"
#include "recording/acmi/acmi_handshake.h"
#include "recording/acmi/acmi_lines.h"
#include "recording/acmi/acmi_text.h"

namespace emscape::playback {
namespace {

constexpr std::size_t kMaxClients = 32, kLongestHello = 4096;
constexpr std::size_t kLongestBacklog = std::size_t{8} << 20;
constexpr double kGreeting_s = 5;

}  // namespace

void AcmiServer::serve(double seconds) {
  const double end_s = steadyTime_s() + seconds;
  constexpr double kSlice_s = 0.02;
  do {
    if (auto connection = listener_.accept(std::clamp(end_s - steadyTime_s(), 0.0, kSlice_s))) {
      if (waiting_.size() + clients_.size() < kMaxClients) {
        waiting_.push_back({std::move(*connection), "", "", steadyTime_s()});
      } else {
        events_.push_back(fmt::format("a client is refused: there are {}", kMaxClients));
      }
    }
    greet();
    flush();
  } while (steadyTime_s() < end_s);
}

void AcmiServer::greet() {
  for (std::size_t i = 0; i < waiting_.size();) {
    Client& client = waiting_[i];
    std::array<char, 512> buffer{};
    const auto count = client.connection.read(0, buffer.data(), buffer.size());
    if (count) client.hello.append(buffer.data(), *count);
    const std::size_t end = client.hello.find('\0');
    std::string fault;
    if (end != std::string::npos) {
      fault = interop::acmiClientFault(std::string_view(client.hello).substr(0, end), password_);
    } else if (!count) {
      fault = "it went before its greeting";
    } else if (client.hello.size() > kLongestHello || steadyTime_s() - client.since_s > kGreeting_s) {
      fault = "its greeting has no end";
    } else {
      ++i;
      continue;
    }
    if (fault.empty()) {
      client.backlog = interop::acmiHostHello("Emscape") + present();
      clients_.push_back(std::move(client));
      events_.push_back(fmt::format("a client has come; there are {}", clients_.size()));
    } else {
      events_.push_back("a client is refused: " + fault);
    }
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void AcmiServer::flush() {
  for (std::size_t i = 0; i < clients_.size();) {
    Client& client = clients_[i];
    std::array<char, 512> ignored{};
    bool is_there = client.connection.read(0, ignored.data(), ignored.size()).has_value();
    std::string reason = "it has gone";
    if (is_there && !client.backlog.empty()) {
      const auto sent = client.connection.writeSome(client.backlog);
      is_there = sent.has_value();
      if (sent) client.backlog.erase(0, *sent);
      if (client.backlog.size() > kLongestBacklog) {
        is_there = false;
        reason = "it reads too slowly";
      }
    }
    if (is_there) {
      ++i;
      continue;
    }
    clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(i));
    events_.push_back(fmt::format("a client is left: {}; there are {}", reason, clients_.size()));
  }
}

void AcmiServer::send(std::string_view line) {
  keep(line);
  const std::string text = interop::physicalAcmi(line) + '\n';
  for (Client& client : clients_) client.backlog += text;
}

void AcmiServer::keep(std::string_view line) {
  if (line.empty()) return;
  if (line.front() == '#') {
    frame_ = line;
    return;
  }
  std::string_view rest = line;
  const auto id = interop::acmiId(interop::nextAcmiPart(rest));
  if (line.front() == '-') {
    rest = line.substr(1);
    if (const auto gone = interop::acmiId(interop::nextAcmiPart(rest))) objects_.erase(*gone);
  } else if (!id || *id == 0) {
    // Of the whole recording; events are not repeated.
    constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
    if (line.find("Event=") == std::string_view::npos && header_.size() < kLongestHeader)
      header_ += interop::physicalAcmi(line) + "\n";
  } else {
    auto& properties = objects_[*id];
    while (!rest.empty()) {
      const std::string_view part = interop::nextAcmiPart(rest);
      const std::size_t at = part.find('=');
      if (at == std::string_view::npos) continue;
      std::string& value = properties[std::string(part.substr(0, at))];
      if (part.substr(0, at) != "T" || value.empty()) {
        value = part.substr(at + 1);
        continue;
      }
      // Empty parts of a place stay as they were; of another number of parts it is the new place.
      const auto before = interop::acmiPlace(value), told = interop::acmiPlace(part.substr(at + 1));
      if (!before || !told) continue;
      std::string place;
      for (std::size_t i = 0; i < told->values.size(); ++i) {
        const auto number = told->values[i] ? told->values[i] : before->values[i];
        place += (i == 0 ? "" : "|") + (number ? fmt::format("{}", *number) : "");
      }
      value = place;
    }
  }
}

std::string AcmiServer::present() const {
  std::string text = header_;
  if (!frame_.empty()) text += frame_ + "\n";
  for (const auto& [id, properties] : objects_) {
    text += fmt::format("{:x}", id);
    for (const auto& [name, value] : properties) text += "," + name + "=" + interop::physicalAcmi(value);
    text += "\n";
  }
  return text;
}

}  // namespace emscape::playback

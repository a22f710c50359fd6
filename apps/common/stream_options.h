/// Options of commands that receive a live battlefield.
#pragma once

#include <optional>
#include <string>

#include "apps/common/command.h"
#include "playback/stream/live_battlefield.h"

namespace emscape::app {

/// The options as they are typed.
struct StreamOptions {
  std::string dis, acmi, interface;
  playback::StreamRequest request;

  /// @param base_name  the option of the base, for messages
  void addTo(CLI::App& command, const std::string& base_name);
  bool isGiven() const { return !dis.empty() || !acmi.empty(); }
  /// The request; reads addresses, which may ask a name server. @throws Error (usage)
  playback::StreamRequest parse() const;
};

}  // namespace emscape::app

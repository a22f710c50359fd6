/// Options of commands that receive a live battlefield.
#pragma once

#include <string>

#include "apps/common/command.h"
#include "playback/stream/live_battlefield.h"

namespace emscape::app {

/// The options as they are typed.
struct StreamOptions {
  std::string dis, acmi, cot, interface;
  playback::StreamRequest request;

  /// @param base      name of the option of the base; empty: none
  /// @param database  name of the option of the emitter database
  void addTo(CLI::App& command, const std::string& base, const std::string& database);
  bool isGiven() const { return !dis.empty() || !acmi.empty() || !cot.empty(); }
  /// The request; reads addresses, which may ask a name server. @throws Error (usage)
  playback::StreamRequest parse() const;
};

}  // namespace emscape::app

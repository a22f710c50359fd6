/// One event of Cursor on Target (TAK), version 2 of the schema as XML.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "recording/common/recording.h"

namespace emscape::interop {

/// What an event says of an object, of a sensor, or of the end of one of them.
struct CotEvent {
  std::string uid, type;
  std::string callsign;
  double time_s = 0, stale_s = 0;  ///< since 1970, by the sender's clock
  std::string removed;             ///< uid of what it removes; empty: it removes nothing
  bool is_object = false;          ///< of a type a-...
  bool has_sensor = false;
  bool has_height = true;
  PoseSample pose;          ///< t_s is time_s
  std::string carrier;      ///< uid of the object that carries the sensor; empty: the event's own
  std::string sensor_name;  ///< empty: it has none
  BeamState sensor;         ///< angles from true north and the horizon

  bool isUsed() const { return !removed.empty() || is_object || has_sensor; }
  /// The object that the sensor belongs to.
  const std::string& sensorCarrier() const { return carrier.empty() || is_object ? uid : carrier; }
  /// A sensor with a carrier has no position of its own.
  bool hasPlace() const { return is_object || (has_sensor && carrier.empty()); }
};

/// @param fault  set to the reason if it is no event
std::optional<CotEvent> parseCotEvent(std::string_view xml, std::string& fault);

/// The event with other times, as one that happens now.
/// @param time_s  since 1970  @param life_s  from its time to its stale time
std::string restampedCotEvent(std::string_view xml, double time_s, double life_s);

/// An event that asks a server for an answer: some send events only to clients that have sent one.
std::string cotPing(const std::string& uid, double time_s);

/// True if the begin of a file is that of events.
bool isCot(std::string_view head);

/// Splits a stream of events, each with or without its own XML declaration.
class CotSplitter {
 public:
  /// Largest event (bytes); longer ones are dropped.
  static constexpr std::size_t kLongest = std::size_t{1} << 20;

  /// @param sink  receives each event, from its <event on
  void take(std::string_view bytes, const std::function<void(std::string_view event)>& sink);
  /// True if an event has begun and not ended.
  bool isWithin() const;
  long long dropped() const { return dropped_; }

 private:
  std::string text_;
  std::size_t searched_ = 0;
  long long dropped_ = 0;
};

}  // namespace emscape::interop

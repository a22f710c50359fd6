/// Reading of Cursor on Target (TAK): events of version 2 of the schema as XML.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "recording/common/byte_source.h"
#include "recording/common/read_options.h"
#include "recording/common/recording.h"
#include "recording/common/track_recorder.h"
#include "recording/cot/cot_event.h"

namespace emscape::interop {

/// Takes events in the order in which they came. Types a-... are objects, from `time` to `stale`; a <sensor>
/// is a beam of its event's object, or of the one that its <link> with the relation p-p names; t-x-d-d
/// removes an object.
class CotReader {
 public:
  explicit CotReader(const ReadOptions& options);

  void takeEvent(std::string_view xml);
  /// @param location  of the event, for messages
  void take(const CotEvent& event, const std::string& location);
  /// Call once.
  Recording finish();
  ReadingTally& tally() { return recorder_.tally(); }

 private:
  struct Object {
    std::size_t index = 0;
    double stale_s = 0;
    bool is_present = false;
  };
  struct Sensor {
    std::size_t beam = 0;
    double stale_s = 0;
  };

  Object& objectOf(const std::string& uid);
  void takeObject(const CotEvent& event, const std::string& location);
  void takeSensor(const CotEvent& event);
  void remove(const std::string& uid, double time_s);
  void switchOff(const Sensor& sensor, double time_s);

  TrackRecorder recorder_;
  std::unordered_map<std::string, Object> objects_;
  std::unordered_map<std::string, Sensor> sensors_;
  double last_s_ = 0;
};

/// Reads a file of events.
Recording readCot(ByteSource& source, const ReadOptions& options);

}  // namespace emscape::interop

/// What a reader of recordings is told besides the file.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace emscape::interop {

struct ReadOptions {
  /// An emission without an update for this time has ended (s), > 0. The default is the standard's:
  /// 2.4 heartbeats of 10 s. @see IEEE 1278.1, HBT_TIMEOUT_MPLIER
  double emission_timeout_s = 24;
  /// The same of an entity. Its heartbeat is 5 s.
  double entity_timeout_s = 12;
  /// The exercise of DIS that is read; none: that of the first PDU.
  std::optional<int> exercise;
  /// A track (GPX, KML, CZML, STK, NMEA, CSV) without a position for longer than this time (s) has ended, and
  /// begins again with the next one; 0: the gap is bridged.
  double gap_s = 0;
  /// Columns of a table of tracks: "latitude=Breite,longitude=Laenge,height=Hoehe:ft"; empty: by their names.
  std::string columns;
  /// False: the heights of the file are replaced, so that assumptions on them are not told.
  bool uses_heights = true;
  /// Names of the emitters of DIS by number, for messages. @see readEmitterNames()
  std::map<int, std::string> emitter_names;
};

}  // namespace emscape::interop

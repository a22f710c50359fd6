/// Reads recordings of other programs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "interop/recording/recording.h"

namespace emscape::interop {

struct ReadOptions {
  /// An emission without an update for this time has ended (s), > 0. The default is the standard's:
  /// 2.4 heartbeats of 10 s. @see IEEE 1278.1, HBT_TIMEOUT_MPLIER
  double emission_timeout_s = 24;
  /// The same of an entity. Its heartbeat is 5 s.
  double entity_timeout_s = 12;
  /// A track (GPX, KML, CZML, STK, NMEA, CSV) without a position for longer than this time (s) has ended, and
  /// begins again with the next one; 0: the gap is bridged.
  double gap_s = 0;
  /// Columns of a table of tracks: "latitude=Breite,longitude=Laenge,height=Hoehe:ft"; empty: by their names.
  std::string columns;
  /// Names of the emitters of DIS by number, for messages. @see readEmitterNames()
  std::map<int, std::string> emitter_names;
};

/// Reads a recording whose format is told by its content: Tacview's ACMI 2.0 to 2.2 (text, or zipped), DIS in
/// .pcap and .pcapng, in the text logs of KDIS and in Disco's .session. Files are streamed. A file that ends
/// too early is read to its end, which the tally reports, as it does records that cannot be read.
/// @param progress  may be empty; it may throw to stop the reading
/// @throws Error (bad_input) naming the file: it cannot be opened, has another format, or has no object with
/// a position
Recording readRecording(const std::string& file, const ReadOptions& options = {},
                        const ProgressSink& progress = {});

/// One recording of several, on one time axis: epochs are aligned where all have one, else each begins at
/// its own t = 0.
Recording merged(std::vector<Recording> recordings);

}  // namespace emscape::interop

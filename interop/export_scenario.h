/// Writes a scenario as a recording for other programs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::interop {

struct ExportOptions {
  double step_s = 0;     ///< largest time between positions of a moving platform; 0: 1 s
  bool replace = false;  ///< files that exist; else they are an error
  /// Further packets of CZML, each after ",\n"; asked for before the first file is written.
  std::function<std::string()> czml_packets;
};

struct ExportResult {
  std::string file;
  std::string format;
  std::string emitters;  ///< the emitter database written beside it, with what the recording cannot tell
  long long records = 0;
  int platforms = 0;
  int emitter_count = 0;
  std::vector<std::string> notes;  ///< what the recording does not carry
};

/// Endings of the formats that are written: ".acmi", ".pcap", ".asi", ..., longer ones first.
std::vector<std::string> exportFormats();

/// Writes a recording, whose format its ending tells, and FILE.emitters.yaml, an emitter database for
/// importRecording(). Positions are those of the tracks and at most step_s apart. ACMI 2.2: the first radar
/// of a platform has its properties, further emitters are objects of type Beam. DIS version 7: Entity State,
/// Electromagnetic Emission and Transmitter PDUs.
/// @param scenario  read from a file
/// @param terrain   of the scenario; may be null
/// @throws Error (usage) for another ending or a file that exists, (bad_input) for a scenario without a file,
/// (other) if a file cannot be written
ExportResult exportScenario(const std::shared_ptr<const scenario::Scenario>& scenario,
                            const scenario::Terrain* terrain, const std::string& file,
                            const ExportOptions& options = {}, const ProgressSink& progress = {});

}  // namespace emscape::interop

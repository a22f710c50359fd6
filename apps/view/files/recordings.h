/// Recordings of other programs, opened as scenarios.
#pragma once

#include <string>
#include <vector>

namespace emscape::view {

/// What was assumed for the scenario of a recording; all empty: it is none.
struct ImportNote {
  std::string platforms;
  std::string silence;  ///< true until an emitter is switched on; else empty
  std::string rest;

  /// In one line. @param is_silent  no emitter of the scenario is switched on
  std::string text(bool is_silent) const { return platforms + (is_silent ? silence : "") + rest; }
};

/// Makes a scenario of a recording, in the folder of the program's state, which a later call for the same
/// recording replaces. What the recording does not tell of its emitters is from FILE.emitters.yaml if there
/// is one, as `emscape export` writes it, else from the starter set.
/// @param note  receives what was assumed
/// @return the scenario's file
/// @throws Error as interop::readRecording() and interop::importRecording()
std::string importRecordingFile(const std::string& file, ImportNote& note);
/// The user's files from which that scenario is made; the second need not exist.
std::vector<std::string> sourcesOfRecording(const std::string& file);

}  // namespace emscape::view

/// Recordings of other programs, opened as scenarios.
#pragma once

#include <string>

namespace emscape::view {

/// Makes a scenario of a recording, in the folder of the program's state, which a later call for the same
/// recording replaces. What the recording does not tell of its emitters is from FILE.emitters.yaml if there
/// is one, as `emscape export` writes it, else from the starter set.
/// @param note  receives what was assumed, in one line
/// @return the scenario's file
/// @throws Error as interop::readRecording() and interop::importRecording()
std::string importRecordingFile(const std::string& file, std::string& note);

}  // namespace emscape::view

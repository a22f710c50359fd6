/// Warnings of a result, merged over emitters.
#pragma once

#include <string>
#include <vector>

namespace emscape::report {

/// Merges warnings that differ only in the emitter and in numbers into one that names the first five emitters
/// and counts the others. Its numbers are those of each emitter, or their range if an emitter has several
/// warnings, as over time, or is not named.
std::vector<std::string> joinedWarnings(const std::vector<std::string>& warnings);
/// Logs joinedWarnings().
void logWarnings(const std::vector<std::string>& warnings);

}  // namespace emscape::report

/// Warnings of a result, merged over emitters.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::report {

/// Merges warnings that differ only in the emitter and in numbers into one that names the first five emitters
/// and counts the others. Its numbers are those of each emitter, or their range if an emitter has several
/// warnings, as over time, or is not named. Of more than three others that differ only in numbers, the first
/// and the count of the rest.
std::vector<std::string> joinedWarnings(const std::vector<std::string>& warnings);

using ReadScenarios = std::vector<std::shared_ptr<const scenario::Scenario>>;
/// Warnings of a result other than those of the scenarios' checks, which are logged where a scenario is read.
std::vector<std::string> withoutChecks(std::vector<std::string> warnings, const ReadScenarios& scenarios);
/// Logs joinedWarnings() of withoutChecks().
void logWarnings(const std::vector<std::string>& warnings, const ReadScenarios& scenarios = {});

}  // namespace emscape::report

/// Exposure as a table, JSON and CSV.
#pragma once

#include <string>

#include "apps/emscape/common/console.h"
#include "emscape/study/exposure/exposure.h"

namespace emscape::app {

Json exposureJson(const study::Exposure& exposure);
/// Statistics of each emitter and of all together; without rows, which are in the files.
void printExposure(const study::Exposure& exposure);
/// One row per time, one column per emitter. @throws Error (other) naming the file
void writeExposureCsv(const study::Exposure& exposure, const std::string& file);

}  // namespace emscape::app

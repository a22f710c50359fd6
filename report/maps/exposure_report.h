/// Exposure as a table, JSON and CSV.
#pragma once

#include <string>

#include "emscape/study/exposure/exposure.h"
#include "report/json.h"

namespace emscape::report {

Json exposureJson(const study::Exposure& exposure);
/// Statistics of each emitter and of all together; without rows, which are in the files.
std::string exposureText(const study::Exposure& exposure);
/// One row per time, one column per emitter. @throws Error (other) naming the file
void writeExposureCsv(const study::Exposure& exposure, const std::string& file);

}  // namespace emscape::report

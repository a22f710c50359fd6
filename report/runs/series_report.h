/// A series that was written, as JSON.
#pragma once

#include <string>
#include <vector>

#include "emscape/playback/series/series_writer.h"
#include "report/json.h"

namespace emscape::report {

/// @param device  on which it was computed  @param warnings  joined  @param seconds  that it took
Json seriesJson(const std::string& device, const std::string& folder, const playback::SeriesResult& result,
                const std::vector<std::string>& warnings, double seconds);

}  // namespace emscape::report

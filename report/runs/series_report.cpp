#include "report/runs/series_report.h"

namespace emscape::report {
namespace {

Json rangesToJson(const playback::SeriesResult& result) {
  Json ranges = Json::object();
  for (std::size_t c = 0; c < result.channels.size(); ++c) {
    const playback::ValueRange& range = result.ranges[c];
    ranges[result.channels[c]] = range.empty() ? Json(nullptr) : Json{range.min, range.max};
  }
  return ranges;
}

}  // namespace

Json seriesJson(const std::string& device, const std::string& folder, const playback::SeriesResult& result,
                const std::vector<std::string>& warnings, double seconds) {
  return {{"device", device},
          {"folder", folder},
          {"steps", result.steps},
          {"steps_computed", result.steps_computed},
          {"channels", result.channels},
          {"ranges", rangesToJson(result)},
          {"warnings", warnings},
          {"seconds", seconds}};
}

}  // namespace emscape::report

/// series.json: description of a folder of volumes, with which an interrupted series is resumed. Internal to
/// the module.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/frames/field_series.h"
#include "emscape/playback/series/series_writer.h"

namespace emscape::playback {

using Json = nlohmann::ordered_json;

struct SeriesState {
  /// All inputs that the values and names of the files depend on; a series is resumed only with equal inputs.
  Json recipe;
  std::vector<std::string> channels;
  std::vector<ValueRange> ranges;  ///< one per channel, over the series; valid if complete
  /// The scenario's file, relative to the folder if it is below it, and its edits, for pictures of the
  /// series. Empty in series of earlier versions.
  std::string scenario_file;
  std::vector<std::string> edits;
  bool complete = false;  ///< every step is present and its files have these ranges
};

/// @throws Error (bad_input) for an elevation file that cannot be read
Json recipeOf(const FieldSeries& series, const SeriesOptions& options);

/// null for an empty range.
Json toJson(const ValueRange& range);
/// @throws nlohmann::json::exception or Error (bad_input) for an invalid range
ValueRange rangeFromJson(const Json& json);

/// True if the folder has the description of a series, readable or not.
bool hasSeriesState(const std::filesystem::path& folder);

/// The state of a folder; none if it holds no series.
/// @throws Error (bad_input) if series.json is damaged: it names the line of invalid JSON
std::optional<SeriesState> readSeriesState(const std::filesystem::path& folder);
void writeSeriesState(const std::filesystem::path& folder, const SeriesState& state);

/// Number of steps.
int stepsOf(const SeriesState& state);

/// @throws Error (bad_input) that names every input that differs, or if the channels differ
void checkSameRecipe(const std::filesystem::path& folder, const SeriesState& found,
                     const SeriesState& wanted);

}  // namespace emscape::playback

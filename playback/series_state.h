/// series.json: what a folder of volumes holds and how far it is, so that an interrupted series can go on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/emscape/console.h"
#include "apps/emscape/field_series.h"

namespace emscape::app {

struct SeriesState {
  /// All that the values and names of the files depend on; a series goes on only with the same.
  Json recipe;
  std::vector<std::string> channels;
  std::vector<ValueRange> ranges;  ///< one a channel, over the whole series
  int finished_steps = 0;          ///< the first so many are on the disk, whole
};

/// The state of a folder; none if it holds no series. @throws Error (bad_input) if series.json is damaged
std::optional<SeriesState> readSeriesState(const std::filesystem::path& folder);
void writeSeriesState(const std::filesystem::path& folder, const SeriesState& state);

/// @throws Error (bad_input) unless the state holds a range of each of `channels` and a possible number of
/// steps
void checkState(const std::filesystem::path& folder, const SeriesState& state,
                const std::vector<std::string>& channels, int steps);

/// @throws Error (bad_input) that names every part in which the recipes differ
void checkSameRecipe(const std::filesystem::path& folder, const Json& found, const Json& wanted);

}  // namespace emscape::app

#include "apps/emscape/series_state.h"

#include <fmt/core.h>

#include <algorithm>

#include "base/whole_file.h"
#include "emscape/base/error.h"

namespace emscape::app {
namespace {

constexpr const char* kStateFile = "series.json";
constexpr int kFormatVersion = 1;

Json toJson(const SeriesState& state) {
  Json ranges = Json::object();
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    const ValueRange& range = state.ranges[c];
    ranges[state.channels[c]] = range.empty() ? Json(nullptr) : Json{range.min, range.max};
  }
  return {{"format_version", kFormatVersion},
          {"finished_steps", state.finished_steps},
          {"ranges", ranges},
          {"recipe", state.recipe}};
}

SeriesState fromJson(const Json& json) {
  if (json.at("format_version") != kFormatVersion) throw std::invalid_argument("format_version is not 1");
  SeriesState state;
  state.recipe = json.at("recipe");
  if (!state.recipe.is_object()) throw std::invalid_argument("recipe is not an object");
  state.finished_steps = json.at("finished_steps").get<int>();
  for (const auto& [channel, range] : json.at("ranges").items()) {
    state.channels.push_back(channel);
    state.ranges.push_back(range.is_null() ? ValueRange{}
                                           : ValueRange{range.at(0).get<float>(), range.at(1).get<float>()});
  }
  return state;
}

}  // namespace

std::optional<SeriesState> readSeriesState(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kStateFile;
  if (!std::filesystem::exists(file)) return std::nullopt;
  const std::vector<std::uint8_t> bytes = readWhole(file);
  try {
    return fromJson(Json::parse(bytes.begin(), bytes.end()));
  } catch (const std::exception& error) {
    throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
                std::string("not the state of a series (") + error.what() + "); --force begins anew");
  }
}

void writeSeriesState(const std::filesystem::path& folder, const SeriesState& state) {
  writeWhole(folder / kStateFile, [&state](std::ostream& out) { out << toJson(state).dump(2) << '\n'; });
}

void checkState(const std::filesystem::path& folder, const SeriesState& state,
                const std::vector<std::string>& channels, int steps) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_input, {(folder / kStateFile).string(), 0, 0},
                "damaged: " + what + "; --force begins anew");
  };
  if (state.finished_steps < 0 || state.finished_steps > steps) {
    fail(fmt::format("'finished_steps' is {}, outside 0..{}", state.finished_steps, steps));
  }
  for (const std::string& channel : channels) {
    if (std::count(state.channels.begin(), state.channels.end(), channel) != 1) {
      fail(fmt::format("'ranges' has no '{}'", channel));
    }
  }
  if (state.channels.size() != channels.size()) {
    fail(fmt::format("'ranges' has {} entries instead of {}", state.channels.size(), channels.size()));
  }
}

void checkSameRecipe(const std::filesystem::path& folder, const Json& found, const Json& wanted) {
  std::string differences;
  for (const auto& [key, value] : wanted.items()) {
    const Json before = found.is_object() ? found.value(key, Json()) : Json();
    if (before == value) continue;
    differences += differences.empty() ? key : ", " + key;
  }
  if (differences.empty()) return;
  throw Error(ErrorCode::bad_input, {(folder / kStateFile).string(), 0, 0},
              "the series was begun with another " + differences +
                  "; give the same to resume it, another -o, or --force to begin anew");
}

}  // namespace emscape::app

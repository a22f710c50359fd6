#include "playback/series/series_state.h"

#include <set>

#include "base/files/file_digest.h"
#include "base/files/file_reading.h"
#include "base/files/json_reading.h"
#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "base/instruction_set.h"
#include "emscape/base/error.h"

namespace emscape::playback {
namespace {

constexpr const char* kStateFile = "series.json";
constexpr int kFormatVersion = 2;

Json toJson(const SeriesState& state) {
  Json ranges = Json::object();
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    ranges[state.channels[c]] = state.complete ? playback::toJson(state.ranges[c]) : Json(nullptr);
  }
  return {{"format_version", kFormatVersion},     {"complete", state.complete}, {"ranges", ranges},
          {"scenario_file", state.scenario_file}, {"edits", state.edits},       {"recipe", state.recipe}};
}

SeriesState fromJson(const Json& json) {
  if (json.at("format_version") != kFormatVersion)
    throw Error(ErrorCode::bad_input, "'format_version' is " + json["format_version"].dump() +
                                          "; this program reads " + std::to_string(kFormatVersion));
  SeriesState state;
  state.recipe = json.at("recipe");
  if (!state.recipe.is_object()) throw Error(ErrorCode::bad_input, "recipe is not an object");
  if (!state.recipe.at("times").is_array()) throw Error(ErrorCode::bad_input, "recipe: times is not a list");
  state.complete = json.at("complete").get<bool>();
  state.scenario_file = json.value("scenario_file", "");
  state.edits = json.value("edits", std::vector<std::string>());
  for (const auto& [channel, range] : json.at("ranges").items()) {
    state.channels.push_back(channel);
    state.ranges.push_back(rangeFromJson(range));
  }
  return state;
}

}  // namespace

Json recipeOf(const FieldSeries& series, const SeriesOptions& options) {
  const scenario::Scenario& scenario = *series.input().scenario;
  Json rasters = Json::array();
  if (scenario.terrain) {
    for (const std::string& file : scenario.terrain->rasters()) {
      const FileDigest digest = digestOf(file);
      rasters.push_back({{"bytes", digest.bytes}, {"crc32", digest.crc32}});
    }
  }
  Json channels = Json::array();
  for (const emfield::Channel& channel : series.channels()) channels.push_back(channel.name);
  Json recipe{
      {"scenario", scenario.name},
      {"scenario hash", scenario.hash},
      {"content of terrain files", rasters},
      {"version of emscape", EMSCAPE_VERSION},
      {"instruction set", instructionSet()},
      {"format", std::set<std::string>(options.formats.begin(), options.formats.end())},
      {"quantity", channels},
      {"range", options.range ? toJson(*options.range) : Json(nullptr)},
      {"allow-missing-terrain", series.options().allow_missing_terrain},
      {"compare", series.reference() != nullptr ? Json(series.reference()->scenario->hash) : Json(nullptr)},
      {"times", series.times_s()}};
  if (options.mesh) recipe["mesh"] = options.mesh_text;
  if (options.with_fog) recipe["look"] = "fog";
  return recipe;
}

Json toJson(const ValueRange& range) {
  return range.empty() ? Json(nullptr) : Json{range.min, range.max};
}

ValueRange rangeFromJson(const Json& json) {
  if (json.is_null()) return {};
  if (!json.is_array() || json.size() != 2)
    throw Error(ErrorCode::bad_input, "a range is two numbers or null");
  const ValueRange range{json.at(0).get<float>(), json.at(1).get<float>()};
  if (!(range.min <= range.max))
    throw Error(ErrorCode::bad_input, "a range whose minimum exceeds its maximum");
  return range;
}

bool hasSeriesState(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / kStateFile);
}

std::optional<SeriesState> readSeriesState(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kStateFile;
  if (!hasSeriesState(folder)) return std::nullopt;
  const std::string remedy = ": not the state of a series; use another folder";
  std::string text;
  try {
    text = readWholeText(file);
  } catch (const Error& error) {
    throw Error(error.code(), error.location(), error.message() + remedy);
  }
  return readJson<Json>(text, file.string(), fromJson, remedy);
}

void writeSeriesState(const std::filesystem::path& folder, const SeriesState& state) {
  writeWhole(
      folder / kStateFile, [&state](std::ostream& out) { out << dumpJson(toJson(state), 2) << '\n'; },
      Replaces::any);
}

int stepsOf(const SeriesState& state) {
  return static_cast<int>(state.recipe.at("times").size());
}

void checkSameRecipe(const std::filesystem::path& folder, const SeriesState& found,
                     const SeriesState& wanted) {
  const std::string file = (folder / kStateFile).string();
  std::string differences;
  for (const auto& [key, value] : wanted.recipe.items()) {
    if (found.recipe.value(key, Json()) == value) continue;
    differences += differences.empty() ? key : ", " + key;
  }
  if (!differences.empty()) {
    throw Error(ErrorCode::bad_input, {file},
                "the series was begun with another " + differences +
                    "; resume it with the same, replace it, or use another folder");
  }
  if (found.channels != wanted.channels) {
    throw Error(ErrorCode::bad_input, {file},
                "damaged: 'ranges' does not contain each quantity once; use another folder");
  }
}

}  // namespace emscape::playback

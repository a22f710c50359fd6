#include "emscape/playback/view/view_state.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"

namespace emscape::playback {

CellMethod parseCellMethod(const std::string& name) {
  return parseName<CellMethod>("way of drawing cells", name);
}

namespace {

constexpr const char* kSpacingKey = ":spacing_m=";
constexpr const char* kCountKey = ",count=";
constexpr double kMinSpacing_m = 1, kMaxSpacing_m = 1e7;
constexpr double kMaxRings = 100;

/// @return whether the whole text is a number from least to most
bool readNumber(const std::string& text, double least, double most, double& value) {
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && value >= least && value <= most;
}

}  // namespace

RangeRings parseRangeRings(const std::string& text) {
  RangeRings rings;
  const std::size_t key = text.rfind(kSpacingKey);
  bool is_valid = key != std::string::npos && key > 0;
  if (is_valid) {
    rings.emitter = text.substr(0, key);
    std::string spacing = text.substr(key + std::string(kSpacingKey).size()), count;
    const std::size_t comma = spacing.find(kCountKey);
    double number = 0;
    if (comma != std::string::npos) {
      is_valid = readNumber(spacing.substr(comma + std::string(kCountKey).size()), 1, kMaxRings, number) &&
                 number == std::floor(number);
      rings.count = static_cast<int>(number);
      spacing.resize(comma);
    }
    is_valid = is_valid && readNumber(spacing, kMinSpacing_m, kMaxSpacing_m, rings.spacing_m);
  }
  if (is_valid) return rings;
  throw Error(
      ErrorCode::usage,
      fmt::format("range rings '{}': expected EMITTER:spacing_m=..[,count=..], spacing {:g} to {:g} m, "
                  "count 1 to {:g}",
                  text, kMinSpacing_m, kMaxSpacing_m, kMaxRings));
}

std::string toString(const RangeRings& rings) {
  const std::string text = fmt::format("{}{}{}", rings.emitter, kSpacingKey, rings.spacing_m);
  return rings.count > 0 ? fmt::format("{}{}{}", text, kCountKey, rings.count) : text;
}

void dropColors(ViewState& view) {
  view.transfer.reset();
  view.range.reset();
  view.settings.iso_value = render::RenderSettings{}.iso_value;
}

void changeQuantity(ViewState& view, const std::string& quantity) {
  if (quantity == view.quantity) return;
  view.quantity = quantity;
  dropColors(view);
}

namespace {
void setComparison(ViewState& view, const std::string& compare, double split) {
  const bool was_difference = view.comparison() == Comparison::difference;
  view.compare = compare;
  view.split = split;
  if ((view.comparison() == Comparison::difference) != was_difference) dropColors(view);
}
}  // namespace

void changeComparison(ViewState& view, const std::string& compare) {
  setComparison(view, compare, view.split);
}

void changeSplit(ViewState& view, double split) {
  setComparison(view, split > 0 && view.compare.empty() ? kOriginal : view.compare, split);
}

void changeRange(ViewState& view, const ValueRange& range) {
  view.range = range;
  view.transfer.reset();
}

void setInput(ViewState& view, const ViewState& opened) {
  view.input = opened.input;
  view.scenario = opened.scenario;
  view.mesh = opened.mesh;
  view.allow_missing_terrain = opened.allow_missing_terrain;
  view.transfer_file = opened.transfer_file;
  view.cells = opened.cells;
  view.pattern = opened.pattern;
}

}  // namespace emscape::playback

#include "emscape/render/annotate/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "render/annotate/hatching.h"
#include "render/annotate/legend_ends.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

// Lengths at 1200 x 900.
constexpr double kEdge = 26;
constexpr double kBarWidth = 20;
constexpr double kOpacityWidth = 34;
constexpr double kPixelsPerTick = 60;
constexpr double kSwatch = 15;
constexpr double kSwatchGap = 8;
constexpr double kRowHeight = 25;
constexpr double kBarTop = 0.2;  // fraction of the picture's height
constexpr double kBarBottom = 0.8;

std::string lowerAlphanumeric(const std::string& text) {
  std::string kept;
  for (char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      kept += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return kept;
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// Decimals that multiples of a step need, at most 6.
int decimalsOf(double step) {
  int decimals = 0;
  for (double scaled = step; decimals < 6 && std::abs(scaled - std::round(scaled)) > 1e-6 * std::abs(scaled);
       scaled *= 10) {
    ++decimals;
  }
  return decimals;
}

struct BarTick {
  double value = 0;
  std::string text;
};

/// Ticks at round values and at both ends, which take the places of round values near them.
/// @param count  of round values, about
/// @param gap    smallest distance of numbers, a part of the bar
std::vector<BarTick> ticksOf(const Legend& legend, int count, double gap, LegendEnds ends = {}) {
  const FieldScale& scale = legend.scale;
  const double lowest = legend.function.lowest(), highest = legend.function.highest();
  const double first = scale.shown(lowest), last = scale.shown(highest);
  std::vector<double> shown =
      scale.is_amplitude ? roundLogTicks(first, last, count) : roundTicks(first, last, count);
  if (legend.whole_numbers) {
    const auto broken = [](double value) { return value != std::round(value); };
    shown.erase(std::remove_if(shown.begin(), shown.end(), broken), shown.end());
  }
  const double step = shown.size() > 1 ? shown[1] - shown[0] : last - first;
  std::vector<BarTick> ticks;
  if (!(highest > lowest)) return ticks;
  for (const double at : shown) {
    const double value = scale.stored(at);
    const double to_end = std::min(value - lowest, highest - value) / (highest - lowest);
    if (to_end >= gap)
      ticks.push_back({value, scale.is_amplitude ? fmt::format("{:g}", at) : tickText(at, step)});
  }
  for (const auto& [value, at] : {std::pair{lowest, first}, std::pair{highest, last}}) {
    const double unit = std::pow(10, -decimalsOf(step));
    const bool is_close = std::abs(at - std::round(at / unit) * unit) < step / 20;
    const char* const beyond = value == highest && ends.has_higher ? "≥ "
                               : value == lowest && ends.has_lower ? "≤ "
                                                                   : "";
    ticks.push_back({value, beyond + (scale.is_amplitude ? fmt::format("{:.3g}", at)
                                                         : tickText(at, is_close ? step : step / 10))});
  }
  return ticks;
}

/// Width of the longest text. Text is measured independently of the picture.
double widestText(const std::vector<std::string>& texts, double size_px, Weight weight = Weight::normal) {
  const Canvas measure({1, 1});
  double widest = 0;
  for (const std::string& text : texts)
    widest = std::max(widest, measure.textBox(text, size_px, weight).width);
  return widest;
}

/// Breaks a long name into lines of at most about `most` characters.
std::vector<std::string> linesOf(const std::string& text, std::size_t most) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (begin < text.size()) {
    std::size_t end = text.size();
    if (end - begin > most) {
      const std::size_t space = text.rfind(' ', begin + most);
      if (space != std::string::npos && space > begin)
        end = space;
      else if (text.find(' ', begin) != std::string::npos)
        end = text.find(' ', begin);
    }
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::vector<std::string> headingOf(const Legend& legend) {
  std::vector<std::string> lines = linesOf(legend.quantity, 15);
  if (!legend.unit.empty()) lines.push_back(legend.unit);
  return lines;
}

/// Maximum width of a category's name.
double nameRoom(const Style& style) {
  return style.name_px - (kSwatch + kSwatchGap) * style.unit;
}

constexpr double kLine = 1.3;  // line height in text sizes

/// Minimum height above the bar or the categories.
double leastTop(const Style& style, const Legend& legend) {
  const double heading = kLine * style.text_px * static_cast<double>(headingOf(legend).size());
  return headerHeight(style) + heading + 10 * style.unit;
}

/// Upper end of the contents below the heading.
double topOf(ImageSize size, const Style& style, const Legend& legend) {
  return std::max(kBarTop * size.height, leastTop(style, legend));
}

/// Draws the heading so that it ends above `bottom`.
void drawHeading(Canvas& canvas, const Style& style, const Legend& legend, double left, double bottom) {
  const std::vector<std::string> lines = headingOf(legend);
  const double line_px = kLine * style.text_px;
  double y = bottom - line_px * (static_cast<double>(lines.size()) - 0.5);
  for (std::size_t i = 0; i < lines.size(); ++i, y += line_px) {
    const bool unit = !legend.unit.empty() && i + 1 == lines.size();
    const Weight weight = unit ? Weight::normal : Weight::bold;
    canvas.textWithRim(shortenedText(canvas, lines[i], style.text_px, style.name_px, weight), {left, y},
                       style.text_px, unit ? style.mutedInk() : style.textInk(), style.rimInk(), Align::left,
                       weight);
  }
}

std::vector<std::string> notesOf(const Legend& legend) {
  std::vector<std::string> notes = linesOf(legend.map_note, 15);
  if (!legend.note.empty()) notes.push_back(legend.note);
  return notes;
}

double contentWidth(const Style& style, const Legend& legend) {
  double content = 0;
  if (legend.function.categorical) {
    std::vector<std::string> names;
    for (const Category& category : legend.categories) names.push_back(category.name);
    content =
        (kSwatch + kSwatchGap) * style.unit + std::min(widestText(names, style.small_px), nameRoom(style));
  } else {
    std::vector<std::string> numbers;
    for (const BarTick& tick : ticksOf(legend, 8, 0)) numbers.push_back(tick.text);
    content = (kOpacityWidth + kBarWidth + 14) * style.unit + widestText(numbers, style.small_px);
  }
  if (!legend.hatched.empty()) {
    const double hatched = (kSwatch + kSwatchGap) * style.unit + widestText({legend.hatched}, style.small_px);
    content = std::max(content, std::min(hatched, style.name_px));
  }
  const double heading = widestText(headingOf(legend), style.text_px) * 1.08;
  const double note = widestText(notesOf(legend), style.small_px);
  return std::max(content, std::min(std::max(heading, note), style.name_px));
}

void drawNotes(Canvas& canvas, const Style& style, const Legend& legend, double left, double y) {
  const double size_px = style.small_px;
  for (const std::string& note : notesOf(legend)) {
    canvas.textWithRim(shortenedText(canvas, note, size_px, style.name_px), {left, y}, size_px,
                       style.mutedInk(), style.rimInk());
    y += kLine * size_px;
  }
}

/// The swatch and the name of what is hatched. @return whether there is any
bool drawHatched(Canvas& canvas, const Style& style, const Legend& legend, double left, double y) {
  if (legend.hatched.empty()) return false;
  const double side = kSwatch * style.unit, top = y - side / 2, step = kHatchStep * style.unit;
  for (double sum = step / 2; sum < 2 * side; sum += step) {  // of the distances to the left and upper edges
    const double far = std::min(sum, side);
    canvas.line({left + sum - far, top + far}, {left + far, top + sum - far}, kHatchInk,
                kHatchWidth * style.unit);
  }
  canvas.outline({{left, top}, {left + side, top}, {left + side, top + side}, {left, top + side}},
                 style.mutedInk(0.8), style.unit, true);
  canvas.textWithRim(shortenedText(canvas, legend.hatched, style.small_px, nameRoom(style)),
                     {left + side + kSwatchGap * style.unit, y}, style.small_px, style.textInk(),
                     style.rimInk());
  return true;
}

/// A line across the bar with an arrowhead at its left end.
/// @param beyond  -1, 1: the value is above or below the bar; an arrowhead points there from its end
void drawIsoMark(Canvas& canvas, const Style& style, double left, double y, double width, int beyond) {
  const double head = 6 * style.unit;
  if (beyond != 0) {
    const double middle = left + width / 2, base = y + 3 * beyond * style.unit;
    canvas.polygon({{middle - head, base}, {middle + head, base}, {middle, base + 1.2 * beyond * head}},
                   style.textInk());
    return;
  }
  canvas.line({left, y}, {left + width, y}, style.rimInk(0.9), 4 * style.unit);
  canvas.line({left, y}, {left + width, y}, style.textInk(), 2 * style.unit);
  canvas.polygon({{left - 1.6 * head, y - head}, {left - 1.6 * head, y + head}, {left, y}}, style.textInk());
}

void drawBar(Canvas& canvas, const Style& style, const Legend& legend, double left, LegendEnds ends) {
  const TransferFunction& function = legend.function;
  const double top = topOf(canvas.size(), style, legend);
  const double bottom = kBarBottom * canvas.size().height;
  const double bar_left = left + kOpacityWidth * style.unit;
  const double bar_width = kBarWidth * style.unit;
  const double range = function.highest() - function.lowest();
  double largest = 0;  // an isosurface has one opacity
  for (const TransferFunction::OpacityPoint& point : function.opacities)
    largest = legend.iso_value ? 0 : std::max(largest, point.opacity);
  const auto yOf = [&](double value) {
    return bottom - (value - function.lowest()) / range * (bottom - top);
  };
  const int rows = static_cast<int>(bottom - top);
  std::vector<Point2> curve;
  for (int row = 0; row < rows; ++row) {
    const double y = top + row;
    const double value = function.highest() - (row + 0.5) / rows * range;
    const Ink ink{function.color(value), 1};
    canvas.rectangle({bar_left, y, bar_width, 1.5}, ink);
    // The square root makes small opacities visible, which are most of a volume.
    const double opacity = largest > 0 ? std::sqrt(function.opacity(value) / largest) : 0;
    const double width = opacity * (kOpacityWidth - 5) * style.unit;
    canvas.rectangle({bar_left - 3 * style.unit - width, y, width, 1.5}, {ink.color, 0.55});
    curve.push_back({bar_left - 3 * style.unit - width, y});
  }
  if (largest > 0) canvas.outline(curve, style.mutedInk(), 1.1 * style.unit, false);
  canvas.outline(
      {{bar_left, top}, {bar_left + bar_width, top}, {bar_left + bar_width, bottom}, {bar_left, bottom}},
      style.mutedInk(0.8), style.unit, true);
  const int count = std::max(2, static_cast<int>((bottom - top) / (kPixelsPerTick * style.unit)));
  for (const BarTick& tick : ticksOf(legend, count, 1.4 * style.small_px / (bottom - top), ends)) {
    const double y = yOf(tick.value);
    const double right = bar_left + bar_width;
    canvas.line({right, y}, {right + 5 * style.unit, y}, style.textInk(0.9), 1.2 * style.unit);
    canvas.textWithRim(tick.text, {right + 9 * style.unit, y}, style.small_px, style.textInk(),
                       style.rimInk());
  }
  if (legend.iso_value) {
    const double y = yOf(*legend.iso_value);
    drawIsoMark(canvas, style, bar_left, std::clamp(y, top, bottom), bar_width,
                *legend.iso_value > legend.function.highest()  ? -1
                : *legend.iso_value < legend.function.lowest() ? 1
                                                               : 0);
  }
  drawHeading(canvas, style, legend, left, top - 10 * style.unit);
  if (largest > 0) {
    canvas.textWithRim("opacity", {left, bottom + 10 * style.unit + 0.6 * style.small_px}, style.small_px,
                       style.mutedInk(), style.rimInk());
  }
  double below = bottom + 14 * style.unit + 1.9 * style.small_px;
  if (drawHatched(canvas, style, legend, left, below)) below += kRowHeight * style.unit;
  drawNotes(canvas, style, legend, left, below);
}

/// Number of the categories that have room, with a line for the others and the notes below them.
std::size_t shownCategories(ImageSize size, const Style& style, const Legend& legend) {
  const double room = size.height - topOf(size, style, legend) - 0.5 * kRowHeight * style.unit;
  const std::size_t below = notesOf(legend).size() + (legend.hatched.empty() ? 0 : 1);
  const auto rows = static_cast<std::size_t>(std::max(room / (kRowHeight * style.unit), 0.0));
  if (legend.categories.size() + below <= rows) return legend.categories.size();
  return rows > below + 1 ? rows - below - 1 : 0;
}

/// Draws a row for each of the first categories, and one with the number of the others. @param y  above them
/// @return the middle of the row below
double drawRows(Canvas& canvas, const Style& style, const std::vector<Category>& categories,
                std::size_t shown, double left, double y) {
  for (std::size_t n = 0; n < shown; ++n) {
    const Category& category = categories[n];
    y += kRowHeight * style.unit;
    const double swatch = kSwatch * style.unit;
    canvas.rectangle({left, y - swatch / 2, swatch, swatch},
                     {category.color.value_or(categoryColor(category.index)), 1}, 3 * style.unit);
    canvas.textWithRim(shortenedText(canvas, category.name, style.small_px, nameRoom(style)),
                       {left + swatch + kSwatchGap * style.unit, y}, style.small_px, style.textInk(),
                       style.rimInk());
  }
  y += kRowHeight * style.unit;
  if (shown == categories.size()) return y;
  canvas.textWithRim(fmt::format("and {} more", categories.size() - shown), {left, y}, style.small_px,
                     style.mutedInk(), style.rimInk());
  return y + kRowHeight * style.unit;
}

void drawCategories(Canvas& canvas, const Style& style, const Legend& legend, double left) {
  const double top = topOf(canvas.size(), style, legend);
  drawHeading(canvas, style, legend, left, top);
  const std::size_t shown = shownCategories(canvas.size(), style, legend);
  double y = drawRows(canvas, style, legend.categories, shown, left, top);
  if (drawHatched(canvas, style, legend, left, y)) y += kRowHeight * style.unit;
  drawNotes(canvas, style, legend, left, y);
}

}  // namespace

void drawGroundClasses(Canvas& canvas, const Style& style, const std::vector<Category>& classes,
                       double bottom, std::vector<Rect>& taken) {
  const double row = kRowHeight * style.unit, left = kEdge * style.unit;
  const double top = headerHeight(style) + 0.5 * row;
  const auto rows = static_cast<std::size_t>(std::max((bottom - top) / row - 1, 0.0));
  if (classes.empty() || rows < 2) return;
  const std::size_t shown = classes.size() <= rows ? classes.size() : rows - 1;
  canvas.textWithRim("ground", {left, top}, style.small_px, style.mutedInk(), style.rimInk());
  const double end = drawRows(canvas, style, classes, shown, left, top);
  std::vector<std::string> names;
  for (std::size_t n = 0; n < shown; ++n) names.push_back(classes[n].name);
  const double width = std::min(widestText(names, style.small_px), nameRoom(style));
  taken.push_back({0, top - row / 2, left + (kSwatch + kSwatchGap) * style.unit + width, end - top});
}

std::vector<double> roundTicks(double lowest, double highest, int count) {
  std::vector<double> ticks;
  const double range = highest - lowest;
  if (!(range > 0) || !std::isfinite(range) || count < 1) return ticks;
  const double raw = range / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (double nice : {1.0, 2.0, 2.5, 5.0}) {
    if (nice * power >= raw * 0.999) {
      step = nice * power;
      break;
    }
  }
  const double slack = 1e-9 * range;
  const double first = std::ceil((lowest - slack) / step);
  const double last = std::floor((highest + slack) / step);
  for (double i = first; i <= last; ++i) ticks.push_back(i * step + 0.0);  // + 0: no "-0"
  return ticks;
}

std::vector<double> roundLogTicks(double lowest, double highest, int count) {
  static const std::vector<double> kMantissas[] = {{1, 2, 5}, {1, 3}, {1}};
  std::vector<double> ticks;
  if (!(lowest > 0) || !(highest > lowest) || !std::isfinite(highest) || count < 1) return ticks;
  constexpr double kSlack = 1e-9;
  const int first = static_cast<int>(std::floor(std::log10(lowest)));
  const int last = static_cast<int>(std::floor(std::log10(highest)));
  for (const std::vector<double>& mantissas : kMantissas) {
    ticks.clear();
    for (int power = first; power <= last; ++power) {
      for (double mantissa : mantissas) {
        const double value = mantissa * std::pow(10.0, power);
        if (value >= lowest * (1 - kSlack) && value <= highest * (1 + kSlack)) ticks.push_back(value);
      }
    }
    if (ticks.size() <= static_cast<std::size_t>(count) + 2) break;
  }
  return ticks;
}

std::string tickText(double value, double step) {
  std::string text = fmt::format("{:.{}f}", value, decimalsOf(step));
  if (!text.empty() && text[0] == '-') text.replace(0, 1, "−");
  return text;
}

std::string unitText(const std::string& unit) {
  std::string text = unit;
  replaceAll(text, "m2", "m²");
  replaceAll(text, "m3", "m³");
  replaceAll(text, "dBu", "dBµ");
  return text;
}

std::string displayText(const std::string& text) {
  std::string shown = text;
  for (const auto& [from, to] : {std::pair{">= ", "≥ "}, {"/m2", "/m²"}, {" m2", " m²"}, {"km2", "km²"}})
    replaceAll(shown, from, to);
  return shown;
}

std::string quantityTitle(const std::string& quantity, const std::string& unit) {
  const std::size_t colon = quantity.find(':');
  std::string name = quantity.substr(0, colon);
  const std::size_t last = name.rfind('_');
  if (last != std::string::npos && !unit.empty() &&
      lowerAlphanumeric(name.substr(last)) == lowerAlphanumeric(unit)) {
    name.resize(last);
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  const std::string word = name.substr(0, name.find(' '));
  const bool is_abbreviation = word == "snr" || word == "sinr" || word == "sclnr";
  for (std::size_t i = 0; i < (is_abbreviation ? word.size() : std::min(name.size(), std::size_t{1})); ++i)
    name[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[i])));
  return colon == std::string::npos ? name : name + " of " + quantity.substr(colon + 1);
}

double FieldScale::shown(double stored) const {
  const double decibels = stored + offset_db;
  return is_amplitude ? std::pow(10.0, decibels / 20) : factor * decibels;
}

double FieldScale::stored(double shown) const {
  return (is_amplitude ? 20 * std::log10(shown) : shown / factor) - offset_db;
}

FieldScale fieldScale(const std::string& stored_unit, FieldUnit unit) {
  constexpr double kMilli_db = 30, kMicro_db = 120;
  const bool is_density = stored_unit == "dBW/m2", is_strength = stored_unit == "dBuV/m";
  if (unit == FieldUnit::stored || (!is_density && !is_strength)) return {stored_unit};
  if (unit == FieldUnit::dbm)
    return {"dBm/m2", kMilli_db - (is_strength ? kFieldStrengthOfPowerDensity_db : 0)};
  return {"V/m", (is_density ? kFieldStrengthOfPowerDensity_db : 0) - kMicro_db, 1, true};
}

void setFieldUnit(Legend& legend, const std::string& stored_unit, FieldUnit unit) {
  legend.scale = fieldScale(stored_unit, unit);
  if (legend.scale.unit != stored_unit) {  // that of the other quantity
    const bool is_strength = legend.scale.is_amplitude;
    replaceAll(legend.quantity, is_strength ? "Power density" : "Field strength",
               is_strength ? "Field strength" : "Power density");
    if (is_strength) replaceAll(legend.quantity, "power density", "field strength");
  }
  legend.unit = unitText(legend.scale.unit);
}

Legend legendOf(const volume::VolumeInfo& info, const TransferFunction& function, FieldUnit unit) {
  Legend legend;
  legend.quantity = quantityTitle(info.quantity, info.unit);
  setFieldUnit(legend, info.unit, unit);
  legend.function = function;
  const auto note = info.extra.find(volume::kLegendNoteKey);
  if (note != info.extra.end()) legend.note = note->second;
  legend.whole_numbers = info.quantity.find("count") != std::string::npos;
  return legend;
}

double legendWidth(const Style& style, const Legend& legend) {
  return 1.6 * kEdge * style.unit + contentWidth(style, legend);
}

double legendHeight(const Style& style, const Legend& legend) {
  if (!legend.function.categorical) return 0;
  const double rows = kRowHeight * style.unit *
                      static_cast<double>(legend.categories.size() + notesOf(legend).size() + 1 +
                                          (legend.hatched.empty() ? 0 : 1));
  return std::max(rows / (1 - kBarTop), leastTop(style, legend) + rows);
}

PixelArea legendHeading(ImageSize size, const Annotations& annotations) {
  const Style style(size, annotations.theme, annotations.scale);
  const Legend& legend = *annotations.legend;
  const double content = contentWidth(style, legend);
  const double gap = legend.function.categorical ? 0 : 10 * style.unit;
  const double bottom = topOf(size, style, legend) - gap;
  const double height = kLine * style.text_px * static_cast<double>(headingOf(legend).size());
  const double heading = std::min(widestText(headingOf(legend), style.text_px, Weight::bold), style.name_px);
  return {size.width - kEdge * style.unit - content, bottom - height, std::max(content, heading), height};
}

void drawLegend(Canvas& canvas, const Style& style, const Legend& legend) {
  drawLegend(canvas, style, legend, {});
}

void drawLegend(Canvas& canvas, const Style& style, const Legend& legend, LegendEnds ends) {
  const double left = canvas.size().width - kEdge * style.unit - contentWidth(style, legend);
  if (legend.function.categorical) {
    drawCategories(canvas, style, legend, left);
  } else {
    drawBar(canvas, style, legend, left, ends);
  }
}

}  // namespace emscape::render

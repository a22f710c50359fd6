#include "emscape/study/maps/products.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "base/text/display_units.h"
#include "emscape/base/error.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::study {
namespace {

constexpr std::size_t kMaxHeights = 1000;

[[noreturn]] void refuseHeights(const std::string& text, const std::string& part) {
  throw Error(ErrorCode::usage,
              fmt::format("heights '{}': '{}' must be one of agl:H,H,... agl:BEGIN:END:STEP msl:H,H,... "
                          "msl:BEGIN:END:STEP (metres; several with ';' between them)",
                          text, part));
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

const std::vector<ProductInfo>& productTable() {
  static const std::vector<ProductInfo> kTable{
      {Product::value, "value", nullptr, nullptr, "the quantity"},
      {Product::covered,
       "covered",
       "coverage",
       "",
       "1 where the quantity reaches the threshold, else 0",
       false,
       true,
       true,
       {"no", "yes"},
       1},
      {Product::margin, "margin", "margin over the threshold", "dB", "the quantity less the threshold"},
      {Product::count, "count", "number of emitters", "",
       "number of emitters that reach the threshold by themselves", false, true},
      {Product::redundancy, "redundancy", "redundancy", "",
       "number of those that may fail before none of them reaches it", false, true},
      {Product::best, "best", "best emitter", "", "the emitter with the largest value that reaches it", false,
       true},
      {Product::max_range, "max_range", "maximum range", "m",
       "distance on the ground of the farthest emitter that reaches the threshold by itself"},
      {Product::min_height, "min_height", "minimum height above ground", "m",
       "minimum height above ground that reaches the threshold, up to 10 km", false, false, false},
      {Product::jam_loss,
       "jam_loss",
       "loss to jamming",
       "",
       "1 where jamming takes the coverage away",
       false,
       true,
       true,
       {"no", "yes"},
       1},
      {Product::burn_through,
       "burn_through",
       "burn-through",
       "",
       "2 where the threshold is reached in spite of jamming, 1 where jamming takes it away, else 0",
       false,
       true,
       true,
       {"out of reach", "jammed", "covered"},
       2},
      {Product::cause,
       "cause",
       "why not covered",
       "",
       "what decides that the threshold is not reached, by the path of the emitter that is nearest to "
       "reaching it; each such pixel takes the time of a `profile`",
       false,
       true,
       true,
       {"covered", "silent", "range", "jamming", "clutter", "terrain", "pointing", "noise"},
       0},
      {Product::first_detection, "first_detection", "first detection", "s", "time of the first coverage",
       true},
      {Product::fraction, "fraction", "fraction of time covered", "", "fraction of the time with coverage",
       true},
      {Product::gaps, "gaps", "number of gaps", "", "number of the gaps in coverage", true, true},
      {Product::longest_gap, "longest_gap", "longest gap", "s", "longest time without coverage", true},
      {Product::mean_gap, "mean_gap", "mean gap", "s", "mean time of the gaps in coverage", true},
      {Product::revisit, "revisit", "revisit time", "s",
       "mean time from the beginning of a coverage to that of the next", true},
      {Product::response, "response", "response time", "s",
       "mean time until coverage, from a moment chosen at random", true},
  };
  return kTable;
}

const ProductInfo& info(Product product) {
  return productTable()[static_cast<std::size_t>(product)];
}

std::string titleOf(scenario::Quantity quantity) {
  const scenario::QuantityInfo& entry = scenario::info(quantity);
  std::string title = render::quantityTitle(entry.name, entry.unit);
  const bool is_abbreviation = title.size() > 1 && std::isupper(static_cast<unsigned char>(title[1])) != 0;
  if (!is_abbreviation) title[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(title[0])));
  return title;
}

std::string titleOf(Product product, scenario::Quantity quantity) {
  const char* const title = info(product).title;
  return title != nullptr ? title : titleOf(quantity);
}

Product productNamed(const std::string& name) {
  std::string known;
  for (const ProductInfo& entry : productTable()) {
    if (name == entry.name) return entry.product;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw Error(ErrorCode::usage, "unknown product '" + name + "'; one of " + known);
}

std::string describe(const MapHeight& height, Units units) {
  const bool above_ground = height.reference == emfield::HeightReference::ground;
  const std::string text =
      units == Units::metric ? fmt::format("{} m", height.metres) : heightText(height.metres, units);
  return text + " above " + (above_ground ? "ground" : "mean sea level");
}

std::string nameOf(const MapHeight& height) {
  const bool above_ground = height.reference == emfield::HeightReference::ground;
  return fmt::format("{}{}m", above_ground ? "agl" : "msl", height.metres);
}

std::vector<MapHeight> parseHeights(const std::string& text) {
  std::vector<MapHeight> heights;
  for (const std::string& part : split(text, ';')) {
    MapHeight height;
    if (part.rfind("msl:", 0) == 0) {
      height.reference = emfield::HeightReference::mean_sea_level;
    } else if (part.rfind("agl:", 0) != 0) {
      refuseHeights(text, part);
    }
    const auto numberOf = [&](const std::string& word) {
      std::size_t used = 0;
      double metres = NAN;
      try {
        metres = std::stod(word, &used);
      } catch (const std::exception&) {
        refuseHeights(text, part);
      }
      const bool above_ground = height.reference == emfield::HeightReference::ground;
      if (used != word.size() || !std::isfinite(metres)) refuseHeights(text, part);
      if (metres < (above_ground ? 0 : -500) || metres > 100e3) {
        throw Error(ErrorCode::usage,
                    fmt::format("heights '{}': {} m must be from {} to 100000 m above {}", text, word,
                                above_ground ? 0 : -500, above_ground ? "ground" : "mean sea level"));
      }
      return metres;
    };
    for (const std::string& item : split(part.substr(4), ',')) {
      const std::vector<std::string> range = split(item, ':');
      if (range.size() != 1 && range.size() != 3) refuseHeights(text, part);
      const double begin = numberOf(range[0]);
      double end = begin, step = 1;
      if (range.size() == 3) {
        end = numberOf(range[1]);
        step = numberOf(range[2]);
        if (!(step > 0) || end < begin) refuseHeights(text, part);
      }
      const double count = std::floor((end - begin) / step + 1e-9) + 1;
      if (static_cast<double>(heights.size()) + count > kMaxHeights) {
        throw Error(ErrorCode::usage, fmt::format("heights '{}': more than {}", text, kMaxHeights));
      }
      for (int n = 0; n < static_cast<int>(count); ++n) {
        height.metres = begin + n * step;
        heights.push_back(height);
      }
    }
  }
  return heights;
}

}  // namespace emscape::study

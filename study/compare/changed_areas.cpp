#include "study/compare/changed_areas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::study {
namespace {

using scenario::EmitterKind;

/// The pixels of the same class that are connected to a pixel along their sides; they are removed from
/// `open`.
std::vector<std::size_t> takeArea(const MapGrid& grid, std::vector<bool>& open, std::size_t first) {
  const auto width = static_cast<std::size_t>(grid.width);
  std::vector<std::size_t> pixels{first};
  open[first] = false;
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    const std::size_t p = pixels[n], column = p % width;
    const auto visit = [&](bool exists, std::size_t neighbour) {
      if (!exists || !open[neighbour]) return;
      open[neighbour] = false;
      pixels.push_back(neighbour);
    };
    visit(column > 0, p - 1);
    visit(column + 1 < width, p + 1);
    visit(p >= width, p - width);
    visit(p + width < grid.pixels(), p + width);
  }
  return pixels;
}

std::size_t middleOf(const MapGrid& grid, const std::vector<std::size_t>& pixels) {
  const auto width = static_cast<std::size_t>(grid.width);
  double column = 0, row = 0;
  for (const std::size_t p : pixels) {
    column += static_cast<double>(p % width) / static_cast<double>(pixels.size());
    row += static_cast<double>(p / width) / static_cast<double>(pixels.size());
  }
  const auto distance = [&](std::size_t p) {
    return std::hypot(static_cast<double>(p % width) - column, static_cast<double>(p / width) - row);
  };
  return *std::min_element(pixels.begin(), pixels.end(), [&](std::size_t one, std::size_t other) {
    return distance(one) != distance(other) ? distance(one) < distance(other) : one < other;
  });
}

/// The paths to one point in one scenario.
class PathsTo {
 public:
  PathsTo(const ComparedScenario& of, const ChangedArea& area, scenario::Quantity quantity)
      : terrain_(of.terrain.get()), quantity_(quantity) {
    auto own = std::make_shared<scenario::Scenario>(*of.scenario);
    own->output.radar_look = scenario::RadarAim::target;
    snapshot_ = scenario::snapshotAt(own, terrain_, area.time_s);
    height_msl_m_ = area.height.metres;
    if (area.height.reference == emfield::HeightReference::ground && terrain_ != nullptr) {
      height_msl_m_ += static_cast<double>(terrain_->heightMsl_m(area.latitude_deg, area.longitude_deg));
    }
    end_.position = {area.latitude_deg, area.longitude_deg,
                     height_msl_m_ + geoidUndulation_m(area.latitude_deg, area.longitude_deg)};
    end_.height_msl_m = height_msl_m_;
  }

  double height_msl_m() const { return height_msl_m_; }

  /// The emitter with the largest value; empty: none.
  std::string best() const {
    std::string name;
    double largest = -HUGE_VAL;
    for (const scenario::Emitter& emitter : snapshot_.scenario->emitters) {
      const bool counts = !scenario::needsRadar(quantity_) || emitter.kind == EmitterKind::radar;
      const double value = counts ? pathFrom(emitter.name).value.value_or(-HUGE_VAL) : -HUGE_VAL;
      if (value <= largest) continue;
      largest = value;
      name = emitter.name;
    }
    return name;
  }

  ExplainedPath pathFrom(const std::string& name) const {
    ExplainedPath path;
    const std::vector<scenario::Emitter>& emitters = snapshot_.scenario->emitters;
    const auto found = std::find_if(emitters.begin(), emitters.end(),
                                    [&](const auto& emitter) { return emitter.name == name; });
    if (found == emitters.end()) {
      path.verdict = fmt::format("There is no emitter '{}'.", name);
      return path;
    }
    const auto e = static_cast<std::size_t>(found - emitters.begin());
    if (!snapshot_.emitters[e].active) {
      path.verdict = fmt::format("'{}' is off.", name);
      return path;
    }
    try {
      const emfield::PathBudget budget =
          emfield::pathBudget(snapshot_, static_cast<int>(e), end_, found->propagation.model, terrain_);
      path.verdict = budget.verdict;
      if (const auto* term = budget.find(scenario::info(quantity_).name)) path.value = term->value;
      if (const auto* term = budget.find("jammer_to_signal_db")) path.jammer_to_signal_db = term->value;
    } catch (const Error& error) {
      path.verdict = error.message();
    }
    return path;
  }

 private:
  const scenario::Terrain* terrain_;
  scenario::Quantity quantity_;
  scenario::Snapshot snapshot_;
  emfield::PathEnd end_;
  double height_msl_m_ = 0;
};

}  // namespace

std::vector<ChangedArea> largestAreas(const MapGrid& grid, const std::vector<float>& changes, float changed,
                                      int most) {
  std::vector<bool> open(grid.pixels());
  for (std::size_t p = 0; p < grid.pixels(); ++p) open[p] = changes[p] == changed;
  std::vector<ChangedArea> areas;
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    if (!open[p]) continue;
    const std::vector<std::size_t> pixels = takeArea(grid, open, p);
    ChangedArea area;
    area.is_gained = changed == kGained;
    for (const std::size_t pixel : pixels) area.area_m2 += static_cast<double>(grid.areas_m2[pixel]);
    const emfield::Surface::Position& middle = grid.positions[middleOf(grid, pixels)];
    area.latitude_deg = middle.latitude_deg;
    area.longitude_deg = middle.longitude_deg;
    areas.push_back(area);
  }
  std::stable_sort(areas.begin(), areas.end(), [](const ChangedArea& one, const ChangedArea& other) {
    return one.area_m2 > other.area_m2;
  });
  areas.resize(std::min(areas.size(), static_cast<std::size_t>(std::max(most, 0))));
  return areas;
}

void explain(ChangedArea& area, scenario::Quantity quantity, const ComparedScenario& a,
             const ComparedScenario& b) {
  const PathsTo in_a(a, area, quantity), in_b(b, area, quantity);
  area.height_msl_m = in_b.height_msl_m();
  area.emitter = area.is_gained ? in_b.best() : in_a.best();
  if (area.emitter.empty()) return;
  area.a = in_a.pathFrom(area.emitter);
  area.b = in_b.pathFrom(area.emitter);
}

}  // namespace emscape::study

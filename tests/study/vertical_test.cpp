#include "emscape/study/vertical/vertical.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/study/maps/area.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::study {
namespace {

using emfield::HeightReference;
using ::testing::HasSubstr;

std::shared_ptr<const scenario::Scenario> jacksboro() {
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("jacksboro.yaml")));
  scenario->output.radar_look = scenario::RadarAim::target;
  return scenario;
}

VerticalRequest small(int emitter, HeightReference axis) {
  VerticalRequest request;
  request.emitter = emitter;
  request.axis = axis;
  request.azimuths_deg = {40, 110};
  request.time_s = 80;
  request.range_m = 12000;
  request.max_height_m = 3000;
  request.ranges = 50;
  request.heights = 40;
  return request;
}

/// Position below the values of a cut at its i-th range, at height 0.
GeodeticPosition placeOf(const VerticalDiagram& diagram, const VerticalCut& cut, std::size_t i) {
  return geodesicDirect(diagram.latitude_deg, diagram.longitude_deg, degToRad(cut.azimuth_deg),
                        diagram.ranges_m[i]);
}

emfield::PathEnd endAt(const GeodeticPosition& position, double height_msl_m) {
  const double undulation_m = geoidUndulation_m(position.latitude_deg, position.longitude_deg);
  return {{position.latitude_deg, position.longitude_deg, height_msl_m + undulation_m}, height_msl_m};
}

// The diagram reads the cells of the marches on both sides of each azimuth; `profile` marches to each point.
TEST(Vertical, SLOW_ParabolicEquationIsNearProfile) {
  auto scenario = std::make_shared<scenario::Scenario>(*jacksboro());
  constexpr int kMast = 2;
  propagation::ModelSettings& settings = scenario->emitters[kMast].propagation;
  settings.model = propagation::PropagationModel::parabolic_equation;
  settings.parabolic_equation.max_angle_deg = 10;
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const scenario::Snapshot snapshot = scenario::instantAt(scenario, terrain.get(), 80);
  VerticalRequest request = small(kMast, HeightReference::mean_sea_level);
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -40;
  request.max_height_m = 1200;
  const VerticalDiagram diagram = computeVertical(scenario, terrain, request, {});
  std::vector<double> differences_db;
  std::mt19937 random(3);
  for (int n = 0; n < 150; ++n) {
    const VerticalCut& cut = diagram.cuts[random() % 2];
    const std::size_t i = random() % 50, k = random() % 40;
    const auto value = static_cast<double>(cut.values[k * 50 + i]);
    if (std::isnan(value)) continue;
    const emfield::PathEnd end = endAt(placeOf(diagram, cut, i), diagram.heights_m[k]);
    const emfield::PathBudget budget =
        emfield::pathBudget(snapshot, kMast, end, settings.model, terrain.get());
    differences_db.push_back(std::abs(value - std::max(budget.find("power_density_dbwm2")->value, -120.0)));
  }
  ASSERT_GT(differences_db.size(), 50u);
  std::sort(differences_db.begin(), differences_db.end());
  EXPECT_LT(differences_db[differences_db.size() / 2], 1.0);
  EXPECT_LT(differences_db[differences_db.size() * 9 / 10], 4.0);  // nulls
  const auto staircases =
      std::count_if(diagram.warnings.begin(), diagram.warnings.end(),
                    [](const std::string& text) { return text.find("staircase") != std::string::npos; });
  EXPECT_EQ(staircases, 1) << "of both cuts, which have other figures";
}

// Over mountains the largest angle decides: with that of maps a point in the shadow was 20 dB and more too
// strong. What remains is the convergence of the march itself (docs/models.md).
TEST(Vertical, SLOW_ParabolicEquationOverMountainsIsNearProfile) {
  constexpr double kLatitude_deg = 44.2706, kLongitude_deg = -71.3033;
  for (const double frequency_hz : {0.3e9, 1e9}) {
    auto scenario = std::make_shared<scenario::Scenario>(*jacksboro());
    constexpr int kMast = 2;
    scenario::Emitter& emitter = scenario->emitters[kMast];
    emitter.frequency_hz = frequency_hz;
    emitter.propagation = {};
    emitter.propagation.model = propagation::PropagationModel::parabolic_equation;
    scenario->region.origin.latitude_deg = kLatitude_deg;
    scenario->region.origin.longitude_deg = kLongitude_deg;
    scenario->platforms = {scenario->platforms[static_cast<std::size_t>(emitter.platform)]};
    scenario->emitters = {emitter};
    scenario->emitters[0].platform = 0;
    scenario->placed_receivers.clear();
    scenario::SitePosition& site = scenario->platforms[0].track[0].position;
    site.latitude_deg = kLatitude_deg;
    site.longitude_deg = kLongitude_deg;
    site.height_agl_m = 20;
    scenario->terrain.emplace();
    scenario->terrain->files = {test::sourceFile("tests/data/dem/N44W072.tif")};
    scenario->terrain->locations = {{scenario->terrain->files[0]}};
    scenario->output.floor = -300;
    const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
    const scenario::Snapshot snapshot = scenario::instantAt(scenario, terrain.get(), 0);
    VerticalRequest request = small(0, HeightReference::mean_sea_level);
    request.quantity = scenario::Quantity::power_density_dbwm2;
    request.threshold = -60;
    request.time_s = 0;
    request.azimuths_deg = {20, 250};
    request.range_m = 6000;
    const VerticalDiagram diagram = computeVertical(scenario, terrain, request, {});
    std::vector<double> differences_db;
    std::mt19937 random(3);
    while (differences_db.size() < 14) {
      const VerticalCut& cut = diagram.cuts[differences_db.size() % 2];
      const std::size_t i = 15 + random() % 35, k = random() % 40;
      const double above_m = diagram.heights_m[k] - static_cast<double>(cut.ground_msl_m[i]);
      if (above_m < 20) continue;
      const emfield::PathEnd end = endAt(placeOf(diagram, cut, i), diagram.heights_m[k]);
      const emfield::PathBudget budget = emfield::pathBudget(
          snapshot, 0, end, propagation::PropagationModel::parabolic_equation, terrain.get());
      differences_db.push_back(
          std::abs(static_cast<double>(cut.values[k * 50 + i]) - budget.find("power_density_dbwm2")->value));
    }
    std::sort(differences_db.begin(), differences_db.end());
    EXPECT_LT(differences_db[7], 2) << frequency_hz;
    EXPECT_LT(differences_db[12], 8) << frequency_hz;
  }
}

/// A mast in a hollow of the hills of Jacksboro, by parabolic_equation at 5 GHz.
std::shared_ptr<scenario::Scenario> mastInAHollow() {
  auto scenario = std::make_shared<scenario::Scenario>(*jacksboro());
  constexpr int kMast = 2;
  scenario::Emitter& emitter = scenario->emitters[kMast];
  emitter.frequency_hz = 5e9;
  emitter.polarization = propagation::Polarization::horizontal;
  emitter.propagation.model = propagation::PropagationModel::parabolic_equation;
  emitter.propagation.parabolic_equation.floor_db = -120;
  scenario::SitePosition& site =
      scenario->platforms[static_cast<std::size_t>(emitter.platform)].track[0].position;
  site.latitude_deg = 36.3444;
  site.longitude_deg = -84.2534;
  site.height_agl_m = 10;
  return scenario;
}

// The ray was taken at the top of the march above other ground than its own: 120 dB were lost.
TEST(Vertical, SLOW_ParabolicEquationFollowsRaysHighAboveLowGround) {
  const std::shared_ptr<scenario::Scenario> scenario = mastInAHollow();
  constexpr int kMast = 2;
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  VerticalRequest request = small(kMast, HeightReference::mean_sea_level);
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -40;
  request.azimuths_deg = {152};
  request.range_m = 17000;
  const VerticalDiagram marched = computeVertical(scenario, terrain, request, {});
  scenario->emitters[kMast].propagation.model = propagation::PropagationModel::free_space;
  const VerticalDiagram free_space = computeVertical(scenario, terrain, request, {});
  int compared = 0;
  for (std::size_t k = 0; k < 40; ++k) {
    for (std::size_t i = 35; i < 50; ++i) {
      const double elevation_deg = marched.elevation_deg(marched.ranges_m[i], marched.heights_m[k]);
      const float value = marched.cuts[0].values[k * 50 + i];
      if (std::isnan(value) || elevation_deg < 5 || elevation_deg > 10) continue;
      EXPECT_NEAR(value, free_space.cuts[0].values[k * 50 + i], 12.0) << elevation_deg << " deg, " << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Vertical, ValueEqualsProfile) {
  const auto scenario = jacksboro();
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const scenario::Snapshot snapshot = scenario::instantAt(scenario, terrain.get(), 80);
  std::mt19937 random(3);
  constexpr int kSearchRadar = 0, kJammer = 3;
  for (const int emitter : {kSearchRadar, kJammer}) {
    for (const HeightReference axis : {HeightReference::mean_sea_level, HeightReference::ground}) {
      VerticalRequest request = small(emitter, axis);
      if (emitter == kJammer) {
        request.quantity = scenario::Quantity::power_density_dbwm2;
        request.threshold = -40;
      }
      const VerticalDiagram diagram = computeVertical(scenario, terrain, request, {});
      ASSERT_EQ(diagram.cuts.size(), 2u);
      int compared = 0;
      for (int n = 0; n < 60; ++n) {
        const VerticalCut& cut = diagram.cuts[random() % 2];
        const std::size_t i = random() % 50, k = random() % 40;
        const auto value = static_cast<double>(cut.values[k * 50 + i]);
        if (std::isnan(value)) continue;
        const GeodeticPosition position = placeOf(diagram, cut, i);
        const auto ground_m =
            static_cast<double>(terrain->heightMsl_m(position.latitude_deg, position.longitude_deg));
        EXPECT_NEAR(static_cast<double>(cut.ground_msl_m[i]), ground_m, 0.01);
        const double height_m = diagram.heights_m[k] + (axis == HeightReference::ground ? ground_m : 0);
        const emfield::PathBudget budget =
            emfield::pathBudget(snapshot, emitter, endAt(position, height_m),
                                scenario->emitters[emitter].propagation.model, terrain.get());
        if (emitter == kJammer) {
          EXPECT_NEAR(value, std::max(budget.find("power_density_dbwm2")->value, -120.0), 0.01);
        } else {
          EXPECT_NEAR(value, budget.find("detection_probability")->value, 1e-4);
        }
        ++compared;
      }
      EXPECT_GT(compared, 30);
    }
  }
}

constexpr const char* kSea = R"(schema_version: 1
name: sea
duration_s: 1
step_s: 1
region:
  origin: {latitude_deg: 0, longitude_deg: 0, height_msl_m: 0}
  frame: altitude
  size_m: [40000, 40000, 2000]
  dims: [10, 10, 10]
atmosphere: {k_factor: 1.3333333, gases: never}
ground: {kind: sea, relative_permittivity: 70, conductivity_s_m: 5}
platforms:
  - {name: ship, position: {latitude_deg: 0, longitude_deg: 0, height_msl_m: 20}}
emitters:
  - {name: set, platform: ship, kind: transmitter, frequency_hz: 1.3e9, power_w: 1000, losses_db: 0,
     polarization: horizontal, antenna: {pattern: isotropic}, propagation: two_ray}
output: {quantities: [power_density_dbwm2], floor: -160}
)";

/// The rays from 20 m to a height over the sphere of a station: the reflection is searched for.
class Lobes {
 public:
  Lobes(double radius_m, double frequency_hz) : radius_m_(radius_m), frequency_hz_(frequency_hz) {}

  double powerDensity_dbwm2(double range_m, double height_m) const {
    const double angle = range_m / radius_m_;
    const auto sineOf = [&](double part, double from_m, double& length_m) {
      const double from = radius_m_ + from_m;
      length_m = std::sqrt(from_m * from_m + 4 * radius_m_ * from * std::pow(std::sin(part / 2), 2));
      return (from * std::cos(part) - radius_m_) / length_m;
    };
    double low = 0, high = angle, r1 = 0, r2 = 0, sine = 0;
    for (int n = 0; n < 200; ++n) {
      const double middle = (low + high) / 2;
      sine = sineOf(middle, kAntenna_m, r1);
      (sine > sineOf(angle - middle, height_m, r2) ? low : high) = middle;
    }
    const double direct =
        std::sqrt(std::pow(height_m - kAntenna_m, 2) +
                  4 * (radius_m_ + kAntenna_m) * (radius_m_ + height_m) * std::pow(std::sin(angle / 2), 2));
    const double wavelength = wavelength_m(frequency_hz_);
    const std::complex<double> permittivity(70, -60 * wavelength * 5);
    const std::complex<double> root = std::sqrt(permittivity - (1 - sine * sine));
    const std::complex<double> fresnel = (sine - root) / (sine + root);
    const double divergence = 1 / std::sqrt(1 + 2 * r1 * r2 / (radius_m_ * (r1 + r2) * sine));
    const std::complex<double> sum =
        1.0 + divergence * fresnel * std::polar(1.0, -2 * kPi / wavelength * (r1 + r2 - direct));
    return ratioToDb(1000 / (4 * kPi * direct * direct) * std::norm(sum));
  }

  static constexpr double kAntenna_m = 20;

 private:
  double radius_m_, frequency_hz_;
};

/// Heights of the deep minima of a curve, by parabolas through three samples.
template <class Function>
std::vector<double> minima(double begin, double end, double step, const Function& function) {
  std::vector<double> found;
  for (double at = begin + step; at + step < end; at += step) {
    const double before = function(at - step), here = function(at), after = function(at + step);
    if (here > before || here >= after) continue;
    found.push_back(at + step / 2 * (before - after) / (before - 2 * here + after));
  }
  return found;
}

TEST(Vertical, HasTheLobesOfTwoRaysOverTheSea) {
  const test::TemporaryFolder folder;
  test::writeFile(folder / "sea.yaml", kSea);
  const auto scenario = scenario::loadScenario(folder / "sea.yaml");
  VerticalRequest request;
  request.azimuths_deg = {90};
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -60;
  request.range_m = 10000;
  request.max_height_m = 600;
  request.ranges = 20;
  request.heights = 1201;
  request.smooth_earth = true;
  const VerticalDiagram diagram = computeVertical(scenario, nullptr, request, {});
  EXPECT_NEAR(diagram.k_factor, 4.0 / 3, 1e-6);
  const Lobes lobes(diagram.effective_earth_radius_m, 1.3e9);
  for (const std::size_t i : {9u, 14u, 19u}) {
    const auto diagramAt = [&](double height_m) {
      const auto k = static_cast<std::size_t>(std::lround(height_m / 0.5));
      return static_cast<double>(diagram.cuts[0].values[k * 20 + i]);
    };
    const auto lobesAt = [&](double height_m) {
      return lobes.powerDensity_dbwm2(diagram.ranges_m[i], height_m);
    };
    double largest_db = 0;
    for (double height_m = 20; height_m <= 600; height_m += 0.5) {
      // In the nulls, where the rays' amplitudes nearly cancel, only the position is compared.
      if (lobesAt(height_m) < ratioToDb(1000 / (4 * kPi * std::pow(diagram.ranges_m[i], 2))) - 15) continue;
      largest_db = std::max(largest_db, std::abs(diagramAt(height_m) - lobesAt(height_m)));
    }
    EXPECT_LT(largest_db, 0.1) << diagram.ranges_m[i];
    const std::vector<double> expected = minima(20, 600, 0.5, lobesAt),
                              nulls = minima(20, 600, 0.5, diagramAt);
    ASSERT_EQ(nulls.size(), expected.size());
    ASSERT_GT(nulls.size(), 5u);
    for (std::size_t n = 0; n < nulls.size(); ++n) EXPECT_NEAR(nulls[n], expected[n], 0.01 * expected[n]);
  }
}

TEST(Vertical, ContoursAreOnTheThreshold) {
  const test::TemporaryFolder folder;
  test::writeFile(folder / "sea.yaml", kSea);
  const auto scenario = scenario::loadScenario(folder / "sea.yaml");
  VerticalRequest request;
  request.azimuths_deg = {0};
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -60;
  request.range_m = 40000;
  request.max_height_m = 20000;
  request.smooth_earth = true;
  const VerticalDiagram diagram = computeVertical(scenario, nullptr, request, {});
  EXPECT_GT(diagram.cuts[0].contours.size(), 0u);
  ASSERT_EQ(diagram.cuts[0].free_space.size(), 1u);
  // 1 kW spread over a sphere is -60 dBW/m2 at 8921 m.
  for (const VerticalCut::Point& point : diagram.cuts[0].free_space[0]) {
    EXPECT_NEAR(diagram.slantRange_m(point.range_m, point.height_m), std::sqrt(1e9 / (4 * kPi)), 15);
  }
}

TEST(Vertical, AnglesAndRangesOfTheChartAgree) {
  VerticalDiagram diagram;
  diagram.effective_earth_radius_m = 8.5e6;
  diagram.station_msl_m = 30;
  for (const double range_m : {500.0, 20e3, 300e3}) {
    for (const double height_m : {0.0, 200.0, 12e3}) {
      const double slant_m = diagram.slantRange_m(range_m, height_m);
      EXPECT_NEAR(diagram.groundRange_m(slant_m, height_m), range_m, 1e-3 * range_m / 500);
      EXPECT_NEAR(diagram.rayHeight_msl_m(slant_m, diagram.elevation_deg(range_m, height_m)), height_m, 1e-3);
    }
  }
  EXPECT_TRUE(std::isnan(diagram.groundRange_m(1000, 5000))) << "below the zenith";
}

TEST(Vertical, TheGroundHasGapsWhereTheTerrainIsMissing) {
  const auto scenario = jacksboro();
  VerticalRequest request = small(0, HeightReference::mean_sea_level);
  request.azimuths_deg = {30};
  VerticalDiagram diagram = computeVertical(scenario, scenario::loadTerrain(*scenario), request, {});
  std::vector<float>& ground_m = diagram.cuts[0].ground_msl_m;
  std::fill(ground_m.begin(), ground_m.end(), 1000.0f);
  std::fill(ground_m.begin() + ground_m.size() / 3, ground_m.end() - ground_m.size() / 3, NAN);
  std::fill(diagram.cuts[0].values.begin(), diagram.cuts[0].values.end(), NAN);
  const test::TemporaryFolder folder;
  plotVertical(diagram, {1400, 800}, folder / "gap.png");
  const render::Image8 image = render::readPng(folder / "gap.png");
  const auto isSky = [&](int x) {
    const std::uint8_t* const pixel = image.at(x, 740);  // just above the abscissa
    return pixel[2] > pixel[0];
  };
  EXPECT_FALSE(isSky(200));
  EXPECT_TRUE(isSky(676));
  EXPECT_FALSE(isSky(1150));
}

TEST(Vertical, PicturesHaveRoomForAllPanels) {
  for (const std::size_t azimuths : {1, 2, 4})
    EXPECT_EQ(verticalPlotSize(azimuths), (render::ImageSize{1400, 800}));
  EXPECT_EQ(verticalPlotSize(20), (render::ImageSize{1400, 3616}));
  for (const std::size_t azimuths : {1, 20, 180}) checkVerticalPlot(verticalPlotSize(azimuths), azimuths);
  checkVerticalPlot({1400, 800}, 5);
  EXPECT_THAT(test::errorOf([] {
                checkVerticalPlot({1400, 800}, 6);
              }),
              HasSubstr("a picture of 1400x800 pixels has no room for 6 azimuths, a panel each; at most 5"));
  checkVerticalPlot({10, 10}, 1);
}

TEST(Vertical, HiddenEmittersTakeNoMemory) {
  auto scenario = std::make_shared<scenario::Scenario>(*jacksboro());
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  VerticalRequest request = small(2, HeightReference::ground);
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.ranges = 400;
  request.heights = 300;
  scenario->emitters[2].propagation = {};
  scenario->emitters[2].propagation.model = propagation::PropagationModel::free_space;
  const VerticalDiagram few = computeVertical(scenario, terrain, request, {});
  scenario->emitters.insert(scenario->emitters.begin(), 30000, scenario->emitters[2]);
  request.emitter += 30000;
  const VerticalDiagram many = computeVertical(scenario, terrain, request, {});
  EXPECT_EQ(many.emitter, few.emitter);
  EXPECT_THAT(many.cuts[1].values,
              ::testing::Pointwise(::testing::NanSensitiveFloatEq(), few.cuts[1].values));
}

TEST(Vertical, RefusesInvalidOptions) {
  const auto scenario = jacksboro();
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const auto refusalOf = [&](const VerticalRequest& request) {
    return test::errorOf([&] { computeVertical(scenario, terrain, request, {}); });
  };
  VerticalRequest request = small(2, HeightReference::ground);
  EXPECT_THAT(refusalOf(request), HasSubstr("'communications mast' is a transmitter"));
  request = small(0, HeightReference::ground);
  request.smooth_earth = true;
  EXPECT_THAT(refusalOf(request), HasSubstr("above mean sea level"));
  request = small(0, HeightReference::ground);
  request.range_m = 10;
  EXPECT_THAT(refusalOf(request), HasSubstr("range: 10 m; 100 to 1990000 m"));
  request = small(0, HeightReference::ground);
  request.quantity = scenario::Quantity::emitter_count;
  EXPECT_THAT(refusalOf(request), HasSubstr("no value of one emitter"));
  request = small(0, HeightReference::mean_sea_level);
  for (const double max_height_m : {100.0, -100.0}) {
    request.max_height_m = max_height_m;
    EXPECT_THAT(refusalOf(request), HasSubstr("lowest ground"));
  }
  request.max_height_m = -501;
  EXPECT_THAT(refusalOf(request), HasSubstr("height: -501 m; -500 to 100000 m"));
  request.smooth_earth = true;
  request.max_height_m = 5;
  EXPECT_THAT(refusalOf(request), HasSubstr("height: 5 m; 10 to 100000 m"));
}

}  // namespace
}  // namespace emscape::study

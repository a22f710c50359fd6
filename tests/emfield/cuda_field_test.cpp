// The field on one GPU, and shared out over two, against the field on the CPU.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "emfield/solver/column_step.h"
#include "emscape/base/cuda/device.h"
#include "emscape/emfield/solver/field_solver.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/random_profile.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"
#include "tests/support/gpu.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;
using ::testing::HasSubstr;

constexpr double kLatitude_deg = 44.5, kLongitude_deg = -71.5;

/// Of a number of GPUs.
class CudaField : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    EMSCAPE_NEEDS_GPU();
    setDeviceLimit(0);
    if (deviceCount() < GetParam()) GTEST_SKIP() << "this system has one GPU";
    setDeviceLimit(GetParam());
  }
  void TearDown() override { setDeviceLimit(1); }
};
INSTANTIATE_TEST_SUITE_P(Gpus, CudaField, ::testing::Values(1, 2));

scenario::AntennaPtr antennaOf(int kind) {
  switch (kind % 5) {
    case 0:
      return scenario::makeIsotropic(3);
    case 1:
      return scenario::makeGaussian(30, 6, 8, -40);
    case 2:
      return scenario::makeCosecant2(32, 8, 5, 40, -45);
    case 3:
      return scenario::makeSinc(30, 5, 5, -60);
    default:
      return scenario::makePhasedArray(28, 16, 16, 0.5, 1);
  }
}

/// Emitters at random positions in a region 40 km wide, with all antennas and the given models in turn.
std::shared_ptr<scenario::Scenario> randomScenario(std::mt19937& random, FrameKind frame,
                                                   const std::vector<PropagationModel>& models,
                                                   double height_m, int count = 8) {
  auto scenario = emptyScenario(frame, kLatitude_deg, kLongitude_deg, {40e3, 36e3, 5000}, {61, 50, 29});
  std::uniform_real_distribution<double> part(-1, 1);
  for (int e = 0; e < count; ++e) {
    scenario::Emitter emitter = plainEmitter("emitter " + std::to_string(e), 0);
    emitter.kind = e % 3 == 0 ? scenario::EmitterKind::radar : scenario::EmitterKind::transmitter;
    emitter.frequency_hz = std::pow(10.0, 8.5 + part(random));
    emitter.power_w = std::pow(10.0, 3 + part(random));
    emitter.antenna = antennaOf(e);
    emitter.scan.azimuth_deg = 180 * part(random);
    emitter.scan.elevation_deg = 5 * part(random);
    emitter.propagation.model = models[static_cast<std::size_t>(e) % models.size()];
    const GeodeticPosition place{kLatitude_deg + 0.15 * part(random), kLongitude_deg + 0.2 * part(random),
                                 height_m + 300 * part(random)};
    addEmitter(*scenario, place, emitter);
  }
  return scenario;
}

/// Differences of two volumes, voxel by voxel.
struct Difference {
  long long voxels = 0;
  std::vector<float> apart_db;
  double largest_db = 0, largest_off_edges_db = 0;  // off edges: where above 0.1 dB, else 0

  void look(const volume::DenseVolume& cpu, const volume::DenseVolume& gpu) {
    const Dims& dims = cpu.grid.dims;
    ASSERT_EQ(cpu.values.size(), gpu.values.size());
    ASSERT_EQ(cpu.first_valid_k, gpu.first_valid_k);
    for (int k = 0; k < dims.z; ++k) {
      for (int j = 0; j < dims.y; ++j) {
        for (int i = 0; i < dims.x; ++i) {
          const double a = valueAt(cpu, i, j, k), b = valueAt(gpu, i, j, k);
          ASSERT_FALSE(std::isnan(b));
          if (cpu.isMasked(i, j, k)) {
            ASSERT_EQ(b, double(gpu.info.floor));
            continue;
          }
          ++voxels;
          apart_db.push_back(static_cast<float>(std::abs(a - b)));
          largest_db = std::max(largest_db, std::abs(a - b));
          if (std::abs(a - b) > 0.1 && !isBetweenNeighbours(cpu, i, j, k, b))
            largest_off_edges_db = std::max(largest_off_edges_db, std::abs(a - b));
        }
      }
    }
    EXPECT_NEAR(cpu.info.range_max, gpu.info.range_max, 0.01);
  }

  /// At a shadow's edge a voxel may be illuminated or dark: it then equals the one above or the one below it.
  static bool isBetweenNeighbours(const volume::DenseVolume& cpu, int i, int j, int k, double value) {
    double lowest = valueAt(cpu, i, j, k), highest = lowest;
    for (int n : {k - 1, k + 1}) {
      if (n < 0 || n >= cpu.grid.dims.z || cpu.isMasked(i, j, n)) continue;
      lowest = std::min<double>(lowest, valueAt(cpu, i, j, n));
      highest = std::max<double>(highest, valueAt(cpu, i, j, n));
    }
    return value > lowest - 0.5 && value < highest + 0.5 && highest - lowest > 0.1;
  }

  long long beyond(double bound_db) const {
    return std::count_if(apart_db.begin(), apart_db.end(),
                         [=](float db) { return static_cast<double>(db) > bound_db; });
  }
  /// @param bound_db            of all voxels but one in a thousand
  /// @param bound_off_edges_db  of all voxels that are not at the edge of a shadow; at least 0.1
  void expectSmall(double bound_db = 0.01, double bound_off_edges_db = 0.1) const {
    EXPECT_LE(static_cast<double>(beyond(bound_db)), 1e-3 * static_cast<double>(voxels))
        << "of " << voxels << " voxels; largest " << largest_db << " dB";
    EXPECT_LE(largest_off_edges_db, bound_off_edges_db) << "of " << voxels << " voxels";
  }
};

/// Two solvers of one scenario that compute the same snapshots.
class Pair {
 public:
  Pair(std::shared_ptr<scenario::Scenario> scenario, scenario::TerrainPtr terrain, FieldOptions options = {})
      : scenario_(std::move(scenario)),
        terrain_(std::move(terrain)),
        cpu_(scenario_, terrain_, with(options, Backend::cpu)),
        gpu_(scenario_, terrain_, with(options, Backend::cuda)) {}

  scenario::Snapshot start() const { return scenario::snapshotAt(scenario_, terrain_.get(), 0); }

  void update(const scenario::Snapshot& snapshot) {
    const FieldChanged a = cpu_.update(snapshot), b = gpu_.update(snapshot);
    EXPECT_EQ(a.moved, b.moved);
    EXPECT_EQ(a.turned, b.turned);
    for (std::size_t c = 0; c < cpu_.channels().size(); ++c) {
      SCOPED_TRACE(cpu_.channels()[c].name);
      difference_.look(*cpu_.volumes()[c].host(), *gpu_.volumes()[c].host());
    }
    EXPECT_EQ(cpu_.warnings(), gpu_.warnings());
  }

  const Difference& difference() const { return difference_; }
  FieldSolver& gpu() { return gpu_; }
  void setTimeGoal(double goal_ms) {
    cpu_.setTimeGoal(goal_ms);
    gpu_.setTimeGoal(goal_ms);
  }
  /// Step between columns, of both.
  int columnStep() const {
    EXPECT_EQ(cpu_.columnStep(), gpu_.columnStep());
    return gpu_.columnStep();
  }

 private:
  static FieldOptions with(FieldOptions options, Backend backend) {
    options.backend = backend;
    return options;
  }

  std::shared_ptr<scenario::Scenario> scenario_;
  scenario::TerrainPtr terrain_;
  FieldSolver cpu_, gpu_;
  Difference difference_;
};

/// Moves, turns and switches some emitters.
void disturb(scenario::Snapshot& snapshot, std::mt19937& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  for (scenario::EmitterState& emitter : snapshot.emitters) {
    const double what = part(random);
    if (what > 0.6) {
      emitter.position.latitude_deg += 0.02 * part(random);
      emitter.position.longitude_deg += 0.02 * part(random);
    } else if (what > 0) {
      const double angle = kPi * part(random), c = std::cos(angle), s = std::sin(angle);
      for (Vec3d* axis : {&emitter.beam.forward, &emitter.beam.right, &emitter.beam.up}) {
        *axis = {c * axis->x + s * axis->y, -s * axis->x + c * axis->y, axis->z};
      }
      emitter.beam.steer_u = 0.3 * part(random);
    } else if (what < -0.8) {
      emitter.active = !emitter.active;
    }
  }
}

void expectSameField(Pair& pair, std::mt19937& random, int updates) {
  scenario::Snapshot snapshot = pair.start();
  for (int n = 0; n < updates; ++n) {
    pair.update(snapshot);
    if (::testing::Test::HasFatalFailure()) return;
    disturb(snapshot, random);
  }
  pair.difference().expectSmall();
}

TEST_P(CudaField, EqualsCpuOverSmoothEarth) {
  std::mt19937 random(1);
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    const auto scenario = randomScenario(
        random, frame,
        {PropagationModel::free_space, PropagationModel::horizon, PropagationModel::diffraction}, 600);
    Pair pair(scenario, nullptr);
    expectSameField(pair, random, 5);
  }
}

TEST_P(CudaField, EqualsCpuOverTerrain) {
  std::mt19937 random(2);
  for (const PropagationModel model : {PropagationModel::horizon, PropagationModel::diffraction}) {
    SCOPED_TRACE(toString(model));
    for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
      const auto scenario = randomScenario(random, frame, {model}, 1900);
      Pair pair(scenario, std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0));
      expectSameField(pair, random, frame == FrameKind::enu ? 1 : 4);
    }
  }
}

TEST_P(CudaField, APartOfTheColumnsEqualsThatOfTheCpuAndIsCompleted) {
  std::mt19937 random(14);
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    const auto scenario = randomScenario(
        random, frame,
        {PropagationModel::diffraction, PropagationModel::horizon, PropagationModel::diffraction}, 1900);
    scenario->region.dims = {242, 201, 32};  // so that the columns take longer than the sums
    FieldOptions options;
    options.allow_missing_terrain = true;
    Pair pair(scenario, std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, 0.02),
              options);
    scenario::Snapshot snapshot = pair.start();
    const auto move = [&] {
      for (scenario::EmitterState& emitter : snapshot.emitters) emitter.position.latitude_deg += 0.01;
      pair.update(snapshot);
    };
    pair.update(snapshot);
    move();  // measured, unlike the first one, without making memory
    EXPECT_EQ(pair.columnStep(), 1);
    constexpr double kUnreachable_ms = 1e-3;
    pair.setTimeGoal(kUnreachable_ms);
    move();
    EXPECT_EQ(pair.columnStep(), ColumnPace::kMaxStep);
    pair.setTimeGoal(0);
    pair.update(snapshot);
    EXPECT_EQ(pair.columnStep(), 1);
    pair.difference().expectSmall();
  }
}

TEST_P(CudaField, LeaningColumnsEqualCpu) {
  std::mt19937 random(11);
  const auto scenario = randomScenario(random, FrameKind::enu, {PropagationModel::diffraction}, 1900, 3);
  scenario->region.size_m = {60e3, 60e3, 40e3};
  scenario->region.dims = {100, 80, 30};
  scenario->atmosphere.rain_mm_h = 5;
  Pair pair(scenario, std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0));
  expectSameField(pair, random, 2);
}

TEST_P(CudaField, EveryModelEqualsCpu) {
  std::mt19937 random(10);
  const auto terrain = std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0);
  for (const PropagationModel model :
       {PropagationModel::free_space, PropagationModel::diffraction, PropagationModel::two_ray,
        PropagationModel::itm, PropagationModel::p528, PropagationModel::p1812, PropagationModel::p452}) {
    SCOPED_TRACE(toString(model));
    const auto scenario = randomScenario(random, FrameKind::altitude, {model}, 1900, 3);
    for (scenario::Emitter& emitter : scenario->emitters) {
      emitter.antenna = scenario::makeIsotropic();
      emitter.frequency_hz = std::max(emitter.frequency_hz, 2e8);
    }
    scenario->emitters[1].propagation.diffraction.method = propagation::DiffractionMethod::deygout;
    scenario->atmosphere.gases = propagation::GasLosses::always;
    scenario->atmosphere.rain_mm_h = 5;
    Pair pair(scenario, terrain);
    expectSameField(pair, random, 2);
  }
}

/// Hills up to 300 m high; the hole is in the north-east.
scenario::TerrainPtr gentleHills(bool has_hole) {
  return std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 0.6, [=](double east_deg, double north_deg) {
        if (has_hole && std::abs(east_deg - 0.38) < 0.02 && std::abs(north_deg - 0.35) < 0.02)
          return std::numeric_limits<double>::quiet_NaN();
        return 150 + 100 * std::sin(80 * east_deg + 1) * std::cos(50 * north_deg) +
               50 * std::sin(190 * north_deg + 40 * east_deg);
      });
}

// A warp a column on the GPU; area mode, few and many heights, and columns that lean.
TEST_P(CudaField, ItmNearTheGroundEqualsCpu) {
  std::mt19937 random(21);
  const auto hills = gentleHills(false);
  for (const auto& [frame, layers, height_m] : {std::tuple{FrameKind::altitude, 29, 350.0},
                                                {FrameKind::altitude, 70, 320.0},
                                                {FrameKind::enu, 5, 400.0}}) {
    const auto scenario = randomScenario(random, frame, {PropagationModel::itm}, height_m, 3);
    scenario->region.size_m = {40e3, 36e3, layers > 30 ? 2500.0 : 5000.0};
    scenario->region.dims.z = layers;
    for (scenario::Emitter& emitter : scenario->emitters) {
      emitter.antenna = scenario::makeIsotropic();
      emitter.frequency_hz = std::max(emitter.frequency_hz, 1e8);
    }
    scenario->emitters[2].propagation.itm.form = propagation::ItmForm::area;
    FieldOptions options;
    options.allow_missing_terrain = true;
    Pair pair(scenario, hills, options);
    expectSameField(pair, random, 2);
  }
}

/// Two emitters of the parabolic equation 50 m above the hills' tops, over a region 24 km wide.
std::shared_ptr<scenario::Scenario> marchedScenario(propagation::Polarization polarization) {
  auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {24e3, 24e3, 1500}, {50, 50, 20});
  for (const double east_deg : {-0.02, 0.03}) {
    scenario::Emitter emitter = plainEmitter(east_deg < 0 ? "west" : "east", 0);
    emitter.frequency_hz = 4e8;
    emitter.polarization = polarization;
    emitter.antenna = scenario::makeIsotropic();
    emitter.propagation.model = PropagationModel::parabolic_equation;
    addEmitter(*scenario, {kLatitude_deg, kLongitude_deg + east_deg, 350}, emitter);
  }
  return scenario;
}

TEST_P(CudaField, MarchesEqualCpu) {
  using propagation::Polarization;
  FieldOptions options;
  options.allow_missing_terrain = true;
  for (const Polarization polarization :
       {Polarization::horizontal, Polarization::vertical, Polarization::circular_right}) {
    for (const bool has_hole : {false, true}) {
      Pair pair(marchedScenario(polarization), gentleHills(has_hole), options);
      pair.update(pair.start());
      pair.difference().expectSmall(0.05);
    }
  }
}

// Tilted columns have positions between the layers.
TEST_P(CudaField, MarchesThroughLeaningColumnsEqualCpu) {
  const auto scenario = marchedScenario(propagation::Polarization::horizontal);
  scenario->region.origin.kind = FrameKind::enu;
  Pair pair(scenario, gentleHills(false));
  pair.update(pair.start());
  // 0.106 dB in one of 45,262 voxels: cubics in azimuth and range multiply differences of the marches by up
  // to 1.6.
  pair.difference().expectSmall(0.05, 0.15);
}

// With more heights than a thread block can hold, the CPU marches.
TEST_P(CudaField, MarchesOfManyHeightsEqualCpu) {
  const auto scenario = marchedScenario(propagation::Polarization::horizontal);
  scenario->region.size_m = {6e3, 6e3, 1500};
  scenario->region.dims = {12, 12, 20};
  for (scenario::Emitter& emitter : scenario->emitters) {
    emitter.frequency_hz = 5e9;
    emitter.propagation.parabolic_equation.max_angle_deg = 5;
  }
  Pair pair(scenario, gentleHills(false));
  pair.update(pair.start());
  pair.difference().expectSmall(0.05);
}

TEST_P(CudaField, MarchesOfAnEnsembleEqualCpu) {
  for (const std::optional<double> quantile : {std::optional<double>(), std::optional<double>(0.7)}) {
    const auto scenario = marchedScenario(propagation::Polarization::horizontal);
    auto air = std::make_shared<propagation::Refractivity>();
    for (const double height_m : {5.0, 12.0, 20.0}) {
      propagation::RefractivityField member;
      member.profiles = {propagation::evaporationDuct(height_m)};
      air->members.push_back(member);
    }
    air->air = air->members.front();
    air->quantile = quantile;
    scenario->atmosphere.refractivity = air;
    Pair pair(scenario, gentleHills(false));
    pair.update(pair.start());
    pair.difference().expectSmall(0.05);
  }
}

TEST_P(CudaField, ReflectedRaysInEveryPatternEqualCpu) {
  // The codes of reflected rays may differ by one step, which changes nulls 40 dB deep by 0.02 dB.
  std::mt19937 random(12);
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    for (const auto look : {scenario::RadarAim::scan, scenario::RadarAim::target}) {
      const auto scenario = randomScenario(random, frame,
                                           {PropagationModel::two_ray, PropagationModel::two_ray,
                                            PropagationModel::two_ray, PropagationModel::horizon},
                                           600, 12);
      for (std::size_t e = 0; e < scenario->emitters.size(); ++e) {
        scenario->emitters[e].frequency_hz = 4e8;
        if (e % 3 == 1) scenario->emitters[e].kind = scenario::EmitterKind::jammer;
        if (e % 4 == 1) scenario->emitters[e].propagation.two_ray.sum = propagation::TwoRaySum::envelope;
      }
      scenario->output.radar_look = look;
      scenario->output.quantities = {"power_density_dbwm2", "snr_db", "jammer_to_signal_db"};
      Pair pair(scenario, nullptr);
      expectSameField(pair, random, 3);
    }
  }
}

TEST_P(CudaField, EqualsCpuOverRealTerrain) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  std::mt19937 random(3);
  const auto scenario = randomScenario(random, FrameKind::altitude,
                                       {PropagationModel::horizon, PropagationModel::diffraction}, 1700);
  Pair pair(scenario, terrain);
  expectSameField(pair, random, 4);
}

TEST_P(CudaField, EveryReductionEqualsCpu) {
  std::mt19937 random(4);
  for (const auto combine :
       {scenario::CombineMode::sum, scenario::CombineMode::max, scenario::CombineMode::per_emitter}) {
    const auto scenario = randomScenario(random, FrameKind::altitude,
                                         {PropagationModel::free_space, PropagationModel::horizon}, 900);
    scenario->output.combine = combine;
    scenario->output.quantities = {"power_density_dbwm2", "snr_db", "field_strength_dbuvm"};
    Pair pair(scenario, nullptr);
    expectSameField(pair, random, 4);
  }
  // Counts and indices differ by whole numbers where a voxel lies on a border.
  const auto scenario = randomScenario(random, FrameKind::altitude, {PropagationModel::free_space}, 900);
  scenario->output.quantities = {"emitter_count", "dominant_emitter"};
  Pair pair(scenario, nullptr);
  scenario::Snapshot snapshot = pair.start();
  for (int n = 0; n < 3; ++n) {
    pair.update(snapshot);
    disturb(snapshot, random);
  }
  EXPECT_LE(static_cast<double>(pair.difference().beyond(0.01)),
            1e-3 * static_cast<double>(pair.difference().voxels));
}

TEST_P(CudaField, RadarProductsEqualCpu) {
  std::mt19937 random(6);
  for (const auto look : {scenario::RadarAim::scan, scenario::RadarAim::target}) {
    const auto scenario = randomScenario(random, FrameKind::altitude,
                                         {PropagationModel::free_space, PropagationModel::horizon}, 900, 12);
    for (std::size_t e = 0; e < scenario->emitters.size(); ++e) {
      scenario->emitters[e].frequency_hz = 1e9;
      if (e % 3 == 1) scenario->emitters[e].kind = scenario::EmitterKind::jammer;
      if (e % 6 == 1) scenario->emitters[e].waveform = scenario::Waveform{1000, 2e-4, {}};
      if (e % 6 == 0) scenario->emitters[e].receiver.side_lobe_blanking = scenario::SideLobeBlanking{5, 0};
    }
    scenario->output.radar_look = look;
    scenario->output.quantities = {"snr_db", "detection_probability", "jammer_to_signal_db",
                                   "burn_through_margin_db"};
    Pair pair(scenario, nullptr);
    expectSameField(pair, random, 4);
  }
}

// Scans whose bursts leave azimuths, and bars of rasters, without a look.
TEST_P(CudaField, LooksInBurstsEqualCpu) {
  std::mt19937 random(13);
  for (const char* quantity : {"detection_probability", "detection_age_s"}) {
    for (const auto kind : {scenario::IntervalKind::max_hold, scenario::IntervalKind::cumulative}) {
      const bool is_age = std::string(quantity) == "detection_age_s";
      if (is_age && kind != scenario::IntervalKind::cumulative) continue;
      SCOPED_TRACE(::testing::Message() << quantity << ", " << toString(kind));
      const auto scenario = randomScenario(
          random, FrameKind::altitude, {PropagationModel::free_space, PropagationModel::horizon}, 900, 12);
      for (std::size_t e = 0; e < scenario->emitters.size(); ++e) {
        scenario::Emitter& emitter = scenario->emitters[e];
        emitter.frequency_hz = 1e9;
        if (e % 3 == 1) emitter.kind = scenario::EmitterKind::jammer;
        if (e % 3 != 0) continue;
        using scenario::ScanKind;
        const ScanKind scans[] = {ScanKind::rotate, ScanKind::sector,
                                  is_age ? ScanKind::sector : ScanKind::raster};
        emitter.scan.kind = scans[e / 3 % 3];
        emitter.scan.rate_rpm = 10;
        emitter.scan.width_deg = 100;
        emitter.scan.rate_deg_s = 50;
        emitter.scan.bars = emitter.scan.kind == ScanKind::raster ? 3 : 1;
        emitter.scan.elevation_step_deg = 6;
        emitter.active_s = {{0.4, 1.3}, {3.1, 4.4}, {6.2, 7.3}};
      }
      scenario->output.quantities = {quantity};
      scenario->output.interval = {kind, 8.0, {}};
      Pair pair(scenario, nullptr);
      expectSameField(pair, random, 3);
    }
  }
}

TEST_P(CudaField, MasksTheSameColumnsAcrossMissingTerrain) {
  std::mt19937 random(5);
  const auto terrain = std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, 0.05);
  FieldOptions options;
  options.allow_missing_terrain = true;
  for (const PropagationModel model : {PropagationModel::horizon, PropagationModel::diffraction}) {
    SCOPED_TRACE(toString(model));
    auto scenario = randomScenario(random, FrameKind::altitude, {model}, 1900, 3);
    scenario->region.size_m = {60e3, 60e3, 5000};
    Pair pair(scenario, terrain, options);
    expectSameField(pair, random, 2);
    const auto mask = pair.gpu().volumes().front().host()->first_valid_k;
    EXPECT_GT(std::count(mask.begin(), mask.end(), 29), 20);
    options.backend = Backend::cuda;
    options.allow_missing_terrain = false;
    EXPECT_THROW(FieldSolver(scenario, terrain, options), Error);
    options.allow_missing_terrain = true;
  }
}

TEST_P(CudaField, EmittersBeyondMemoryBoundAreComputedAgain) {
  std::mt19937 random(6);
  FieldOptions options;
  options.cache_bytes = 61 * 50 * 40 * 3 + 1;
  Pair pair(randomScenario(random, FrameKind::altitude, {PropagationModel::horizon}, 900), nullptr, options);
  expectSameField(pair, random, 4);
  EXPECT_EQ(pair.gpu().memoryUse().uncached_emitters, 5);
}

TEST_P(CudaField, KeepsVolumesThatACallerHolds) {
  std::mt19937 random(7);
  Pair pair(randomScenario(random, FrameKind::altitude, {PropagationModel::horizon}, 900), nullptr);
  scenario::Snapshot snapshot = pair.start();
  pair.update(snapshot);
  EXPECT_EQ(pair.gpu().backend(), Backend::cuda);
  const auto kept = pair.gpu().volumes().front().device();
  const auto values = kept->download().values;
  for (int n = 0; n < 3; ++n) {
    for (scenario::EmitterState& emitter : snapshot.emitters) emitter.position.latitude_deg += 0.01;
    pair.update(snapshot);
    EXPECT_NE(pair.gpu().volumes().front().device(), kept);
  }
  EXPECT_EQ(kept->download().values, values);
  EXPECT_NE(pair.gpu().volumes().front().host()->values, values);
}

TEST_P(CudaField, InHalfPrecisionLiesWithinItsSteps) {
  std::mt19937 random(8);
  const auto scenario = randomScenario(random, FrameKind::altitude, {PropagationModel::free_space}, 900);
  FieldOptions options;
  options.backend = Backend::cuda;
  FieldSolver single(scenario, nullptr, options);
  options.device_precision = volume::VoxelPrecision::float16;
  FieldSolver half(scenario, nullptr, options);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  single.update(snapshot);
  half.update(snapshot);
  const auto a = single.volumes().front().host(), b = half.volumes().front().host();
  for (std::size_t v = 0; v < a->values.size(); ++v) {
    ASSERT_NEAR(a->values[v], b->values[v], std::abs(a->values[v]) / 2048);
  }
}

TEST_P(CudaField, EmittersThatRemainKeepTheirGeometry) {
  std::mt19937 random(14);
  const auto before = randomScenario(random, FrameKind::altitude,
                                     {PropagationModel::horizon, PropagationModel::diffraction}, 900);
  FieldOptions options;
  options.backend = Backend::cuda;
  FieldSolver edited(before, nullptr, options);
  edited.update(scenario::snapshotAt(before, nullptr, 0));
  const auto after = std::make_shared<scenario::Scenario>(*before);
  after->emitters.erase(after->emitters.begin() + 2);
  const FieldChanged changed = edited.update(scenario::snapshotAt(after, nullptr, 0));
  EXPECT_TRUE(changed.moved.empty());
  FieldSolver anew(after, nullptr, options);
  anew.update(scenario::snapshotAt(after, nullptr, 0));
  const auto a = edited.volumes().front().host(), b = anew.volumes().front().host();
  for (std::size_t v = 0; v < a->values.size(); ++v) ASSERT_NEAR(a->values[v], b->values[v], 1e-4F);
}

TEST_P(CudaField, TooLittleMemoryIsReportedBeforeComputation) {
  std::mt19937 random(9);
  const auto scenario = randomScenario(random, FrameKind::altitude, {PropagationModel::free_space}, 900);
  scenario->region.dims = {4000, 4000, 2000};
  scenario->output.quantities = {"power_density_dbwm2"};
  FieldOptions options;
  options.backend = Backend::cuda;
  const std::string error =
      test::errorOf([&] { FieldSolver solver(scenario, nullptr, options); }, ErrorCode::device);
  EXPECT_THAT(error, HasSubstr("the field of 4000 x 4000 x 2000 voxels, 8 emitters"));
  EXPECT_THAT(error, HasSubstr("MiB are free"));
}

}  // namespace
}  // namespace emscape::emfield

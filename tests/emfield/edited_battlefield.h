/// A small battlefield with random places, for tests of edited scenarios.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/emfield/test_scenario.h"

namespace emscape::emfield::testing {

using propagation::PropagationModel;
using scenario::Emitter;
using scenario::EmitterKind;
using scenario::Scenario;

constexpr double kLatitude_deg = 45, kLongitude_deg = 7;

using Random = std::mt19937;

inline double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline int below(Random& random, std::size_t count) {
  return std::uniform_int_distribution<int>(0, static_cast<int>(count) - 1)(random);
}
template <class T>
T oneOf(Random& random, const std::vector<T>& values) {
  return values[static_cast<std::size_t>(below(random, values.size()))];
}

inline GeodeticPosition somewhere(Random& random) {
  return {kLatitude_deg + between(random, -0.06, 0.06), kLongitude_deg + between(random, -0.08, 0.08),
          between(random, 1800, 3000)};
}

inline scenario::AntennaPtr someAntenna(Random& random) {
  switch (below(random, 3)) {
    case 0:
      return scenario::makeIsotropic();
    case 1:
      return scenario::makeSinc(30, between(random, 2, 8), between(random, 2, 8), -40);
    default:
      return scenario::makeGaussian(between(random, 20, 35), between(random, 2, 20), 10, -35);
  }
}

/// A rotating radar, a jammer on a track, a fixed radar, and two transmitters, with one model or all models.
inline std::shared_ptr<Scenario> battlefield(Random& random, FrameKind frame,
                                             std::vector<PropagationModel> models) {
  auto scenario = emptyScenario(frame, kLatitude_deg, kLongitude_deg, {15e3, 14e3, 4000}, {12, 11, 5});
  scenario->output.floor = -150;
  const char* const names[] = {"radar", "jammer", "second radar", "radio", "beacon"};
  for (std::size_t e = 0; e < std::size(names); ++e) {
    Emitter emitter = plainEmitter(names[e], 0);
    emitter.propagation.model = models[e % models.size()];
    emitter.antenna = someAntenna(random);
    if (e == 0 || e == 2) emitter.kind = EmitterKind::radar;
    if (e == 1) emitter.kind = EmitterKind::jammer;
    if (e == 0) emitter.scan.kind = scenario::ScanKind::rotate;
    emitter.scan.rate_rpm = 5;
    addEmitter(*scenario, somewhere(random), emitter);
  }
  scenario::TrackPoint end = scenario->platforms[1].track.front();
  end.t_s = 10;
  end.position.longitude_deg += 0.03;
  scenario->platforms[1].track.push_back(end);
  scenario->receivers.emplace_back();
  scenario->receivers.front().noise_figure_db = 5;
  scenario->receivers.front().bandwidth_hz = 1e6;
  scenario->receivers.front().sensitivity_dbm = -90;
  scenario->output.wanted_emitter = 0;
  scenario->bands = {{"low", 1e8, 2e9}, {"high", 2e9, 2e10}};
  return scenario;
}

inline std::string withoutCount(const std::string& warning) {
  return warning.substr(0, warning.find(" ("));
}

inline void expectEqualSolvers(const FieldSolver& updated, const FieldSolver& fresh) {
  ASSERT_EQ(updated.channels().size(), fresh.channels().size());
  ASSERT_EQ(updated.volumes().size(), fresh.volumes().size());
  EXPECT_EQ(updated.groundHeights_m().size(), fresh.groundHeights_m().size());
  for (std::size_t c = 0; c < fresh.channels().size(); ++c) {
    SCOPED_TRACE(fresh.channels()[c].name);
    EXPECT_EQ(updated.channels()[c].name, fresh.channels()[c].name);
    const auto a = updated.volumes()[c].host(), b = fresh.volumes()[c].host();
    EXPECT_TRUE(a->info == b->info);
    EXPECT_EQ(a->info.extra, b->info.extra);
    EXPECT_EQ(a->first_valid_k, b->first_valid_k);
    ASSERT_EQ(a->values.size(), b->values.size());
    long long different = 0;
    for (std::size_t v = 0; v < a->values.size(); ++v) different += a->values[v] != b->values[v] ? 1 : 0;
    ASSERT_EQ(different, 0) << "of " << a->values.size() << " voxels";
  }
  std::vector<std::string> warnings;
  for (const std::string& warning : updated.warnings()) warnings.push_back(withoutCount(warning));
  for (const std::string& warning : fresh.warnings()) {
    EXPECT_THAT(warnings, ::testing::Contains(withoutCount(warning)));
  }
}

}  // namespace emscape::emfield::testing

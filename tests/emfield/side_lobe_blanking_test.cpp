// Pulsed jamming and side-lobe blanking against closed forms and draws; the values are read from voxels.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <map>
#include <random>

#include "emfield/channels/products.h"
#include "emfield/combine/radar_product.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/emfield/link/path_cause.h"
#include "tests/emfield/jamming_forms.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

constexpr double kDuty = 0.3, kRange_m = 20e3;

scenario::Emitter pulsed(scenario::Emitter jammer, double duty) {
  jammer.waveform = scenario::Waveform{1000, duty / 1000, {}};
  return jammer;
}

/// Side lobes of -5 dBi, below the auxiliary antenna.
scenario::Emitter blankingRadar(int pulses) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.side_lobe_blanking = scenario::SideLobeBlanking{5, 3};
  radar.receiver.pulses = pulses;
  return radar;
}

double exactProbability(const scenario::Emitter& radar, int pulses, double snr) {
  Detector detector = detectorOf(radar.receiver);
  detector.pulses = pulses;
  return detectionProbability(detector, detectionThreshold(detector), snr);
}

/// Jammers, over noise: on boresight in the main channel, the weight there, and the duty.
struct DrawnJammer {
  double peak, weight, duty;
};

/// Of a detector of so many pulses.
Blanker blankerWith(double auxiliary, int swerling, int pulses = 1) {
  const Detector detector{swerlingOfCase(swerling), pulses, 1e-6};
  return blankerOf(auxiliary, detector, DetectionCurve(detector));
}

BlankedSum sumOf(const Blanker& blanker, const std::vector<DrawnJammer>& jammers) {
  BlankedSum sum;
  for (const DrawnJammer& jammer : jammers) {
    JammerAtRadar at_radar;
    at_radar.boresight_to_noise = static_cast<float>(jammer.peak * jammer.duty);
    at_radar.duty = static_cast<float>(jammer.duty);
    blanker.add(at_radar, static_cast<float>(jammer.weight), sum);
  }
  return sum;
}

/// What a blanker leaves of the pulses of an echo; of none without the square.
OpenPulses leftOf(const Blanker& blanker, const std::vector<DrawnJammer>& jammers, double echo) {
  const BlankedSum sum = sumOf(blanker, jammers);
  OpenPulses left;
  for (int n = 0; n < sum.count; ++n) {
    left = left.plus(echo > 0 ? blanker.leftOf(sum.states[n], 0, static_cast<float>(echo))
                              : blanker.leftOf(sum.states[n], 0),
                     sum.parts[n]);
  }
  return left;
}

TEST(Blanker, BlanksThePulsesThatAreStrongerInTheAuxiliaryChannel) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, std::sqrt(0.5));
  const auto draw = [&] { return std::complex<double>(normal(random), normal(random)); };
  constexpr double kPart = 0.2;
  for (const auto& [peak, auxiliary, weight, echo] :
       {std::array{1e4, 1e-2, 1e-3, 0.0}, std::array{1e4, 1e-2, 2e-2, 0.0}, std::array{1e3, 1e-2, 1e-3, 20.0},
        std::array{30.0, 0.1, 0.02, 3.0}, std::array{1.0, 0.01, 1.0, 10.0},
        std::array{300.0, 0.1, 0.095, 3.0}}) {
    constexpr int kDraws = 200000;
    int blanked = 0;
    double passed = 0;
    for (int n = 0; n < kDraws; ++n) {
      const std::complex<double> jamming = draw(), rest = std::sqrt(1 + echo) * draw();
      const bool is_blanked = std::norm(std::sqrt(peak * auxiliary) * jamming) >
                              std::norm(std::sqrt(peak * weight) * jamming + rest);
      blanked += is_blanked;
      passed += is_blanked ? 0 : std::norm(std::sqrt(peak * weight) * jamming + rest);
    }
    const OpenPulses left = leftOf(blankerWith(auxiliary, 2, 2), {{peak, weight, kPart}}, echo);
    SCOPED_TRACE(::testing::Message() << peak << ' ' << auxiliary << ' ' << weight << ' ' << echo);
    EXPECT_NEAR((1 - double(left.part)) / kPart, blanked / double(kDraws), 0.005);
    const double all = peak * weight + 1 + echo;
    EXPECT_NEAR((double(left.power) - (1 - kPart) * (1 + echo)) / (kPart * all), passed / kDraws / all, 0.01);
  }
  const Blanker blanker = blankerWith(1e-2, 2, 2);
  const OpenPulses side = leftOf(blanker, {{1e15, 1e-3, kPart}}, 0),
                   main = leftOf(blanker, {{1e15, 1, kPart}}, 0);
  EXPECT_NEAR(side.part, 1 - kPart, 1e-6);
  EXPECT_NEAR(side.power, 1 - kPart, 1e-6);
  EXPECT_NEAR(main.part, 1, 1e-6);
  EXPECT_NEAR(main.power / 2e14f, 1, 1e-6);
}

/// Echoes of Swerling's cases in one pulse, over their mean.
double drawnEcho(int swerling, std::mt19937& random) {
  if (swerling == 0) return 1;
  return std::gamma_distribution<double>(swerling == 2 ? 1 : 2, swerling == 2 ? 1 : 0.5)(random);
}

/// What is left by draws of all jammers in both channels, each with an arbitrary phase between them.
OpenPulses drawn(const std::vector<DrawnJammer>& jammers, double auxiliary, double echo, int swerling) {
  constexpr int kDraws = 50000;
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, std::sqrt(0.5));
  std::uniform_real_distribution<double> uniform;
  const auto draw = [&] { return std::complex<double>(normal(random), normal(random)); };
  double open = 0, left = 0, square = 0;
  for (int n = 0; n < kDraws; ++n) {
    std::complex<double> in_main = 0, in_auxiliary = 0;
    for (const DrawnJammer& jammer : jammers) {
      if (uniform(random) >= jammer.duty) continue;
      const std::complex<double> field = std::sqrt(jammer.peak) * draw();
      in_main += std::sqrt(jammer.weight) * field;
      in_auxiliary += std::polar(std::sqrt(auxiliary), 2 * kPi * uniform(random)) * field;
    }
    const double received = std::norm(in_main + draw() + std::sqrt(echo * drawnEcho(swerling, random)));
    if (std::norm(in_auxiliary) > received) continue;
    open += 1;
    left += received;
    square += received * received;
  }
  return {static_cast<float>(open / kDraws), static_cast<float>(left / kDraws),
          static_cast<float>(square / kDraws)};
}

TEST(Blanker, LeavesThePartAndThePowersOfDraws) {
  const std::vector<std::vector<DrawnJammer>> cases{
      {{1e3, 1e-3, 1}, {1e3, 1e-3, 1}, {1e3, 1e-3, 1}},  // of one level
      {{30, 0.003, 1}, {60, 0.002, 1}, {20, 0.005, 1}},  // near the noise
      {{1e4, 1e-3, 1}, {300, 1, 1}},                     // one in the beam
      {{5e3, 1.9e-2, 1}},                                // near the auxiliary gain
      {{300, 0.02, 1}, {100, 0.03, 1}, {100, 0.001, 1}, {50, 0.05, 1}},
      {{1e3, 1e-3, 0.6}, {300, 1, 0.4}},                    // pulses in the beam, which open
      {{100, 3e-3, 1}, {80, 1e-3, 0.7}, {1e3, 2e-3, 0.5}},  // and in the side lobes
  };
  for (const std::vector<DrawnJammer>& jammers : cases) {
    for (const int swerling : {0, 2, 4}) {
      constexpr double kAuxiliary = 0.02, kEcho = 15;
      double all = 1 + kEcho;
      for (const DrawnJammer& jammer : jammers) all += jammer.peak * jammer.duty * jammer.weight;
      const OpenPulses left = leftOf(blankerWith(kAuxiliary, swerling, 2), jammers, kEcho);
      const OpenPulses expected = drawn(jammers, kAuxiliary, kEcho, swerling);
      SCOPED_TRACE(::testing::Message() << jammers.size() << " of " << jammers[0].peak << ", " << swerling);
      EXPECT_NEAR(left.part, expected.part, 0.01);
      EXPECT_NEAR(double(left.power) / all, double(expected.power) / all, 0.02);
      EXPECT_NEAR(std::sqrt(double(left.square) / double(expected.square)), 1, 0.05);
    }
  }
}

TEST(Blanker, HearsAJammerInTheAuxiliaryChannelByTheJammersOwnPattern) {
  JammerAtRadar plain, away;
  plain.boresight_to_noise = 100;
  away.boresight_to_noise = 1e4f;
  away.has_reflected_ray = true;
  away.direct_amplitude = away.reflected_amplitude = 0.1f;
  Blanker blanker;
  blanker.auxiliary = 0.1f;
  BlankedSum of_away, of_plain;
  blanker.add(away, 1e-5f, of_away);
  blanker.add(plain, 1e-3f, of_plain);
  EXPECT_NEAR(of_away.states[0].main, of_plain.states[0].main, 1e-6);
  EXPECT_NEAR(of_away.states[0].auxiliary, of_plain.states[0].auxiliary, 1e-5);
}

/// Jammers as of blanked_draws.py: powers in both channels, and the duty.
struct JammerInChannels {
  double main, auxiliary, duty;
};

TEST(Blanker, DetectsAsDrawsOfPulsesDo) {
  const std::vector<std::vector<JammerInChannels>> sets{
      {{3.162, 10, 1}},
      {{100, 100, 1}},
      {{50, 158, 1}, {50, 158, 1}},
      {{100, 1000, 1}, {100, 1000, 1}, {100, 1000, 1}},
      {{15, 300, 1}, {30, 200, 1}, {10, 60, 1}, {2.5, 100, 1}},
      {{100, 316, 0.3}},
      {{3.162, 10, 0.6}},
      {{10, 100, 1}, {100, 1000, 0.9}},
      {{126, 190, 0.3}},
      {{100, 1000, 0.5}, {100, 1000, 0.5}},
  };
  struct Draw {
    int set, pulses, swerling;
    double snr_db, probability;
  };
  const Draw draws[]{
      {0, 1, 0, 18, 0.726},  {0, 1, 1, 21, 0.676},  {0, 1, 2, 21, 0.672},  {0, 1, 3, 18, 0.539},
      {0, 1, 4, 18, 0.542},  {0, 4, 0, 12, 0.449},  {0, 4, 1, 15, 0.587},  {0, 4, 2, 12, 0.457},
      {0, 4, 3, 15, 0.703},  {0, 4, 4, 12, 0.449},  {0, 16, 0, 9, 0.807},  {0, 16, 1, 12, 0.680},
      {0, 16, 2, 9, 0.769},  {0, 16, 3, 9, 0.538},  {0, 16, 4, 9, 0.782},  {0, 64, 0, 6, 0.970},
      {0, 64, 1, 6, 0.522},  {0, 64, 2, 3, 0.307},  {0, 64, 3, 6, 0.623},  {0, 64, 4, 3, 0.243},
      {1, 1, 0, 33, 0.823},  {1, 1, 1, 36, 0.693},  {1, 1, 2, 36, 0.692},  {1, 1, 3, 33, 0.579},
      {1, 1, 4, 33, 0.574},  {1, 4, 0, 27, 0.546},  {1, 4, 1, 30, 0.617},  {1, 4, 2, 27, 0.490},
      {1, 4, 3, 30, 0.740},  {1, 4, 4, 27, 0.511},  {1, 16, 0, 24, 0.916}, {1, 16, 1, 24, 0.510},
      {1, 16, 2, 24, 0.840}, {1, 16, 3, 24, 0.611}, {1, 16, 4, 24, 0.873}, {1, 64, 0, 18, 0.528},
      {1, 64, 1, 21, 0.619}, {1, 64, 2, 18, 0.522}, {1, 64, 3, 21, 0.736}, {1, 64, 4, 18, 0.517},
      {2, 1, 0, 33, 0.550},  {2, 1, 1, 36, 0.613},  {2, 1, 2, 36, 0.618},  {2, 1, 3, 36, 0.741},
      {2, 1, 4, 36, 0.749},  {2, 4, 0, 30, 0.923},  {2, 4, 1, 30, 0.503},  {2, 4, 2, 30, 0.723},
      {2, 4, 3, 30, 0.606},  {2, 4, 4, 30, 0.783},  {2, 16, 0, 24, 0.300}, {2, 16, 1, 27, 0.569},
      {2, 16, 2, 24, 0.486}, {2, 16, 3, 27, 0.685}, {2, 16, 4, 24, 0.415}, {2, 64, 0, 21, 0.351},
      {2, 64, 1, 24, 0.582}, {2, 64, 2, 21, 0.661}, {2, 64, 3, 24, 0.703}, {2, 64, 4, 21, 0.543},
      {3, 1, 0, 39, 0.768},  {3, 1, 1, 42, 0.666},  {3, 1, 2, 42, 0.661},  {3, 1, 3, 39, 0.515},
      {3, 1, 4, 39, 0.523},  {3, 4, 0, 36, 0.880},  {3, 4, 1, 39, 0.691},  {3, 4, 2, 36, 0.730},
      {3, 4, 3, 36, 0.570},  {3, 4, 4, 36, 0.782},  {3, 16, 0, 33, 0.962}, {3, 16, 1, 33, 0.507},
      {3, 16, 2, 30, 0.406}, {3, 16, 3, 33, 0.601}, {3, 16, 4, 30, 0.293}, {3, 64, 0, 30, 0.987},
      {3, 64, 1, 30, 0.508}, {3, 64, 2, 27, 0.442}, {3, 64, 3, 30, 0.614}, {3, 64, 4, 27, 0.274},
      {4, 1, 0, 33, 0.920},  {4, 1, 1, 33, 0.524},  {4, 1, 2, 33, 0.526},  {4, 1, 3, 33, 0.626},
      {4, 1, 4, 33, 0.618},  {4, 4, 0, 27, 0.345},  {4, 4, 1, 30, 0.566},  {4, 4, 2, 27, 0.454},
      {4, 4, 3, 30, 0.675},  {4, 4, 4, 27, 0.438},  {4, 16, 0, 24, 0.359}, {4, 16, 1, 27, 0.575},
      {4, 16, 2, 24, 0.629}, {4, 16, 3, 27, 0.700}, {4, 16, 4, 24, 0.548}, {4, 64, 0, 21, 0.381},
      {4, 64, 1, 24, 0.588}, {4, 64, 2, 21, 0.759}, {4, 64, 3, 24, 0.713}, {4, 64, 4, 21, 0.631},
      {5, 1, 0, 12, 0.496},  {5, 1, 1, 18, 0.642},  {5, 1, 2, 15, 0.503},  {5, 1, 3, 15, 0.594},
      {5, 1, 4, 15, 0.592},  {5, 4, 0, 9, 0.766},   {5, 4, 1, 12, 0.678},  {5, 4, 2, 9, 0.600},
      {5, 4, 3, 9, 0.552},   {5, 4, 4, 9, 0.667},   {5, 16, 0, 3, 0.430},  {5, 16, 1, 6, 0.586},
      {5, 16, 2, 3, 0.432},  {5, 16, 3, 6, 0.698},  {5, 16, 4, 3, 0.438},  {5, 64, 0, 0, 0.681},
      {5, 64, 1, 3, 0.646},  {5, 64, 2, 0, 0.657},  {5, 64, 3, 0, 0.485},  {5, 64, 4, 0, 0.666},
      {6, 1, 0, 15, 0.851},  {6, 1, 1, 15, 0.531},  {6, 1, 2, 15, 0.535},  {6, 1, 3, 15, 0.624},
      {6, 1, 4, 15, 0.623},  {6, 4, 0, 9, 0.661},   {6, 4, 1, 12, 0.651},  {6, 4, 2, 9, 0.573},
      {6, 4, 3, 9, 0.512},   {6, 4, 4, 9, 0.603},   {6, 16, 0, 3, 0.337},  {6, 16, 1, 6, 0.547},
      {6, 16, 2, 3, 0.357},  {6, 16, 3, 6, 0.653},  {6, 16, 4, 3, 0.353},  {6, 64, 0, 0, 0.513},
      {6, 64, 1, 3, 0.616},  {6, 64, 2, 0, 0.551},  {6, 64, 3, 3, 0.734},  {6, 64, 4, 0, 0.531},
      {7, 1, 0, 30, 0.548},  {7, 1, 1, 33, 0.572},  {7, 1, 2, 33, 0.572},  {7, 1, 3, 33, 0.679},
      {7, 1, 4, 33, 0.676},  {7, 4, 0, 27, 0.617},  {7, 4, 1, 30, 0.608},  {7, 4, 2, 27, 0.582},
      {7, 4, 3, 27, 0.443},  {7, 4, 4, 27, 0.591},  {7, 16, 0, 24, 0.645}, {7, 16, 1, 27, 0.630},
      {7, 16, 2, 24, 0.762}, {7, 16, 3, 24, 0.456}, {7, 16, 4, 24, 0.733}, {7, 64, 0, 21, 0.597},
      {7, 64, 1, 24, 0.623}, {7, 64, 2, 21, 0.885}, {7, 64, 3, 21, 0.425}, {7, 64, 4, 21, 0.811},
      {8, 1, 0, 15, 0.824},  {8, 1, 1, 15, 0.516},  {8, 1, 2, 18, 0.671},  {8, 1, 3, 15, 0.599},
      {8, 1, 4, 15, 0.598},  {8, 4, 0, 9, 0.649},   {8, 4, 1, 12, 0.662},  {8, 4, 2, 9, 0.569},
      {8, 4, 3, 9, 0.516},   {8, 4, 4, 9, 0.601},   {8, 16, 0, 3, 0.363},  {8, 16, 1, 6, 0.582},
      {8, 16, 2, 3, 0.385},  {8, 16, 3, 6, 0.668},  {8, 16, 4, 3, 0.375},  {8, 64, 0, 0, 0.566},
      {8, 64, 1, 3, 0.665},  {8, 64, 2, 0, 0.573},  {8, 64, 3, 0, 0.516},  {8, 64, 4, 0, 0.565},
      {9, 1, 0, 27, 0.536},  {9, 1, 1, 30, 0.546},  {9, 1, 2, 33, 0.693},  {9, 1, 3, 30, 0.621},
      {9, 1, 4, 30, 0.619},  {9, 4, 0, 21, 0.340},  {9, 4, 1, 24, 0.537},  {9, 4, 2, 24, 0.686},
      {9, 4, 3, 24, 0.629},  {9, 4, 4, 21, 0.395},  {9, 16, 0, 18, 0.485}, {9, 16, 1, 21, 0.644},
      {9, 16, 2, 18, 0.563}, {9, 16, 3, 21, 0.731}, {9, 16, 4, 18, 0.575}, {9, 64, 0, 15, 0.598},
      {9, 64, 1, 18, 0.700}, {9, 64, 2, 15, 0.705}, {9, 64, 3, 15, 0.568}, {9, 64, 4, 15, 0.671},
  };
  std::map<std::pair<int, int>, DetectionCurve> curves;
  for (const Draw& draw : draws) {
    const Detector detector{swerlingOfCase(draw.swerling), draw.pulses, 1e-6};
    const DetectionCurve& curve =
        curves.try_emplace({draw.pulses, draw.swerling}, detector, scenario::DetectionMethod::exact, 0, true)
            .first->second;
    const auto echo = static_cast<float>(dbToRatio(draw.snr_db));
    const Blanker blanker = blankerOf(1, detector, curve);
    std::vector<DrawnJammer> jammers;
    for (const JammerInChannels& jammer : sets[std::size_t(draw.set)])
      jammers.push_back({jammer.auxiliary, jammer.main / jammer.auxiliary, jammer.duty});
    EXPECT_NEAR(blanker.probability(sumOf(blanker, jammers), curve.view(), 0, echo), draw.probability, 0.06)
        << draw.set << ' ' << draw.pulses << ' ' << draw.swerling;
  }
}

// An echo opens pulses with their jamming: no reason for a detection.
TEST(Blanker, JammingRaisesNoProbability) {
  for (int swerling = 0; swerling <= 4; ++swerling) {
    const Detector detector{swerlingOfCase(swerling), 8, 1e-6};
    const DetectionCurve curve(detector, scenario::DetectionMethod::exact, 0, true);
    const Blanker blanker = blankerOf(1, detector, curve);
    const auto echo = static_cast<float>(dbToRatio(7.0));
    for (const double main : {0.1, 1.0, 10.0, 1e2, 1e3, 1e4}) {
      const double over_auxiliary = dbToRatio(-1.8);
      const BlankedSum sum = sumOf(blanker, {{main / over_auxiliary, over_auxiliary, 0.3}});
      EXPECT_LE(blanker.probability(sum, curve.view(), 0, echo), curve.view()(7) + 1e-6F)
          << swerling << ' ' << main;
    }
  }
}

// Strong jamming leaves next to no open pulses: what their numbers are rounded to is no reason for a
// detection.
TEST(Blanker, AStrongerEchoIsDetectedAtLeastAsOften) {
  for (const int swerling : {0, 1, 4}) {
    const Detector detector{swerlingOfCase(swerling), 10, 1e-6};
    const DetectionCurve curve(detector, scenario::DetectionMethod::exact, 0, true);
    const Blanker blanker = blankerOf(1, detector, curve);
    for (const double duty : {0.3, 1.0}) {
      for (const double auxiliary_db : {20.0, 37.0, 57.0, 67.0}) {
        for (const double main_db : {-47.0, -27.0, -12.0}) {
          const BlankedSum sum = sumOf(blanker, {{dbToRatio(auxiliary_db), dbToRatio(main_db), duty}});
          float before = blanker.probability(sum, curve.view(), 0, 1);
          for (double snr_db = 0; snr_db < 25; snr_db += 0.05) {
            const auto echo = static_cast<float>(dbToRatio(snr_db));
            const float probability = blanker.probability(sum, curve.view(), 0, echo);
            EXPECT_GT(probability, before - 2e-3F)
                << swerling << ' ' << duty << ' ' << auxiliary_db << ' ' << main_db << ' ' << snr_db;
            EXPECT_LT(probability, before + 0.03F)
                << swerling << ' ' << duty << ' ' << auxiliary_db << ' ' << main_db << ' ' << snr_db;
            before = probability;
          }
        }
      }
    }
  }
}

// Its pulses are open, and are no reason to take those of another jammer for more frequent.
TEST(Blanker, AJammerOfVanishingPowerChangesNothing) {
  for (int swerling = 0; swerling <= 4; ++swerling) {
    const Detector detector{swerlingOfCase(swerling), 4, 1e-6};
    const DetectionCurve curve(detector, scenario::DetectionMethod::exact, 0, true);
    const Blanker blanker = blankerOf(1, detector, curve);
    const DrawnJammer strong{100, 0.5, 0.2}, none{1e-9, 0.5, 0.95};
    for (const double snr_db : {6.0, 12.0, 18.0}) {
      const auto echo = static_cast<float>(dbToRatio(snr_db));
      EXPECT_NEAR(blanker.probability(sumOf(blanker, {strong, none}), curve.view(), 0, echo),
                  blanker.probability(sumOf(blanker, {strong}), curve.view(), 0, echo), 1e-4)
          << swerling << ' ' << snr_db;
    }
  }
}

// It is in the main channel alone, where it opens pulses, and the threshold follows it.
TEST(Blanker, ClutterCountsAsNoiseOfTheMainChannel) {
  constexpr float kClutter = 12;
  for (int swerling = 0; swerling <= 4; ++swerling) {
    const Detector detector{swerlingOfCase(swerling), 4, 1e-6};
    const DetectionCurve curve(detector, scenario::DetectionMethod::exact, 0, true);
    const Blanker blanker = blankerOf(1, detector, curve);
    const auto jammersOver = [&](double noise) {
      return sumOf(blanker, {{1000 / noise, 0.016, 0.9}, {300 / noise, 0.03, 0.4}});
    };
    const float noise = 1 + kClutter;
    for (const double snr_db : {15.0, 20.0, 25.0}) {
      const auto echo = static_cast<float>(dbToRatio(snr_db));
      const float probability = blanker.probability(jammersOver(1), curve.view(), kClutter, echo);
      EXPECT_NEAR(probability, blanker.probability(jammersOver(double(noise)), curve.view(), 0, echo / noise),
                  1e-4)
          << swerling << ' ' << snr_db;
    }
  }
}

TEST(Blanker, OfNoJammerDetectsAsTheCurveDoes) {
  for (int swerling = 0; swerling <= 4; ++swerling) {
    const Detector detector{swerlingOfCase(swerling), 16, 1e-6};
    const DetectionCurve curve(detector, scenario::DetectionMethod::exact, 0, true);
    const Blanker blanker = blankerOf(0.1, detector, curve);
    for (const float snr_db : {-5.0f, 0.0f, 5.0f, 20.0f}) {
      const auto echo = static_cast<float>(dbToRatio(double(snr_db)));
      EXPECT_NEAR(blanker.probability({}, curve.view(), 0, echo), curve.view()(snr_db), 1e-4)
          << swerling << ' ' << snr_db;
    }
  }
}

/// Of the path to the voxel at kRange_m.
PathBudget budgetEast(const std::shared_ptr<scenario::Scenario>& scenario) {
  const volume::Grid grid = gridOf(scenario->region);
  const GeoFrame frame(grid.frame);
  const Vec3d center = grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0) + Vec3d{kRange_m, 0, 0};
  return pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0,
                    {frame.toGeodetic(center), frame.heightMsl_m(center)},
                    propagation::PropagationModel::free_space, nullptr);
}

class SideLobeBlanking : public test::OnBackends {
 protected:
  float probability(const std::shared_ptr<scenario::Scenario>& scenario) const {
    scenario->output.radar_look = scenario::RadarAim::target;
    scenario->output.quantities = {"detection_probability"};
    FieldOptions options;
    options.backend = GetParam();
    return valueEast(*solve(scenario, nullptr, options), kRange_m);
  }
};

TEST_P(SideLobeBlanking, PulsesCountWithTheirMeanPowerWithoutIt) {
  scenario::Emitter radar = blankingRadar(1), mean = jammerOf(kDuty * 5e4);
  radar.receiver.side_lobe_blanking.reset();
  const scenario::Emitter jammer = pulsed(jammerOf(5e4), kDuty);
  EXPECT_NEAR(probability(duel(radar, jammer, 0, 60e3)), probability(duel(radar, mean, 0, 60e3)), 1e-6);
  EXPECT_LT(probability(duel(radar, jammer, 0, 60e3)), 0.05);
}

TEST_P(SideLobeBlanking, OfOnePulseLeavesTheTimeBetweenTheJammersPulses) {
  const scenario::Emitter radar = blankingRadar(1);
  const scenario::Emitter jammer = pulsed(jammerOf(5e6), kDuty);
  const double snr = dbToRatio(radarSnrDb(linkTowardsTarget(radar), 5, kRange_m));
  const double alone = exactProbability(radar, 1, snr);
  ASSERT_GT(alone, 0.5);
  EXPECT_NEAR(probability(duel(radar, jammer, 0, 60e3)), (1 - kDuty) * alone, 1e-3);
  EXPECT_LT(probability(duel(radar, jammerOf(5e6), 0, 60e3)), 1e-3) << "one without a pause";
}

TEST_P(SideLobeBlanking, OfSeveralPulsesIsTheSumOverThoseThatRemain) {
  for (const int pulses : {2, 4, 16, 64}) {
    scenario::Emitter radar = blankingRadar(pulses);
    radar.receiver.target_rcs_m2 = 5 / std::sqrt(double(pulses));
    const double snr =
        dbToRatio(radarSnrDb(linkTowardsTarget(radar), radar.receiver.target_rcs_m2, kRange_m));
    double expected = 0, weight = std::pow(kDuty, pulses);
    for (int k = 0; k <= pulses; ++k) {  // pulses that remain
      if (k > 0) {
        expected += weight * exactProbability(radar, k, snr);
      }
      weight *= double(pulses - k) / (k + 1) * (1 - kDuty) / kDuty;
    }
    EXPECT_NEAR(probability(duel(radar, pulsed(jammerOf(5e6), kDuty), 0, 60e3)), expected, 0.01) << pulses;
  }
}

TEST_P(SideLobeBlanking, DoesNothingAgainstTheMainBeamAndWeakPulses) {
  scenario::Emitter radar = blankingRadar(1), plain = radar;
  plain.receiver.side_lobe_blanking.reset();
  const scenario::Emitter strong = pulsed(jammerOf(5), kDuty), weak = pulsed(jammerOf(1e-3), kDuty);
  // The pauses of its pulses are told apart behind a blanker, their mean power counts without one.
  EXPECT_NEAR(probability(duel(radar, strong, 60e3, 0)), probability(duel(plain, strong, 60e3, 0)), 1e-2);
  EXPECT_NEAR(probability(duel(radar, weak, 0, 60e3)), probability(duel(plain, weak, 0, 60e3)), 1e-3);
}

TEST_P(SideLobeBlanking, VoxelEqualsItsPath) {
  for (const double power_w : {0.1, 10.0, 1e3, 1e5}) {
    const auto scenario = duel(blankingRadar(8), pulsed(jammerOf(power_w), kDuty), 40e3, 5e3);
    const double voxel = double(probability(scenario));
    const PathBudget budget = budgetEast(scenario);
    EXPECT_NEAR(budget.find("detection_probability")->value, voxel, 1e-3) << power_w;
    ASSERT_EQ(budget.jamming.jammers.size(), 1U);
    EXPECT_EQ(budget.jamming.jammers[0].name, "jammer");
    EXPECT_NEAR(budget.jamming.jammers[0].to_signal_db, budget.find("jammer_to_signal_db")->value, 1e-9);
    EXPECT_EQ(budget.jamming.jammers[0].blanked_part > 0.9, power_w > 1e4) << power_w;
  }
}

TEST(SideLobeBlankingVerdict, NamesTheJammerInTheBeamNotTheStrongerOneThatIsBlanked) {
  const auto scenario = duel(blankingRadar(8), pulsed(jammerOf(5e6), 0.05), 0, 60e3);
  scenario::Emitter in_the_beam = jammerOf(20);
  in_the_beam.name = "in the beam";
  addEmitter(*scenario, pointAt(*scenario, 60e3, 0), in_the_beam);
  scenario->output.radar_look = scenario::RadarAim::target;
  const PathBudget budget = budgetEast(scenario);
  ASSERT_EQ(budget.jamming.jammers.size(), 2u);
  EXPECT_EQ(budget.jamming.jammers[0].name, "jammer");
  EXPECT_GT(budget.jamming.jammers[0].blanked_part, 0.9);
  EXPECT_EQ(decisionText(budget), "Jamming by 'in the beam' decides.");
}

TEST(SideLobeBlankingVerdict, TellsTheEchoThatIsMissingWithJammingOfEveryLook) {
  scenario::Emitter follows = blankingRadar(8), fixed = follows;
  follows.receiver.target_rcs_m2 = fixed.receiver.target_rcs_m2 = 1e-4;
  fixed.scan = {};
  fixed.scan.azimuth_deg = 88;
  for (scenario::Emitter radar : {follows, fixed}) {
    for (const bool blanks : {true, false}) {
      if (!blanks) radar.receiver.side_lobe_blanking.reset();
      const scenario::Emitter jammer = pulsed(jammerOf(1e3), kDuty);
      const PathBudget weak = budgetEast(duel(radar, jammer, 40e3, 5e3));
      ASSERT_TRUE(weak.jamming.missing_db);
      EXPECT_GT(*weak.jamming.missing_db, weak.find("required_snr_db")->value - weak.find("snr_db")->value);
      EXPECT_THAT(decisionText(weak), ::testing::HasSubstr(fmt::format("With jamming {:.1f} dB are missing",
                                                                       *weak.jamming.missing_db)));
      radar.receiver.target_rcs_m2 *= dbToRatio(*weak.jamming.missing_db);
      const PathBudget strong = budgetEast(duel(radar, jammer, 40e3, 5e3));
      EXPECT_NEAR(strong.find("detection_probability")->value, 0.5, 0.01);
      radar.receiver.target_rcs_m2 = follows.receiver.target_rcs_m2;
    }
  }
}

EMSCAPE_ON_BACKENDS(SideLobeBlanking);

}  // namespace
}  // namespace emscape::emfield

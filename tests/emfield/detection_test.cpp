// Detection statistics against closed forms; the radar equation, jamming and noise.
#include "emfield/radar/detection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emfield/radar/equation.h"
#include "emscape/base/units.h"
#include "emscape/scenario/model/emitter.h"
#include "propagation/air/gases.h"
#include "propagation/air/rain.h"
#include "tests/emfield/jamming_forms.h"
#include "tests/support/errors.h"

namespace emscape::emfield {
namespace {

using namespace propagation;

using ::testing::HasSubstr;

constexpr Swerling kAllCases[] = {Swerling::steady, Swerling::slow_exponential, Swerling::fast_exponential,
                                  Swerling::slow_dominant, Swerling::fast_dominant};

double probability(const Detector& detector, double snr) {
  return detectionProbability(detector, detectionThreshold(detector), snr);
}

TEST(Detection, ThresholdOfOnePulseEqualsLogarithmOfPfa) {
  for (const double pfa : {0.5, 1e-3, 1e-6, 1e-12}) {
    EXPECT_NEAR(detectionThreshold({Swerling::steady, 1, pfa}), -std::log(pfa), 1e-12 * -std::log(pfa));
  }
}

TEST(Detection, OfOnePulseFromARayleighTargetIsAPowerOfPfa) {
  for (const double pfa : {1e-4, 1e-6, 1e-12}) {
    for (const double snr : {1e-3, 1.0, 20.0, 1e4}) {
      const double expected = std::pow(pfa, 1 / (1 + snr));
      EXPECT_NEAR(probability({Swerling::slow_exponential, 1, pfa}, snr), expected, 1e-12);
      EXPECT_NEAR(probability({Swerling::fast_exponential, 1, pfa}, snr), expected, 1e-12);
    }
  }
}

TEST(Detection, OfOnePulseFromADominantScattererMeetsItsClosedForm) {
  // Skolnik: Pd = (1 + T x / 2 / (1 + x / 2)^2) exp(-T / (1 + x / 2))
  for (const double snr : {0.1, 2.0, 30.0}) {
    const double t = -std::log(1e-6), half = 1 + snr / 2;
    const double expected = (1 + t * snr / 2 / (half * half)) * std::exp(-t / half);
    EXPECT_NEAR(probability({Swerling::slow_dominant, 1, 1e-6}, snr), expected, 1e-12);
  }
}

/// Upper gamma function of a whole n by its finite sum, in long double.
long double upperGamma(int n, long double t) {
  long double sum = 0, logarithm = -t;
  for (int j = 0; j < n; ++j) {
    sum += std::exp(logarithm);
    logarithm += std::log(t) - std::log((long double)(j + 1));
  }
  return sum;
}

TEST(Detection, OfPulsesThatAllFluctuateIsAGammaFunction) {
  // case 2: the sum of N exponentials of mean 1 + x
  for (const int n : {1, 10, 100, 1000}) {
    for (const double pfa : {1e-4, 1e-12}) {
      const Detector detector{Swerling::fast_exponential, n, pfa};
      const double t = detectionThreshold(detector);
      EXPECT_NEAR(double(upperGamma(n, t)) / pfa, 1, 1e-9);
      for (const double snr_db : {-15.0, -5.0, 3.0, 20.0}) {
        const double snr = dbToRatio(snr_db);
        EXPECT_NEAR(detectionProbability(detector, t, snr), double(upperGamma(n, t / (1 + snr))), 1e-10);
      }
    }
  }
}

TEST(Detection, StaysFiniteAndRisesFromPfaToOne) {
  for (const Swerling swerling : kAllCases) {
    for (const int n : {1, 3, 1000, 100000}) {
      const Detector detector{swerling, n, 1e-12};
      const double threshold = detectionThreshold(detector);
      EXPECT_NEAR(detectionProbability(detector, threshold, 0) / 1e-12, 1, n > 1000 ? 1e-6 : 1e-9);
      double before = 0;
      for (double snr_db = -60; snr_db <= 150; snr_db += 1.7) {
        const double pd = detectionProbability(detector, threshold, dbToRatio(snr_db));
        EXPECT_GE(pd, before - (n > 1000 ? 1e-9 : 1e-13)) << int(swerling) << ", " << n << ", " << snr_db;
        EXPECT_LE(pd, 1);
        before = pd;
      }
      EXPECT_GT(before, 1 - 1e-9);
      EXPECT_TRUE(std::isnan(detectionProbability(detector, threshold, std::nan(""))));
    }
  }
}

TEST(Detection, SnrAndProbabilityAreInverse) {
  for (const Swerling swerling : kAllCases) {
    for (const double pd : {0.01, 0.5, 0.99}) {
      const Detector detector{swerling, 24, 1e-8};
      EXPECT_NEAR(probability(detector, dbToRatio(requiredSnrDb(detector, pd))), pd, 1e-9);
    }
  }
}

TEST(Detection, CurveIsWithinItsAccuracyAndNeverFalls) {
  for (const Swerling swerling : kAllCases) {
    for (const Detector& detector : {Detector{swerling, 1, 1e-6}, Detector{swerling, 12, 1e-4},
                                     Detector{swerling, 1000, 1e-12}, Detector{swerling, 1, 0.5}}) {
      const DetectionCurve curve(detector);
      const double threshold = detectionThreshold(detector);
      double worst = 0;
      float before = 0;
      for (float snr_db = -50; snr_db < 80; snr_db += 0.0137f) {
        const float pd = curve.view()(snr_db);
        ASSERT_GE(pd, before - 1e-7f);
        before = pd;
        const double exact = detectionProbability(detector, threshold, dbToRatio(snr_db));
        worst = std::max(worst, std::abs(pd - exact));
      }
      EXPECT_LT(worst, 1e-4) << int(swerling) << ", " << detector.pulses;
      EXPECT_TRUE(std::isnan(curve.view()(std::nanf(""))));
    }
  }
}

TEST(Detection, FormulasTurnedRoundAreTheirInverses) {
  for (const int pulses : {1, 10, 100}) {
    for (const double pfa : {1e-3, 1e-6}) {
      const Detector steady{Swerling::steady, pulses, pfa};
      for (const double pd : {0.1, 0.3, 0.5, 0.9}) {
        EXPECT_NEAR(albersheimProbability(steady, albersheimSnrDb(steady, pd)), pd, 1e-9);
        for (const Swerling swerling : kAllCases) {
          const Detector detector{swerling, pulses, pfa};
          EXPECT_NEAR(shnidmanProbability(detector, shnidmanSnrDb(detector, pd)), pd, 1e-6);
        }
      }
    }
  }
}

TEST(Detection, CurvesOfFormulasAreNearThemAndNeverFall) {
  for (const int pulses : {1, 12, 200}) {
    for (const Swerling swerling : kAllCases) {
      const Detector detector{swerling, pulses, 1e-6};
      const DetectionCurve curve(detector, scenario::DetectionMethod::shnidman);
      const DetectionCurve steady(detector, scenario::DetectionMethod::albersheim);
      double worst = 0;
      float before = 0;
      for (float snr_db = -20; snr_db < 40; snr_db += 0.0371f) {
        const float pd = curve.view()(snr_db);
        ASSERT_GE(pd, before - 1e-7f);
        before = pd;
        const double exact = shnidmanProbability(detector, snr_db);
        if (exact > 0.1 && exact < 0.99) worst = std::max(worst, std::abs(pd - exact));
        const double formula = albersheimProbability(detector, snr_db);
        if (formula > 0.1 && formula < 0.9) {
          ASSERT_NEAR(steady.view()(snr_db), formula, 2e-3);
        }
      }
      EXPECT_LT(worst, 2e-3) << int(swerling) << ", " << pulses;
    }
  }
}

TEST(Detection, SLOW_AlbersheimsFormulaContinuesToThePfa) {
  for (const int pulses : {1, 4, 100, 10000}) {
    for (const double pfa : {1e-12, 1e-6, 1e-3, 0.01, 0.1, 0.5}) {
      SCOPED_TRACE(::testing::Message() << pulses << " pulses, Pfa " << pfa);
      const Detector detector{Swerling::steady, pulses, pfa};
      EXPECT_TRUE(std::isnan(albersheimProbability(detector, std::nan(""))));
      double before = albersheimProbability(detector, -80);
      EXPECT_NEAR(before / pfa, 1, 1e-4);
      for (double snr_db = -50; snr_db < 25; snr_db += 0.05) {
        const double pd = albersheimProbability(detector, snr_db);
        ASSERT_GE(pd, before * (1 - 1e-9) - 1e-14) << snr_db;
        ASSERT_LT(pd - before, 0.03) << snr_db;
        before = pd;
      }
      EXPECT_GT(before, 0.99);
    }
  }
}

TEST(Detection, CurvesEndAtThePfa) {
  using scenario::DetectionMethod;
  for (const auto method : {DetectionMethod::exact, DetectionMethod::albersheim, DetectionMethod::shnidman}) {
    for (const Swerling swerling : {Swerling::steady, Swerling::slow_exponential}) {
      for (const double pfa : {1e-12, 1e-6, 1e-4, 0.5}) {
        const DetectionCurve curve({swerling, 4, pfa}, method);
        EXPECT_FLOAT_EQ(curve.view()(-60), float(pfa));
        EXPECT_FLOAT_EQ(curve.view()(-HUGE_VALF), float(pfa));
      }
    }
  }
  // also where it is small the probability is that of the statistics
  const Detector detector{Swerling::slow_exponential, 1, 1e-6};
  const DetectionCurve curve(detector);
  for (const float snr_db : {-10.0f, -6.0f, -3.0f}) {
    EXPECT_NEAR(double(curve.view()(snr_db)) / probability(detector, dbToRatio(snr_db)), 1, 0.01);
  }
}

TEST(Detection, RequiredSnrIsWhereTheMethodHasTheProbability) {
  using scenario::DetectionMethod;
  for (const auto method : {DetectionMethod::exact, DetectionMethod::albersheim, DetectionMethod::shnidman}) {
    for (const int pulses : {1, 16}) {
      for (const double pfa : {1e-6, 1e-3, 0.4}) {
        for (const double pd : {0.5, 0.8}) {
          const Detector detector{Swerling::steady, pulses, pfa};
          const DetectionCurve curve(detector, method);
          EXPECT_NEAR(curve.view()(float(requiredSnrDb(detector, method, pd))), pd, 1e-3)
              << toString(method) << ", " << pulses << ", " << pfa;
        }
      }
    }
  }
}

TEST(Detection, RefusesInputsOutsideItsLimits) {
  EXPECT_EQ(test::errorOf(
                [] {
                  detectionThreshold({Swerling::steady, 0, 1e-6});
                },
                ErrorCode::bad_input),
            "pulses: 0 is outside 1..1000000");
  EXPECT_EQ(test::errorOf(
                [] {
                  detectionThreshold({Swerling::steady, 1, 0.7});
                },
                ErrorCode::bad_input),
            "probability of false alarm: 0.7 is outside 1e-15..0.5");
  EXPECT_THAT(test::errorOf(
                  [] {
                    detectionThreshold({Swerling::steady, 1, std::nan("")});
                  },
                  ErrorCode::bad_input),
              HasSubstr("nan is outside"));
  EXPECT_THAT(test::errorOf(
                  [] {
                    requiredSnrDb({Swerling::steady, 1, 1e-6}, 1);
                  },
                  ErrorCode::bad_input),
              HasSubstr("probability of detection: 1 is outside 1e-06..1"));
  EXPECT_EQ(test::errorOf([] { swerlingOfCase(5); }, ErrorCode::bad_input),
            "Swerling case: 5 is outside 0..4");
}

RadarLink searchRadar() {
  RadarLink radar;
  radar.power_w = 2e5;
  radar.frequency_hz = 3e9;
  radar.gain_dbi = 34;
  radar.losses_db = 3;
  radar.bandwidth_hz = 1e6;
  return radar;
}

TEST(RadarFormulas, PathLossCountsTwiceForEchoAndOnceForJammer) {
  const RadarLink radar = searchRadar();
  JammerLink jammer;
  jammer.eirp_w = 1000;
  jammer.bandwidth_hz = 1e7;
  EXPECT_NEAR(radarSnrDb(radar, 5, 5e4) - radarSnrDb(radar, 5, 5e4, 4), 8, 1e-9);
  EXPECT_NEAR(ratioToDb(jammingPower_w(radar, jammer, 5e4) / jammingPower_w(radar, jammer, 5e4, 4)), 4, 1e-9);
  // F^4 against R^4: 12.04 dB for each doubling of the range
  EXPECT_NEAR(radarSnrDb(radar, 5, 5e4) - radarSnrDb(radar, 5, 1e5), 40 * std::log10(2), 1e-9);
  EXPECT_NEAR(ratioToDb(jammingPower_w(radar, jammer, 5e4) / jammingPower_w(radar, jammer, 1e5)),
              20 * std::log10(2), 1e-9);
}

TEST(RadarFormulas, FieldStrengthUsesEirpAndIsRms) {
  // ITU's figures for 1 kW at 1 km: 106.9 dBuV/m of ERP, 104.8 of EIRP
  const double spread_db = ratioToDb(4 * kPi * 1e6);
  EXPECT_NEAR(30 + kDipoleGain_dbi - spread_db + kFieldStrengthOfPowerDensity_db, 106.92, 0.01);
  EXPECT_NEAR(30 - spread_db + kFieldStrengthOfPowerDensity_db, 104.77, 0.01);
  // S = E^2 / Z0 with E as RMS; with the peak value it would be half, 3.01 dB
  const double field_v_per_m = std::pow(10, (104.768207 - 120) / 20);
  EXPECT_NEAR(ratioToDb(field_v_per_m * field_v_per_m / kFreeSpaceImpedance), 30 - spread_db, 1e-4);
}

TEST(RadarFormulas, GasesAndRainCountTwiceForEcho) {
  const RadarLink radar = searchRadar();
  const double one_way_db =
      40 * (gasAttenuation(radar.frequency_hz, AirState{}).total_db_per_km() +
            rainCoefficients(radar.frequency_hz, 0, 0).specificAttenuation_db_per_km(10.0));
  EXPECT_NEAR(radarSnrDb(radar, 5, 4e4) - radarSnrDb(radar, 5, 4e4, one_way_db), 2 * one_way_db, 1e-9);
}

TEST(Radar, RangeHasRequiredSnr) {
  const RadarLink radar = searchRadar();
  EXPECT_NEAR(radarSnrDb(radar, 5, radarRange_m(radar, 5, 13)), 13, 1e-9);
}

TEST(Jamming, BurnThroughRangeHasAllowedRatio) {
  using namespace testing;
  const RadarLink radar = searchRadar();
  JammerLink jammer;
  jammer.eirp_w = 500;
  jammer.bandwidth_hz = 2e7;
  jammer.radar_gain_dbi = 34;
  const double own = selfScreeningBurnThrough_m(radar, 5, jammer, -3);
  EXPECT_NEAR(jammerToSignalDb(radar, 5, own, jammer, own), -3, 1e-9);
  EXPECT_GT(jammerToSignalDb(radar, 5, 1.1 * own, jammer, 1.1 * own), -3);
  jammer.radar_gain_dbi = -5;
  const double far = standOffBurnThrough_m(radar, 5, jammer, 1e5, -3);
  EXPECT_NEAR(jammerToSignalDb(radar, 5, far, jammer, 1e5), -3, 1e-9);
}

TEST(Jamming, WiderBandLosesPowerOutsideRadarBand) {
  const RadarLink radar = searchRadar();
  JammerLink narrow, wide;
  narrow.eirp_w = wide.eirp_w = 1;
  narrow.bandwidth_hz = 1e5;
  wide.bandwidth_hz = 1e8;
  EXPECT_NEAR(ratioToDb(jammingPower_w(radar, narrow, 1e4) / jammingPower_w(radar, wide, 1e4)), 20, 1e-9);
}

TEST(Noise, TemperaturesAndFigures) {
  // kTB of 1 Hz at 290 K: -173.98 dBm
  EXPECT_NEAR(ratioToDb(noisePower_w(1, 290)) + 30, -173.975, 1e-3);
  EXPECT_NEAR(noiseTemperature_k(3.0103), 290, 0.01);
  // a line at 290 K before a receiver adds its loss to the noise figure
  EXPECT_NEAR(systemNoiseTemperature_k(0, 290, 2, 4), noiseTemperature_k(6), 1e-9);
}

/// A polarisation ellipse: tilt of the major axis from the horizontal; minor axis over major, 1 right and -1
/// left circular.
struct PolarizationEllipse {
  double tilt_rad = 0, axial_ratio = 0;
};

/// Part of the power that passes between two ellipses.
/// @see Blake 1980; C. A. Balanis, Antenna Theory, section 2.12 (in axial ratios)
double passedBetween(const PolarizationEllipse& a, const PolarizationEllipse& b) {
  const double a2 = a.axial_ratio * a.axial_ratio, b2 = b.axial_ratio * b.axial_ratio;
  return 0.5 +
         (4 * a.axial_ratio * b.axial_ratio + (1 - a2) * (1 - b2) * std::cos(2 * (a.tilt_rad - b.tilt_rad))) /
             (2 * (1 + a2) * (1 + b2));
}

TEST(Polarization, MismatchOfNamedOnesFollowsFromEllipses) {
  using propagation::Polarization;
  const struct {
    Polarization name;
    PolarizationEllipse ellipse;
  } all[] = {{Polarization::horizontal, {0, 0}},       {Polarization::vertical, {kPi / 2, 0}},
             {Polarization::slant_45, {kPi / 4, 0}},   {Polarization::slant_135, {3 * kPi / 4, 0}},
             {Polarization::circular_right, {0.3, 1}}, {Polarization::circular_left, {1.1, -1}}};
  for (const auto& a : all) {
    for (const auto& b : all) {
      EXPECT_NEAR(passedBetween(a.ellipse, b.ellipse), scenario::polarizationFactor(a.name, b.name, 300),
                  1e-12);
    }
  }
}

}  // namespace
}  // namespace emscape::emfield

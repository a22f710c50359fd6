// Antenna files of other programs: the gain towards known directions, contradictions, damage.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "scenario/antenna/pattern_file.h"
#include "scenario/antenna/shapes.h"
#include "tests/scenario/antenna_directions.h"
#include "tests/scenario/antenna_files.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Gain (dBi) of a smooth beam that is wider in azimuth than in elevation and points 10 degrees to the right
/// and 20 upwards, of a direction (forward, right, up).
double beamGain_dbi(const Vec3d& direction) {
  const Vec3d axis = towards(10, 20);
  const double azimuth_deg = radToDeg(std::atan2(direction.y, direction.x)) - 10;
  return 15 - 20 * (1 - dot(direction, axis)) -
         0.02 * std::abs(std::remainder(azimuth_deg, 360.0)) * (1 - std::abs(direction.z));
}

/// Rows "first,second,gain" over a sphere in steps of 5 degrees.
std::string sphereRows(const char* separator, double last_first_deg, double first_second_deg,
                       double last_second_deg, const std::function<Vec3d(double, double)>& directionOf,
                       bool swaps = false) {
  std::string text;
  for (double first = 0; first <= last_first_deg; first += 5) {
    for (double second = first_second_deg; second <= last_second_deg; second += 5) {
      text += fmt::format("{1}{0}{2}{0}{3:.6f}\n", separator, swaps ? second : first, swaps ? first : second,
                          beamGain_dbi(directionOf(first, second)));
    }
  }
  return text;
}

Vec3d fromZenith(double phi_deg, double theta_deg) {
  return towards(-phi_deg, 90 - theta_deg);
}
/// Theta from boresight, phi from the left upwards.
Vec3d fromBoresight(double phi_deg, double theta_deg) {
  const double phi = degToRad(phi_deg), theta = degToRad(theta_deg);
  return {std::cos(theta), -std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi)};
}

void expectBeam(const AntennaPtr& antenna, double tolerance_db) {
  for (const double azimuth_deg : {-170.0, -95.0, -40.0, 0.0, 10.0, 35.0, 90.0, 175.0}) {
    for (const double elevation_deg : {-60.0, -15.0, 0.0, 20.0, 55.0}) {
      const Vec3d direction = towards(azimuth_deg, elevation_deg);
      EXPECT_NEAR(gainTowards_dbi(*antenna, direction), beamGain_dbi(direction), tolerance_db)
          << azimuth_deg << " " << elevation_deg;
    }
  }
}

TEST(AntennaTables, OneBeamInTheAnglesOfManyProgramsIsOneAntenna) {
  const std::string az_el = sphereRows(",", 355, -90, 90, towards);
  for (const auto& [name, text] : {
           std::pair<std::string, std::string>{"a.csv", "azimuth_deg,elevation_deg,gain_dbi\n" + az_el},
           {"b.csv", "Az (deg),El (deg),Gain (dBi)\n" + az_el},
           {"c.csv", "Freq [GHz];Phi[deg];Theta[deg];dB(GainTotal)[];Phase [deg]\n" +
                         [] {
                           std::string rows, part = sphereRows(";", 360, 0, 180, fromZenith);
                           for (std::size_t at = 0, end; at < part.size(); at = end + 1) {
                             end = part.find('\n', at);
                             std::string row = part.substr(at, end - at);
                             std::replace(row.begin(), row.end(), '.', ',');
                             rows += "3,5;" + row + ";17\n";
                           }
                           return rows;
                         }()},
           {"d.ant", "stk.v.11.0\nThetaPhiPattern\nAngleUnits Degrees\nNumberOfPoints 2701\nPatternData\n" +
                         sphereRows(" ", 360, 0, 180, fromBoresight, true)},
           {"e.pattern",
            "stk.v.11.0\nPhiThetaPattern\nPatternData\n" + sphereRows("\t", 360, 0, 180, fromBoresight)},
           {"f.ant", "stk.v.11.0\nAzElPattern\nPatternData\n" + sphereRows(" ", 360, -90, 90, towards)},
           {"g.ant", "stk.v.11.0\nElAzPattern\nPatternData\n" + sphereRows(" ", 360, -90, 90, towards, true)},
       }) {
    SCOPED_TRACE(name);
    const TemporaryFile file(name, text);
    const PatternFile pattern = readPatternFile(file.path());
    EXPECT_THAT(pattern.warnings, IsEmpty());
    ASSERT_TRUE(pattern.gain_dbi);
    const bool is_resampled = name == "d.ant" || name == "e.pattern";
    EXPECT_NEAR(*pattern.gain_dbi, 15, is_resampled ? 0.15 : 1e-6);
    expectBeam(readAntenna(file.path()), is_resampled ? 0.2 : 0.05);
    EXPECT_EQ(readAntenna(file.path(), 7)->gain_dbi, 7);
  }
}

TEST(AntennaTables, WhatIsIgnoredAndAssumedIsTold) {
  const TemporaryFile file(
      "a.csv", "Freq [GHz],Phi[deg],Theta[deg],dB(GainTotal)[]\n" + [] {
        std::string rows;
        for (int phi = 0; phi < 360; phi += 90) {
          for (int theta = 0; theta <= 180; theta += 45)
            rows += fmt::format("3.5,{},{},{}\n", phi, theta, phi == 0 && theta == 90 ? 5 : -10);
        }
        return rows;
      }());
  const PatternFile pattern = readPatternFile(file.path());
  EXPECT_THAT(pattern.notes,
              ElementsAre(HasSubstr("ignored: 1 columns (Freq [GHz])"),
                          HasSubstr("the largest value of 'dB(GainTotal)[]', 5 dB, is taken as the gain"),
                          HasSubstr("theta is from the zenith")));
}

TEST(AntennaTables, WhatARowLeavesOutHasTheSmallestGainAndAWarning) {
  std::string rows = "stk.v.4.3\nAzElPattern\nPatternData\n";
  for (int azimuth = -20; azimuth <= 20; azimuth += 5) {
    for (int elevation = -20; elevation <= 20; elevation += 5)
      rows += fmt::format("{} {} {}\n", azimuth, elevation, 30 - 0.5 * std::hypot(azimuth, elevation));
  }
  const TemporaryFile file("a.ant", rows);
  const PatternFile pattern = readPatternFile(file.path());
  EXPECT_THAT(pattern.warnings,
              ElementsAre(HasSubstr("the rows cover -20 to 20 deg in azimuth and -20 to 20 deg in elevation: "
                                    "elsewhere their smallest gain is used, 14.1 dB below the maximum")));
  const AntennaPtr antenna = readAntenna(file.path());
  EXPECT_NEAR(gainTowards_dbi(*antenna, towards(120, 0)), 30 - 14.142, 0.01);
  EXPECT_NEAR(gainTowards_dbi(*antenna, towards(0, 10)), 25, 0.01);
}

TEST(AntennaTables, ContradictionsAreErrorsAtTheirPlace) {
  const TemporaryFile file("a.csv", "");
  const auto expectBroken = [&](const std::string& content, int line, int column, const std::string& part) {
    file.rewrite(content);
    expectFault([&] { readAntenna(file.path(), 10); }, file.path(), line, column, part);
  };
  expectBroken("theta_deg,elevation_deg,gain_dbi\n", 1, 11, "are the same angle");
  expectBroken("theta_deg,azimuth_deg,gain_dbi\n", 1, 1, "no pair of angles among the columns");
  expectBroken("theta_deg,phi_deg,mag(rE)\n", 1, 1, "no gain, directivity or attenuation among the columns");
  expectBroken("theta_deg,phi_deg,attenuation\n0,0,-3\n", 2, 5,
               "attenuations are 0 or above: is it gain_db?");
  expectBroken("theta_deg,phi_deg,gain\n0,0,0.5\n90,0,1\n", 0, 0, "as those of a linear gain");
  expectBroken("theta_deg,phi_deg,gain\n0,0,30\n90,0,1\n180,0,0.001\n", 0, 0, "as those of a linear gain");
  expectBroken("theta_deg,phi_deg,gain_dbi\n200,0,3\n", 2, 1, "theta_deg is 200 deg");
  expectBroken("freq,theta_deg,phi_deg,gain_dbi\n1,0,0,3\n2,0,0,3\n", 0, 0, "the table has 2 frequencies");
  expectBroken("theta_deg,phi_deg,gain_dbi\n0,0,3\n90,0,3\n0,90,3\n", 0, 0, "the rows are not a full grid");
  expectBroken("theta_deg,phi_deg,gain_dbi\n0,0,3\n0,0,9\n", 3, 1, "occurs a second time, with 9 dB instead");
}

std::string nsma(const std::string& header, bool has_elevation = true) {
  std::string text = "REVNUM:,NSMA WG16.99.050\nANTMAN:,Acme\nMODNUM:,P-900\nLOWFRQ:,880\n" + header;
  const auto cut = [&](const char* plane, const char* polarization, double width, double tilt,
                       double offset) {
    text += fmt::format("PATCUT:,{}\nPOLARI:,{}\nNUPOIN:,360\nFSTLST:,-180,179\n", plane, polarization);
    for (int angle = -180; angle < 180; ++angle) {
      const double off = std::remainder(angle + tilt, 360.0) / width;
      text += fmt::format("{},{:.3f}\n", angle, offset - std::min(12 * off * off, 25.0));
    }
  };
  cut("H", "V/V", 65, 0, 0);
  cut("H", "V/H", 65, 0, -20);
  if (has_elevation) cut("V", "V/V", 10, 4, 0);
  return text + "ENDFIL:,EOF\n";
}

TEST(AntennaFiles, InArchivesAreRefusedWithTheirNames) {
  const test::TemporaryFolder folder;
  const std::string text = nsma("GUNITS:,DBI/DBR\nMDGAIN:,15\n");
  const std::string first = folder.write("a.adf", text), second = folder.write("b.adf", text);
  test::writeZip(folder / "antennas.zip", {{"a.adf", first}, {"b.adf", second}});
  for (const char* const name : {"antennas.zip", "antennas.adf", "antennas.csv"}) {
    if (folder / name != folder / "antennas.zip")
      std::filesystem::copy_file(folder / "antennas.zip", folder / name);
    const std::string file = folder / name;
    expectFault(
        [&] { readAntenna(file); }, file, 0, 0,
        "an antenna file is read unpacked: it is an archive (ZIP) of a.adf, b.adf; unpack it (unzip " + file +
            ") and name one of them");
  }
  test::writeGzip(first, folder / "a.adf.gz");
  expectFault([&] { readAntenna(folder / "a.adf.gz"); }, folder / "a.adf.gz", 0, 0, "gunzip ");
  EXPECT_NO_THROW(readAntenna(first));  // the remedy
}

TEST(AntennaFiles, StateTheirFrequencies) {
  const auto bandOf = [](const char* name, const std::string& text) {
    const TemporaryFile file(name, text);
    return readPatternFile(file.path()).stated_band;
  };
  const StatedBand nsma_band = bandOf("a.adf", nsma("HGHFRQ:,960.5\n"));
  EXPECT_EQ(nsma_band.lowest_hz, 880e6);
  EXPECT_EQ(nsma_band.highest_hz, 960.5e6);
  EXPECT_EQ(bandOf("a.adf", nsma("")).highest_hz, HUGE_VAL);
  const std::string cuts =
      "\nGAIN 12\nHORIZONTAL 4\n0 0\n90 10\n180 20\n270 10\nVERTICAL 4\n0 0\n90 15\n180 20\n270 16\n";
  for (const char* const one :
       {"FREQUENCY 900", "FREQUENCY (MHz) 900", "frequency\t900 MHz", "FREQUENCY 0.9GHz"}) {
    EXPECT_EQ(bandOf("a.msi", one + cuts).lowest_hz, 900e6) << one;
    EXPECT_EQ(bandOf("a.msi", one + cuts).highest_hz, 900e6) << one;
  }
  EXPECT_EQ(bandOf("a.msi", "FREQUENCY 880-960" + cuts).highest_hz, 960e6);
  EXPECT_EQ(bandOf("a.msi", "FREQUENCY dual band" + cuts).lowest_hz, 0);
}

TEST(NsmaAntenna, HasGainCutsAndTilt) {
  const TemporaryFile file("a.adf", nsma("GUNITS:,DBD/DBR\nMDGAIN:,15.35\nAZWIDT:,65\nELTILT:,4\n"));
  const PatternFile pattern = readPatternFile(file.path());
  EXPECT_THAT(pattern.warnings, IsEmpty());
  EXPECT_THAT(pattern.notes, ElementsAre("azimuth: cut H V/V", "elevation: cut V V/V",
                                         "ignored: 1 lines and cuts (cut H V/H)"));
  EXPECT_NEAR(*pattern.gain_dbi, 17.5, 1e-9);
  const AntennaPtr antenna = readAntenna(file.path());
  EXPECT_EQ(antenna->description.substr(0, 10), "Acme P-900");
  EXPECT_NEAR(gainTowards_dbi(*antenna, towards(0, -4)), 17.5, 0.01) << "the beam points downwards";
  EXPECT_NEAR(gainTowards_dbi(*antenna, towards(32, -4)), 17.5 - 12 * 0.2424, 0.02);
  EXPECT_NEAR(gainTowards_dbi(*antenna, towards(0, 1)), 17.5 - 3, 0.02);
}

TEST(NsmaAntenna, ContradictionsAndAssumptionsAreTold) {
  const auto warningsOf = [](const std::string& header, bool has_elevation) {
    const TemporaryFile file("a.adf", nsma(header, has_elevation));
    std::vector<std::string> warnings;
    antennaOf(file.path(), readPatternFile(file.path()), 10, warnings);
    return warnings;
  };
  EXPECT_THAT(warningsOf("ELTILT:,-4\n", true),
              ElementsAre(HasSubstr("ELTILT is -4 deg downwards, but the elevation cut has its maximum 4 deg "
                                    "below the horizon")));
  EXPECT_THAT(warningsOf("AZWIDT:,30\n", true),
              ElementsAre(HasSubstr("the file states a beamwidth of 30 deg in azimuth, but its pattern is")));
  EXPECT_THAT(warningsOf("ELWIDT:,8\nELTILT:,4\n", false),
              ElementsAre(HasSubstr("no elevation cut; a Gaussian beam of ELWIDT, 8 deg, at ELTILT, 4 deg")));
  EXPECT_THAT(warningsOf("MDGAIN:,10\n", true), ElementsAre(HasSubstr("MDGAIN without GUNITS")));
  const TemporaryFile linear("a.adf", nsma("GUNITS:,LIN/LIN\nMDGAIN:,10\n"));
  expectFault([&] { readAntenna(linear.path()); }, linear.path(), 0, 0, "GUNITS is 'LIN/LIN'");
  const TemporaryFile none("a.adf", nsma("", false));
  expectFault([&] { readAntenna(none.path(), 3); }, none.path(), 0, 0, "no ELWIDT from which to make one");
}

TEST(SplatAntenna, IsTurnedAndTilted) {
  const test::TemporaryFolder folder;
  std::string azimuth = "45.0\n", elevation = "2.0 45.0\n";
  for (int angle = 0; angle < 360; ++angle)
    azimuth +=
        fmt::format("{}\t{:.4f}\n", angle, 0.55 + 0.45 * std::cos(degToRad(static_cast<double>(angle))));
  for (int below = -90; below <= 90; ++below)
    elevation += fmt::format("{} {:.4f} ; row\n", below, std::exp(-0.01 * (below - 1) * (below - 1)));
  const std::string file = folder.write("l.az", azimuth);
  folder.write("l.el", elevation);
  const AntennaPtr antenna = readAntenna(file, 6);
  const auto fieldAt = [&](double azimuth_deg, double elevation_deg) {
    return antenna->amplitudeTowards(towards(azimuth_deg, elevation_deg), 0, 0);
  };
  EXPECT_NEAR(fieldAt(45, -3), 1, 0.01) << "turned by 45 deg, tilted by 2 below the 1 deg of the file";
  EXPECT_NEAR(fieldAt(225, 1), 0.1, 0.01) << "the back is tilted upwards";
  EXPECT_NEAR(fieldAt(135, -1), 0.55, 0.01);
  EXPECT_THAT(test::errorOf([&] { readAntenna(file); }), HasSubstr("the SPLAT! pattern has no gain"));
  EXPECT_NEAR(readAntenna(folder / "l.el", 6)->amplitudeTowards(towards(45, -3), 0, 0), 1, 0.01);
}

TEST(SplatAntenna, WithoutElevationsIsTheSameAtAll) {
  const TemporaryFile file("a.az", "0\n0 1\n90 0.5\n180 0.25\n270 0.5\n");
  const PatternFile pattern = readPatternFile(file.path());
  EXPECT_THAT(pattern.notes, ElementsAre("no .el file beside it: the same at all elevations"));
  EXPECT_NEAR(readAntenna(file.path(), 3)->amplitudeTowards(towards(90, 40), 0, 0), 0.5, 1e-6);
  const TemporaryFile decibels("b.az", "0\n0 0\n90 -3\n180 -10\n");
  expectFault([&] { readAntenna(decibels.path(), 3); }, decibels.path(), 3, 4,
              "the relative field is -3; allowed are 0 to 1.001");
}

TEST(MsiAntenna, GainsInPlaceOfAttenuationsAreTurnedWithAWarning) {
  const TemporaryFile file(
      "a.msi",
      "80010292 X-pol panel\nMAKE Acme\n900 960\nGAIN 10 dBi\nH_WIDTH 180\nHORIZONTAL 4\n0 "
      "0\n90 -10\n180 -20\n270 -11\nVERTICAL 4\n0 0\n90 15\n180 20\n270 16\n");
  const PatternFile pattern = readPatternFile(file.path());
  EXPECT_THAT(pattern.warnings,
              ElementsAre(HasSubstr("the HORIZONTAL cut has gains relative to the maximum")));
  EXPECT_THAT(pattern.notes, ElementsAre("ignored: 3 lines (80010292, MAKE, 900)"));
  EXPECT_NEAR(gainTowards_dbi(*readAntenna(file.path()), towards(90, 0)), 0, 1e-4);
}

TEST(AntennaFormats, DamageToEveryByteIsAnErrorOrAnAntenna) {
  std::string small_nsma =
      "REVNUM:,NSMA\nGUNITS:,DBI/DBR\nMDGAIN:,9\nELWIDT:,20\nPATCUT:,AZ\nPOLARI:,H/"
      "H\nNUPOIN:,4\nFSTLST:,-180,"
      "90\n-180,-30\n-90,-20\n0,0\n90,-20\nENDFIL:,EOF\n";
  std::string stk = "stk.v.11.0\nSymmetricPattern\nNumberOfPoints 3\nPatternData\n0 9\n10 6\n180 -20\n";
  std::string table = "theta,phi,gain_db\n0,0,-3\n90,0,0\n180,0,-9\n0,90,-3\n90,90,-1\n180,90,-9\n";
  for (const auto& [name, text] : {std::pair<const char*, std::string>{"a.adf", small_nsma},
                                   {"a.ant", stk},
                                   {"a.csv", table},
                                   {"a.az", "5\n0 1\n120 0.5\n240 0.5\n"},
                                   {"a.el", "1 0\n-10 0.5\n0 1\n90 0.1\n"}}) {
    SCOPED_TRACE(name);
    const TemporaryFile file(name, text);
    surviveDamage(file, text, [&file = file] { readAntenna(file.path(), 10); });
  }
}

}  // namespace
}  // namespace emscape::scenario

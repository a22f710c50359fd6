// The keys of atmosphere.refractivity.
#include <gmock/gmock.h>

#include <cmath>

#include "emscape/scenario/file/scenario_file.h"
#include "propagation/parabolic_equation/air/bulk_duct.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "scenario/file/parameters.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

using namespace propagation;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RefractivityKeys : public ::testing::Test {
 protected:
  std::string fileOf(const std::string& atmosphere) {
    return folder_.write("scenario.yaml", R"(schema_version: 1
name: small
epoch: 2023-11-18T01:00:00Z
region: {origin: {latitude_deg: 36, longitude_deg: -84}, size_m: [1000, 1000, 1000], dims: [4, 4, 4]}
atmosphere: )" + atmosphere + R"(
ground: {kind: sea}
platforms:
  - {name: site, position: {latitude_deg: 36, longitude_deg: -84, height_msl_m: 100}}
emitters:
  - {name: radio, platform: site, kind: transmitter, frequency_hz: 1.0e9, power_w: 10, antenna: {pattern: isotropic}, propagation: )" +
                                              propagation_ + "}\n");
  }
  ParseResult parse(const std::string& refractivity, const std::vector<Edit>& edits = {}) {
    return parseScenario(fileOf("{refractivity: " + refractivity + "}"), edits);
  }
  std::shared_ptr<const Refractivity> refractivityOf(const std::string& text,
                                                     const std::vector<Edit>& edits = {}) {
    const ParseResult result = parse(text, edits);
    for (const Problem& problem : result.problems) {
      if (problem.severity == Severity::error) ADD_FAILURE() << text << ": " << problem.message;
    }
    return result.scenario ? result.scenario->atmosphere.refractivity
                           : std::make_shared<const Refractivity>();
  }
  RefractivityProfile profileOf(const std::string& text) { return refractivityOf(text)->air.profiles.at(0); }
  /// "line:column: message" of every problem.
  std::vector<std::string> problemsOf(const std::string& refractivity) {
    std::vector<std::string> all;
    for (const Problem& problem : parse(refractivity).problems) {
      const SourceLocation& at = problem.location;
      all.push_back(at.file.substr(at.file.rfind('/') + 1) + ":" + std::to_string(at.line) + ":" +
                    std::to_string(at.column) + ": " + problem.message);
    }
    return all;
  }

  test::TemporaryFolder folder_;
  std::string propagation_ = "free_space";
};

TEST_F(RefractivityKeys, GiveEachKind) {
  EXPECT_FALSE(parseScenario(fileOf("{rain_mm_h: 1}")).scenario->atmosphere.refractivity);
  EXPECT_NEAR(profileOf("{kind: standard}").at(1000), 330 + 118, 1e-9);
  EXPECT_NEAR(profileOf("{kind: linear, gradient_m_per_km: 50, surface_m_units: 300}").at(1000), 350, 1e-9);
  EXPECT_EQ(profileOf("{kind: evaporation_duct, duct_height_m: 14}").at(10), evaporationDuct(14).at(10));
  EXPECT_NEAR(profileOf("{kind: surface_duct, top_m: 50, deficit_m_units: 10}").at(50), 320, 1e-9);
  EXPECT_NEAR(profileOf("{kind: trilinear, base_m: 200, top_m: 300, deficit_m_units: 40}").at(300), 313.6,
              1e-9);
  folder_.write("air.csv", "height_msl_m,m_units\n0,330\n100,320\n");
  const RefractivityProfile measured = profileOf("{kind: profile, file: air.csv}");
  EXPECT_NEAR(measured.at(50), 325, 1e-9);
  EXPECT_NEAR(measured.at(1100), 320 + 118, 1e-9);
  BulkInputs inputs;
  inputs.air_temperature_k = 287;
  inputs.sea_temperature_k = 288;
  inputs.relative_humidity_percent = 70;
  inputs.wind_m_s = 6;
  inputs.sensor_height_m = 20;
  inputs.wind_height_m = 20;
  EXPECT_EQ(
      profileOf("{kind: bulk, air_temperature_k: 287, sea_temperature_k: 288, relative_humidity_percent: 70, "
                "wind_m_s: 6, sensor_height_m: 20}")
          .at(8),
      bulkAir(inputs).profile.at(8));
}

TEST_F(RefractivityKeys, TakeTheSoundingNearestToTheEpochOrToATime) {
  folder_.write("station.txt",
                "#USM00072649 2023 11 18 00 2303    2 ncdc-nws           448497  -935647\n"
                "21     0  98107B  290    65B  350   143   360     0 \n"
                "20    33  95916   476B   60B  325   152   224    73 \n"
                "#USM00072649 2023 11 18 12 1101    2 ncdc-nws           448497  -935647\n"
                "21     0  98022B  290    -9B  810    28   360     0 \n"
                "20     4  97717   316B   -1B  771    35   275    26 \n");
  EXPECT_NEAR(profileOf("{kind: soundings, file: station.txt}").levels.at(1).height_msl_m, 476, 0.1);
  EXPECT_NEAR(
      profileOf("{kind: soundings, file: station.txt, time: 2023-11-18T11:00:00Z}").levels.at(1).height_msl_m,
      316, 0.1);
}

TEST_F(RefractivityKeys, SoundingInUseIsNamedAndAFarOneIsWarnedOf) {
  const std::string levels =
      "21     0  98107B  290    65B  350   143   360     0 \n"
      "20    33  95916   476B   60B  325   152   224    73 \n";
  folder_.write("near.txt",
                "#USM00072649 2023 11 18 00 2303    2 ncdc-nws           360000  -835000\n" + levels);
  EXPECT_EQ(
      refractivityOf("{kind: soundings, file: near.txt}")->source,
      "near.txt: sounding of USM00072649, 2023-11-18T00:00:00Z (2 of 2 levels; 1 sounding in the file); 1 h "
      "before the epoch, 45 km from the region's origin");
  EXPECT_THAT(problemsOf("{kind: soundings, file: near.txt}"),
              testing::Not(testing::Contains(HasSubstr("the sounding in use"))));
  folder_.write("far.txt",
                "#USM00072649 2021 11 18 00 2303    2 ncdc-nws           448497  -935647\n" + levels);
  EXPECT_THAT(
      problemsOf("{kind: soundings, file: far.txt}"),
      testing::Contains(HasSubstr("the sounding in use, of USM00072649 at 2021-11-18T00:00:00Z, is 730 days "
                                  "before the epoch and 1273 km from the region's origin")));
}

TEST_F(RefractivityKeys, AddAnEvaporationDuct) {
  const auto refractivity = refractivityOf(
      "{kind: trilinear, base_m: 200, top_m: 300, deficit_m_units: 40, evaporation_duct_height_m: 14}");
  EXPECT_EQ(refractivity->air.evaporation_duct_m, 14);
  EXPECT_THAT(problemsOf("{kind: bulk, evaporation_duct_height_m: 14}"),
              testing::Contains(HasSubstr("'evaporation_duct_height_m' goes with kind standard or")));
}

TEST_F(RefractivityKeys, AreEditedByPath) {
  const std::string text = "{kind: evaporation_duct, duct_height_m: {mean: 14, deviation: 3}, members: 4}";
  const auto heightOf = [](const std::shared_ptr<const Refractivity>& r) {
    double lowest = 0;
    for (const RefractivityLevel& level : r->air.profiles.at(0).levels)
      if (level.m_units < r->air.profiles.at(0).at(lowest)) lowest = level.height_msl_m;
    return lowest;
  };
  EXPECT_NEAR(heightOf(refractivityOf(text)), 14, 0.5);
  EXPECT_NEAR(heightOf(refractivityOf(text, {{"atmosphere.refractivity.duct_height_m.mean", "24"}})), 24, 1);
  const auto single = refractivityOf(text, {{"atmosphere.refractivity.duct_height_m", "30"}});
  EXPECT_NEAR(heightOf(single), 30, 1);
  EXPECT_THAT(single->members, IsEmpty());
  EXPECT_EQ(refractivityOf("{kind: evaporation_duct, duct_height_m: 14, members: 3}",
                           {{"atmosphere.refractivity.duct_height_m", "{mean: 14, deviation: 3}"}})
                ->members.size(),
            3u);
  // Rows of the window, and the choice of another kind there.
  const ParseResult result = parse(text);
  ASSERT_TRUE(result.scenario);
  const auto group = parametersOf(*result.scenario, "atmosphere.refractivity");
  EXPECT_EQ(group.parameters.at(0).value, "evaporation_duct");
  Scenario edited = *result.scenario;
  edited.set(editsForChoice(edited, "atmosphere.refractivity.kind", "trilinear"));
  EXPECT_EQ(edited.atmosphere.refractivity->air.profiles.at(0).levels.size(), 3u);
}

TEST_F(RefractivityKeys, DrawTheSameMembersFromTheSameSeed) {
  const auto draw = [&](const std::string& more) {
    return refractivityOf("{kind: surface_duct, top_m: {mean: 50, deviation: 10}, deficit_m_units: 10" +
                          more + "}");
  };
  const auto few = draw(", members: 3"), many = draw(", members: 400, quantile: 0.9"),
             other = draw(", members: 3, seed: 2");
  ASSERT_EQ(few->members.size(), 3u);
  const auto top = [](const RefractivityField& field) {
    return field.profiles.at(0).levels.back().height_msl_m;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(top(few->members[i]), top(many->members[i]));  // a member does not depend on their number
    EXPECT_NE(top(few->members[i]), top(other->members[i]));
  }
  double sum = 0, squares = 0;
  for (const RefractivityField& member : many->members) {
    sum += top(member);
    squares += std::pow(top(member) - 50, 2);
  }
  EXPECT_NEAR(sum / 400, 50, 3 * 10 / std::sqrt(400.0));
  EXPECT_NEAR(std::sqrt(squares / 400), 10, 3 * 10 / std::sqrt(800.0));
  EXPECT_EQ(top(many->air), 50);
  EXPECT_EQ(many->quantile, 0.9);
}

TEST_F(RefractivityKeys, DrawMembersAgainThatAreOutsideTheLimits) {
  const auto refractivity = refractivityOf(
      "{kind: trilinear, base_m: {mean: 100, deviation: 60}, top_m: {mean: 130, deviation: 60}, "
      "deficit_m_units: 10, members: 200}");
  for (const RefractivityField& member : refractivity->members) {
    const auto& levels = member.profiles.at(0).levels;
    EXPECT_LT(levels[levels.size() - 2].height_msl_m, levels.back().height_msl_m);
  }
}

TEST_F(RefractivityKeys, OneMemberHasMeanValues) {
  const auto one =
      refractivityOf("{kind: evaporation_duct, duct_height_m: {mean: 14, deviation: 3}, members: 1}");
  EXPECT_THAT(one->members, IsEmpty());
  EXPECT_TRUE(areSame(one, refractivityOf("{kind: evaporation_duct, duct_height_m: 14}")));
  EXPECT_THAT(problemsOf("{kind: evaporation_duct, duct_height_m: {mean: 14, deviation: 3}, quantile: 0.5}"),
              AllOf(testing::Contains(HasSubstr("'members' is 1: its mean is taken")),
                    testing::Contains(HasSubstr("'quantile' applies to an ensemble"))));
  EXPECT_THAT(problemsOf("{kind: evaporation_duct, duct_height_m: 14, members: 5}"),
              testing::Contains(HasSubstr("'members' is 5, but no value has a deviation")));
}

TEST_F(RefractivityKeys, ExcludeKFactor) {
  const ParseResult result = parseScenario(fileOf("{k_factor: 1.5, refractivity: {kind: standard}}"));
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].severity, Severity::error);
  EXPECT_THAT(result.problems[0].message, HasSubstr("'refractivity' and 'k_factor' exclude each other"));
}

TEST_F(RefractivityKeys, SayWhichModelsDoNotReadThem) {
  EXPECT_THAT(
      problemsOf("{kind: standard}"),
      ElementsAre(HasSubstr("scenario.yaml:5:28: 'refractivity' is for parabolic_equation; the models of "
                            "'radio' (free_space) do not read it")));
  propagation_ = "diffraction";
  EXPECT_THAT(problemsOf("{kind: evaporation_duct, duct_height_m: 14}"),
              ElementsAre(HasSubstr("the models of 'radio' (diffraction) bend rays by k_factor, 1.333")));
  EXPECT_EQ(parse("{kind: evaporation_duct, duct_height_m: 14}").scenario->atmosphere.k_factor, 4.0 / 3);
  // A linear profile has a k factor, which the other models take.
  EXPECT_NEAR(parse("{kind: linear, gradient_m_per_km: 78.48}").scenario->atmosphere.k_factor, 2, 1e-3);
  EXPECT_EQ(parse("{kind: linear, gradient_m_per_km: -50}").scenario->atmosphere.k_factor, 4.0 / 3);
}

TEST_F(RefractivityKeys, ErrorsHaveLocations) {
  const auto first = [&](const std::string& text) { return problemsOf(text).at(0); };
  EXPECT_THAT(first("{kind: evaporation_duct, duct_height_m: 61}"),
              HasSubstr("scenario.yaml:5:68: 'duct_height_m' is 61, outside the allowed range 0 to 60 m"));
  EXPECT_THAT(first("{kind: evaporation_duct, duct_height_m: .nan}"), HasSubstr("not a finite number"));
  EXPECT_THAT(first("{kind: evaporation_duct, duct_height_m: [1]}"),
              HasSubstr("'duct_height_m' must be a number (m) or the keys of a spread, not a list"));
  EXPECT_THAT(first("{kind: evaporation_duct, duct_height_m: {mean: 14}}"),
              HasSubstr("missing key 'deviation' of the spread"));
  EXPECT_THAT(
      first("{kind: evaporation_duct, duct_height_m: {mean: 140, deviation: 3}, members: 2}"),
      HasSubstr(
          "scenario.yaml:5:75: the mean of 'duct_height_m' is 140, outside the allowed range 0 to 60 m"));
  EXPECT_THAT(first("{kind: trilinear, base_m: 300, top_m: 200, deficit_m_units: 40}"),
              HasSubstr("top of the layer: 200 m is not above its base of 300 m"));
  EXPECT_THAT(first("{kind: duct}"), HasSubstr("must be one of standard, linear, evaporation_duct"));
  EXPECT_THAT(first("{kind: surface_duct, top_m: 50}"), HasSubstr("missing key 'deficit_m_units'"));
  EXPECT_THAT(
      first("{kind: evaporation_duct, duct_height_m: {mean: 60, deviation: 0}, members: 2, seed: -1}"),
      HasSubstr("'seed' is -1"));
}

TEST_F(RefractivityKeys, NameTheFilesOfFaults) {
  EXPECT_THAT(problemsOf("{kind: profile, file: none.csv}").at(0),
              AllOf(HasSubstr("scenario.yaml:5:"), HasSubstr("none.csv")));
  folder_.write("air.csv", "height_msl_m,m_units\n0,330\n0,331\n");
  EXPECT_THAT(problemsOf("{kind: profile, file: air.csv}").at(0),
              HasSubstr("air.csv:3:1: height: 0 m is not above the level before"));
  folder_.write("air.csv", "height_msl_m,m_units\n80,330\n2000,260\n");
  const std::vector<std::string> problems = problemsOf("{kind: profile, file: air.csv}");
  EXPECT_THAT(problems, testing::Contains(HasSubstr("these look like N-units")));
  EXPECT_THAT(problems, testing::Contains(HasSubstr("the first level is 80 m above the sea")));
  folder_.write("air.csv", "height_msl_m,m_units\n0,330\n60,337\n");
  EXPECT_THAT(problemsOf("{kind: profile, file: air.csv}"),
              testing::Contains(HasSubstr("the profile ends at 60 m, below 'radio' at 100 m")));
}

TEST_F(RefractivityKeys, SayWhenABulkDuctIsNotDefined) {
  EXPECT_THAT(problemsOf("{kind: bulk, air_temperature_k: 290.15, sea_temperature_k: 288.15, "
                         "relative_humidity_percent: 40, wind_m_s: 5}"),
              testing::Contains(HasSubstr("the height of the evaporation duct is not defined")));
}

TEST_F(RefractivityKeys, KeepTheirFileThroughEdits) {
  folder_.write("air.csv", "height_msl_m,m_units\n0,330\n100,320\n");
  ParseResult result = parse("{kind: profile, file: air.csv}");
  ASSERT_TRUE(result.scenario);
  std::filesystem::remove(folder_.path() / "air.csv");
  Scenario edited = *result.scenario;
  edited.set("emitters.radio.power_w", "20");
  EXPECT_TRUE(areSame(edited.atmosphere.refractivity, result.scenario->atmosphere.refractivity));
}

}  // namespace
}  // namespace emscape::scenario

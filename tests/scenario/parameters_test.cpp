#include "scenario/file/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::scenario {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::shared_ptr<const Scenario> shipped(const char* name) {
  return loadScenario(test::shippedScenario(name));
}

const Parameter* find(const ParameterGroup& group, const std::string& path) {
  for (const Parameter& parameter : group.parameters) {
    if (parameter.path == path) return &parameter;
  }
  for (const ParameterGroup& inner : group.groups) {
    if (const Parameter* found = find(inner, path)) return found;
  }
  return nullptr;
}

void forEach(const ParameterGroup& group, const std::function<void(const Parameter&)>& visit) {
  for (const Parameter& parameter : group.parameters) visit(parameter);
  for (const ParameterGroup& inner : group.groups) forEach(inner, visit);
}

TEST(Parameters, StateValueAndAllowedValues) {
  const auto scenario = shipped("jacksboro.yaml");
  const ParameterGroup radar = parametersOf(*scenario, "emitters.search radar");
  EXPECT_EQ(radar.name, "search radar");
  const Parameter* power = find(radar, "emitters.search radar.power_w");
  ASSERT_TRUE(power);
  EXPECT_EQ(power->name, "power");
  EXPECT_EQ(power->unit, "W");
  EXPECT_EQ(power->value, "20000");
  EXPECT_TRUE(power->minimum_excluded) << "above 0";
  EXPECT_TRUE(power->is_given && power->required);
  const Parameter* pulses = find(radar, "emitters.search radar.receiver.pulses");
  ASSERT_TRUE(pulses);
  EXPECT_EQ(pulses->type, Parameter::Type::integer);
  const Parameter* isolation = find(radar, "emitters.search radar.receiver.cross_polar_isolation_db");
  ASSERT_TRUE(isolation);
  EXPECT_FALSE(isolation->is_given);
  EXPECT_EQ(isolation->value, "25");
  const Parameter* platform = find(radar, "emitters.search radar.platform");
  ASSERT_TRUE(platform);
  EXPECT_THAT(platform->choices, Contains("helicopter"));
}

TEST(Parameters, OmitParametersWithoutChoices) {
  const auto scenario = shipped("jacksboro.yaml");
  const ParameterGroup radar = parametersOf(*scenario, "emitters.search radar");
  EXPECT_TRUE(find(radar, "emitters.search radar.antenna.max_elevation_deg"));
  EXPECT_FALSE(find(radar, "emitters.search radar.antenna.columns"));
  EXPECT_TRUE(find(radar, "emitters.search radar.scan.rate_rpm"));
  EXPECT_FALSE(find(radar, "emitters.search radar.scan.width_deg"));
  EXPECT_FALSE(find(radar, "emitters.search radar.itm.form"));  // it uses `horizon`
  const ParameterGroup jammer = parametersOf(*scenario, "emitters.jammer");
  EXPECT_TRUE(find(jammer, "emitters.jammer.scan.kind"));  // not given
  EXPECT_FALSE(find(jammer, "emitters.jammer.scan.azimuth_deg"));
  EXPECT_FALSE(find(jammer, "emitters.jammer.receiver.pulses"));
  const ParameterGroup site = parametersOf(*scenario, "platforms.ridge site");
  EXPECT_TRUE(find(site, "platforms.ridge site.position.height_agl_m"));
  EXPECT_FALSE(find(site, "platforms.ridge site.position.height_msl_m"));
  EXPECT_FALSE(find(site, "platforms.ridge site.track.file"));
  const ParameterGroup helicopter = parametersOf(*scenario, "platforms.helicopter");
  EXPECT_TRUE(find(helicopter, "platforms.helicopter.track.file"));
  EXPECT_TRUE(find(parametersOf(*scenario, "ground"), "ground.kind"));  // not in the file
}

/// The names are words: no keys, no unit's suffixes, no abbreviations that only keys have.
TEST(Parameters, HaveNamesInWords) {
  for (const char* name : {"jacksboro.yaml", "jamming.yaml", "links.yaml", "sinr.yaml", "clutter.yaml"}) {
    const auto scenario = shipped(name);
    std::vector<std::string> paths{"atmosphere", "ground", "output", "region"};
    for (const Emitter& emitter : scenario->emitters) paths.push_back("emitters." + pathStep(emitter.name));
    for (const auto& platform : scenario->platforms) paths.push_back("platforms." + pathStep(platform.name));
    for (const auto& receiver : scenario->receivers) paths.push_back("receivers." + pathStep(receiver.name));
    for (const auto& target : scenario->targets) paths.push_back("targets." + pathStep(target.name));
    for (const std::string& path : paths) {
      forEach(parametersOf(*scenario, path), [&](const Parameter& parameter) {
        const std::string words = " " + parameter.name + " ";
        for (const char* wrong : {"_", " agl ", " msl ", " az ", " el ", " pfa ", " prf ", " cfar ", " rcs ",
                                  " deg ", " msec ", " swerling "}) {
          EXPECT_EQ(words.find(wrong), std::string::npos) << parameter.path << ": " << parameter.name;
        }
        EXPECT_EQ(parameter.titles.size(), parameter.choices.size()) << parameter.path;
        if (parameter.key == "platform") return;
        for (const std::string& title : parameter.titles)
          EXPECT_EQ(title.find('_'), std::string::npos) << title;
      });
    }
  }
}

TEST(Parameters, OfferTheNamesOfOtherItems) {
  const auto scenario = shipped("sinr.yaml");
  const ParameterGroup output = parametersOf(*scenario, "output");
  EXPECT_THAT(find(output, "output.wanted_emitter")->choices, Contains(scenario->emitters.front().name));
  EXPECT_THAT(find(output, "output.receiver")->choices, Contains(scenario->receivers.front().name));
  EXPECT_THAT(find(output, "output.quantities")->choices, Contains("sinr_db"));
}

TEST(Parameters, EveryValueSetToItselfKeepsTheScenarioValid) {
  for (const char* name : {"jacksboro.yaml", "jamming.yaml", "quick.yaml"}) {
    const auto scenario = shipped(name);
    std::vector<std::string> paths{"atmosphere", "ground", "output", "region"};
    for (const Emitter& emitter : scenario->emitters) paths.push_back("emitters." + pathStep(emitter.name));
    for (const Platform& platform : scenario->platforms) {
      paths.push_back("platforms." + pathStep(platform.name));
    }
    for (const std::string& path : paths) {
      forEach(parametersOf(*scenario, path), [&](const Parameter& parameter) {
        if (parameter.value.empty()) return;
        Scenario edited = *scenario;
        EXPECT_NO_THROW(edited.set(parameter.path, parameter.value)) << name << ": " << parameter.path;
      });
    }
  }
}

TEST(EditsForChoice, ChangeToEveryPatternScanModelAndKindAndBack) {
  const auto scenario = shipped("jacksboro.yaml");
  Scenario edited = *scenario;
  const auto choose = [&](const std::string& path, const std::string& choice) {
    const std::vector<Edit> edits = editsForChoice(edited, path, choice);
    EXPECT_NO_THROW(edited.set(edits)) << path << " = " << choice;
    const ParameterGroup group = parametersOf(edited, path.substr(0, path.rfind('.')));
    const Parameter* chosen = find(group, path);
    ASSERT_TRUE(chosen);
    EXPECT_EQ(chosen->value, choice);
  };
  for (const char* emitter : {"search radar", "jammer"}) {
    const std::string path = std::string("emitters.") + emitter;
    for (const char* pattern :
         {"isotropic", "gaussian", "sinc", "cosecant2", "phased_array", "gaussian", "cosecant2"}) {
      choose(path + ".antenna.pattern", pattern);
    }
    for (const char* scan : {"fixed", "rotate", "sector", "raster", "dwell_list", "track", "rotate"}) {
      choose(path + ".scan.kind", scan);
    }
    for (const char* model :
         {"free_space", "horizon", "diffraction", "two_ray", "itm", "p528", "p1812", "p452", "itm"}) {
      choose(path + ".propagation", model);
      for (const char* settings :
           {"diffraction.method=deygout", "two_ray.sum=envelope", "itm.time_percent=90",
            "p528.time_percent=90", "p1812.time_percent=10", "p452.zone=sea"}) {
        const Edit edit = parseEdit(settings);
        if (find(parametersOf(edited, path), path + "." + edit.path)) {
          edited.set(path + "." + edit.path, edit.value);
        }
      }
    }
    for (const char* kind : {"transmitter", "radar", "jammer"}) choose(path + ".kind", kind);
  }
}

TEST(EditsForChoice, NameParametersWithoutCommonValue) {
  const auto scenario = shipped("jacksboro.yaml");
  EXPECT_THAT(test::errorOf([&] { editsForChoice(*scenario, "emitters.jammer.antenna.pattern", "cuts"); },
                            ErrorCode::bad_input),
              HasSubstr("'cuts' needs 'azimuth_file', which has no common value"));
}

TEST(PathStep, QuotesNamesThatNeedIt) {
  EXPECT_EQ(pathStep("search radar"), "search radar");
  EXPECT_EQ(pathStep("a=b"), "\"a=b\"");
  EXPECT_EQ(pathStep("St. \"X\""), "\"St. \\\"X\\\"\"");
}

}  // namespace
}  // namespace emscape::scenario

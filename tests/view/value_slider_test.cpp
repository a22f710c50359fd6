#include "apps/view/values/value_slider.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "apps/view/values/edit_text.h"
#include "apps/view/values/refusal_text.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/support/files.h"

namespace emscape::view {
namespace {

using scenario::Parameter;
using scenario::ParameterGroup;

constexpr double kPixel = 1.0 / 160;  // of a panel at scale 1

/// Visits the sliders of all numbers of a group.
template <class Visit>
void forEachSlider(const ParameterGroup& group, const Visit& visit) {
  for (const Parameter& parameter : group.parameters) {
    const bool is_number =
        parameter.type == Parameter::Type::number || parameter.type == Parameter::Type::integer;
    if (!is_number || parameter.value.empty()) continue;
    const double value = std::strtod(parameter.value.c_str(), nullptr);
    if (const auto slider = sliderOf(parameter, value)) visit(parameter, *slider, value);
  }
  for (const ParameterGroup& inner : group.groups) forEachSlider(inner, visit);
}

template <class Visit>
void forEachSlider(const Visit& visit) {
  for (const char* name : {"jacksboro.yaml", "links.yaml", "clutter.yaml", "sinr.yaml"}) {
    const auto scenario = scenario::loadScenario(emscape::test::shippedScenario(name));
    std::vector<std::string> paths{"atmosphere", "ground", "output", "region"};
    for (const auto& emitter : scenario->emitters)
      paths.push_back("emitters." + scenario::pathStep(emitter.name));
    for (const auto& platform : scenario->platforms)
      paths.push_back("platforms." + scenario::pathStep(platform.name));
    for (const std::string& path : paths) forEachSlider(scenario::parametersOf(*scenario, path), visit);
  }
}

// A scale whose smallest value came from the digits on screen had three quarters of its length below 1 m.
TEST(ValueSlider, AThirdOfItsLengthIsAtMostTwoDecades) {
  forEachSlider([](const Parameter& parameter, const ValueSlider& slider, double) {
    if (parameter.key == "pfa" || parameter.key == "power_w") return;  // of many decades by nature
    const double low = std::abs(slider.valueAt(1. / 3)), high = std::abs(slider.valueAt(2. / 3));
    EXPECT_LT(std::max(low, high), 100 * std::max(std::min(low, high), slider.stepAt(low, kPixel)))
        << parameter.path;
  });
}

TEST(ValueSlider, PositionAndValueAreInverse) {
  forEachSlider([](const Parameter& parameter, const ValueSlider& slider, double value) {
    EXPECT_NEAR(slider.valueAt(slider.positionOf(value)), value, 1e-9 * std::max(1.0, std::abs(value)))
        << parameter.path;
    EXPECT_NEAR(slider.positionOf(slider.min), 0, 1e-12) << parameter.path;
    EXPECT_NEAR(slider.positionOf(slider.max), 1, 1e-12) << parameter.path;
  });
}

TEST(ValueSlider, DraggedValuesAreRoundMultiplesOfTheStepAndPixelsDiffer) {
  forEachSlider([](const Parameter& parameter, const ValueSlider& slider, double) {
    for (double position = 0.1; position < 0.9; position += 0.1) {
      const double value = slider.steppedValueAt(position, kPixel);
      const double step = slider.stepAt(slider.valueAt(position), kPixel);
      EXPECT_NEAR(value / step, std::round(value / step), 1e-6) << parameter.path;
      const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
      EXPECT_TRUE(std::abs(digit - 1) < 1e-6 || std::abs(digit - 2) < 1e-6 || std::abs(digit - 5) < 1e-6)
          << parameter.path << ": " << step;
      if (slider.is_integer) continue;
      EXPECT_NE(value, slider.steppedValueAt(position + 2 * kPixel, kPixel)) << parameter.path;
    }
  });
}

TEST(ValueSlider, AMastOfFortyMetresChangesByMetres) {
  Parameter height;
  height.key = "height_agl_m";
  height.type = Parameter::Type::number;
  height.maximum = 100000;
  const auto slider = sliderOf(height, 40);
  ASSERT_TRUE(slider);
  EXPECT_LE(slider->stepAt(40, kPixel), 2);
  EXPECT_GE(slider->stepAt(40, kPixel), 0.5);
  EXPECT_EQ(slider->max, 3000);
  EXPECT_EQ(sliderOf(height, 5000)->max, 5000);
}

// The power has eight decades: without a limit a pixel would change it by 11 %.
TEST(ValueSlider, APixelOfADragChangesAPowerByTwoPercent) {
  Parameter power;
  power.key = "power_w";
  power.type = Parameter::Type::number;
  const auto slider = sliderOf(power, 5000);
  ASSERT_TRUE(slider);
  const double position = slider->positionOf(5000);
  EXPECT_NEAR(slider->valueAt(position + slider->dragRate(1 / kPixel) * kPixel), 5100, 1);
  EXPECT_EQ((ValueSlider{0, 30}.dragRate(1 / kPixel)), 1) << "a linear scale follows the mouse";
}

TEST(EditTexts, NameTheThingTheValueAndItsChange) {
  const auto scenario = scenario::loadScenario(emscape::test::shippedScenario("quick.yaml"));
  EXPECT_THAT(editTexts(*scenario, {{"emitters.radar.name", "\"Радар\""},
                                    {"emitters.Радар.power_w", "5000"},
                                    {"emitters.Радар.antenna.gain_dbi", "null"},
                                    {"emitters.transmitter", "null"},
                                    {"targets.drone", "{platform: mast}"},
                                    {"emitters.nobody.power_w", "1"}}),
              testing::ElementsAre(
                  "radar, name: radar → Радар", testing::MatchesRegex("radar, power: .* → 5 kW"),
                  testing::MatchesRegex("radar, gain: .* → by default"), "emitter transmitter: removed",
                  "target drone: added", "emitters.nobody.power_w=1"));
}

TEST(RefusalText, SpeaksOfValuesNotOfPlacesInFiles) {
  const std::vector<scenario::Edit> edits{{"emitters.a.height_agl_m", "-5"}};
  EXPECT_EQ(refusalText("emitters.a.height_agl_m=-5: 'height_agl_m' is -5 m, outside of 0 to 1 m", edits),
            "height above ground is -5 m, outside of 0 to 1 m");
  EXPECT_EQ(refusalText("dir/a b.yaml:62:11: 'emitters' has 'jammer' twice; first at line 29", edits),
            "another emitter is named 'jammer'");
  const std::string longest(1000000, 'x');
  EXPECT_EQ(refusalText(longest + ":2: '" + longest + "' is unknown", {}), "'" + longest + "' is unknown");
  EXPECT_EQ(refusalText("a.yaml:2: 'frequency_hz' must be a number (Hz)\na.yaml:3:1: there is no 'b'", edits),
            "frequency must be a number (Hz)\nthere is no 'b'");
}

}  // namespace
}  // namespace emscape::view

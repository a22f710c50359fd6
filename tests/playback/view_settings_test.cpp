#include "playback/view/view_settings.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::playback::test {
namespace {

/// The table of docs/view-state.md, as Markdown.
std::string viewStateTable() {
  std::string table = "| key | value | default | option | meaning |\n|---|---|---|---|---|\n";
  for (const ViewSetting& setting : viewSettings()) {
    if (setting.key.empty()) continue;
    std::string value = setting.value_text, of_default = setting.default_text;
    if (value.empty()) {
      value = setting.isSwitch()   ? "true, false"
              : setting.isChoice() ? fmt::format("{}", fmt::join(setting.spec.choices, ", "))
                                   : fmt::format("{:g}..{:g}{}{}", setting.spec.minimum, setting.spec.maximum,
                                                 setting.spec.unit.empty() ? "" : " ", setting.spec.unit);
    }
    if (of_default.empty()) {
      of_default = setting.text(ViewState{});
      if (setting.isSwitch()) of_default = of_default == "on" ? "true" : "false";
    }
    table += fmt::format("| `{}` | {} | {} | {} | {} |\n", setting.key, value, of_default,
                         setting.option.empty() ? "" : "`" + setting.option + "`", setting.meaning);
  }
  return table;
}

TEST(ViewSettings, DocumentationHoldsTheTable) {
  const std::string manual = emscape::test::readFile(emscape::test::sourceFile("docs/view-state.md"));
  EXPECT_NE(manual.find(viewStateTable()), std::string::npos) << "docs/view-state.md: put this there\n"
                                                              << viewStateTable();
}

/// Another value that the setting allows.
SettingValue otherValue(const ViewSetting& setting) {
  if (setting.isNumber()) return setting.spec.maximum / 2;
  if (setting.key == "camera") return std::string("orbit:azimuth_deg=1");
  if (setting.key == "map_layer") return std::string("50");
  if (setting.key == "size") return std::string("3x4");
  if (setting.key == "range") return std::string("-1:2.5");
  if (setting.key == "planes") return std::vector<std::string>{"horizontal:altitude_m=5,keep=above"};
  if (setting.key == "range_rings") return std::vector<std::string>{"a:b:spacing_m=5000,count=2"};
  if (setting.isListOfTexts()) return std::vector<std::string>{"a.b=1"};
  return std::string("other");
}

TEST(ViewSettings, ChangedSettingIsFoundWithWhatItAffects) {
  for (const ViewSetting& setting : viewSettings()) {
    if (!setting.set) continue;
    SCOPED_TRACE(setting.key + setting.option);
    ViewState view;
    if (setting.isSwitch() || setting.isChoice()) {
      setting.changeToNext(view);
    } else {
      setting.set(view, otherValue(setting));
    }
    ViewState again;
    setting.set(again, setting.get(view));
    EXPECT_TRUE(setting.isSame(view, again));
    EXPECT_FALSE(setting.isSame(view, {}));
    for (const ViewSetting& other : viewSettings()) {
      EXPECT_EQ(other.set && !other.isSame(view, {}), &other == &setting) << other.key;
    }
    const ViewChange change = changeOf({}, view);
    if (setting.affects) {
      EXPECT_TRUE(change.*setting.affects);
    }
  }
}

TEST(ViewSettings, ValuesOfAChoiceFollowEachOtherInACircle) {
  const ViewSetting& mode = settingOfKey("mode");
  ViewState view;
  for (const char* name : {"mida", "mip", "iso", "dvr"}) {
    mode.changeToNext(view);
    EXPECT_EQ(mode.text(view), name);
  }
}

TEST(ViewSettings, RangeRingsAreAnEmitterASpacingAndPerhapsACount) {
  const RangeRings rings = parseRangeRings("a: radar, 1:spacing_m=7500.5,count=3");
  EXPECT_EQ(rings.emitter, "a: radar, 1");
  EXPECT_EQ(rings.spacing_m, 7500.5);
  EXPECT_EQ(rings.count, 3);
  EXPECT_EQ(toString(rings), "a: radar, 1:spacing_m=7500.5,count=3");
  EXPECT_EQ(toString(parseRangeRings("radar:spacing_m=1e4")), "radar:spacing_m=10000");
  for (const char* const text :
       {"", "radar", ":spacing_m=5", "radar:spacing_m=", "radar:spacing_m=0", "radar:spacing_m=5x",
        "radar:spacing_m=5,count=0", "radar:spacing_m=5,count=1.5", "radar:count=5"}) {
    EXPECT_THAT(emscape::test::errorOf([&] { parseRangeRings(text); }, ErrorCode::usage),
                testing::HasSubstr("expected EMITTER:spacing_m=..[,count=..]"))
        << text;
  }
}

TEST(ViewSettings, RangeIsTwoNumbersInTheirOrder) {
  EXPECT_EQ(parseRange("-90:-20.5"), (ValueRange{-90, -20.5F}));
  for (const char* text : {"", "1", "2:1", "1:1", "a:2", "1:", "1:2x", "nan:1", "1:inf"}) {
    EXPECT_THROW(parseRange(text), Error) << text;
  }
}

}  // namespace
}  // namespace emscape::playback::test

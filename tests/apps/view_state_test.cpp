// emscape render --state and --save-state: a view saved as a file gives the same picture as the options.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

ProgramResult render(const Arguments& more) {
  return run(joined({"render", quick()}, more));
}

const Arguments kLook{"--size",         "200x150",
                      "--camera",       "orbit:azimuth_deg=40,elevation_deg=50,fov_deg=20",
                      "--mode",         "mida",
                      "--step",         "0.7",
                      "--theme",        "light",
                      "--times",        "2.5",
                      "--set",          "emitters.radar.power_w=777",
                      "--exaggeration", "2.5",
                      "--emitters",     "off",
                      "--shading"};

TEST(ViewState, AnIsosurfaceOutsideOfTheValuesIsAWarning) {
  const TemporaryFolder folder;
  const std::string state = folder.write(
      "a.view.json", R"({"schema_version": 1, "mode": "iso", "iso_value": 999, "size": [64, 48]})");
  const ProgramResult drawn = render({"--state", state, "-o", folder / "a.png"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_THAT(drawn.err, HasSubstr("warning: iso value 999 dBW/m2: power_density_dbwm2 ranges from "));
  EXPECT_THAT(drawn.err, HasSubstr("; no surface is drawn\n"));
  EXPECT_EQ(render({"--state", state, "-o", folder / "frames", "--iso-value", "998"}).status, 0);
  EXPECT_EQ(render({"--state", state, "-o", folder / "b.png", "--iso-value", "998"}).status, 3);
}

TEST(ViewState, DrawsThePictureThatTheOptionsDrew) {
  const TemporaryFolder folder;
  const ProgramResult saved =
      render(joined(kLook, {"-o", folder / "options.png", "--save-state", folder / "a.view.json"}));
  ASSERT_EQ(saved.status, 0) << saved.err;
  const ProgramResult drawn = render({"-o", folder / "state.png", "--state", folder / "a.view.json"});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  const std::string picture = readFile(folder / "options.png");
  EXPECT_GT(picture.size(), 1000u);
  EXPECT_TRUE(picture == readFile(folder / "state.png"));

  const json state = json::parse(readFile(folder / "a.view.json"));
  EXPECT_EQ(state["schema_version"], 1);
  EXPECT_EQ(state["time_s"], 2.5);
  EXPECT_EQ(state["size"], json({200, 150}));
  EXPECT_EQ(state["edits"], json({"emitters.radar.power_w=777"}));
  EXPECT_EQ(state["transfer"]["unit"], "dBW/m2");
  EXPECT_TRUE(state.contains("range"));

  // Saving a loaded state gives the same state.
  ASSERT_EQ(render({"--state", folder / "a.view.json", "--save-state", folder / "b.view.json"}).status, 0);
  EXPECT_EQ(readFile(folder / "a.view.json"), readFile(folder / "b.view.json"));
}

TEST(ViewState, OptionsThatAreGivenCountMore) {
  const TemporaryFolder folder;
  ASSERT_EQ(render(joined(kLook, {"--save-state", folder / "a.view.json"})).status, 0);
  const Arguments other{"--size",  "120x90", "--theme", "dark",
                        "--times", "1",      "--set",   "emitters.radar.power_w=5"};
  ASSERT_EQ(render(joined(other, {"--state", folder / "a.view.json", "--save-state", folder / "b.view.json"}))
                .status,
            0);
  const json state = json::parse(readFile(folder / "b.view.json"));
  EXPECT_EQ(state["size"], json({120, 90}));
  EXPECT_EQ(state["theme"], "dark");
  EXPECT_EQ(state["time_s"], 1);
  EXPECT_EQ(state["edits"], json({"emitters.radar.power_w=5"}));
  EXPECT_EQ(state["mode"], "mida");
  EXPECT_EQ(state["transfer"], json::parse(readFile(folder / "a.view.json"))["transfer"]);
}

TEST(ViewState, AnotherQuantityDropsTheColoursOfTheViewsOwn) {
  const TemporaryFolder folder;
  ASSERT_EQ(render({"--size", "120x90", "--save-state", folder / "a.view.json"}).status, 0);
  const ProgramResult result = render({"--state", folder / "a.view.json", "--quantity",
                                       "field_strength_dbuvm", "--save-state", folder / "b.view.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const json state = json::parse(readFile(folder / "b.view.json"));
  EXPECT_EQ(state["quantity"], "field_strength_dbuvm");
  EXPECT_EQ(state["transfer"]["unit"], "dBuV/m");
}

TEST(ViewState, AHandWrittenStateNeedsTheVersionAlone) {
  const TemporaryFolder folder;
  writeFile(folder / "a.json", "{\"schema_version\": 1}");
  ASSERT_EQ(render({"--size", "200x150", "-o", folder / "a.png", "--state", folder / "a.json"}).status, 0);
  ASSERT_EQ(render({"--size", "200x150", "-o", folder / "b.png"}).status, 0);
  EXPECT_TRUE(readFile(folder / "a.png") == readFile(folder / "b.png"));
}

TEST(ViewState, FaultyStatesAreBadInput) {
  const TemporaryFolder folder;
  const auto refusalOf = [&](const std::string& text) {
    writeFile(folder / "a.json", text);
    const ProgramResult result = render({"-o", folder / "a.png", "--state", folder / "a.json"});
    EXPECT_EQ(result.status, 3);
    return result.err;
  };
  EXPECT_THAT(refusalOf("{\"schema_version\": 1,\n \"thme\": \"dark\"}"),
              HasSubstr("a.json:2:2: unknown key 'thme' of the view; did you mean 'theme'?"));
  EXPECT_THAT(refusalOf("{\"schema_version\": 9}"), HasSubstr("'schema_version' is 9; this program reads 1"));
  EXPECT_THAT(refusalOf("{\"schema_version\": 1, \"edits\": [\"emitters.nobody.power_w=1\"]}"),
              HasSubstr("there is no emitter 'nobody'"));
  EXPECT_EQ(render({"-o", folder / "a.png", "--state", folder / "none.json"}).status, 3);
  EXPECT_EQ(render({"--state", folder / "a.json"}).status, 2);  // nothing to write
}

}  // namespace
}  // namespace emscape::test

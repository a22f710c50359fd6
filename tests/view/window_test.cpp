/// The window as a user sees it: the program in a virtual display, with real events of keyboard and mouse.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "emscape/render/picture/image.h"
#include "tests/support/sanitizers.h"
#include "tests/support/without_proc.h"
#include "tests/view/window_fixture.h"

namespace emscape::test {
namespace {

using testing::HasSubstr;

int colorsOf(const render::Image8& image) {
  std::set<std::uint32_t> colors;
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    colors.insert(image.rgba[i] | image.rgba[i + 1] << 8 | image.rgba[i + 2] << 16);
  }
  return static_cast<int>(colors.size());
}

TEST_F(Window, ShowsAnExactPictureAndWritesScreenshots) {
  const std::string file = folder_ / "window.png";
  play(R"({"do":"wait_state","state":"exact"}
{"do":"expect","key":"exact","op":"==","value":true}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"screenshot","file":")" +
       file + R"("}
)");
  const render::Image8 picture = render::readPng(file);
  EXPECT_EQ(picture.size.width, 640);
  EXPECT_EQ(picture.size.height, 480);
  EXPECT_GT(colorsOf(picture), 500);
  EXPECT_EQ(log("start").size(), 1U);
  EXPECT_EQ(log("end").size(), 1U);
  EXPECT_GT(log("frame").size(), 1U);
}

TEST_F(Window, CutsTheVolumeOpenAndComparesWithTheOriginal) {
  play(R"({"do":"wait_state","state":"exact"}
{"do":"key","key":"H"}
{"do":"key","key":"Shift+H"}
{"do":"plane","index":1,"altitude_m":2000,"flip":true}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"planes","op":"==","value":2}
{"do":"plane","on":false}
{"do":"expect","key":"planes","op":"==","value":1}
{"do":"plane","remove":true}
{"do":"set","path":"emitters.radar.power_w","value":"100000"}
{"do":"key","key":"C"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"quantity","op":"==","value":"power_density_difference_db"}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"plane","index":3,"on":true}
{"do":"expect","key":"error","op":"==","value":"plane: index 3: expected 1..1"}
{"do":"key","key":"C"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"quantity","op":"==","value":"power_density_dbwm2"}
)");
}

TEST_F(Window, DragsOrbitAndThePictureBecomesExactAgain) {
  play(R"({"do":"wait_state","state":"exact"}
{"do":"mouse","x":150,"y":200,"button":"left","to_x":250,"to_y":230}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"elevation_deg","op":">","value":30}
{"do":"mouse","x":150,"y":200,"wheel":2}
{"do":"wait_state","state":"exact"}
)");
  EXPECT_THAT(states(), HasSubstr("BUSY"));
  EXPECT_THAT(states(), testing::EndsWith("IDLE"));
}

TEST_F(Window, KeysRunTheirActions) {
  play(R"({"do":"wait_state","state":"exact"}
{"do":"key","key":"Right"}
{"do":"expect","key":"asked_s","op":">","value":0}
{"do":"key","key":"Home"}
{"do":"expect","key":"asked_s","op":"==","value":0}
{"do":"key","key":"Ctrl+L"}
{"do":"expect","key":"loop","op":"==","value":true}
{"do":"key","key":"Space"}
{"do":"expect","key":"playing","op":"==","value":true}
{"do":"key","key":"Space"}
{"do":"expect","key":"playing","op":"==","value":false}
{"do":"key","key":"Home"}
{"do":"key","key":"D"}
{"do":"expect","key":"theme","op":"==","value":"light"}
{"do":"key","key":"Ctrl+1"}
{"do":"key","key":"End"}
{"do":"key","key":"1"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"shown_s","op":"==","value":0}
)");
}

TEST_F(Window, EditsAreComputedUndoneAndRedone) {
  const std::string emitter = "emitters.radar.power_w";
  play(R"({"do":"wait_state","state":"exact"}
{"do":"set","path":")" +
       emitter + R"(","value":"5"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"expect","key":"edits","op":"==","value":1}
{"do":"undo"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"edits","op":"==","value":0}
{"do":"redo"}
{"do":"expect","key":"edits","op":"==","value":1}
{"do":"set","path":")" +
       emitter + R"(","value":"-5"}
{"do":"expect","key":"error","op":"!=","value":""}
{"do":"expect","key":"edits","op":"==","value":1}
)");
}

TEST_F(Window, AMarkerIsDraggedAndTheFieldFollows) {
  // The camera's target is the radar; the legend moves it to the left of the middle.
  play(R"({"do":"panel","name":"all","open":false}
{"do":"pattern","pattern":"quarter"}
{"do":"camera","spec":"orbit:elevation_deg=89,distance=1.5,target_x_m=0,target_y_m=0,target_z_m=20"}
{"do":"wait_state","state":"exact"}
{"do":"mouse","x":258,"y":240,"button":"left","to_x":309,"to_y":280}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"expect","key":"edits","op":"==","value":2}
{"do":"expect","key":"elevation_deg","op":"==","value":89}
{"do":"key","key":"Ctrl+Z"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"edits","op":"==","value":0}
{"do":"expect","key":"can_undo","op":"==","value":false}
)");
  const std::vector<Json> edits = log("edit");
  ASSERT_GE(edits.size(), 2U);
  EXPECT_EQ(edits[0]["path"], "platforms.radar site.position.latitude_deg");
  EXPECT_EQ(edits[1]["path"], "platforms.radar site.position.longitude_deg");
  EXPECT_THAT(states(), HasSubstr("BUSY RESTORE IDLE"));
}

TEST_F(Window, AnOpacityPointIsDraggedInTheCurve) {
  play(R"({"do":"panel","name":"colors","open":true}
{"do":"panel","name":"scenario","open":false}
{"do":"pattern","pattern":"quarter"}
{"do":"step_voxels","value":0.05}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"opacity_points","op":"==","value":9}
{"do":"mouse","x":510,"y":150,"button":"left","to_x":530,"to_y":130}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"opacity_points","op":"==","value":10}
{"do":"mouse","x":530,"y":130,"button":"left","to_x":500,"to_y":90}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"opacity_points","op":"==","value":10}
{"do":"expect","key":"selected_opacity","op":">","value":0.01}
{"do":"key","key":"Ctrl+Z"}
{"do":"expect","key":"selected_opacity","op":"<","value":0.01}
{"do":"key","key":"Delete"}
{"do":"expect","key":"opacity_points","op":"==","value":9}
{"do":"key","key":"Ctrl+Z"}
{"do":"key","key":"Ctrl+Z"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"can_undo","op":"==","value":false}
{"do":"expect","key":"error","op":"==","value":""}
)");
  EXPECT_THAT(states(), HasSubstr("BUSY RESTORE IDLE"));
  EXPECT_THAT(states(), testing::EndsWith("IDLE"));
}

TEST_F(Window, TheTimeLineIsScrubbedZoomedPannedAndLimited) {
  play(R"({"do":"wait_state","state":"exact"}
{"do":"mouse","x":200,"y":392,"button":"left","to_x":360,"to_y":392}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"shown_s","op":">","value":1.95}
{"do":"expect","key":"shown_s","op":"<","value":2.1}
{"do":"mouse","x":614,"y":378,"button":"left","to_x":486,"to_y":378}
{"do":"expect","key":"play_to_s","op":"==","value":3}
{"do":"key","key":"["}
{"do":"expect","key":"play_from_s","op":">","value":1.95}
{"do":"expect","key":"play_from_s","op":"<","value":2.1}
{"do":"expect","key":"shown_s","op":">","value":1.95}
{"do":"expect","key":"shown_s","op":"<","value":2.1}
{"do":"mouse","x":360,"y":392,"wheel":3}
{"do":"wait_s","seconds":0.2}
{"do":"expect","key":"visible_from_s","op":">","value":0.5}
{"do":"expect","key":"visible_from_s","op":"<","value":1.05}
{"do":"mouse","x":350,"y":392,"button":"middle","to_x":300,"to_y":392}
{"do":"expect","key":"visible_from_s","op":">","value":1.05}
{"do":"key","key":"Ctrl+Home"}
{"do":"expect","key":"visible_from_s","op":"==","value":0}
{"do":"key","key":"Backspace"}
{"do":"expect","key":"play_to_s","op":"==","value":4}
{"do":"key","key":"Shift+J"}
{"do":"key","key":"Space"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"rate","op":"==","value":-1}
)");
}

TEST_F(Window, SurvivesAnySize) {
  play(R"({"do":"wait_state","state":"exact"}
{"do":"resize","width":1,"height":1}
{"do":"wait_s","seconds":0.1}
{"do":"resize","width":300,"height":80}
{"do":"wait_s","seconds":0.1}
{"do":"resize","width":500,"height":400}
{"do":"wait_s","seconds":0.1}
{"do":"wait_state","state":"exact"}
{"do":"scale","factor":2}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"scale","op":"==","value":2}
{"do":"panel","name":"all","open":false}
{"do":"wait_s","seconds":0.2}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"picture_width","op":"==","value":500}
{"do":"expect","key":"picture_height","op":"==","value":400}
)");
}

TEST_F(Window, AnExpectationThatIsNotMetEndsWithStatusFive) {
  const ProgramResult result = runScript(R"({"do":"wait_frame"}
{"do":"expect","key":"rate","op":"==","value":2}
)");
  EXPECT_EQ(result.status, 5);
  EXPECT_THAT(result.err, HasSubstr("script.jsonl:2: expected rate == 2, but it is 1"));
}

TEST_F(Window, BadInputIsOneMessageAndStatusThree) {
  ProgramResult result = run({"view", folder_ / "none.yaml"}, environment());
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("none.yaml"));
  const std::string file = folder_ / "wrong.yaml";
  writeFile(file, "schema_version: 1\nname: x\nspeed: 3\n");
  result = run({"view", file}, environment());
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("speed"));
  result = runScript("{\"do\":\"wait_state\",\"state\":\"ready\"}\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("script.jsonl:1: wait_state: state 'ready': expected BUSY"));
  result = runScript("{\"do\":\"jump\"}\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("script.jsonl:1: unknown verb 'jump'"));
}

TEST_F(Window, AViewAsInputIsOneMessage) {
  const std::string file = folder_ / "x.view.json";
  writeFile(file, R"({"schema_version": 1})");
  const ProgramResult result = run({"view", file}, environment());
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.err, "emscape-view: error: " + file +
                            ": a view file, not a scenario: `render` and `view` read it with --state\n");
}

TEST_F(Window, NamesAreShownToTheirEnd) {
  const auto headingOf = [this](const std::string& name) {
    std::string text = readFile(quick());
    const std::string plain = "- name: radar\n";
    text.replace(text.find(plain), plain.size(), "- name: '" + name + "'\n");
    writeFile(folder_ / "own.yaml", text);
    runWell(viewOf(folder_ / "own.yaml", R"({"do":"wait_state","state":"exact"}
{"do":"panel","name":"side"}
{"do":"wait_s","seconds":0.2}
{"do":"screenshot","file":")" + (folder_ / "window.png") +
                                             R"("}
{"do":"quit"}
)"),
            environment());
    const render::Image8 window = render::readPng(folder_ / "window.png");
    std::vector<std::uint8_t> heading;
    for (int y = 109; y < 128; ++y) heading.insert(heading.end(), window.at(345, y), window.at(505, y));
    return heading;
  };
  const auto first = headingOf("r##1");
  EXPECT_TRUE(first == headingOf("r##1"));
  EXPECT_FALSE(first == headingOf("r##2"));
}

TEST_F(Window, AnInputThatCannotBeOpenedEndsWithItsOwnStatus) {
  EXPECT_THAT(errorOfRun({"view", quick(), "--quantity", "power_density_dbwm2:none"}, 2, environment()),
              HasSubstr("there is no such channel"));
}

TEST_F(Window, DrawsAViewAsRenderDoes) {
  const std::string state = folder_ / "a.view.json", shown = folder_ / "shown.png";
  runWell({"render", quick(), "--save-state", state, "--size", "500x300", "--camera",
           "orbit:azimuth_deg=40,elevation_deg=50", "--times", "2", "--theme", "light", "--mode", "mida",
           "--set", "emitters.radar.power_w=777", "-o", folder_ / "rendered.png"});
  writeFile(folder_ / "script.jsonl", R"({"do":"wait_state","state":"exact"}
{"do":"expect","key":"picture_width","op":"==","value":500}
{"do":"expect","key":"picture_height","op":"==","value":300}
{"do":"picture","file":")" + shown + R"("}
{"do":"save_state","file":")" + state + R"("}
{"do":"copy_command"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"quit"}
)");
  runWell({"view", quick(), "--state", state, "--scale", "1.5", "--backend", "cpu", "--script",
           folder_ / "script.jsonl", "--log", logFile()},
          environment());
  const render::Image8 picture = render::readPng(shown);
  const render::ImageDifference difference =
      render::compare(picture, render::readPng(folder_ / "rendered.png"));
  for (const int max : difference.max) EXPECT_LE(max, 1);
  // And so does the view that the window wrote.
  ASSERT_EQ(run({"render", quick(), "--state", state, "-o", folder_ / "again.png"}).status, 0);
  EXPECT_EQ(render::compare(render::readPng(folder_ / "again.png"), render::readPng(folder_ / "rendered.png"))
                .erroneous,
            0);
}

TEST_F(Window, RestoresEditsAfterAKill) {
  RunningProgram program(viewOf(quick(), R"({"do":"wait_state","state":"exact"}
{"do":"set","path":"emitters.radar.power_w","value":"500"}
{"do":"wait_s","seconds":60}
)"),
                         environment());
  ASSERT_TRUE(comesToLog("autosave"));
  program.signal(SIGKILL);
  program.wait();
  play(R"({"do":"wait_state","state":"exact"}
{"do":"expect","key":"kept","op":"==","value":true}
{"do":"expect","key":"edits","op":"==","value":0}
{"do":"restore"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"edits","op":"==","value":1}
{"do":"expect","key":"unsaved","op":"==","value":true}
)");
  EXPECT_EQ(keptViews(), 0) << "after a regular end";
}

TEST_F(Window, ASignalEndsARecordingAndKeepsEdits) {
  const std::string films = folder_ / "films";
  std::filesystem::create_directory(films);
  RunningProgram program(viewOf(quick(), R"({"do":"wait_state","state":"exact"}
{"do":"set","path":"emitters.radar.power_w","value":"500"}
{"do":"wait_state","state":"exact"}
{"do":"record","file":")" + films + R"(/film.mp4","step_s":0.001}
{"do":"wait_s","seconds":0.3}
{"do":"mark","text":"recording"}
{"do":"wait_s","seconds":60}
)"),
                         environment());
  ASSERT_TRUE(comesToLog("mark"));
  program.signal(SIGTERM);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.status, 128 + SIGTERM);
  EXPECT_THAT(result.err, HasSubstr("emscape-view: stopped by signal 15\n"));
  EXPECT_TRUE(std::filesystem::is_empty(films));
  EXPECT_EQ(log("end").size(), 1U);
  EXPECT_EQ(keptViews(), 1);
}

TEST_F(Window, ALostDisplayEndsItWithTheStatusOfNone) {
  RunningProgram program(viewOf(quick(), R"({"do":"wait_state","state":"exact"}
{"do":"mark","text":"open"}
{"do":"wait_s","seconds":60}
)"),
                         environment());
  ASSERT_TRUE(comesToLog("mark"));
  display_.reset();
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.status, 4);
  EXPECT_EQ(result.err.substr(result.err.find("emscape-view: error")),
            "emscape-view: error: the connection to the display is lost\n");
}

TEST_F(Window, BrowsesAndOpensAnotherInput) {
  const std::string inputs = folder_ / "inputs";
  std::filesystem::create_directory(inputs);
  writeFile(inputs + "/a.yaml", readFile(quick()));
  writeFile(inputs + "/b.yaml", readFile(quick()));
  const ProgramResult result = runWell(viewOf(inputs + "/a.yaml", R"({"do":"wait_state","state":"exact"}
{"do":"key","key":"Ctrl+O"}
{"do":"wait_s","seconds":0.5}
{"do":"key","key":"Down"}
{"do":"key","key":"Enter"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"input","op":"==","value":")" + inputs + R"(/b.yaml"}
{"do":"open","file":"/no/such/file.yaml"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"error","op":"==","value":"/no/such/file.yaml: no such file or folder"}
{"do":"open_recent"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"input","op":"==","value":")" + inputs + R"(/a.yaml"}
{"do":"quit"}
)"),
                                       environment());
}

TEST_F(Window, WithoutAnInputItAsksForOne) {
  const auto runEmpty = [this](const std::string& script) {
    writeFile(folder_ / "script.jsonl", script);
    forgetLog();
    return run({"view", "--size", "640x480", "--backend", "cpu", "--script", folder_ / "script.jsonl",
                "--log", logFile()},
               "cd " + folder_.path().string() + ";" + environment());
  };
  std::filesystem::create_directory(folder_ / "inputs");
  writeFile(folder_ / "inputs/a.yaml", readFile(quick()));
  ProgramResult result = runEmpty(R"({"do":"wait_s","seconds":0.3}
{"do":"expect","key":"input","op":"==","value":""}
{"do":"expect","key":"computing","op":"==","value":false}
{"do":"reload"}
{"do":"expect","key":"error","op":"==","value":"nothing is open: open a scenario or volumes first"}
{"do":"key","key":"Ctrl+O"}
{"do":"wait_s","seconds":0.3}
{"do":"key","key":"Enter"}
{"do":"wait_s","seconds":0.3}
{"do":"key","key":"Enter"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"quit"}
)");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(log("end").front()["input"], testing::EndsWith("/inputs/a.yaml"));
  // The next time it is the first of the recent ones.
  result = runEmpty(R"({"do":"wait_s","seconds":0.3}
{"do":"key","key":"Ctrl+Shift+O"}
{"do":"wait_state","state":"exact"}
{"do":"quit"}
)");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(log("end").front()["input"], testing::EndsWith("/inputs/a.yaml"));
}

TEST_F(Window, OptionsOfAnInputNeedOne) {
  EXPECT_THAT(errorOfRun({"view", "--set", "emitters.radar.power_w=5"}, 2, environment()),
              HasSubstr("--set needs INPUT"));
}

TEST_F(Window, RealEventsOfTheServerArrive) {
  if (!hasProgram("xdotool")) GTEST_SKIP() << "xdotool is not installed";
  RunningProgram program(viewOf(quick(), R"({"do":"wait_state","state":"exact"}
{"do":"wait_s","seconds":4}
{"do":"expect","key":"loop","op":"==","value":true}
{"do":"expect","key":"elevation_deg","op":"!=","value":28}
{"do":"quit"}
)"),
                         environment());
  ASSERT_TRUE(comesToLog("first_picture"));
  const std::string hands =
      environment() +
      "w=$(xdotool search --name emscape | head -n 1);"
      "xdotool windowfocus $w; sleep 0.3;"
      "xdotool key ctrl+l;"
      "xdotool mousemove 150 200 mousedown 1 mousemove 220 240 mousemove 260 260 mouseup 1";
  EXPECT_EQ(std::system(("sh -c '" + hands + "' 2>/dev/null").c_str()), 0);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST(WindowWithoutADisplay, IsReportedWithStatusFour) {
  const ProgramResult result = run({"view", quick()}, "unset DISPLAY WAYLAND_DISPLAY;");
  EXPECT_EQ(result.status, 4);
  EXPECT_THAT(result.err, HasSubstr("DISPLAY"));
  EXPECT_THAT(result.err, HasSubstr("emscape render"));
}

TEST(WindowWithoutProc, StartsNoProgramOfTheCurrentFolder) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers need /proc";
  const std::string view = withoutProc("exec " + besideThisProgram("emscape") + " view");
  if (view.empty()) GTEST_SKIP() << "/proc cannot be hidden";
  const TemporaryFolder folder;
  writeFile(folder / "emscape-view", "#!/bin/sh\ntouch ran\n");
  std::filesystem::permissions(folder / "emscape-view", std::filesystem::perms::owner_all);
  const std::string command = "cd " + folder.path().string() + " && " + view + " 2>err";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 4);
  EXPECT_FALSE(std::filesystem::exists(folder / "ran"));
  EXPECT_THAT(readFile(folder / "err"), HasSubstr("/proc/self/exe"));
}

TEST(WindowHelp, ComesFromTheWindow) {
  const ProgramResult result = runWell({"view", "--help"});
  EXPECT_THAT(result.out, HasSubstr("--script"));
}

}  // namespace
}  // namespace emscape::test

/// The window as a user sees it: the program in a virtual display, with real events of keyboard and mouse.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "emscape/render/image.h"
#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

bool hasProgram(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

/// An X server without a screen.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    int ends[2];
    if (pipe(ends) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      const int nowhere = open("/dev/null", O_RDWR);
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
      const std::string number = std::to_string(ends[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1920x1200x24", "-nolisten", "tcp",
             static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) name_ += c;
    close(ends[0]);
  }
  ~VirtualDisplay() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// ":7"; ":" if it did not start.
  std::string name() const { return ":" + name_; }

 private:
  pid_t process_ = -1;
  std::string name_;
};

class Window : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasProgram("Xvfb")) GTEST_SKIP() << "Xvfb is not installed";
    display_ = std::make_unique<VirtualDisplay>();
    ASSERT_GT(display_->name().size(), 1U) << "Xvfb did not start";
  }

  std::string environment() const {
    // The OpenGL driver is unloaded before its leaks could be told from the program's.
    return "export DISPLAY=" + display_->name() +
           " LP_NUM_THREADS=1 LIBGL_ALWAYS_SOFTWARE=1 ASAN_OPTIONS=detect_leaks=0;";
  }

  Arguments viewOf(const std::string& input, const std::string& script) {
    writeFile(folder_ / "script.jsonl", script);
    return {"view",  input,    "--size", "640x480", "--backend", "cpu", "--script", folder_ / "script.jsonl",
            "--log", logFile()};
  }

  /// Runs a script to its end.
  ProgramResult runScript(const std::string& script, const Arguments& more = {}) {
    Arguments arguments = viewOf(quick(), script);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, environment());
  }

  std::string logFile() const { return folder_ / "log.jsonl"; }
  std::vector<Json> log(const std::string& event) const {
    std::vector<Json> lines;
    std::istringstream text(readFile(logFile()));
    for (std::string line; std::getline(text, line);) {
      Json object = Json::parse(line, nullptr, false);
      if (!object.is_discarded() && object["event"] == event) lines.push_back(object);
    }
    return lines;
  }
  /// "BUSY RESTORE IDLE": the states in the order in which they came.
  std::string states() const {
    std::string states;
    for (const Json& change : log("state"))
      states += (states.empty() ? "" : " ") + change["to"].get<std::string>();
    return states;
  }

  TemporaryFolder folder_;
  std::unique_ptr<VirtualDisplay> display_;
};

int colorsOf(const render::Image8& image) {
  std::set<std::uint32_t> colors;
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    colors.insert(image.rgba[i] | image.rgba[i + 1] << 8 | image.rgba[i + 2] << 16);
  }
  return static_cast<int>(colors.size());
}

TEST_F(Window, ShowsAnExactPictureAndWritesScreenshots) {
  const std::string file = folder_ / "window.png";
  const ProgramResult result = runScript(R"({"do":"wait_state","state":"exact"}
{"do":"expect","key":"exact","op":"==","value":true}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"screenshot","file":")" + file + R"("}
{"do":"quit"}
)");
  EXPECT_EQ(result.status, 0) << result.err;
  const render::Image8 picture = render::readPng(file);
  EXPECT_EQ(picture.size.width, 640);
  EXPECT_EQ(picture.size.height, 480);
  EXPECT_GT(colorsOf(picture), 500);
  EXPECT_EQ(log("start").size(), 1U);
  EXPECT_EQ(log("end").size(), 1U);
  EXPECT_GT(log("frame").size(), 1U);
}

TEST_F(Window, DragsOrbitAndThePictureBecomesExactAgain) {
  const ProgramResult result = runScript(R"({"do":"wait_state","state":"exact"}
{"do":"mouse","x":150,"y":200,"button":"left","to_x":250,"to_y":230}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"elevation_deg","op":">","value":30}
{"do":"mouse","x":150,"y":200,"wheel":2}
{"do":"wait_state","state":"exact"}
{"do":"quit"}
)");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(states(), HasSubstr("BUSY"));
  EXPECT_THAT(states(), testing::EndsWith("IDLE"));
}

TEST_F(Window, KeysRunTheirActions) {
  const ProgramResult result = runScript(R"({"do":"wait_state","state":"exact"}
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
{"do":"key","key":"D"}
{"do":"expect","key":"theme","op":"==","value":"light"}
{"do":"key","key":"Ctrl+1"}
{"do":"key","key":"End"}
{"do":"key","key":"1"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"shown_s","op":"==","value":0}
{"do":"quit"}
)");
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST_F(Window, EditsAreComputedUndoneAndRedone) {
  const std::string emitter = "emitters.radar.power_w";
  const ProgramResult result = runScript(R"({"do":"wait_state","state":"exact"}
{"do":"set","path":")" + emitter + R"(","value":"5"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"expect","key":"edits","op":"==","value":1}
{"do":"undo"}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"edits","op":"==","value":0}
{"do":"redo"}
{"do":"expect","key":"edits","op":"==","value":1}
{"do":"set","path":")" + emitter + R"(","value":"-5"}
{"do":"expect","key":"error","op":"!=","value":""}
{"do":"expect","key":"edits","op":"==","value":1}
{"do":"quit"}
)");
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST_F(Window, SurvivesAnySize) {
  const ProgramResult result = runScript(R"({"do":"wait_state","state":"exact"}
{"do":"resize","width":1,"height":1}
{"do":"wait_s","seconds":0.3}
{"do":"resize","width":300,"height":80}
{"do":"wait_s","seconds":0.3}
{"do":"resize","width":800,"height":600}
{"do":"wait_s","seconds":0.3}
{"do":"wait_state","state":"exact"}
{"do":"scale","factor":2}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"scale","op":"==","value":2}
{"do":"panel","name":"all","open":false}
{"do":"wait_s","seconds":0.2}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"picture_width","op":"==","value":800}
{"do":"expect","key":"picture_height","op":"==","value":600}
{"do":"quit"}
)");
  EXPECT_EQ(result.status, 0) << result.err;
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
  result = runScript("{\"do\":\"jump\"}\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("script.jsonl:1: unknown verb 'jump'"));
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
  for (int i = 0; i < 300 && log("first_picture").empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
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

TEST(WindowWithoutADisplay, SaysSoWithStatusFour) {
  const ProgramResult result = run({"view", quick()}, "unset DISPLAY WAYLAND_DISPLAY;");
  EXPECT_EQ(result.status, 4);
  EXPECT_THAT(result.err, HasSubstr("DISPLAY"));
  EXPECT_THAT(result.err, HasSubstr("emscape render"));
}

TEST(WindowHelp, ComesFromTheWindow) {
  const ProgramResult result = run({"view", "--help"});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("--script"));
}

}  // namespace
}  // namespace emscape::test

/// Real keys and mouse buttons: X events of the server, in a window that a window manager manages.
#include "tests/view/real_input.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

namespace emscape::test {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::Lt;

// With quick.yaml in a window of 1000 x 800 pixels
constexpr Place kSwitch{933, 118}, kFrequency{890, 258}, kBandwidth{890, 285}, kPower{850, 312},
    kLosses{950, 339}, kModel{900, 393}, kGain{850, 493};
constexpr Place kRate{228, 648}, kPicture{120, 150}, kLowerPicture{120, 480}, kTimeLine{500, 722},
    kFileMenu{27, 12}, kOpenItem{50, 35};

struct TypedNumber {
  const char* name;
  Place slider;
  const char* path;
  const char* typed;
  double value;
};
class TypedIntoASlider : public RealInput, public testing::WithParamInterface<TypedNumber> {};

TEST_P(TypedIntoASlider, NumberBecomesTheValueAndIsNoCommand) {
  const TypedNumber& number = GetParam();
  open(quick());
  ASSERT_TRUE(xdotool(controlClick(number.slider) + type(number.typed) + " key Return"));
  EXPECT_TRUE(commandsBecome("set")) << commands();
  ASSERT_TRUE(comesToLog("edit"));
  EXPECT_EQ(end()["edits"], 1);
  const std::vector<Json> edits = log("edit");
  ASSERT_EQ(edits.size(), 1U);
  EXPECT_EQ(edits[0]["path"], number.path);
  EXPECT_DOUBLE_EQ(std::stod(edits[0]["value"].get<std::string>()), number.value);
}

INSTANTIATE_TEST_SUITE_P(
    Window, TypedIntoASlider,
    testing::Values(
        TypedNumber{"PowerOfMoreThanAThousandKilowatts", kPower, "emitters.radar.power_w", "2000", 2e6},
        TypedNumber{"PowerOfLessThanAKilowatt", kPower, "emitters.radar.power_w", "0.5", 500},
        TypedNumber{"Losses", kLosses, "emitters.radar.losses_db", "4.256789", 4.256789},
        TypedNumber{"GainOutsideTheSlider", kGain, "emitters.radar.antenna.gain_dbi", "-12.5", -12.5}),
    [](const auto& number) { return std::string(number.param.name); });

TEST_F(RealInput, TypedNumbersAreTakenWhenAnotherFieldIsClicked) {
  open(quick());
  ASSERT_TRUE(xdotool(click(kRate) + type("4") + click(kBandwidth) + " key ctrl+a" + type("5 MHz") +
                      controlClick(kLosses) + type("7") + click(kFrequency)));
  EXPECT_TRUE(commandsBecome("rate set set")) << commands();
  EXPECT_TRUE(reports("rate", 4));
  ASSERT_TRUE(comes([&] { return log("edit").size() == 2; }));
  EXPECT_EQ(log("edit")[0]["path"], "emitters.radar.bandwidth_hz");
  EXPECT_EQ(log("edit")[0]["value"], "5000000");
  EXPECT_EQ(log("edit")[1]["path"], "emitters.radar.losses_db");
  EXPECT_EQ(log("edit")[1]["value"], "7");
}

TEST_F(RealInput, ADigitThatOpensASelectedRowIsTakenWhenARowAboveIsClicked) {
  open(quick());
  ASSERT_TRUE(xdotool(click(kLosses) + " sleep 0.3" + type("7") + " sleep 0.3" + click(kFrequency)));
  EXPECT_TRUE(commandsBecome("set")) << commands();
  ASSERT_TRUE(comesToLog("edit"));
  EXPECT_EQ(log("edit")[0]["path"], "emitters.radar.losses_db");
  EXPECT_EQ(log("edit")[0]["value"], "7");
}

TEST_F(RealInput, KeysWithControlTakeTheNumberThatIsBeingTypedAndThenAct) {
  const std::string input = folder_ / "a.yaml";
  writeFile(input, readFile(quick()));
  openByHand(input);
  ASSERT_TRUE(xdotool(controlClick(kPower) + type("6 kW") + " key ctrl+s"));
  EXPECT_TRUE(commandsBecome("set save")) << commands();
  ASSERT_TRUE(comes([&] { return std::filesystem::exists(folder_ / "a.edited.yaml"); }));
  EXPECT_NE(readFile(folder_ / "a.edited.yaml").find("power_w: 6000"), std::string::npos);
  ASSERT_TRUE(xdotool(click(kRate) + " key ctrl+a" + type("4") + " key ctrl+q"));
  EXPECT_TRUE(commandsBecome("set save rate quit")) << commands();
  EXPECT_EQ(program_->wait().status, 0);
  program_.reset();
}

TEST_F(RealInput, LettersAndSpaceAreForThePictureAfterANumberIsTypedOrAChoiceIsMade) {
  open(quick());
  ASSERT_TRUE(xdotool(controlClick(kPower) + type("5 kW") + " key Return key c key space key k"));
  EXPECT_TRUE(commandsBecome("set compare play pause")) << commands();
  ASSERT_TRUE(xdotool(type("7") + " key Return"));  // the row still has the digits
  EXPECT_TRUE(commandsBecome("set compare play pause set")) << commands();
  ASSERT_TRUE(
      xdotool(click(kModel) + " sleep 0.5" + click({kModel.x - 40, kModel.y + 70}) + " sleep 0.5 key space"));
  EXPECT_TRUE(commandsBecome("set compare play pause set choose play")) << commands();
}

TEST_F(RealInput, EscapeInAFieldTakesBackTheTypedNumberAndNothingElse) {
  open(quick());
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7") + " key Escape"));
  ASSERT_TRUE(xdotool(controlClick(kGain) + type("9") + " key Return"));
  EXPECT_TRUE(commandsBecome("set")) << commands();
  ASSERT_TRUE(xdotool("key Escape key Escape"));  // the first one gives the keys back to the picture
  EXPECT_TRUE(commandsBecome("set back")) << commands();
  EXPECT_EQ(log("edit").size(), 1U);
}

TEST_F(RealInput, EscapeAndUndoShowTheValueInPlaceOfARefusedText) {
  open(quick());
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("xyz") + " key Return sleep 0.5 key Escape sleep 0.3"));
  // The row still has the focus: what is typed next is its number.
  ASSERT_TRUE(xdotool(type("7") + " key Return"));
  EXPECT_TRUE(commandsBecome("set")) << commands();
  ASSERT_TRUE(comesToLog("edit"));
  ASSERT_TRUE(xdotool("key Return" + type("q") + " key Return sleep 0.3 key ctrl+z sleep 0.5"));
  EXPECT_TRUE(commandsBecome("set undo")) << commands();
  // Without a refused text, a drag changes the value.
  ASSERT_TRUE(xdotool(drag(kLosses, 20)));
  EXPECT_TRUE(comes([&] { return log("edit").size() > 1; }));
}

TEST_F(RealInput, ARefusedNumberStaysInEachFieldUntilItIsMended) {
  open(quick());
  ASSERT_TRUE(xdotool(click(kRate) + " key ctrl+a" + type("2,5") + " key Return sleep 0.5"));
  EXPECT_EQ(commands(), "");
  ASSERT_TRUE(xdotool(click(kRate) + " key End BackSpace BackSpace Return"));
  EXPECT_TRUE(commandsBecome("rate")) << commands();
  EXPECT_TRUE(reports("rate", 2));
}

TEST_F(RealInput, EnterInAListOrARefusedFieldOfADialogDoesNotEndIt) {
  constexpr Place kCamera{364, 325}, kBegin{294, 378};  // below the line about bookmarks
  open(quick());
  ASSERT_TRUE(xdotool("key ctrl+m sleep 0.6" + click(kCamera) + " sleep 0.4 key Down Return sleep 0.6"));
  EXPECT_TRUE(commandsBecome("record camera_path")) << commands();
  ASSERT_TRUE(
      xdotool(click(kBegin) + " key ctrl+a" + type("1,x") + " key Return sleep 0.6 key Return sleep 0.6"));
  EXPECT_TRUE(commandsBecome("record camera_path")) << commands();
}

TEST_F(RealInput, TheOpenDialogStaysWhenAnOpeningEnds) {
  open(quick());
  const std::string name = type(std::filesystem::path(quick()).filename().string());
  ASSERT_TRUE(opens("ctrl+o", "open"));
  ASSERT_TRUE(xdotool(name + " key Return key ctrl+o"));
  EXPECT_TRUE(reports("computing_what", [](const Json& what) {
    return what.is_string() && what.get<std::string>().find("after the dialog") != std::string::npos;
  }));
  ASSERT_TRUE(xdotool(name + " key Return"));
  EXPECT_TRUE(commandsBecome("open open open open")) << commands();
  EXPECT_TRUE(reports("program", "IDLE"));
}

TEST_F(RealInput, ShiftEscapeCancelsAlsoWhileAValueHasTheKeyboard) {
  open(quick());
  ASSERT_TRUE(xdotool(click(kLosses) + " key shift+Escape"));
  EXPECT_TRUE(commandsBecome("cancel")) << commands();
  ASSERT_TRUE(xdotool(type("7") + " key Return"));
  EXPECT_TRUE(commandsBecome("cancel set")) << commands();
}

TEST_F(RealInput, AClickSelectsAValueAndADragChangesItFromWhereItIs) {
  open(quick());
  ASSERT_TRUE(xdotool("keydown ctrl keyup ctrl" + click(kLosses) + " sleep 0.6" + drag(kLosses, -20)));
  ASSERT_TRUE(comesToLog("edit"));
  EXPECT_EQ(commands(), "");
  for (const Json& edit : log("edit"))
    EXPECT_THAT(std::stod(edit["value"].get<std::string>()), AllOf(Ge(0), Lt(3)));
}

TEST_F(RealInput, AHeldSliderMakesOneEditForAValue) {
  open(quick());
  ASSERT_TRUE(xdotool(at(kLosses) + " mousedown 1" + at({kLosses.x - 10, kLosses.y}) + " sleep 1 mouseup 1"));
  ASSERT_TRUE(comesToLog("edit"));
  std::vector<std::string> values;
  for (const Json& edit : log("edit")) values.push_back(edit["value"]);
  EXPECT_EQ(std::adjacent_find(values.begin(), values.end()), values.end());
  EXPECT_EQ(end()["edits"], 1);
}

TEST_F(RealInput, ADoubleClickedValueTakesOtherUnits) {
  open(quick());
  ASSERT_TRUE(xdotool(doubleClick(kPower) + type("5 MW") + " key Return" + doubleClick(kLosses) +
                      type("7 km") + " key Return"));
  EXPECT_TRUE(commandsBecome("set")) << commands();
  // The refused text is kept: what is wrong of it is replaced.
  ASSERT_TRUE(xdotool("key Return End BackSpace BackSpace BackSpace Return"));
  EXPECT_TRUE(commandsBecome("set set")) << commands();
  ASSERT_TRUE(comes([&] { return log("edit").size() == 2; }));
  EXPECT_EQ(log("edit")[0]["value"], "5000000");
  EXPECT_EQ(log("edit")[1]["value"], "7");
}

TEST_F(RealInput, KeysOfASelectedValueAreTypedThereAndAreNoCommands) {
  open(quick());
  ASSERT_TRUE(xdotool(click(kPower) + type("5 kW")));
  ASSERT_TRUE(xdotool("key Tab" + type("4") + " key Return Down Up"));
  EXPECT_TRUE(commandsBecome("set set")) << commands();
  ASSERT_TRUE(comes([&] { return log("edit").size() == 2; }));
  EXPECT_EQ(log("edit")[0]["path"], "emitters.radar.power_w");
  EXPECT_EQ(log("edit")[0]["value"], "5000");
  EXPECT_EQ(log("edit")[1]["path"], "emitters.radar.losses_db");
  EXPECT_EQ(log("edit")[1]["value"], "4");
  ASSERT_TRUE(xdotool("key Right key Escape key b"));
  EXPECT_TRUE(commandsBecome("set set set terrain")) << commands();
}

TEST_F(RealInput, TheSwitchOfAHeadingTurnsAnEmitterOffAndOn) {
  open(quick());
  ASSERT_TRUE(xdotool(click(kSwitch) + " sleep 1" + click(kSwitch)));
  EXPECT_TRUE(commandsBecome("enable enable")) << commands();
  EXPECT_TRUE(comes([&] { return log("edit").size() == 2; }));
  EXPECT_EQ(end()["edits"], 0);
}

TEST_F(RealInput, ShiftAndDragPanTheTimeLineAndAPlainDragSeeks) {
  open(quick());
  ASSERT_TRUE(xdotool(at(kTimeLine) + " click 4 click 4 click 4"));
  ASSERT_TRUE(commandsBecome("timeline timeline timeline")) << commands();
  ASSERT_TRUE(reports("visible_from_s", [](const Json& value) { return value > 0; }));
  const Json before = last("frame");
  ASSERT_TRUE(xdotool("keydown shift" + drag(kTimeLine, 60) + " keyup shift"));
  ASSERT_TRUE(reports("visible_from_s", [&](const Json& value) { return value < before["visible_from_s"]; }));
  EXPECT_EQ(commands().find("seek"), std::string::npos) << commands();
  ASSERT_TRUE(xdotool(drag(kTimeLine, 60)));
  EXPECT_TRUE(reports("asked_s", [](const Json& value) { return value > 1; }));
}

TEST_F(RealInput, ShiftAndDragPanThePictureAndAPlainDragTurnsIt) {
  open(quick());
  const Json before = log("mark").front();
  ASSERT_TRUE(xdotool("keydown shift" + drag(kPicture, 60) + " keyup shift"));
  ASSERT_TRUE(comes([&] { return last("frame")["frame"] > before["frame"]; }));
  EXPECT_EQ(last("frame")["azimuth_deg"], before["azimuth_deg"]);
  ASSERT_TRUE(xdotool(drag(kLowerPicture, 60)));  // elsewhere: no double click
  EXPECT_TRUE(reports("azimuth_deg", [&](const Json& value) { return value != before["azimuth_deg"]; }));
}

TEST_F(RealInput, KeysPaintTheMapAndSplitThePictureByALineThatIsDragged) {
  open(quick());
  ASSERT_TRUE(xdotool("key shift+l"));
  EXPECT_TRUE(reports("map_layer", 100));
  ASSERT_TRUE(xdotool("key shift+c"));
  ASSERT_TRUE(reports("split", 0.5));
  const int width = last("frame")["picture_width"].get<int>();
  ASSERT_TRUE(comes([&] { return last("frame")["exact"] == true; }));
  const Json before = last("frame");
  ASSERT_TRUE(xdotool(drag({width / 2 + 1, 480}, -80)));
  EXPECT_TRUE(reports("split", [&](const Json& value) {
    return std::abs(value.get<double>() - (0.5 - 79.0 / width)) < 0.01;
  }));
  EXPECT_EQ(last("frame")["azimuth_deg"], before["azimuth_deg"]) << "the camera stays";
  EXPECT_TRUE(commandsBecome("map_layer split split")) << commands();
}

class Selecting : public RealInput {
 protected:
  /// Selects the first object by its key. @return where it is in the window
  Place select() {
    constexpr int kMenuBar_px = 24;
    open(quick());
    EXPECT_TRUE(xdotool("key y"));
    EXPECT_TRUE(reports("selected", "emitters.radar"));
    const Json frame = last("frame");
    return {static_cast<int>(frame["selected_x"].get<double>()),
            static_cast<int>(frame["selected_y"].get<double>()) + kMenuBar_px};
  }
};

TEST_F(Selecting, InADragTheStatusLineTellsThePointUnderTheCursor) {
  const Place object = select(), there{object.x + 60, object.y + 30};
  const auto latitude = [&](const Place& place, const char* hand) {
    const Json before = last("frame").value("cursor_latitude_deg", Json());
    EXPECT_TRUE(xdotool(at(place) + hand));
    EXPECT_TRUE(
        reports("cursor_latitude_deg", [&](const Json& now) { return now.is_number() && now != before; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    return last("frame").value("cursor_latitude_deg", 0.0);
  };
  const double before = latitude(there, "");
  latitude(object, " mousedown 1");
  EXPECT_NEAR(latitude(there, " sleep 0.5"), before, 1e-6);
  ASSERT_TRUE(xdotool("mouseup 1"));
  EXPECT_TRUE(comesToLog("edit"));
}

TEST_F(Selecting, AClickOnTheGroundSelectsNothingAndOneOnAThingSelectsIt) {
  const Place radar = select();
  ASSERT_TRUE(xdotool(click(kPicture)));
  EXPECT_TRUE(reports("selected", ""));
  ASSERT_TRUE(xdotool(click({radar.x + 3, radar.y - 2})));
  EXPECT_TRUE(reports("selected", "emitters.radar"));
  EXPECT_EQ(log("edit").size(), 0U) << "a click does not move it";
  EXPECT_EQ(log("error").size(), 0U);
}

TEST_F(Selecting, ARightClickOpensTheMenuAndARightDragLooksAround) {
  const Place radar = select();
  const Json before = last("frame");
  // The second entry is "Look at it".
  ASSERT_TRUE(xdotool(at(radar) + " click 3" + at({radar.x + 40, radar.y + 68}) + " sleep 0.5 click 1"));
  EXPECT_TRUE(comes([&] { return commands().find("focus") != std::string::npos; })) << commands();
  const std::string until_drag = commands();
  ASSERT_TRUE(xdotool(at(kPicture) + " mousedown 3" + at({kPicture.x + 40, kPicture.y}) + " mouseup 3"));
  EXPECT_TRUE(reports("azimuth_deg", [&](const Json& value) { return value != before["azimuth_deg"]; }));
  EXPECT_EQ(commands(), until_drag);
}

TEST_F(Selecting, TwoClicksMeasureAndEscapeEnds) {
  const Place radar = select();
  ASSERT_TRUE(xdotool("key shift+m" + click(radar) + click({radar.x + 60, radar.y + 20})));
  EXPECT_TRUE(reports("measured_m", [](const Json& value) { return value.is_number() && value > 100; }));
  EXPECT_EQ(last("frame")["selected"], "emitters.radar") << "clicks of a tool do not select";
  ASSERT_TRUE(xdotool("key Escape"));
  EXPECT_TRUE(reports("tool", "none"));
}

TEST_F(RealInput, AMovingCursorShowsTheValueBelowIt) {
  open(quick());
  ASSERT_TRUE(xdotool(at({300, 300}) + at({330, 330})));
  EXPECT_TRUE(reports("cursor_latitude_deg", [](const Json& value) { return value.is_number(); }));
}

TEST_F(RealInput, ClassIsThatOfTheDesktopEntryAndTheTitleMarksUnsavedEdits) {
  open(quick());
  EXPECT_TRUE(xdotool("search --class '^emscape$'"));
  EXPECT_FALSE(xdotool("search --name '^[*] quick.yaml'"));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7") + " key Return"));
  ASSERT_TRUE(comesToLog("edit"));
  EXPECT_TRUE(comes([&] { return xdotool("search --name '^[*] quick.yaml'"); }));
}

TEST_F(RealInput, EscapeClosesAMenuAndNothingElse) {
  open(quick());
  ASSERT_TRUE(xdotool(click(kFileMenu) + " sleep 0.5 key Escape sleep 0.5" + at(kPicture) + " key g"));
  EXPECT_TRUE(commandsBecome("panel")) << commands();
}

TEST_F(RealInput, KeysAfterGoToTimeAreItsNumber) {
  open(quick());
  ASSERT_TRUE(xdotool("key g 3 Return"));
  EXPECT_TRUE(commandsBecome("panel seek")) << commands();
  EXPECT_TRUE(reports("asked_s", 3));
}

TEST_F(RealInput, LettersInTheDialogOfTheMapAreForItsField) {
  open(quick());
  ASSERT_TRUE(xdotool("key ctrl+shift+g sleep 0.5" + type("cz.tif") + " key Return sleep 0.3 key Escape"));
  EXPECT_TRUE(commandsBecome("panel drape back")) << commands();
}

/// A folder of two scenarios, another one below it, and views.
class OpenDialog : public RealInput {
 protected:
  void SetUp() override {
    RealInput::SetUp();
    if (IsSkipped()) return;
    std::filesystem::create_directories(folder_ / "inputs/below");
    for (const char* name : {"a.yaml", "b.yaml", "below/c.yaml"}) writeFile(input(name), readFile(quick()));
  }
  std::string input(const std::string& name) const { return folder_ / ("inputs/" + name); }
};

TEST_F(OpenDialog, ARefusedTextStaysInEachFieldOfADialogUntilItIsMended) {
  open(input("a.yaml"));
  ASSERT_TRUE(xdotool("key g sleep 0.5" + type("3x") + " key Return sleep 0.5 key BackSpace Return"));
  EXPECT_TRUE(commandsBecome("panel seek seek")) << commands();
  EXPECT_TRUE(reports("asked_s", 3));
  // The fields of begin and end, one after the other
  ASSERT_TRUE(xdotool("key ctrl+m sleep 0.5 key Tab Tab Tab Tab sleep 0.2" + type("1x") +
                      " key Tab sleep 0.2" + type("3y") +
                      " key Tab sleep 0.3 key shift+Tab sleep 0.2 key End BackSpace shift+Tab sleep 0.2"
                      " key End BackSpace Return"));
  ASSERT_TRUE(commandsBecome("panel seek seek record record")) << commands();
  EXPECT_EQ(last("command")["begin_s"], 1);
  EXPECT_EQ(last("command")["end_s"], 3);
}

TEST_F(OpenDialog, OpensTheTypedFile) {
  open(input("a.yaml"));
  ASSERT_TRUE(xdotool("key ctrl+o" + type("b.yaml") + " key Return"));
  EXPECT_TRUE(commandsBecome("open open")) << commands();
  EXPECT_TRUE(reports("input", input("b.yaml")));
}

TEST_F(OpenDialog, EntersTheTypedFolderAndOpensTheTypedFileThere) {
  open(input("a.yaml"));
  ASSERT_TRUE(xdotool("key ctrl+o" + type("below") + " key Return" + type("c.yaml") + " key KP_Enter"));
  EXPECT_TRUE(commandsBecome("open open")) << commands();
  EXPECT_TRUE(reports("input", input("below/c.yaml")));
}

TEST_F(OpenDialog, OpensTheSelectedFileIfNothingIsTyped) {
  open(input("a.yaml"));
  ASSERT_TRUE(opens("ctrl+o", "open"));
  ASSERT_TRUE(xdotool(type("x") + " key BackSpace key Down key Down key Return"));
  EXPECT_TRUE(commandsBecome("open open")) << commands();
  EXPECT_TRUE(reports("input", input("b.yaml")));
}

TEST_F(OpenDialog, TabReachesTheButtonsAndComesBackToThePath) {
  open(input("below/c.yaml"));
  // Path, Open, Open this folder of volumes, Up: which Enter presses.
  ASSERT_TRUE(xdotool("key ctrl+o sleep 0.5 key Tab key Tab key Tab sleep 0.2 key Return sleep 0.6" +
                      std::string(" key Tab") + type("b.yaml") + " key Tab sleep 0.2 key space"));
  EXPECT_TRUE(commandsBecome("open open")) << commands();
  EXPECT_TRUE(reports("input", input("b.yaml")));
}

TEST_F(OpenDialog, TabGoesThroughTheFieldsAndListsOfTheDialogOfRecordings) {
  open(input("a.yaml"));
  // File, Browse, size, camera, begin, end; and back to the size, whose list the arrow keys go through
  ASSERT_TRUE(xdotool("key ctrl+m sleep 0.5 key Tab key Tab key Tab key Tab sleep 0.2" + type("1") +
                      " key Tab sleep 0.2" + type("2") +
                      " key shift+Tab key shift+Tab key shift+Tab sleep 0.2 key Return sleep 0.5 key Down"
                      " key Return sleep 0.3 key Tab key Tab key Tab sleep 0.2" +
                      type("3") + " key Return"));
  ASSERT_TRUE(commandsBecome("record record")) << commands();
  const Json record = last("command");
  EXPECT_EQ(record["begin_s"], 1);
  EXPECT_EQ(record["end_s"], 3);
  EXPECT_EQ(record["width"], 1280);
}

TEST_F(OpenDialog, AMistypedPathStaysWithItsText) {
  open(input("a.yaml"));
  ASSERT_TRUE(opens("ctrl+o", "open"));
  ASSERT_TRUE(xdotool(type("b.yamk") + " key Return sleep 0.4 key BackSpace" + type("l") + " key Return"));
  EXPECT_TRUE(commandsBecome("open open")) << commands();
  EXPECT_TRUE(reports("input", input("b.yaml")));
}

TEST_F(OpenDialog, LoadsTheTypedView) {
  writeFile(input("first.view.json"), R"({"schema_version": 1, "mode": "mip"})");
  writeFile(input("second.view.json"), R"({"schema_version": 1, "mode": "mida"})");
  open(input("a.yaml"));
  ASSERT_TRUE(xdotool("key ctrl+shift+l" + type("second.view.json") + " key Return"));
  EXPECT_TRUE(commandsBecome("load_state load_state")) << commands();
  EXPECT_TRUE(reports("mode", "mida"));
}

TEST_F(OpenDialog, SavesUnderTheTypedName) {
  open(input("a.yaml"));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7") + " key Return"));
  ASSERT_TRUE(comesToLog("edit"));
  ASSERT_TRUE(opens("ctrl+shift+s", "save_as"));
  ASSERT_TRUE(xdotool("key ctrl+a" + type("other.yaml") + " key Return"));
  EXPECT_TRUE(commandsBecome("set save_as save")) << commands();
  EXPECT_TRUE(comes([&] { return std::filesystem::exists(input("other.yaml")); }));
  EXPECT_TRUE(reports("unsaved", false));
}

TEST_F(OpenDialog, FileDialogsFollowOneAnotherInOneWindow) {
  open(input("a.yaml"));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7") + " key Return"));
  ASSERT_TRUE(comesToLog("edit"));
  ASSERT_TRUE(opens("ctrl+o", "open"));
  ASSERT_TRUE(xdotool("key Escape"));
  ASSERT_TRUE(opens("ctrl+shift+s", "save_as"));
  ASSERT_TRUE(xdotool("key ctrl+a" + type("other.yaml") + " key Return"));
  EXPECT_TRUE(commandsBecome("set open back save_as save")) << commands();
}

TEST_F(OpenDialog, TheSavedNameIsInTheTitleAndTheNextToBeSaved) {
  openByHand(input("a.yaml"));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7")));
  ASSERT_TRUE(opens("ctrl+shift+s", "save_as"));
  ASSERT_TRUE(xdotool(type("mine.yaml") + " key Return"));
  EXPECT_TRUE(comes([&] { return xdotool("search --name '^mine.yaml'"); }));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("8") + " key ctrl+s"));
  EXPECT_TRUE(commandsBecome("set save_as save set save")) << commands();
  EXPECT_TRUE(comes([&] { return readFile(input("mine.yaml")).find("losses_db: 8") != std::string::npos; }));
  EXPECT_FALSE(std::filesystem::exists(input("a.edited.yaml")));
}

TEST_F(OpenDialog, TabAndArrowsGoThroughTheAnswersOfAQuestion) {
  openByHand(input("a.yaml"));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7") + " key Return"));
  ASSERT_TRUE(comesToLog("edit"));
  ASSERT_TRUE(xdotool("key ctrl+q sleep 0.5 key Tab key Tab key Return sleep 0.5"));  // Back
  ASSERT_TRUE(xdotool("key ctrl+q sleep 0.5 key Right key Return"));                  // Discard and quit
  EXPECT_EQ(program_->wait().status, 0);
  program_.reset();
  EXPECT_EQ(commands(), "set quit quit quit") << "the row behind has no keys";
  EXPECT_FALSE(std::filesystem::exists(input("a.edited.yaml")));
}

// The help over it closes alone; the rest of the window waits.
TEST_F(OpenDialog, TheQuestionAboutKeptEditsIsAnsweredByEnter) {
  open(input("a.yaml"));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7") + " key Return"));
  ASSERT_TRUE(comesToLog("autosave"));
  kill(SIGKILL);
  openByHand(input("a.yaml"));
  ASSERT_TRUE(
      xdotool(click(kFileMenu) + click(kPicture) + " sleep 0.5 key F1 sleep 0.5 key Escape sleep 0.5"));
  EXPECT_TRUE(commandsBecome("panel back")) << commands();
  ASSERT_TRUE(xdotool("key Return"));
  EXPECT_TRUE(commandsBecome("panel back restore")) << commands();
  EXPECT_TRUE(reports("edits", 1));
}

TEST_F(OpenDialog, EnterInTheQuestionOfLossReplacesNoFile) {
  writeFile(input("a.edited.yaml"), "kept");
  openByHand(input("a.yaml"));
  ASSERT_TRUE(xdotool(controlClick(kLosses) + type("7") + " key Return"));
  ASSERT_TRUE(comesToLog("edit"));
  ASSERT_TRUE(xdotool("key ctrl+q sleep 0.5 key Return sleep 0.5"));
  EXPECT_TRUE(commandsBecome("set quit")) << commands();
  EXPECT_EQ(readFile(input("a.edited.yaml")), "kept");
  EXPECT_EQ(end()["edits"], 1);
}

}  // namespace
}  // namespace emscape::test

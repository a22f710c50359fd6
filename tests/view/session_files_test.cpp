/// Opening, recent files, autosave, recording: file operations of a session, without a window.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <thread>

#include "apps/view/files/recent_files.h"
#include "apps/view/parts/opening.h"
#include "apps/view/session/session_opener.h"
#include "emscape/render/picture/image.h"
#include "emscape/volume/format/file.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

/// A copy of scenarios/quick.yaml that a test may change.
std::string ownScenario(const StateFolder& folder, const std::string& from = "", const std::string& to = "") {
  std::string text = readFile(shippedScenario("quick.yaml"));
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return folder.write("own.yaml", text);
}

bool waitUntilOpened(SessionSample& shown, SessionOpener& opener) {
  return shown.waitUntil([&] {
    opener.update(shown.session);
    shown->update();
    return !opener.active() && shown->settled();
  });
}

// --- fields on tetrahedra ---

TEST(SessionOfTetrahedra, ShowsEditsAndRefusesUnsupportedVerbs) {
  const StateFolder folder;
  ViewOptions options = optionsFor(shippedScenario("quick.yaml"), {160, 120});
  options.view.mesh = "terrain:4,50";
  SessionSample shown(options);
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(shown->report()["cells"], "marched");
  const double before = shown->report()["range_max"];
  EXPECT_THAT(shown.perform(R"({"do": "mode", "mode": "mip"})"), HasSubstr("support only mode dvr"));
  EXPECT_EQ(shown->report()["mode"], "dvr");
  shown.perform(R"({"do": "probe", "x": 80, "y": 60})");
  ASSERT_TRUE(shown->prober().result());
  EXPECT_THAT(shown->prober().result()->error, HasSubstr("are not probed"));
  shown.perform(R"({"do": "fit_step"})");
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(shown->report()["range_max"], before);
  shown.perform(R"({"do": "copy_command"})");
  ASSERT_TRUE(shown.waitUntil([&] { return !shown.window.clipboard.empty(); }));
  EXPECT_THAT(shown.window.clipboard, HasSubstr(" --mesh terrain:4,50 "));
}

TEST(SessionOfVolumes, AQuantityThatTheyDoNotHoldIsRefused) {
  const StateFolder folder;
  {
    SessionSample computed(optionsFor(shippedScenario("quick.yaml"), {160, 120}));
    ASSERT_TRUE(computed.settle());
    const auto first = computed->picture()->volume.host();
    computed.perform(R"({"do":"quantity","name":"field_strength_dbuvm"})");
    ASSERT_TRUE(computed.settle());
    volume::writeVolumes(folder / "one.vdb", {first.get(), computed->picture()->volume.host().get()});
  }
  SessionSample shown(optionsFor(folder / "one.vdb", {160, 120}));
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(shown.perform(R"({"do":"focus"})"), "focus: the picture has no emitters");
  shown.perform(R"({"do":"quantity","name":"snr_db"})");
  ASSERT_TRUE(shown.settle());
  EXPECT_THAT(shown.error(), HasSubstr("one.vdb: there is no volume of 'snr_db'"));
  EXPECT_EQ(shown->viewState().quantity, "");
  EXPECT_TRUE(shown->viewState().transfer);
  shown.perform(R"({"do":"dolly","factor":0.9})");
  ASSERT_TRUE(shown.settle());
  EXPECT_THAT(shown.error(), HasSubstr("'snr_db'")) << "the quantity shown before is no remedy";
  shown.perform(R"({"do":"quantity","name":"field_strength_dbuvm"})");
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(shown.error(), "");
}

// --- recent files ---

TEST(RecentFiles, KeepTheNewestInFrontAndEachOnce) {
  const StateFolder folder;
  EXPECT_THAT(readRecentFiles(), ElementsAre());
  addRecentFile("/a.yaml");
  addRecentFile("/b.yaml");
  addRecentFile("/x/../a.yaml");
  EXPECT_THAT(readRecentFiles(), ElementsAre("/a.yaml", "/b.yaml"));
  for (int i = 0; i < 20; ++i) addRecentFile(fmt::format("/{}.yaml", i));
  EXPECT_EQ(readRecentFiles().size(), kMaxRecentFiles);
  EXPECT_EQ(readRecentFiles().front(), "/19.yaml");
}

// What was opened or saved is so.
TEST(RecentFiles, ThatCannotBeWrittenAreNoFailure) {
  const StateFolder folder;
  folder.write("emscape", "no folder");
  EXPECT_THAT(addRecentFile("/a.yaml"), ElementsAre("/a.yaml"));
}

// --- the browser ---

bool waitUntilRead(FileBrowser& browser) {
  for (int i = 0; i < 2000 && browser.reading(); ++i) {
    browser.update();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return !browser.reading();
}

std::vector<std::string> namesOf(const FileBrowser& browser) {
  std::vector<std::string> names;
  for (const FolderEntry& entry : browser.entries()) names.push_back(entry.name);
  return names;
}

TEST(FileBrowser, ShowsFoldersThenOpenableFiles) {
  const StateFolder folder;
  fs::create_directory(folder / "Zebra");
  fs::create_directory(folder / "apple");
  for (const char* name : {"b.yaml", "A.vdb", "c.view.json", "notes.txt", "dem.tif", ".hidden.yaml"}) {
    folder.write(name, "");
  }
  FileBrowser browser;
  browser.open(FileBrowser::Purpose::input, folder / "");
  ASSERT_TRUE(waitUntilRead(browser));
  EXPECT_THAT(namesOf(browser), ElementsAre("apple", "Zebra", "A.vdb", "b.yaml", "c.view.json"));
  browser.open(FileBrowser::Purpose::view, "");
  ASSERT_TRUE(waitUntilRead(browser));
  EXPECT_THAT(namesOf(browser), ElementsAre("apple", "Zebra", "c.view.json"));
}

TEST(FileBrowser, EntersFoldersAndComesBackToWhereItWas) {
  const StateFolder folder;
  fs::create_directory(folder / "a");
  fs::create_directory(folder / "b");
  folder.write("b/x.yaml", "");
  FileBrowser browser;
  browser.open(FileBrowser::Purpose::input, folder / "");
  ASSERT_TRUE(waitUntilRead(browser));
  browser.moveSelection(1);
  EXPECT_EQ(browser.choose(), std::nullopt);
  ASSERT_TRUE(waitUntilRead(browser));
  EXPECT_THAT(namesOf(browser), ElementsAre("x.yaml"));
  EXPECT_EQ(browser.choose(), folder / "b/x.yaml");
  browser.goUp();
  ASSERT_TRUE(waitUntilRead(browser));
  EXPECT_EQ(browser.selected(), 1);
  EXPECT_EQ(browser.choose(std::string("b/new.view.json")), std::nullopt);
  EXPECT_EQ(browser.refused(), "b/new.view.json") << "there is no such file";
  for (const char* typed : {" b/x.yaml ", "\"b/x.yaml\"", "'b/x.yaml'\n"})
    EXPECT_EQ(browser.choose(std::string(typed)), folder / "b/x.yaml") << typed;
  EXPECT_EQ(browser.refused(), "");
  browser.moveSelection(-100);
  EXPECT_EQ(browser.selected(), 0);
}

TEST(FileBrowser, BeginsInTheFolderOfAnInputThatWasOpenedMeanwhile) {
  const StateFolder folder;
  fs::create_directory(folder / "a");
  fs::create_directory(folder / "b");
  FileBrowser browser;
  browser.open(FileBrowser::Purpose::input, folder / "a");
  browser.open(FileBrowser::Purpose::save_scenario, folder / "b", "s.edited.yaml");
  EXPECT_EQ(browser.folder(), fs::canonical(folder / "a"));
  browser.forgetFolder();
  EXPECT_EQ(browser.folder(), fs::canonical(folder / "a")) << "a dialog that is open stays";
  browser.open(FileBrowser::Purpose::save_scenario, folder / "b", "s.edited.yaml");
  EXPECT_EQ(browser.folder(), fs::canonical(folder / "b"));
}

TEST(FileBrowser, ReportsUnreadableFolder) {
  FileBrowser browser;
  browser.open(FileBrowser::Purpose::input, "/no/such/folder");
  ASSERT_TRUE(waitUntilRead(browser));
  EXPECT_THAT(browser.error(), HasSubstr("/no/such/folder: the folder cannot be read: No such file"));
}

// --- opening ---

TEST(Opening, RecognizesFilesByContent) {
  const StateFolder folder;
  const ViewOptions present = optionsFor(shippedScenario("quick.yaml"));
  folder.write("a.view.json", R"({"schema_version": 1, "time_s": 2})");
  Opening opening = prepareOpening({folder / "a.view.json", "", std::nullopt, false}, present);
  EXPECT_EQ(opening.options.view.input, present.view.input);
  EXPECT_EQ(opening.options.view.time_s, 2);
  folder.write("b.json", R"({"schema_version": 1, "domain": "relative", "opacity": [], "colors": []})");
  opening = prepareOpening({folder / "b.json", "", std::nullopt, false}, present);
  EXPECT_EQ(opening.colors, folder / "b.json");
  opening = prepareOpening({ownScenario(folder), "", std::nullopt, false}, present);
  EXPECT_EQ(opening.options.view.input, folder / "own.yaml");
}

TEST(Opening, RefusesFilesWithoutAPicture) {
  const StateFolder folder;
  const ViewOptions present = optionsFor(shippedScenario("quick.yaml"));
  const auto fault = [&](const std::string& file) {
    return errorOf([&] { prepareOpening({file, "", std::nullopt, false}, present); });
  };
  EXPECT_THAT(fault(folder / "none.yaml"), HasSubstr("none.yaml: no such file or folder"));
  folder.write("dem.tif", "");
  EXPECT_THAT(fault(folder / "dem.tif"), HasSubstr("dem.tif: neither a scenario nor a volume"));
  folder.write("notes.txt", "");
  EXPECT_THAT(fault(folder / "notes.txt"), HasSubstr("ending '.txt' is not known"));
  EXPECT_THAT(fault(ownScenario(folder, "power_w: 10000", "power_w: -1")), HasSubstr("power_w"));
}

TEST(Opening, RefusesFilesThatDescribeVolumes) {
  const StateFolder folder;
  const ViewOptions present = optionsFor(shippedScenario("quick.yaml"));
  folder.write("series.json", R"({"format_version": 2, "recipe": {}})");
  folder.write("field_0001.raw.json", R"({"dims": [2, 2, 2]})");
  const auto fault = [&](const char* name) {
    return errorOf([&] { prepareOpening({folder / name, "", std::nullopt, false}, present); });
  };
  EXPECT_THAT(fault("series.json"), HasSubstr("describes a series of volumes"));
  EXPECT_THAT(fault("field_0001.raw.json"), HasSubstr("the header of a volume"));
}

TEST(Opening, DropsEditsThatNoLongerApply) {
  const StateFolder folder;
  ViewOptions present = optionsFor(shippedScenario("quick.yaml"));
  playback::ViewState view;
  view.edits = {{"emitters.radar.power_w", "500"}, {"emitters.gone.power_w", "5"}};
  const Opening opening = prepareOpening({shippedScenario("quick.yaml"), "", view, true}, present);
  ASSERT_EQ(opening.options.view.edits.size(), 1U);
  EXPECT_EQ(opening.options.view.edits[0].path, "emitters.radar.power_w");
  ASSERT_EQ(opening.left_out.size(), 1U);
  EXPECT_THAT(opening.left_out[0], HasSubstr("the edit emitters.gone.power_w=5 is left out"));
  EXPECT_THAT(opening.left_out[0], HasSubstr("quick.yaml: there is no emitter 'gone'"));
  EXPECT_TRUE(opening.options.unsaved_edits);
}

/// Another program that opens the input after the first one ended irregularly.
struct NextProgram {
  explicit NextProgram(SessionSample& ended, const std::string& input = shippedScenario("quick.yaml"))
      : shown(optionsFor(input)) {
    ended.session.reset();
    ended.files->autosaves.reset();
    shown->shown({});
  }
  SessionSample shown;
  SessionOpener opener{shown.files, [this](const ViewOptions& options) { return shown.make(options); }};
};

class Opener : public testing::Test {
 protected:
  StateFolder folder_;
  SessionSample shown_{optionsFor(shippedScenario("quick.yaml"))};
  SessionOpener opener_{shown_.files, [this](const ViewOptions& options) { return shown_.make(options); }};
};

TEST_F(Opener, ReplacesInputOnScreen) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"theme","theme":"light"})");
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", ownScenario(folder_)));
  EXPECT_FALSE(shown_->settled());
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_->view().input, folder_ / "own.yaml");
  EXPECT_EQ(shown_->theme(), render::Theme::light);
  EXPECT_THAT(readRecentFiles(), ElementsAre(folder_ / "own.yaml"));
}

TEST_F(Opener, KeepsInputOnScreenWhenOpeningFails) {
  ASSERT_TRUE(shown_.settle());
  const Session* before = shown_.session.get();
  shown_.perform(R"({"do":"open","file":"/no/such/file.yaml"})");
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_.session.get(), before);
  EXPECT_THAT(shown_->notice().text, HasSubstr("/no/such/file.yaml: no such file"));
  folder_.write("broken.vdb", "not a volume");
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", folder_ / "broken.vdb"));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_.session.get(), before);
  EXPECT_THAT(shown_->notice().text, HasSubstr("broken.vdb"));
}

TEST_F(Opener, ReloadsAChangedFileWithTheEditsThatApply) {
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", ownScenario(folder_)));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  shown_.perform(R"({"do":"set","path":"emitters.transmitter.power_w","value":"7"})");
  ownScenario(folder_, "name: transmitter", "name: sender");
  shown_.perform(R"({"do":"reload"})");
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  ASSERT_EQ(shown_->viewState().edits.size(), 1U);
  EXPECT_EQ(shown_->viewState().edits[0].path, "emitters.radar.power_w");
  EXPECT_THAT(shown_->notice().text, HasSubstr("1 part of the view is left out"));
  shown_->update();
  EXPECT_THAT(shown_->warnings(), testing::Contains(HasSubstr("emitters.transmitter.power_w=7")))
      << "listed as long as the input is open";
  EXPECT_TRUE(shown_->hasUnsavedEdits());
  fs::remove(folder_ / "own.yaml");
  shown_.perform(R"({"do":"reload"})");
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_THAT(shown_->notice().text, HasSubstr("own.yaml: no such file or folder"));
}

TEST_F(Opener, WaitsForAnOpenDialogAndForTyping) {
  ASSERT_TRUE(shown_.settle());
  const Session* const before = shown_.session.get();
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", ownScenario(folder_)));
  shown_.perform(R"({"do":"open"})");
  const auto isReady = [&] {
    opener_.update(shown_.session);
    return shown_.files->opening.progress.fraction == 1 &&
           shown_.files->opening.progress.what.find("after the dialog") != std::string::npos;
  };
  ASSERT_TRUE(shown_.waitUntil(isReady));
  EXPECT_EQ(shown_.session.get(), before);
  EXPECT_TRUE(shown_->panels.open);
  shown_->panels.open = false;
  shown_.files->is_typing = true;
  EXPECT_FALSE(opener_.update(shown_.session)) << "the text would become keys";
  shown_.files->is_typing = false;
  shown_->panels.help = true;
  EXPECT_TRUE(opener_.update(shown_.session));
  EXPECT_EQ(shown_->view().input, folder_ / "own.yaml");
  EXPECT_TRUE(shown_->panels.help) << "it does not belong to the input";
}

TEST_F(Opener, ReloadingKeepsTheNameOfSaveAsAndOpeningDoesNot) {
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", ownScenario(folder_)));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  ASSERT_TRUE(shown_.settle());
  shown_.perform(fmt::format(R"({{"do":"save","file":"{}"}})", folder_ / "mine.yaml"));
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"reload"})");
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_->document(), folder_ / "mine.yaml");
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"600"})");
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"save"})");
  EXPECT_FALSE(shown_->panels.replace) << "this window has written it";
  ASSERT_TRUE(shown_.settle());
  EXPECT_THAT(readFile(folder_ / "mine.yaml"), HasSubstr("power_w: 600"));
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", folder_ / "own.yaml"));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_->document(), folder_ / "own.yaml");
}

TEST_F(Opener, ReloadingKeepsTheSelection) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"select","path":"emitters.radar"})");
  shown_.perform(R"({"do":"reload"})");
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_->selected(), "emitters.radar");
}

TEST_F(Opener, ShowsViewFiles) {
  ASSERT_TRUE(shown_.settle());
  folder_.write(
      "a.view.json",
      R"({"schema_version": 1, "time_s": 3, "mode": "mip", "edits": ["emitters.radar.power_w=5"]})");
  shown_.perform(fmt::format(R"({{"do":"load_state","file":"{}"}})", folder_ / "a.view.json"));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_->settings().mode, render::CompositingMode::mip);
  EXPECT_EQ(shown_->timeline().step_s(), 3);
  EXPECT_EQ(shown_->viewState().edits.size(), 1U);
  EXPECT_FALSE(shown_->hasUnsavedEdits());
}

TEST_F(Opener, ShowsViewsWhoseIsosurfaceIsOutsideOfTheValues) {
  ASSERT_TRUE(shown_.settle());
  folder_.write(
      "a.view.json",
      R"({"schema_version": 1, "mode": "iso", "iso_value": -25, "edits": ["emitters.radar.power_w=1e-6"]})");
  shown_.perform(fmt::format(R"({{"do":"load_state","file":"{}"}})", folder_ / "a.view.json"));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_EQ(shown_.error(), "");
  EXPECT_EQ(shown_->settings().iso_value, -25);
  EXPECT_EQ(shown_->viewState().edits.size(), 1U);
}

TEST_F(Opener, AFaultIsLoggedOnce) {
  ASSERT_TRUE(shown_.settle());
  shown_.log = EventLog(folder_ / "log.jsonl");
  folder_.write("broken.vdb", "not a volume");
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", folder_ / "broken.vdb"));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  EXPECT_THAT(shown_.error(), HasSubstr("broken.vdb"));
  const std::string log = readFile(folder_ / "log.jsonl");
  const std::size_t first = log.find(R"("event":"error")");
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find(R"("event":"error")", first + 1), std::string::npos) << log;
}

// --- edits that are not saved ---

bool waitForAutosave(SessionSample& shown, bool wanted) {
  return shown.waitUntil([&] {
    return fs::exists(playback::autosaveFileOf(shown->view().input)) == wanted && !shown->working();
  });
}

TEST_F(Opener, SLOW_EditsAreAutosavedAndRestored) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  ASSERT_TRUE(waitForAutosave(shown_, true));
  // A second window does not ask.
  {
    SessionSample beside(optionsFor(shippedScenario("quick.yaml")));
    beside->shown({});
    ASSERT_TRUE(beside.settle());
    EXPECT_FALSE(beside->keptView());
  }
  NextProgram next(shown_);
  SessionSample& again = next.shown;
  ASSERT_TRUE(again.settle());
  ASSERT_TRUE(again->keptView());
  again->update();
  EXPECT_TRUE(again->panels.restore);
  again.perform(R"({"do":"restore"})");
  ASSERT_TRUE(waitUntilOpened(again, next.opener));
  ASSERT_EQ(again->viewState().edits.size(), 1U);
  EXPECT_EQ(again->viewState().edits[0].value, "500");
  EXPECT_TRUE(again->hasUnsavedEdits());
  ASSERT_TRUE(waitForAutosave(again, true));
  again->leave(false);
  EXPECT_TRUE(waitForAutosave(again, false));
}

TEST_F(Opener, SLOW_EditsThatLeaveNoIsosurfaceAreRestored) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"iso","value":-25})");
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"1e-6"})");
  ASSERT_TRUE(waitForAutosave(shown_, true));
  NextProgram next(shown_);
  SessionSample& again = next.shown;
  ASSERT_TRUE(again.settle());
  again.perform(R"({"do":"restore"})");
  ASSERT_TRUE(waitUntilOpened(again, next.opener));
  EXPECT_EQ(again.error(), "");
  ASSERT_EQ(again->viewState().edits.size(), 1U);
  EXPECT_EQ(again->settings().mode, render::CompositingMode::iso);
  again->leave(false);
  EXPECT_TRUE(waitForAutosave(again, false));
}

TEST_F(Opener, SLOW_FilesOfTheMapThatAreGoneDoNotPreventRestoring) {
  ASSERT_TRUE(shown_.settle());
  const std::string places = folder_.write("places.geojson", R"({"type":"FeatureCollection","features":[]})");
  shown_.perform(fmt::format(R"({{"do":"places","files":["{}"]}})", places));
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  ASSERT_TRUE(waitForAutosave(shown_, true));
  NextProgram next(shown_);
  SessionSample& again = next.shown;
  ASSERT_TRUE(again.settle());
  fs::remove(places);
  again.perform(R"({"do":"restore"})");
  ASSERT_TRUE(waitUntilOpened(again, next.opener));
  EXPECT_EQ(again->viewState().edits.size(), 1U);
  EXPECT_THAT(again->viewState().places, ElementsAre());
  again->update();
  EXPECT_THAT(again->warnings(), testing::Contains(HasSubstr("places.geojson is left out of the map")));
  again->leave(false);
  EXPECT_TRUE(waitForAutosave(again, false));
}

TEST_F(Opener, SLOW_EditsThatCannotBeRestoredStayInTheirFile) {
  const std::string input = shippedScenario("jacksboro.yaml");
  const std::string small = R"("region.dims=[20, 20, 10]")";
  shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", input));
  ASSERT_TRUE(waitUntilOpened(shown_, opener_));
  shown_.perform(fmt::format(
      R"({{"do":"set_together","edits":[{},"platforms.ridge site.position.latitude_deg=40"]}})", small));
  ASSERT_TRUE(waitForAutosave(shown_, true));
  EXPECT_THAT(shown_->programState().what, HasSubstr("NOT COMPUTED: "));
  NextProgram next(shown_, input);
  SessionSample& again = next.shown;
  ASSERT_TRUE(again.settle());
  const fs::path kept = playback::autosaveFileOf(input);
  const std::string before = readFile(kept);
  again.perform(R"({"do":"restore"})");
  ASSERT_TRUE(waitUntilOpened(again, next.opener));
  EXPECT_THAT(again.error(), HasSubstr("terrain"));
  EXPECT_THAT(again->viewState().edits, testing::IsEmpty());
  again.perform(fmt::format(R"({{"do":"set_together","edits":[{}]}})", small));
  ASSERT_TRUE(
      again.waitUntil([&] { return fs::exists(playback::autosaveFileOf(input, 2)) && !again->working(); }));
  EXPECT_EQ(readFile(kept), before);
  again->leave(false);
}

TEST_F(Opener, FilesOfTheMapThatDoNotExistAreRefused) {
  ASSERT_TRUE(shown_.settle());
  EXPECT_THAT(shown_.perform(R"({"do":"drape","file":"/no/such.tif"})"), HasSubstr("no such file"));
  EXPECT_EQ(shown_->view().drape, "");
  EXPECT_THAT(shown_.perform(R"({"do":"places","files":["/no/such.csv"]})"), HasSubstr("no such file"));
  EXPECT_THAT(shown_->view().places, ElementsAre());
}

TEST_F(Opener, SLOW_AnAutosaveGoesWhenEditsAreUndoneOrDiscarded) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  ASSERT_TRUE(waitForAutosave(shown_, true));
  shown_.perform(R"({"do":"undo"})");
  EXPECT_TRUE(waitForAutosave(shown_, false));
  EXPECT_EQ(shown_.perform(R"({"do":"discard"})"), "no edits were kept for this input");
}

TEST_F(Opener, QuitAsksForUnsavedEdits) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  shown_.perform(R"({"do":"quit"})");
  EXPECT_FALSE(shown_.window.has_quit);
  EXPECT_TRUE(shown_->panels.unsaved);
  EXPECT_THAT(shown_.perform(R"({"do":"quit","edits":"perhaps"})"), HasSubstr("expected save, discard, ask"));
  shown_.perform(fmt::format(R"({{"do":"save","file":"{}"}})", folder_ / "saved.yaml"));
  ASSERT_TRUE(shown_.settle());
  EXPECT_THAT(readFile(folder_ / "saved.yaml"), HasSubstr("power_w: 500"));
  shown_.perform(R"({"do":"quit"})");
  EXPECT_TRUE(shown_.window.has_quit);
}

TEST_F(Opener, QuitWithoutEditsAsksNoQuestion) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"quit"})");
  EXPECT_TRUE(shown_.window.has_quit);
}

// --- recording ---

bool waitUntilRecorded(SessionSample& shown) {
  return shown.waitUntil([&] { return !shown.files->recorder.running(); });
}

TEST_F(Opener, RecordsThePicturesOfTheWindow) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  shown_.perform(R"({"do":"seek","time_s":3})");
  ASSERT_TRUE(shown_.settle());
  EXPECT_EQ(shown_.perform(fmt::format(R"({{"do":"record","file":"{}","begin_s":1,"end_s":3,"step_s":1}})",
                                       folder_ / "frames")),
            "");
  EXPECT_THAT(shown_.perform(R"({"do":"record","file":"x.mp4"})"), HasSubstr("is being recorded"));
  ASSERT_TRUE(waitUntilRecorded(shown_));
  EXPECT_THAT(shown_->notice().text, HasSubstr("recorded 3 pictures"));
  shown_.perform(fmt::format(R"({{"do":"picture","file":"{}"}})", folder_ / "picture.png"));
  ASSERT_TRUE(shown_.settle());
  const render::ImageDifference difference = render::compare(
      render::readPng(folder_ / "picture.png"), render::readPng(folder_ / "frames/quick_0003.png"));
  for (const int max : difference.max) EXPECT_LE(max, 1);
}

// The window is drawn when update() is true.
TEST_F(Opener, TheProgressAndTheEndOfARecordingAreDrawn) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}"}})", folder_ / "frames"));
  const auto begin = std::chrono::steady_clock::now();
  std::set<int> told;  // numbers of pictures
  bool is_end_drawn = false;
  while (!is_end_drawn && std::chrono::steady_clock::now() - begin < std::chrono::minutes(1)) {
    const bool is_drawn = shown_->update();
    if (is_drawn) told.insert(shown_.files->recorder.progress().pictures);
    is_end_drawn = is_drawn && shown_->notice().text.find("recorded 5") == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(is_end_drawn);
  EXPECT_GE(told.size(), 2u) << "also in between";
}

// Its change is told, and taken with a reload alone.
TEST_F(Opener, AnInputThatChangedOnTheDiskIsNotReadAgainForARecordingOrAComparison) {
  const auto write = [this](bool has_radar) {
    ownScenario(folder_, "power_w: 10000",
                has_radar ? "power_w: 10000" : "power_w: 10000\n    enabled: false");
  };
  struct Pictures {
    render::Image8 recorded, original;
  };
  const auto picturesOf = [&](bool has_radar_at_first, bool has_radar_then) {
    write(has_radar_at_first);
    shown_.perform(fmt::format(R"({{"do":"open","file":"{}"}})", folder_ / "own.yaml"));
    EXPECT_TRUE(waitUntilOpened(shown_, opener_));
    EXPECT_TRUE(shown_.settle());
    write(has_radar_then);
    const std::string recorded = folder_ / "recorded.png", split = folder_ / "split.png";
    shown_.perform(
        fmt::format(R"({{"do":"record","file":"{}","begin_s":0,"end_s":0,"replace":true}})", recorded));
    EXPECT_TRUE(waitUntilRecorded(shown_));
    shown_.perform(R"({"do":"set","path":"emitters.transmitter.enabled","value":"false"})");
    shown_.perform(R"({"do":"split","position":1})");
    EXPECT_TRUE(shown_.settle());
    shown_.perform(fmt::format(R"({{"do":"picture","file":"{}","replace":true}})", split));
    EXPECT_TRUE(shown_.settle());
    shown_.perform(R"({"do":"revert"})");
    return Pictures{render::readPng(recorded), render::readPng(split)};
  };
  /// Number of bytes that differ clearly.
  const auto differing = [](const render::Image8& one, const render::Image8& other) {
    int count = 0;
    for (std::size_t n = 0; n < one.rgba.size(); ++n) count += std::abs(one.rgba[n] - other.rgba[n]) > 4;
    return count;
  };
  const Pictures with = picturesOf(true, true), without = picturesOf(false, false);
  const Pictures found = picturesOf(true, false);
  EXPECT_GT(differing(with.recorded, without.recorded), 100);
  EXPECT_GT(differing(with.original, without.original), 100);
  EXPECT_LT(differing(found.recorded, with.recorded), 10);
  EXPECT_LT(differing(found.original, with.original), 10);
}

TEST_F(Opener, AVideoInNoFolderIsRefused) {
  ASSERT_TRUE(shown_.settle());
  const std::string video = folder_ / "none/film.mp4";
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}"}})", video));
  ASSERT_TRUE(waitUntilRecorded(shown_));
  EXPECT_EQ(shown_.error(), video + ": cannot write: the folder " + (folder_ / "none") + " does not exist");
}

TEST_F(Opener, CancelledVideoLeavesNoFile) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}","step_s":0.01}})", folder_ / "film.mp4"));
  ASSERT_TRUE(shown_.waitUntil([this] {
    return shown_.files->recorder.progress().pictures > 0 || !shown_.files->recorder.running();
  }));
  if (!shown_.files->recorder.running()) GTEST_SKIP() << "no ffmpeg: " << shown_->notice().text;
  shown_.perform(R"({"do":"record_cancel"})");
  ASSERT_TRUE(waitUntilRecorded(shown_));
  EXPECT_THAT(shown_->notice().text, HasSubstr("film.mp4 is not written"));
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_THAT(entry.path().filename().string(), testing::Not(testing::StartsWith("film")));
  }
}

// What has the name is still the file from before.
TEST_F(Opener, ACancelledRecordingIsAskedForAgain) {
  ASSERT_TRUE(shown_.settle());
  folder_.write("film.mp4", "mine");
  const auto record = [this](const char* options) {
    return fmt::format(R"({{"do":"record","file":"{}",{}}})", folder_ / "film.mp4", options);
  };
  shown_.perform(record(R"("step_s":0.01,"replace":true)"));
  ASSERT_TRUE(shown_.waitUntil([this] {
    return shown_.files->recorder.progress().pictures > 0 || !shown_.files->recorder.running();
  }));
  if (!shown_.files->recorder.running()) GTEST_SKIP() << "no ffmpeg: " << shown_->notice().text;
  shown_.perform(R"({"do":"record_cancel"})");
  ASSERT_TRUE(waitUntilRecorded(shown_));
  shown_.perform(record(R"("replace":false)"));
  EXPECT_TRUE(shown_->panels.replace);
  EXPECT_EQ(readFile(folder_ / "film.mp4"), "mine");
}

TEST_F(Opener, ErrorsOfRecordingAreReported) {
  ASSERT_TRUE(shown_.settle());
  EXPECT_THAT(shown_.perform(R"({"do":"record","file":"x.mp4","begin_s":3,"end_s":1})"),
              HasSubstr("begin_s <= end_s"));
  EXPECT_THAT(shown_.perform(R"({"do":"record","file":"x.mp4","frames_per_s":0})"), HasSubstr("0.1..240"));
  folder_.write("file", "");
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}"}})", folder_ / "file/frames"));
  ASSERT_TRUE(waitUntilRecorded(shown_));
  EXPECT_TRUE(shown_->notice().is_error);
  EXPECT_THAT(shown_->notice().text, HasSubstr("is to be a folder, but " + folder_ / "file" + " is a file"));
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}"}})", folder_ / "one.png"));
  ASSERT_TRUE(waitUntilRecorded(shown_));
  EXPECT_THAT(shown_->notice().text, HasSubstr("one .png for 5 pictures"));
}

TEST_F(Opener, ARecordedPictureThatWasEditedIsAskedForBeforeItIsReplaced) {
  ASSERT_TRUE(shown_.settle());
  const std::string record = fmt::format(
      R"({{"do":"record","file":"{}","begin_s":1,"end_s":1,"replace":false}})", folder_ / "frames");
  shown_.perform(record);
  ASSERT_TRUE(waitUntilRecorded(shown_));
  EXPECT_FALSE(shown_->notice().is_error) << shown_->notice().text;
  shown_.perform(record);
  EXPECT_FALSE(shown_->panels.replace) << "as this window has written it";
  ASSERT_TRUE(waitUntilRecorded(shown_));
  folder_.write("frames/quick_0001.png", "edited");
  shown_.perform(record);
  EXPECT_TRUE(shown_->panels.replace);
  EXPECT_EQ(readFile(folder_ / "frames/quick_0001.png"), "edited");
}

TEST_F(Opener, TheDialogOfSaveAsComesBackWithTheNameThatCannotBeWritten) {
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"save_as"})");
  ASSERT_TRUE(shown_->panels.open);
  const std::string file = folder_ / "none/changed.yaml";
  shown_.perform(fmt::format(R"({{"do":"save","file":"{}"}})", file));
  ASSERT_TRUE(shown_.waitUntil([this] { return shown_->notice().is_error; }));
  EXPECT_THAT(shown_->notice().text, HasSubstr("none does not exist"));
  EXPECT_TRUE(shown_->panels.open);
  EXPECT_EQ(shown_.files->browser.proposed(), file);
}

TEST_F(Opener, AMissingFfmpegIsOneMessage) {
  ASSERT_TRUE(shown_.settle());
  const std::string path = getenv("PATH");
  setenv("PATH", "/no/such/folder", 1);
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}"}})", folder_ / "film.mp4"));
  const bool recorded = waitUntilRecorded(shown_);
  setenv("PATH", path.c_str(), 1);
  ASSERT_TRUE(recorded);
  EXPECT_THAT(shown_->notice().text, HasSubstr("needs the program ffmpeg, which is not on PATH"));
}

}  // namespace
}  // namespace emscape::view::test

// View files, and the description and journal of a series.
#include "emscape/playback/frames/field_series.h"
#include "emscape/playback/series/series_writer.h"
#include "playback/view/view_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> views() {
  playback::ViewState full;
  full.camera.kind = render::CameraSpec::Kind::lookat;
  full.camera.eye_m = Vec3d{1, 2, 3};
  full.camera.target_m = Vec3d{4, 5, 6};
  full.bookmarks = {{"ridge", {}, 12.5}, {"sea", full.camera, {}}};
  full.play_range = scenario::TimeInterval{1, 2};
  full.visible_time = scenario::TimeInterval{0, 60};
  full.quantity = "snr_db";
  full.transfer =
      render::TransferFunction{"mine", "dB", {{0, {0, 0, 1}}, {20, {1, 0, 0}}}, {{0, 0}, {20, 0.5}}};
  full.range = volume::ValueRange{-10, 40};
  full.settings.planes = {render::parseCutPlane("horizontal:altitude_m=500")};
  full.edits = {{"emitters.radar.power_w", "500"}};
  full.open_panels = {"scenario"};
  return {playback::viewStateText({}), playback::viewStateText(full), "schema_version: 1\n"};
}

/// Two steps of a small series, as written. @return the contents of a file of the folder
void writeSmallSeries(const fs::path& folder) {
  std::vector<double> times_s{0, 1};
  playback::FieldSeries series(
      playback::loadScenarioWithTerrain(shippedScenario("quick.yaml"), {{"region.dims", "[4, 4, 3]"}}),
      times_s, {});
  playback::SeriesOptions options;
  options.folder = folder;
  options.formats = {"raw"};
  playback::writeSeries(series, options);
}

std::vector<std::string> seriesSeed(const std::string& file) {
  const TemporaryFolder folder;
  writeSmallSeries(folder.path());
  return {readFile(folder / file)};
}

void readSeries(const fs::path& file, const std::string&) {
  playback::findSeries(file.parent_path());
}

const FuzzTargetsAdded added({
    {"view_state", "input.json",
     [](const fs::path& file, const std::string&) {
       const std::string text = playback::viewStateText(playback::readViewState(file));
       playback::parseViewState(text, "again.json");
     },
     views},
    {"series_json", "series.json", readSeries, [] { return seriesSeed("series.json"); }, writeSmallSeries},
    {"series_steps", "series.steps", readSeries, [] { return seriesSeed("series.steps"); }, writeSmallSeries},
});

}  // namespace
}  // namespace emscape::test

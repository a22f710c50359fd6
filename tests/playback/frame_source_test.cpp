#include "emscape/playback/frames/frame_source.h"

#include <algorithm>

#include "emscape/base/work.h"
#include "emscape/volume/format/file.h"
#include "playback/frames/range_search.h"
#include "playback/frames/volume_input.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::HasSubstr;

TEST(FrameSource, TheNearestIndexToATimeIsFoundBeyondTheEndsToo) {
  const MadeFrames source({0, 1, 1.5, 4});
  const std::vector<std::pair<double, int>> expected{{-7, 0},  {0, 0},   {0.4, 0}, {0.6, 1}, {1, 1}, {1.2, 1},
                                                     {1.3, 2}, {2.7, 2}, {2.8, 3}, {4, 3},   {99, 3}};
  for (const auto& [time_s, index] : expected) EXPECT_EQ(source.nearestIndex(time_s), index) << time_s;
  EXPECT_EQ(source.nearestIndex(0.5), 0) << "of two as near the earlier";
  EXPECT_EQ(MadeFrames({3}).nearestIndex(-1), 0);
}

TEST(FrameSource, ComputesAScenariosStepsWithOneRange) {
  const TemporaryFolder folder;
  FrameSelection selection;
  selection.input = quickScenario(folder, {{"[40, 40, 20]", "[8, 8, 6]"}});
  selection.times = "0:3:1";
  std::vector<double> fractions;
  const auto source = openFrameSource(
      selection, {}, [&](const std::string&, double fraction) { fractions.push_back(fraction); });
  EXPECT_THAT(fractions, testing::ElementsAre(0.25, 0.5, 0.75, 1));
  EXPECT_EQ(source->count(), 4);
  EXPECT_EQ(source->name(), "quick");
  ASSERT_NE(source->scene(), nullptr);
  const Frame first = source->frame(0), last = source->frame(3);
  EXPECT_EQ(first.markers.size(), 2U);
  EXPECT_TRUE(first.tracks.empty());
  ValueRange together;
  for (int step = 0; step < 4; ++step) {
    const Frame frame = source->frame(step);
    together.add({frame.info().range_min, frame.info().range_max});
    const auto values = frame.volume.host()->values;
    EXPECT_EQ(frame.info().range_max, *std::max_element(values.begin(), values.end())) << "its own";
  }
  EXPECT_EQ(first.color_range, together);
  EXPECT_EQ(last.color_range, together);
  EXPECT_EQ(last.volume.info().time_s, 3);
  EXPECT_FALSE(source->frame(3).changed);
}

TEST(FrameSource, AFieldWithATimeGoalIsCompletedWithoutIt) {
  FrameSelection selection;
  selection.input = emscape::test::shippedScenario("jacksboro.yaml");
  selection.edits = {{"region.dims", "[50, 50, 25]"}, {"emitters.jammer.propagation", "diffraction"}};
  selection.independent = true;
  const auto source = openFrameSource(selection, {}), fresh = openFrameSource(selection, {});
  const auto valuesOf = [](const Frame& frame) { return frame.volume.host()->values; };
  constexpr double kUnreachable_ms = 1e-3;
  source->setTimeGoal(kUnreachable_ms);
  EXPECT_EQ(source->frameAt(2).column_step, 1) << "the first field has all columns";
  EXPECT_GT(source->frameAt(60).column_step, 1);
  source->setTimeGoal(0);
  const Frame complete = source->frameAt(60);
  EXPECT_EQ(complete.column_step, 1);
  EXPECT_TRUE(complete.changed);
  EXPECT_EQ(valuesOf(complete), valuesOf(fresh->frameAt(60)));
}

TEST(FrameSource, MarkersAreEmittersAndPlatformsWithoutOne) {
  const TemporaryFolder folder;
  writeFile(folder / "late.csv", "t_s,latitude_deg,longitude_deg,height_msl_m\n3,52,5,900\n4,52,5.1,900\n");
  FrameSelection selection;
  selection.input = quickScenario(
      folder,
      {{"[40, 40, 20]", "[8, 8, 6]"},
       {"  - {name: mast, ",
        "  - {name: ship, sidc: \"10043000001201000000\", position: {latitude_deg: 52.03, longitude_deg: 5, "
        "height_msl_m: 20}}\n"
        "  - {name: hill, position: {latitude_deg: 52.03, longitude_deg: 5.01, height_agl_m: 2}}\n"
        "  - {name: late, track: {file: late.csv}}\n"
        "  - {name: mast, side: hostile, "},
       {"emitters:\n",
        "receivers: [{name: post, platform: hill, noise_figure_db: 5, center_frequency_hz: 3.0e9, "
        "bandwidth_hz: 1.0e6}]\nemitters:\n"}});
  const std::vector<render::Marker> markers = openFrameSource(selection, {})->frame(0).markers;
  ASSERT_EQ(markers.size(), 5U);
  EXPECT_EQ(markers[0].side, render::Affiliation::none);
  EXPECT_EQ(markers[0].detail, "radar 3 GHz");
  EXPECT_DOUBLE_EQ(markers[0].height_m.value(), 20);
  EXPECT_TRUE(markers[0].is_height_above_ground);
  EXPECT_EQ(markers[1].label, "transmitter");
  EXPECT_EQ(markers[1].side, render::Affiliation::hostile);
  EXPECT_EQ(markers[2].label, "ship");
  EXPECT_EQ(markers[2].side, render::Affiliation::neutral);
  EXPECT_EQ(markers[2].sidc, "10043000001201000000");
  EXPECT_EQ(markers[2].detail, "");
  EXPECT_NEAR(markers[2].height_m.value(), 20, 0.5);
  EXPECT_FALSE(markers[2].is_height_above_ground);
  EXPECT_EQ(markers[3].label, "hill");
  EXPECT_EQ(markers[3].kind, render::MarkerKind::receiver);
  EXPECT_TRUE(markers[3].is_shown);
  EXPECT_EQ(markers[4].label, "late");
  EXPECT_EQ(markers[4].kind, render::MarkerKind::platform);
  EXPECT_FALSE(markers[4].is_shown) << "before its track";
}

TEST(FrameSource, TracksPassThroughMarkersOfTheirEmitters) {
  const TemporaryFolder folder;
  writeFile(folder / "track.csv",
            "t_s,latitude_deg,longitude_deg,height_msl_m\n"
            "-10,52.0,4.9,900\n0,52.0,5.0,1000\n2,52.02,5.0,1200\n3,52.02,5.03,1200\n90,52.02,6,1200\n");
  FrameSelection selection;
  selection.input = quickScenario(
      folder, {{"[40, 40, 20]", "[8, 8, 6]"},
               {"{name: mast, position: {latitude_deg: 52.05, longitude_deg: 5.06, height_agl_m: 50}}",
                "{name: mast, track: {file: track.csv}}"}});
  const auto source = openFrameSource(selection, {});
  double before = -1;
  for (int step = 0; step < source->count(); ++step) {
    const Frame frame = source->frame(step);
    ASSERT_EQ(frame.tracks.size(), 1U);
    const render::Track& track = frame.tracks[0];
    EXPECT_EQ(track.kind, render::MarkerKind::transmitter);
    EXPECT_GT(track.travelled, before);
    before = track.travelled;
    const auto point = std::min(static_cast<std::size_t>(track.travelled), track.points_m.size() - 2);
    const Vec3d leg = track.points_m[point + 1] - track.points_m[point];
    const Vec3d here = track.points_m[point] + leg * (track.travelled - static_cast<double>(point));
    EXPECT_LT(length(here - frame.markers[1].position_m), 0.1) << step;
  }
  const Frame last = source->frame(source->count() - 1);
  EXPECT_EQ(last.tracks[0].travelled, static_cast<double>(last.tracks[0].points_m.size() - 1));
}

TEST(FrameSource, ReadsVolumesNearestToTheTimesThatAreAskedFor) {
  const TemporaryFolder folder;
  MadeFrames made(seconds(5));
  for (int i = 0; i < made.count(); ++i) {
    volume::writeVolumes(folder / ("v_000" + std::to_string(i + 1) + ".vdb"),
                         {made.frame(i).volume.host().get()});
  }
  FrameSelection selection;
  selection.input = folder.path().string();
  selection.times = "1.2:3.4:2";
  selection.range = ValueRange{-5, 5};
  const auto source = openFrameSource(selection, {});
  ASSERT_EQ(source->count(), 2);
  EXPECT_EQ(source->time_s(1), 3);
  EXPECT_EQ(source->frame(1).volume.host()->values.front(), 3.5F);
  EXPECT_EQ(source->frame(1).color_range->min, -5);
  EXPECT_EQ(source->frame(1).volume.info().range_min, 0) << "as the file states it";
}

TEST(FrameSource, StepWithoutTimeHasTimeOfTheList) {
  const TemporaryFolder folder;
  const std::string image =
      "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 1 0 1 0 1\" "
      "Origin=\"0 0 0\" Spacing=\"1 1 1\">TIME<Piece Extent=\"0 1 0 1 0 1\"><PointData>"
      "<DataArray Name=\"d\" type=\"Float32\" format=\"ascii\">N 1 1 1 1 1 1 1</DataArray>"
      "</PointData></Piece></ImageData></VTKFile>";
  const std::string mesh =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid>TIME"
      "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>"
      "<DataArray type=\"Float32\" Name=\"d\" format=\"ascii\">N 0 0 1</DataArray></PointData><Points>"
      "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1"
      "</DataArray></Points><Cells>"
      "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray>"
      "</Cells></Piece></UnstructuredGrid></VTKFile>";
  for (const std::string ending : {".vti", ".vtu"}) {
    std::string list;
    for (int step = 0; step < 4; ++step) {
      std::string text = ending == ".vti" ? image : mesh;
      // The last step's own time differs from the list's.
      const std::string time =
          step < 3 ? ""
                   : "<FieldData><DataArray Name=\"TimeValue\" type=\"Float64\" format=\"ascii\">35"
                     "</DataArray></FieldData>";
      text.replace(text.find("TIME"), 4, time);
      text.replace(text.find("N "), 1, std::to_string(step + 2));
      writeFile(folder / (std::to_string(step) + ending), text);
      list += "<DataSet timestep=\"" + std::to_string(10 * step) + "\" file=\"" + std::to_string(step) +
              ending + "\"/>";
    }
    writeFile(folder / "a.pvd",
              "<VTKFile type=\"Collection\"><Collection>" + list + "</Collection></VTKFile>");
    FrameSelection selection;
    selection.input = folder / "a.pvd";
    const auto source = openFrameSource(selection, {});
    ASSERT_EQ(source->count(), 4);
    EXPECT_EQ(source->time_s(1), 10);
    EXPECT_EQ(source->frame(2).info().time_s, 20);
    EXPECT_EQ(source->time_s(3), 35);
    selection.times = "21";
    const auto chosen = openFrameSource(selection, {});
    ASSERT_EQ(chosen->count(), 1);
    EXPECT_EQ(chosen->frame(0).info().range_max, 4);
  }
}

TEST(FrameSource, StepsOfVolumesAreChosenByTimesSince1970) {
  const TemporaryFolder folder;
  volume::DenseVolume volume = *MadeFrames(seconds(1)).frame(0).volume.host();
  for (const int step : {1, 2, 3}) {
    volume.info.time_s = 1780000000.0 + step;
    volume::writeVolumes(folder / ("plain_" + std::to_string(step) + ".vti"), {&volume});
  }
  FrameSelection selection;
  selection.input = folder.path();
  selection.times = "1780000002";
  const auto one = openFrameSource(selection, {});
  ASSERT_EQ(one->count(), 1);
  EXPECT_EQ(one->time_s(0), 1780000002);
  selection.times = "1780000001:1780000003:2";
  const auto range = openFrameSource(selection, {});
  ASSERT_EQ(range->count(), 2);
  EXPECT_EQ(range->time_s(1), 1780000003);
}

TEST(FrameSource, AQuantityThatAFolderLacksIsRefusedWithThoseThatItHas) {
  const TemporaryFolder folder;
  volume::DenseVolume volume = *MadeFrames(seconds(1)).frame(0).volume.host();
  for (const char* quantity : {"snr_db", "power_density_dbwm2"}) {
    volume.info.quantity = quantity;
    volume::writeVolumes(folder / (std::string(quantity) + "_0001.vti"), {&volume});
  }
  FrameSelection selection;
  selection.input = folder.path().string();
  selection.quantity = "emitter_count";
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {}); }),
              HasSubstr("there is no volume of 'emitter_count'; there are volumes of power_density_dbwm2, "
                        "snr_db"));
}

TEST(FrameSource, AFolderOfSeveralFormatsWarnsOfTheFilesThatAreNotShown) {
  const TemporaryFolder folder;
  const volume::DenseVolume volume = *MadeFrames(seconds(1)).frame(0).volume.host();
  FrameSelection selection;
  selection.input = folder.path().string();
  const auto warnings = [&] { return openFrameSource(selection, {})->warnings(); };
  volume::writeVolumes(folder / "a.vti", {&volume});
  volume::writeVolumes(folder / "a.raw", {&volume});
  EXPECT_TRUE(warnings().empty()) << "the same volume in two formats";
  volume::writeVolumes(folder / "b.raw", {&volume});
  EXPECT_THAT(warnings(), testing::ElementsAre(HasSubstr(
                              "the .vti files are shown; not shown: b.raw. Open such a file to see it")));
}

TEST(FrameSource, InvalidInputIsRefusedByName) {
  FrameSelection selection;
  selection.input = "/nowhere/there.vdb";
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {}); }), HasSubstr("/nowhere/there.vdb"));
  const TemporaryFolder folder;
  selection.input = quickScenario(folder);
  selection.quantity = "power_density_dbwm2:nobody";
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {}); }), HasSubstr("there is no such channel"));
}

TEST(RangeSearch, VisitsEveryStepOrAtMost24) {
  const auto stepsOf = [](int count) {
    std::vector<int> steps;
    RangeSearch search(count);
    volume::VolumeInfo info;
    while (const auto step = search.next()) {
      steps.push_back(*step);
      info.range_max = static_cast<float>(*step);
      search.add(info);
    }
    const ValueRange all = steps.empty() ? ValueRange() : ValueRange{0, static_cast<float>(steps.back())};
    EXPECT_EQ(search.range(), all);
    return steps;
  };
  EXPECT_TRUE(stepsOf(0).empty());
  EXPECT_THAT(stepsOf(3), testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(stepsOf(24).size(), 24U);
  EXPECT_THAT(stepsOf(25).back(), 24);
  EXPECT_EQ(stepsOf(25).size(), 13U);
}

TEST(VolumeFiles, AreListedByTimeAndChosenByTheNearest) {
  const TemporaryFolder folder;
  volume::DenseVolume volume = *MadeFrames(seconds(1)).frame(0).volume.host();
  for (const int n : {1, 2, 3}) {
    volume.info.time_s = 30 - 10 * n;  // the last file is the first step
    volume::writeVolumes(folder / ("v_000" + std::to_string(n) + ".vti"), {&volume});
  }
  std::string quantity;
  const std::vector<VolumeFile> files = volumeFilesOf(folder.path(), quantity);
  EXPECT_EQ(quantity, "made");
  const auto timesOf = [](const std::vector<VolumeFile>& of) {
    std::vector<double> times_s;
    for (const VolumeFile& file : of) times_s.push_back(file.time_s);
    return times_s;
  };
  EXPECT_THAT(timesOf(files), testing::ElementsAre(0, 10, 20));
  EXPECT_EQ(files.front().file.filename(), "v_0003.vti");
  EXPECT_THAT(timesOf(chosenFiles(files, "", false)), testing::ElementsAre(0, 10, 20));
  EXPECT_THAT(timesOf(chosenFiles(files, "", true)), testing::ElementsAre(0));
  EXPECT_THAT(timesOf(chosenFiles(files, "14", false)), testing::ElementsAre(10));
  EXPECT_THAT(timesOf(chosenFiles(files, "0:20", false)), testing::ElementsAre(0, 10, 20));
  EXPECT_THAT(timesOf(chosenFiles(files, "4:20:12", false)), testing::ElementsAre(0, 20));
  quantity = "snr_db";
  EXPECT_THAT(errorOf([&] { volumeFilesOf(folder.path(), quantity); }),
              HasSubstr("there are volumes of made"));
}

TEST(FrameSource, AStopFlagEndsTheSearchForTheRange) {
  const TemporaryFolder folder;
  const StopFlag stop{true};
  FrameSelection selection;
  selection.input = quickScenario(folder);
  EXPECT_THROW(openFrameSource(selection, {}, {}, &stop), Stopped);
}

}  // namespace
}  // namespace emscape::playback::test

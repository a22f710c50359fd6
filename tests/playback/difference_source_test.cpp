#include "playback/frames/difference_source.h"

#include <algorithm>

#include "tests/playback/playback_samples.h"
#include "volume/difference.h"

namespace emscape::playback::test {
namespace {

using testing::HasSubstr;

const std::vector<std::pair<std::string, std::string>> kSmall{{"[40, 40, 20]", "[8, 8, 6]"}};

/// Both emitters ten times as strong.
std::vector<scenario::Edit> tenfold() {
  return {{"emitters.radar.power_w", "100000"}, {"emitters.transmitter.power_w", "10000"}};
}

FrameSelection selectionOf(const std::string& input) {
  FrameSelection selection;
  selection.input = input;
  selection.times = "0:3:1";
  selection.compare = kOriginal;
  return selection;
}

std::unique_ptr<FrameSource> made(std::vector<double> times_s) {
  return std::make_unique<MadeFrames>(std::move(times_s));
}

TEST(DifferenceSource, EqualScenariosDifferByZero) {
  const TemporaryFolder folder;
  const auto source = openFrameSource(selectionOf(quickScenario(folder, kSmall)), {});
  for (int index = 0; index < source->count(); ++index) {
    const auto volume = source->frame(index).volume.host();
    EXPECT_EQ(volume->values, UnsetVector<float>(volume->values.size(), 0.0F)) << index;
  }
}

TEST(DifferenceSource, TenTimesThePowerIsTenDecibelsWhereBothHaveAField) {
  const TemporaryFolder folder;
  FrameSelection selection = selectionOf(quickScenario(folder, kSmall));
  FrameSelection plain = selection;
  plain.compare.clear();
  selection.edits = tenfold();
  const auto source = openFrameSource(selection, {});
  const auto before = openFrameSource(plain, {})->frame(1).volume.host();
  const auto volume = source->frame(1).volume.host();
  long long compared = 0;
  for (std::size_t i = 0; i < volume->values.size(); ++i) {
    if (before->values[i] <= before->info.floor) continue;
    EXPECT_NEAR(volume->values[i], 10, 1e-4);
    ++compared;
  }
  EXPECT_GT(compared, 100);
  EXPECT_EQ(volume->info.unit, "dB");
  EXPECT_EQ(volume->info.quantity, "power_density_difference_db");
  EXPECT_EQ(volume->info.time_s, 1);
  EXPECT_EQ(volume->info.extra.at(kDifferenceToKey), "the original scenario");
}

TEST(DifferenceSource, AnEditDoesNotComputeTheReferenceAgain) {
  int opened = 0;
  const MadeFrames* reference = nullptr;
  DifferenceSource source(
      made({0, 1, 2}),
      [&] {
        ++opened;
        auto frames = std::make_unique<MadeFrames>(std::vector<double>{0, 1, 2});
        reference = frames.get();
        return frames;
      },
      {"the other"}, Comparison::none);
  source.frame(0);
  EXPECT_EQ(opened, 0) << "nothing is compared yet";
  source.setComparison(Comparison::difference);
  EXPECT_EQ(source.frame(1).volume.host()->values, UnsetVector<float>(MadeFrames::kVoxels, 0.0F));
  source.frame(1);
  source.setComparison(Comparison::none);
  EXPECT_EQ(source.frame(1).volume.info().quantity, "made");
  source.setComparison(Comparison::difference);
  source.frame(1);
  EXPECT_EQ(opened, 1);
  EXPECT_EQ(reference->asked(), std::vector<int>{1});
}

TEST(DifferenceSource, BesideAFieldIsTheReferenceAtItsTime) {
  const TemporaryFolder folder;
  FrameSelection selection = selectionOf(quickScenario(folder, kSmall));
  FrameSelection original = selection, changed = selection;
  original.compare.clear();
  selection.edits = changed.edits = tenfold();
  changed.compare.clear();
  selection.split = 0.5;
  const Frame frame = openFrameSource(selection, {})->frame(2);
  ASSERT_TRUE(frame.beside);
  const Frame& beside = *frame.beside->frame;
  EXPECT_EQ(frame.volume.host()->values, openFrameSource(changed, {})->frame(2).volume.host()->values);
  EXPECT_EQ(beside.volume.host()->values, openFrameSource(original, {})->frame(2).volume.host()->values);
  EXPECT_EQ(beside.info().time_s, frame.info().time_s);
  EXPECT_EQ(beside.markers.size(), frame.markers.size());
  EXPECT_EQ(frame.beside->caption, "the original scenario");
  EXPECT_EQ(frame.beside->own_caption, "with the changes");
}

TEST(DifferenceSource, FieldsOnDifferentGridsAreNotSideBySide) {
  const TemporaryFolder folder, other;
  FrameSelection selection = selectionOf(quickScenario(folder, kSmall));
  selection.compare = quickScenario(other, {{"[40, 40, 20]", "[9, 8, 6]"}});
  selection.split = 0.5;
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {})->frame(0); }), HasSubstr("another grid"));
}

TEST(DifferenceSource, TheReferenceMustHaveTheSameSteps) {
  DifferenceSource source(
      made({0, 1.25}),
      [] {
        return made({0, 1, 2});
      },
      {"the other"}, Comparison::difference);
  EXPECT_NO_THROW(source.frame(0));
  EXPECT_EQ(errorOf([&] { source.frame(1); }),
            "the other has no step at 1.25 s to compare with; the nearest is at 1 s");
}

TEST(DifferenceSource, FieldOnTetrahedraIsRefusedOnEitherSide) {
  const TemporaryFolder folder;
  FrameSelection mesh = selectionOf(quickScenario(folder, kSmall));
  mesh.compare.clear();
  mesh.mesh = "terrain:4";
  mesh.independent = true;
  const auto open = [&] { return openFrameSource(mesh, {}); };
  DifferenceSource of_mesh(
      open(),
      [] {
        return made({0, 1, 2, 3});
      },
      {"the other"}, Comparison::difference);
  EXPECT_THAT(errorOf([&] { of_mesh.frame(0); }), HasSubstr("fields on tetrahedra are not compared"));
  DifferenceSource to_mesh(made({0, 1, 2, 3}), open, {"the mesh"}, Comparison::difference);
  EXPECT_THAT(errorOf([&] { to_mesh.frame(0); }), HasSubstr("fields on tetrahedra are not compared"));
}

TEST(DifferenceSource, WarningsOfTheReferenceNameIt) {
  const TemporaryFolder folder;
  const LoadedScenario input =
      loadScenarioWithTerrain(quickScenario(folder, {{"[40, 40, 20]", "[8, 8, 6]"}}));
  FieldSeries series(input, seconds(2), {});
  series.compareWith(input, "the other");
  series.rehearse();
  const std::vector<std::string> warnings = series.warnings();
  ASSERT_EQ(warnings.size() % 2, 0U);
  for (std::size_t w = 0; w < warnings.size() / 2; ++w)
    EXPECT_EQ(warnings[warnings.size() / 2 + w], "the other: " + warnings[w]);
}

TEST(DifferenceSource, IndicesAreRefused) {
  const TemporaryFolder folder;
  FrameSelection selection = selectionOf(quickScenario(folder, kSmall));
  selection.quantity = "dominant_emitter";
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {})->frame(0); }),
              HasSubstr("dominant_emitter: indices have no difference"));
}

TEST(DifferenceSource, VolumesHaveNoOriginal) {
  const TemporaryFolder folder;
  FrameSelection selection;
  selection.input = folder.path().string();
  selection.compare = kOriginal;
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {}); }),
              HasSubstr("volumes have no original to compare with"));
}

TEST(DifferenceSource, ASeriesOfDifferencesHasOneRangeAndTheirNames) {
  const TemporaryFolder folder;
  const std::string file = quickScenario(folder, kSmall);
  const LoadedScenario original = loadScenarioWithTerrain(file);
  FieldSeries series(loadScenarioWithTerrain(file, tenfold()), seconds(3), {});
  series.compareWith(original, "the original scenario");
  ASSERT_EQ(series.channels().size(), 1U);
  EXPECT_EQ(series.channels().front().name, "power_density_difference_db");
  const auto volume = series.compute(2).front().host();
  EXPECT_EQ(volume->info.quantity, "power_density_difference_db");
  EXPECT_EQ(volume->info.time_s, 2);
  EXPECT_NEAR(*std::max_element(volume->values.begin(), volume->values.end()), 10, 1e-3);
  emfield::FieldOptions indices;
  indices.quantities = {"dominant_emitter"};
  FieldSeries of_indices(original, seconds(3), indices);
  EXPECT_THAT(errorOf([&] { of_indices.compareWith(original, "x"); }),
              HasSubstr("indices have no difference"));
}

}  // namespace
}  // namespace emscape::playback::test

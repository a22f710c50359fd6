#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

class SessionTransfer : public SessionTest {
 protected:
  std::string file(const std::string& name) const { return folder_ / name; }
  std::string text() const { return render::transferFunctionText(session->transfer()->function()); }
  std::size_t points() const { return session->transfer()->function().opacities.size(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(SessionTransfer, PointsAreAddedMovedAndRemovedInThePicture) {
  const std::size_t before = points();
  const double middle =
      0.5 * (session->transfer()->function().lowest() + session->transfer()->function().highest());
  session->perform({"opacity_point", {{"value", middle}, {"opacity", 0.2}}});
  EXPECT_EQ(points(), before + 1);
  EXPECT_EQ(session->report()["selected_value"], middle);
  const int index = session->report()["selected_point"];
  session->perform({"opacity_point", {{"index", index}, {"opacity", 0.9}}});
  settle();
  EXPECT_EQ(render::TransferFunction(session->picture()->transfer).opacity(middle), 0.9);
  session->perform({"remove_point", {{"index", index}}});
  settle();
  EXPECT_EQ(session->picture()->transfer.opacities.size(), before);
}

TEST_F(SessionTransfer, ErrorsOfVerbsNameTheExpectedArguments) {
  perform(R"({"do":"opacity_point","value":-60})");
  EXPECT_THAT(error(), HasSubstr("expected value and opacity of a new point, or the index of one"));
  perform(R"({"do":"opacity_point","value":-60,"opacity":1.5})");
  EXPECT_THAT(error(), HasSubstr("opacity 1.5: expected a number 0..1"));
  perform(R"({"do":"opacity_point","index":99,"opacity":0.5})");
  EXPECT_THAT(error(), HasSubstr("opacity_point: index 99: there are the points 0.."));
  perform(R"({"do":"range","min":5,"max":-5})");
  EXPECT_THAT(error(), HasSubstr("range 5..-5: expected min below max"));
  perform(R"({"do":"transfer"})");
  EXPECT_THAT(error(), HasSubstr("transfer: expected either colors or file"));
  perform(R"({"do":"transfer","colors":"jet"})");
  EXPECT_THAT(error(), HasSubstr("unknown colour map 'jet'"));
  perform(R"({"do":"opacity_preset","name":"hill"})");
  EXPECT_THAT(error(), HasSubstr("opacity_preset: name 'hill': expected ramp"));
  perform(R"({"do":"opacity","factor":0})");
  EXPECT_THAT(error(), HasSubstr("opacity: factor 0: expected a number 0.001..1000"));
  session->perform({"transfer", {{"file", file("none.json")}}});
  waitUntil([this] { return error().find("none.json") != std::string::npos; });
  EXPECT_FALSE(session->canUndo()) << "nothing was changed";
}

TEST_F(SessionTransfer, UndoTakesTheLatestChangeOfEitherKind) {
  const std::string fitted = text();
  perform(R"({"do":"transfer","colors":"cividis"})");
  perform(R"({"do":"set","path":"emitters.radar.power_w","value":"5"})");
  perform(R"({"do":"opacity","factor":0.5})");
  const std::string last = text();
  EXPECT_EQ(session->scenario()->edits().size(), 1U);
  perform(R"({"do":"undo"})");
  EXPECT_NE(text(), last);
  EXPECT_EQ(session->scenario()->edits().size(), 1U);
  perform(R"({"do":"undo"})");
  EXPECT_EQ(session->scenario()->edits().size(), 0U);
  EXPECT_EQ(session->transfer()->colorMap(), "cividis");
  perform(R"({"do":"undo"})");
  EXPECT_EQ(text(), fitted);
  EXPECT_FALSE(session->canUndo());
  for (int n = 0; n < 3; ++n) perform(R"({"do":"redo"})");
  EXPECT_EQ(text(), last);
  EXPECT_EQ(session->scenario()->edits().size(), 1U);
  EXPECT_FALSE(session->canRedo());
  settle();
  EXPECT_EQ(render::transferFunctionText(session->picture()->transfer), last);
}

TEST_F(SessionTransfer, ADragIsOneStep) {
  const std::string before = text();
  for (int n = 0; n < 20; ++n) {
    session->dragTransfer([n](playback::TransferEditor& editor) {
      editor.select(1);
      editor.moveSelected(editor.function().opacities[1].at, 0.01 * n);
    });
  }
  EXPECT_TRUE(session->canUndo());
  session->endDrag();
  perform(R"({"do":"undo"})");
  EXPECT_EQ(text(), before);
  EXPECT_FALSE(session->canUndo());
}

TEST_F(SessionTransfer, FittingStretchesColoursAndOpacitiesTogether) {
  perform(R"({"do":"transfer","colors":"inferno"})");
  const double lowest = session->transfer()->function().lowest();
  perform(R"({"do":"range","min":-300,"max":100})");
  settle();
  EXPECT_EQ(session->report()["range_min"], -300);
  perform(R"({"do":"fit_step"})");
  settle();
  EXPECT_DOUBLE_EQ(session->transfer()->function().lowest(), lowest) << "that of the start";
  EXPECT_EQ(session->transfer()->colorMap(), "inferno");
  const std::size_t before = points();
  perform(R"({"do":"fit_series"})");
  settle();
  ASSERT_TRUE(session->status().series_range);
  EXPECT_EQ(session->report()["range_min"], session->status().series_range->min);
  EXPECT_EQ(session->report()["range_max"], session->status().series_range->max);
  EXPECT_EQ(points(), before);
  perform(R"({"do":"seek","time_s":3})");
  settle();
  EXPECT_EQ(session->report()["range_max"], session->status().series_range->max) << "stays over the series";
  perform(R"({"do":"undo"})");
  EXPECT_DOUBLE_EQ(session->transfer()->function().lowest(), lowest);
}

TEST_F(SessionTransfer, FilesContainShownFunction) {
  perform(R"({"do":"opacity_preset","name":"bands"})");
  perform(R"({"do":"transfer","colors":"cividis"})");
  const std::string saved = text();
  session->perform({"save_transfer", {{"file", file("a.json")}}});
  settle();
  EXPECT_EQ(readFile(file("a.json")), saved);
  perform(R"({"do":"reset_transfer"})");
  settle();
  EXPECT_EQ(session->transfer()->colorMap(), "viridis");
  session->perform({"transfer", {{"file", file("a.json")}}});
  settle();
  EXPECT_EQ(render::transferFunctionText(session->picture()->transfer), saved);
  session->perform({"save_transfer", {{"file", file("none/a.json")}}});
  waitUntil([this] { return error().find("none/a.json") != std::string::npos; });
}

TEST_F(SessionTransfer, HistogramIsOfVolumeOnScreen) {
  EXPECT_EQ(session->values(), nullptr) << "nobody looks";
  session->panels.colors = true;
  settle();
  ASSERT_NE(session->values(), nullptr);
  long long counted = 0;
  for (const long long count : session->values()->histogram.counts) counted += count;
  EXPECT_GT(counted, 0);
  const ValueSummary* before = session->values();
  perform(R"({"do":"transfer","colors":"cividis"})");
  settle();
  EXPECT_EQ(session->values(), before) << "counted once";
  perform(R"({"do":"seek","time_s":2})");
  settle();
  EXPECT_TRUE(sameValues(session->values()->field, *session->picture()));
}

TEST_F(SessionTransfer, AnotherQuantityHasColoursOfItsOwn) {
  perform(R"({"do":"transfer","colors":"cividis"})");
  perform(R"({"do":"quantity","name":"field_strength_dbuvm"})");
  settle();
  EXPECT_EQ(session->transfer()->function().unit, session->picture()->info().unit);
  EXPECT_EQ(session->transfer()->colorMap(), "viridis");
  EXPECT_FALSE(session->canUndo());
  perform(R"({"do":"quantity","name":"dominant_emitter"})");
  settle();
  EXPECT_EQ(session->transfer(), nullptr);
  perform(R"({"do":"opacity","factor":0.5})");
  EXPECT_THAT(error(), HasSubstr("categories have their own colours"));
  perform(R"({"do":"quantity","name":"power_density_dbwm2"})");
  settle();
  EXPECT_EQ(session->transfer()->colorMap(), "cividis") << "as it was left";
}

}  // namespace
}  // namespace emscape::view::test

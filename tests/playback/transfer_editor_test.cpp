#include "playback/editing/transfer_editor.h"

#include <random>

#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

render::TransferFunction ramp() {
  render::TransferFunction function;
  function.unit = "dB";
  function.colors = {{-100, {0, 0, 0}}, {0, {1, 1, 1}}};
  function.opacities = {{-100, 0}, {-50, 0.01}, {0, 0.5}};
  return function;
}

TEST(OpacityAxis, IsLogarithmicWithZeroAtTheBottom) {
  const OpacityAxis axis;
  EXPECT_EQ(axis.position(0), 0);
  EXPECT_EQ(axis.opacity(0), 0);
  EXPECT_EQ(axis.opacity(0.04), 0);
  EXPECT_NEAR(axis.position(1), 1, 1e-12);
  EXPECT_NEAR(axis.opacity(1), 1, 1e-12);
  EXPECT_NEAR(axis.position(OpacityAxis::kMinOpacity), OpacityAxis::kZeroPart, 1e-12);
  // Equal ratios are equal lengths.
  EXPECT_NEAR(axis.position(0.1) - axis.position(0.01), axis.position(0.01) - axis.position(0.001), 1e-12);
  for (double opacity = 1e-4; opacity <= 1; opacity *= 1.1) {
    EXPECT_NEAR(axis.opacity(axis.position(opacity)) / opacity, 1, 1e-9);
  }
  OpacityAxis linear;
  linear.logarithmic = false;
  EXPECT_EQ(linear.position(0.3), 0.3);
  EXPECT_EQ(linear.opacity(7), 1);
}

TEST(TransferEditor, AddsMovesAndDeletesPoints) {
  TransferEditor editor(ramp());
  EXPECT_EQ(editor.add(-20, 0.2), 2);
  EXPECT_EQ(editor.selected(), 2);
  editor.moveSelected(-30, 0.3);
  EXPECT_EQ(editor.function().opacities[2].at, -30);
  EXPECT_EQ(editor.function().opacities[2].opacity, 0.3);
  editor.moveSelected(-80, 7);  // not beyond its neighbour, nor above 1
  EXPECT_EQ(editor.function().opacities[2].at, -50);
  EXPECT_EQ(editor.function().opacities[2].opacity, 1);
  editor.moveSelected(10, -1);
  EXPECT_EQ(editor.function().opacities[2].at, 0);
  EXPECT_EQ(editor.function().opacities[2].opacity, 0);
  editor.removeSelected();
  EXPECT_EQ(editor.function().opacities.size(), 3u);
  EXPECT_EQ(editor.selected(), 2);
  editor.removeSelected();
  editor.removeSelected();  // two stay
  EXPECT_EQ(editor.function().opacities.size(), 2u);
  editor.select(std::nullopt);
  editor.moveSelected(0, 0);
  editor.removeSelected();
  EXPECT_EQ(editor.function().opacities.size(), 2u);
  editor.select(99);
  EXPECT_FALSE(editor.selected());
}

TEST(TransferEditor, FindsThePointUnderTheCursor) {
  TransferEditor editor(ramp());
  editor.axis.logarithmic = false;
  const double scale = 0.01;  // the interval is as wide as the axis is high
  EXPECT_EQ(editor.pointNear(-51, 0.02, scale, 0.05), 1);
  EXPECT_EQ(editor.pointNear(-1, 0.49, scale, 0.05), 2);
  EXPECT_FALSE(editor.pointNear(-70, 0.5, scale, 0.05));
}

TEST(TransferEditor, FitsColoursAndOpacitiesTogether) {
  TransferEditor editor(ramp());
  editor.fit({-120, -20});
  EXPECT_EQ(editor.function().lowest(), -120);
  EXPECT_EQ(editor.function().highest(), -20);
  EXPECT_DOUBLE_EQ(editor.function().opacities[1].at, -70);
  EXPECT_EQ(editor.function().colors.back().at, -20);
  editor.setHighest(30);
  EXPECT_EQ(editor.function().lowest(), -120);
  EXPECT_EQ(editor.function().highest(), 30);
  editor.setLowest(40);  // no interval
  EXPECT_EQ(editor.function().lowest(), -120);
  editor.fit({});
  EXPECT_EQ(editor.function().highest(), 30);
}

TEST(TransferEditor, PresetsAreColourMapsOverTheInterval) {
  TransferEditor editor(ramp());
  EXPECT_EQ(TransferEditor::presets(), render::colorMapNames());
  for (const std::string& name : TransferEditor::presets()) {
    editor.setColorMap(name);
    EXPECT_EQ(editor.function().colors.front().at, -100);
    EXPECT_EQ(editor.function().colors.back().at, 0);
    EXPECT_EQ(editor.function().opacities.size(), 3u);
  }
  EXPECT_THAT(errorOf([&] { editor.setColorMap("jet"); }), testing::HasSubstr("unknown colour map 'jet'"));
}

TEST(TransferEditor, UndoRestoresEveryFunctionAndDragIsOneStep) {
  TransferEditor editor(ramp());
  std::vector<std::string> texts{transferFunctionText(editor.function())};
  std::mt19937 random(4);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  while (texts.size() <= 60) {
    editor.select(static_cast<int>(random() % editor.function().opacities.size()));
    switch (random() % 5) {
      case 0:
        editor.add(uniform(-120, 20), uniform(0, 1));
        break;
      case 1:
        editor.removeSelected();
        break;
      case 2:
        editor.setColorMap(render::colorMapNames()[random() % 4]);
        break;
      case 3:
        editor.fit({static_cast<float>(uniform(-200, -100)), static_cast<float>(uniform(-50, 0))});
        break;
      default:
        editor.beginDrag();
        for (int i = 0; i < 10; ++i) editor.moveSelected(uniform(-120, 20), uniform(0, 1));
        editor.endDrag();
    }
    EXPECT_GT(editor.function().highest(), editor.function().lowest());
    std::string text = transferFunctionText(editor.function());
    if (text != texts.back()) texts.push_back(std::move(text));
  }
  for (std::size_t step = texts.size() - 1; step-- > 0;) {
    ASSERT_TRUE(editor.canUndo());
    editor.undo();
    ASSERT_EQ(transferFunctionText(editor.function()), texts[step]);
  }
  EXPECT_FALSE(editor.canUndo());
  for (std::size_t step = 1; step < texts.size(); ++step) {
    editor.redo();
    ASSERT_EQ(transferFunctionText(editor.function()), texts[step]);
  }
  EXPECT_FALSE(editor.canRedo());
}

TEST(TransferEditor, UnchangedFunctionIsNoUndoStep) {
  TransferEditor editor(ramp());
  editor.setFunction(ramp());
  editor.fit({-100, 0});
  editor.select(1);
  editor.moveSelected(-50, 0.01);
  editor.beginDrag();
  editor.moveSelected(-40, 0.5);
  editor.moveSelected(-50, 0.01);
  editor.endDrag();
  EXPECT_FALSE(editor.canUndo());
}

TEST(TransferEditor, PointsStayWithinTheInterval) {
  TransferEditor editor(ramp());
  EXPECT_EQ(editor.function().opacities[static_cast<std::size_t>(editor.add(50, 0.2))].at, 0);
  editor.select(0);
  editor.moveSelected(-200, 0);
  EXPECT_EQ(editor.function().lowest(), -100) << "the ends have handles of their own";
}

TEST(TransferEditor, DragOfAnEndKeepsAllPoints) {
  TransferEditor editor(ramp());
  editor.setColorMap("viridis");
  const std::string before = transferFunctionText(editor.function());
  editor.beginDrag();
  editor.setLowest(std::nextafter(0.0, -1.0));  // all colours in one value
  editor.setLowest(-80);
  EXPECT_EQ(editor.function().colors.size(), render::colorMap("viridis").points.size());
  EXPECT_EQ(editor.colorMap(), "viridis");
  editor.setLowest(-100);
  editor.endDrag();
  EXPECT_EQ(transferFunctionText(editor.function()), before);
}

TEST(TransferEditor, OpacitiesAreScaledAndStayBelowOne) {
  TransferEditor editor(ramp());
  editor.scaleOpacities(3);
  EXPECT_DOUBLE_EQ(editor.function().opacities[1].opacity, 0.03);
  EXPECT_EQ(editor.function().opacities[2].opacity, 1);
  EXPECT_EQ(editor.stepsMade(), 1);
  EXPECT_EQ(editor.changes(), 1);
  editor.undo();
  EXPECT_EQ(editor.changes(), 2);
  editor.undo();
  EXPECT_EQ(editor.changes(), 2) << "there was nothing to undo";
}

TEST(TransferEditor, OpacityPresetsCoverTheInterval) {
  for (const OpacityPreset& preset : opacityPresets()) {
    for (const double at : {-1e9, -100.0, -37.0, 0.0}) {
      TransferEditor editor(ramp());
      editor.setOpacityPreset(preset.name, at);
      EXPECT_EQ(editor.function().lowest(), -100) << preset.name;
      EXPECT_EQ(editor.function().highest(), 0) << preset.name;
      // What the format asks of a function: it can be read back.
      volume::VolumeInfo info;
      info.unit = "dB";
      EXPECT_NO_THROW(render::parseTransferFunction(transferFunctionText(editor.function()), "a.json", info));
    }
  }
  TransferEditor editor(ramp());
  editor.setOpacityPreset("threshold", -40);
  EXPECT_EQ(editor.function().opacity(-41), 0);
  EXPECT_EQ(editor.function().opacity(-39), 0.05);
  EXPECT_THAT(errorOf([&] { editor.setOpacityPreset("hill"); }),
              testing::HasSubstr("unknown opacity preset 'hill': expected ramp, late ramp, threshold"));
}

TEST(TransferEditor, CategoriesAreRefused) {
  render::TransferFunction function = ramp();
  function.categorical = true;
  EXPECT_THAT(errorOf([&] { TransferEditor editor(function); }),
              testing::HasSubstr("categories have their own colours"));
}

}  // namespace
}  // namespace emscape::playback::test

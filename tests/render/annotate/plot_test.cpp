#include "render/annotate/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/stopping.h"
#include "tests/support/temporary_folder.h"

namespace emscape::render {
namespace {

TEST(Plot, TextsAreMadeToFit) {
  const Canvas canvas({100, 100});
  const std::string text = "a title of some length";
  const double width = canvas.textBox(text, 20, Weight::bold).width;
  EXPECT_EQ(fittedSize_px(canvas, text, 20, width + 1, Weight::bold), 20);
  const double smaller_px = fittedSize_px(canvas, text, 20, 0.6 * width, Weight::bold);
  EXPECT_NEAR(smaller_px, 12, 0.1);
  EXPECT_LE(canvas.textBox(text, smaller_px, Weight::bold).width, 0.62 * width);
}

TEST(Plot, IsStoppedBetweenItsParts) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "plot.png";
  const auto draw = [&] {
    drawPlot({4000, 3000}, file, [](Canvas& canvas) {
      for (int n = 0; n < 2000; ++n) canvas.rectangle({0, 0, 4000, 3000}, kPlotGrid);
    });
  };
  test::expectStopsWithinASecond(draw, 100);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Plot, TextsAreShortenedByWholeCharacters) {
  const Canvas canvas({100, 100});
  const std::string text = "Überhorizontradar";
  const auto widthOf = [&](const std::string& some) { return canvas.textBox(some, 20).width; };
  EXPECT_EQ(shortenedText(canvas, text, 20, widthOf(text)), text);
  EXPECT_EQ(shortenedText(canvas, text, 20, widthOf("Über…")), "Über…");
  EXPECT_EQ(shortenedText(canvas, text, 20, widthOf("Ü…") - 1), "…");
  EXPECT_EQ(shortenedText(canvas, text, 20, -5), "…");
  EXPECT_EQ(shortenedText(canvas, "", 20, 0), "");
  EXPECT_EQ(shortenedText(canvas, "", 20, -5), "");
}

TEST(Plot, LinesOfATextAreNoWiderThanTheirRoom) {
  const Canvas canvas({100, 100});
  const std::string text =
      "Clear: the nearest ground is far below the ray and the path is as good as free space.";
  std::string joined;
  const std::vector<std::string> lines = wrappedText(canvas, text, 200, 16);
  EXPECT_GT(lines.size(), 2u);
  for (const std::string& line : lines) {
    EXPECT_LE(canvas.textBox(line, 16).width, 200) << line;
    joined += (joined.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(joined, text);
  EXPECT_EQ(wrappedText(canvas, text, 1e4, 16), std::vector<std::string>{text});
}

/// Whether anything is drawn in a rectangle.
bool isDrawn(const Image8& image, const Rect& area) {
  const std::uint8_t* const paper = image.at(0, 0);
  for (int y = static_cast<int>(area.y); y < static_cast<int>(area.y + area.height); ++y) {
    for (int x = static_cast<int>(area.x); x < static_cast<int>(area.x + area.width); ++x) {
      if (!std::equal(paper, paper + 3, image.at(x, y))) return true;
    }
  }
  return false;
}

TEST(Plot, DashesDoNotDependOnTheNumberOfPoints) {
  const auto inkOf = [](int points) {
    Canvas canvas({600, 100});
    canvas.rectangle({0, 0, 600, 100}, kPlotPaper);
    PlotPanel panel(canvas, {0, 0, 600, 100}, 1, {0, 1, 4, ""}, {0, 1, 4, ""});
    PlotLine line{"", {}, plotInk(0)};
    for (int i = 0; i < points; ++i) line.points.push_back({i / (points - 1.0), 0.5, true});
    line.is_dashed = true;
    panel.drawLine(line);
    const Image8 image = canvas.pixels();
    int drawn = 0;
    for (int x = 0; x < 600; ++x) drawn += isDrawn(image, {static_cast<double>(x), 45, 1, 10}) ? 1 : 0;
    return drawn;
  };
  EXPECT_LT(inkOf(2), 500);
  EXPECT_NEAR(inkOf(1000), inkOf(2), 10);
}

TEST(Plot, PointsWithoutANeighbourAreDrawn) {
  for (const bool is_dashed : {false, true}) {
    Canvas canvas({600, 100});
    canvas.rectangle({0, 0, 600, 100}, kPlotPaper);
    PlotPanel panel(canvas, {0, 0, 600, 100}, 1, {0, 1, 4, ""}, {0, 1, 4, ""});
    PlotLine line{"", {{0.25, NAN, false}, {0.5, 0.5, false}, {0.75, NAN, false}}, plotInk(0)};
    line.is_dashed = is_dashed;
    panel.drawLine(line);
    const Image8 image = canvas.pixels();
    EXPECT_TRUE(isDrawn(image, {298, 45, 4, 10}));
    EXPECT_FALSE(isDrawn(image, {100, 0, 100, 100}));
  }
}

TEST(Plot, NamesStayBesideTheirFrame) {
  for (const std::size_t count : {3, 8, 9, 40}) {
    Canvas canvas({600, 600});
    canvas.rectangle({0, 0, 600, 600}, kPlotPaper);
    PlotPanel panel(canvas, {20, 20, 200, 160}, 1, {0, 1, 4, ""}, {0, 1, 4, ""});
    std::vector<PlotLine> lines;
    for (std::size_t i = 0; i < count; ++i) lines.push_back({"line " + std::to_string(i), {}, plotInk(i)});
    panel.drawNames(lines);
    const Image8 image = canvas.pixels();
    EXPECT_TRUE(isDrawn(image, {230, 20, 300, 20}));
    EXPECT_EQ(isDrawn(image, {230, 170, 300, 40}), count > 7) << count;
    EXPECT_FALSE(isDrawn(image, {230, 212, 300, 380})) << count;
  }
}

}  // namespace
}  // namespace emscape::render

#include "render/annotate/canvas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace emscape::render {
namespace {

// DejaVu Sans, which is always installed, has the scripts of these tests.
constexpr double kSize = 30;

double widthOf(const std::string& text) {
  return Canvas({1, 1}).textBox(text, kSize).width;
}

Image8 drawn(const std::string& text, Align align = Align::left) {
  Canvas canvas({200, 60});
  canvas.text(text, {align == Align::left ? 10.0 : 190.0, 30}, kSize, {{1, 1, 1}}, align);
  return canvas.pixels();
}

bool areSame(const Image8& a, const Image8& b, int left, int right) {
  for (int y = 0; y < a.size.height; ++y) {
    if (!std::equal(a.at(left, y), a.at(right - 1, y) + 4, b.at(left, y))) return false;
  }
  return true;
}

TEST(CanvasText, ArabicLettersAreJoined) {
  double separate = 0;
  for (const char* letter : {"س", "ل", "س", "ل"}) separate += widthOf(letter);
  EXPECT_LT(widthOf("سلسل"), 0.9 * separate);
}

TEST(CanvasText, HebrewBeginsAtTheRight) {
  const Image8 word = drawn("אבגד", Align::right), letter = drawn("א", Align::right);
  const int left = 190 - static_cast<int>(widthOf("א"));
  EXPECT_TRUE(areSame(word, letter, left + 1, 190));
  EXPECT_FALSE(areSame(word, letter, 60, left));
}

TEST(CanvasText, ALetterThatNoFontHasIsABox) {
  const std::string unassigned = "\u0378";
  EXPECT_GT(widthOf(unassigned), 0.3 * kSize);
  EXPECT_FALSE(areSame(drawn(unassigned), drawn(""), 0, 200));
  EXPECT_FALSE(areSame(drawn(unassigned), drawn("?"), 0, 200));
}

TEST(CanvasText, BytesThatAreNotUtf8AreReplaced) {
  EXPECT_EQ(widthOf("a\xff"), widthOf("a\uFFFD"));
}

TEST(CanvasText, ShorterTextsEndInAnEllipsis) {
  const Canvas canvas({1, 1});
  const std::string text = "Мачта на высоком холме", shorter = shortenedText(canvas, text, kSize, 150);
  EXPECT_EQ(shorter.substr(shorter.size() - 3), "…");
  EXPECT_EQ(text.compare(0, shorter.size() - 3, shorter, 0, shorter.size() - 3), 0);
  EXPECT_LE(widthOf(shorter), 150);
}

}  // namespace
}  // namespace emscape::render

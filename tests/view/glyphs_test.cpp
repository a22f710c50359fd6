#include "apps/view/widgets/glyphs.h"

#include <gtest/gtest.h>

#include <numeric>

namespace emscape::view {
namespace {

TEST(Glyphs, TextsOfTheFontAreUnchanged) {
  Glyphs glyphs;
  for (const char* text : {"search radar", "Мачта на холме", "Łódź, Şırnak, Đà Nẵng", "±3 dBW/m²"}) {
    EXPECT_EQ(glyphs.drawable(text), text);
  }
  EXPECT_FALSE(glyphs.hasNew());
}

TEST(Glyphs, HanCharactersAreAddedOnce) {
  Glyphs glyphs;
  EXPECT_EQ(glyphs.drawable("雷达站"), "雷达站");
  EXPECT_TRUE(glyphs.hasNew());
  ImFontAtlas atlas;
  glyphs.addTo(atlas, atlas.AddFontDefault(), 14);
  EXPECT_FALSE(glyphs.hasNew());
  EXPECT_EQ(glyphs.drawable("达雷"), "达雷");
  EXPECT_FALSE(glyphs.hasNew());
}

TEST(Glyphs, WordsThatAreShapedAreOneGlyph) {
  Glyphs glyphs;
  const std::string hindi = glyphs.drawable("रडार 2");
  EXPECT_EQ(hindi.size(), 3U + 2U) << "one character for private use";
  EXPECT_EQ(hindi.substr(3), " 2");
  EXPECT_EQ(glyphs.drawable("mast रडार").substr(5), hindi.substr(0, 3)) << "the same word";
  EXPECT_EQ(glyphs.drawable("mast محطة الرادار!").size(), 5U + 3U + 1U)
      << "words from right to left in their order";
  EXPECT_EQ(glyphs.drawable("محطة 7").size(), 3U) << "a text from right to left";
}

TEST(Glyphs, BytesThatAreNotUtf8AreKept) {
  Glyphs glyphs;
  EXPECT_EQ(glyphs.drawable("a\xff\x80"), "a\xff\x80");
}

TEST(Glyphs, AreDrawnIntoTheAtlas) {
  Glyphs glyphs;
  const std::string arabic = glyphs.drawable("رادار");  // DejaVu Sans has Arabic
  ImFontAtlas atlas;
  ImFont* const font = atlas.AddFontDefault();
  glyphs.addTo(atlas, font, 14);
  ASSERT_TRUE(atlas.Build());
  glyphs.drawInto(atlas);
  const auto id =
      static_cast<ImWchar>((arabic[0] & 0xF) << 12 | (arabic[1] & 0x3F) << 6 | (arabic[2] & 0x3F));
  const ImFontGlyph* const glyph = font->FindGlyphNoFallback(id);
  ASSERT_NE(glyph, nullptr);
  EXPECT_GT(glyph->AdvanceX, 15);
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsAlpha8(&pixels, &width, &height);
  long long ink = 0;
  for (int y = static_cast<int>(glyph->V0 * static_cast<float>(height));
       y < glyph->V1 * static_cast<float>(height); ++y) {
    const unsigned char* const row = pixels + static_cast<std::ptrdiff_t>(y) * width;
    ink += std::accumulate(row + static_cast<int>(glyph->U0 * static_cast<float>(width)),
                           row + static_cast<int>(glyph->U1 * static_cast<float>(width)), 0LL);
  }
  EXPECT_GT(ink, 20 * 255);
}

}  // namespace
}  // namespace emscape::view

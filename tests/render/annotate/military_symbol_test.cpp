#include "render/annotate/military_symbol.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "render/annotate/military_symbol_table.h"

namespace emscape::render {
namespace {

constexpr Affiliation kSides[] = {Affiliation::friendly, Affiliation::hostile, Affiliation::neutral,
                                  Affiliation::unknown};

std::vector<std::uint8_t> drawn(Affiliation side, const std::string& sidc) {
  Canvas canvas({80, 80});
  drawMilitarySymbol(canvas, side, sidc, true, {40, 40}, 30);
  return canvas.pixels().rgba;
}

TEST(MilitarySymbol, SidesDifferInShapeWithoutColour) {
  std::set<std::vector<bool>> shapes;
  for (const Affiliation side : kSides) {
    const std::vector<std::uint8_t> pixels = drawn(side, "");
    std::vector<bool> covered;
    for (std::size_t i = 3; i < pixels.size(); i += 4) covered.push_back(pixels[i] > 127);
    shapes.insert(covered);
  }
  EXPECT_EQ(shapes.size(), 4U);
}

TEST(MilitarySymbol, EveryDrawingOfTheTableIsDrawn) {
  for (int i = 0; i < kIconsCount; ++i) {
    const std::string code = kIcons[i].code;
    if (code.size() != 6) continue;  // a part of others
    const std::string sidc = std::string("1003") + kIcons[i].set + "0000" + code + "0000";
    const std::string empty = std::string("1003") + kIcons[i].set + "0000" + "000000" + "0000";
    EXPECT_NE(drawn(Affiliation::friendly, sidc), drawn(Affiliation::friendly, empty)) << sidc;
  }
}

TEST(MilitarySymbol, AnEntityWithoutADrawingHasThatOfItsType) {
  EXPECT_EQ(drawn(Affiliation::hostile, "10061000001211990000"),
            drawn(Affiliation::hostile, "10061000001211000000"));
  EXPECT_EQ(drawn(Affiliation::hostile, "10069900001211000000"), drawn(Affiliation::hostile, ""))
      << "an unknown symbol set";
}

}  // namespace
}  // namespace emscape::render

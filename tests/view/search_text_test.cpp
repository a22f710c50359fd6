#include "apps/view/values/search_text.h"

#include <gtest/gtest.h>

namespace emscape::view {
namespace {

TEST(SearchText, FindsLettersOfAnyScriptWhateverTheirCase) {
  for (const char* typed : {"Радар 264", "радар", "РАДАР", "Р", "дар", " 264 ", ""})
    EXPECT_TRUE(isFound(typed, "Радар 264")) << typed;
  EXPECT_TRUE(isFound("STÖR", "Störer"));
  EXPECT_TRUE(isFound("ΠΎΡΓΟΣ", "πύργος"));  // with the sigma of the end
  EXPECT_TRUE(isFound("雷达", "北雷达"));
  EXPECT_FALSE(isFound("Радар 265", "Радар 264"));
}

TEST(SearchText, BytesThatAreNoTextAreFoundAsTheyAre) {
  EXPECT_TRUE(isFound("\xff", "a\xff"));
  EXPECT_FALSE(isFound("\xfe", "a\xff"));
}

}  // namespace
}  // namespace emscape::view

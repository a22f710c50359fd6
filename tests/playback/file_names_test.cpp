#include "playback/series/file_names.h"

#include <gtest/gtest.h>

#include <set>

namespace emscape::playback {
namespace {

TEST(FileNames, KeepNamesOfOrdinaryLength) {
  EXPECT_EQ(fileNameOf("search radar, 2"), "search_radar__2");
  EXPECT_EQ(fileNameOf(std::string(80, 'x')), std::string(80, 'x'));
}

TEST(FileNames, OfLongNamesAreShortAndDiffer) {
  const std::string same(199, 'x');
  std::string umlauts;
  for (int n = 0; n < 200; ++n) umlauts += "\xC3\xBC";
  std::set<std::string> names;
  for (const std::string& name : {same + "1", same + "2", umlauts}) {
    EXPECT_EQ(fileNameOf(name).size(), 80U);
    EXPECT_EQ(fileNameOf(name), fileNameOf(name));
    names.insert(fileNameOf(name));
  }
  EXPECT_EQ(names.size(), 3U);
}

}  // namespace
}  // namespace emscape::playback

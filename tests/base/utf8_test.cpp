#include "base/text/utf8.h"

#include <gtest/gtest.h>

namespace emscape {
namespace {

using namespace std::string_literals;

TEST(Utf8, FindsControlCharactersAndNoncharacters) {
  for (const std::string& text :
       {""s, "a b"s, "\xC3\xBC"s, "\xC2\xA0"s, "\xEF\xBF\xBD"s, "\xF0\x9F\x8E\x89"s, "\xFF not UTF-8"s}) {
    EXPECT_FALSE(firstUnprintable(text)) << text;
  }
  EXPECT_EQ(firstUnprintable("a\0"s), char32_t{0});
  EXPECT_EQ(firstUnprintable("a\tb\n"), char32_t{'\t'});
  EXPECT_EQ(firstUnprintable("a\r"), char32_t{'\r'});
  EXPECT_EQ(firstUnprintable("\xC3\xBC\x1B["), char32_t{0x1B});
  EXPECT_EQ(firstUnprintable("\x7F"), char32_t{0x7F});
  EXPECT_EQ(firstUnprintable("\xC2\x9F"), char32_t{0x9F});
  EXPECT_EQ(firstUnprintable("\xEF\xB7\x90"), char32_t{0xFDD0});
  EXPECT_EQ(firstUnprintable("\xEF\xBF\xBE"), char32_t{0xFFFE});
  EXPECT_EQ(firstUnprintable("\xF4\x8F\xBF\xBF"), char32_t{0x10FFFF});
}

TEST(Utf8, XmlHasOnlyCharactersThatItAllows) {
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(xmlCharacters("a\tb\n\xC3\xBC\xF0\x9F\x8E\x89<&"), "a\tb\n\xC3\xBC\xF0\x9F\x8E\x89<&");
  EXPECT_EQ(xmlCharacters("\x1B[31m\0."s), replaced + "[31m" + replaced + ".");
  EXPECT_EQ(xmlCharacters("\xEF\xBF\xBE\xEF\xBF\xBF"), replaced + replaced);
  EXPECT_EQ(xmlCharacters("\xFF\xC3"), replaced + replaced) << "not UTF-8";
}

}  // namespace
}  // namespace emscape

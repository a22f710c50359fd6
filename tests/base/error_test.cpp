#include "emscape/base/error.h"

#include <gtest/gtest.h>

namespace emscape {
namespace {

TEST(SourceLocation, IsWrittenAsFileLineColumn) {
  EXPECT_EQ(toString(SourceLocation{"a.yaml", 3, 7}), "a.yaml:3:7");
}

TEST(SourceLocation, OmitsUnknownParts) {
  EXPECT_EQ(toString(SourceLocation{"a.yaml", 3, 0}), "a.yaml:3");
  EXPECT_EQ(toString(SourceLocation{"a.tif", 0, 0}), "a.tif");
  EXPECT_EQ(toString(SourceLocation{"a.tif", 0, 7}), "a.tif");
}

TEST(Error, StartsWithTheLocation) {
  const Error error(ErrorCode::bad_input, {"a.yaml", 3, 7}, "gain_dbi is 99");
  EXPECT_STREQ(error.what(), "a.yaml:3:7: gain_dbi is 99");
  EXPECT_EQ(error.message(), "gain_dbi is 99");
  EXPECT_EQ(error.location().line, 3);
  EXPECT_EQ(error.code(), ErrorCode::bad_input);
}

TEST(Error, WithoutLocationIsTheMessageOnly) {
  const Error error(ErrorCode::usage, "no such subcommand");
  EXPECT_STREQ(error.what(), "no such subcommand");
  EXPECT_STREQ(Error(ErrorCode::usage, SourceLocation{}, "no such subcommand").what(), "no such subcommand");
  EXPECT_TRUE(error.location().file.empty());
}

TEST(Error, QuotesInputInReadableLines) {
  EXPECT_STREQ(Error(ErrorCode::usage, "size '1\x1b[2J\x7f'\nsecond\tline").what(),
               "size '1?[2J?'\nsecond?line");
  const std::string token(70000, 'x');
  const std::string what = Error(ErrorCode::usage, "first\nvalue '" + token + "' is no number").what();
  EXPECT_LT(what.size(), 800U);
  EXPECT_EQ(what.substr(0, 17), "first\nvalue 'xxxx");
  EXPECT_EQ(what.substr(what.size() - 16), "xx' is no number");
  std::string characters;
  for (int n = 0; n < 1000; ++n) characters += "\u00fc";  // two bytes each: none is cut
  const std::string cut = Error(ErrorCode::usage, characters).what();
  EXPECT_EQ(cut.find(" ... ") % 2, 0U);
}

TEST(Error, CarriesAHintForProgramsAndNoneByDefault) {
  EXPECT_EQ(Error(ErrorCode::bad_input, {"a.yaml", 3, 7}, "void").hint(), Hint::none);
  const Error error(ErrorCode::bad_input, {"a.yaml", 3, 7}, "void", Hint::allow_missing_terrain);
  EXPECT_EQ(error.hint(), Hint::allow_missing_terrain);
  EXPECT_STREQ(error.what(), "a.yaml:3:7: void");
}

TEST(Error, IsCaughtAsAStandardException) {
  EXPECT_THROW(throw Error(ErrorCode::device, "out of memory"), std::runtime_error);
}

}  // namespace
}  // namespace emscape

#include "emscape/base/error.h"

#include <gtest/gtest.h>

namespace emscape {
namespace {

TEST(SourceLocation, IsWrittenAsFileLineColumn) {
  EXPECT_EQ(toString(SourceLocation{"a.yaml", 3, 7}), "a.yaml:3:7");
}

TEST(SourceLocation, LeavesOutWhatIsUnknown) {
  EXPECT_EQ(toString(SourceLocation{"a.yaml", 3, 0}), "a.yaml:3");
  EXPECT_EQ(toString(SourceLocation{"a.tif", 0, 0}), "a.tif");
  EXPECT_EQ(toString(SourceLocation{"a.tif", 0, 7}), "a.tif");
}

TEST(Error, StartsWithThePlace) {
  const Error error(ErrorCode::bad_input, {"a.yaml", 3, 7}, "gain_dbi is 99");
  EXPECT_STREQ(error.what(), "a.yaml:3:7: gain_dbi is 99");
  EXPECT_EQ(error.message(), "gain_dbi is 99");
  EXPECT_EQ(error.location().line, 3);
  EXPECT_EQ(error.code(), ErrorCode::bad_input);
}

TEST(Error, WithoutAPlaceIsTheMessageAlone) {
  const Error error(ErrorCode::usage, "no such subcommand");
  EXPECT_STREQ(error.what(), "no such subcommand");
  EXPECT_STREQ(Error(ErrorCode::usage, SourceLocation{}, "no such subcommand").what(), "no such subcommand");
  EXPECT_TRUE(error.location().file.empty());
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

#include "apps/view/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

std::string faultOf(const std::string& text) {
  const std::string file = (std::filesystem::temp_directory_path() / "emscape_script_test.jsonl").string();
  std::ofstream(file) << text;
  std::string fault;
  try {
    EXPECT_FALSE(Script(file).finished());
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    fault = error.what();
    fault.erase(0, file.size());
  }
  std::filesystem::remove(file);
  return fault;
}

TEST(Script, CommentsAndEmptyLinesAreSkipped) {
  EXPECT_EQ(faultOf("# a tour\n\n  {\"do\":\"play\"}\n"), "");
}

TEST(Script, FaultsNameTheLine) {
  EXPECT_EQ(faultOf("{\"do\":\"play\"}\n{\"do\":\"step\"}\n"), ":2: step: steps is missing");
  EXPECT_EQ(faultOf("play\n"), ":1: not JSON");
  EXPECT_EQ(faultOf("{\"do\":\"play\",\"at_s\":\"soon\"}\n"), ":1: at_s: expected a number");
}

TEST(Script, NoFileIsBadInput) {
  EXPECT_THROW(Script("no/such/script.jsonl"), Error);
}

}  // namespace
}  // namespace emscape::view

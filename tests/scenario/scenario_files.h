/// Scenario files of the tests, and ones written for a single test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario::test {

using emscape::test::errorOf;
using emscape::test::readFile;
using emscape::test::shippedScenario;
using emscape::test::sourceFile;
using emscape::test::TemporaryFolder;
using emscape::test::thrownBy;

inline std::filesystem::path testData() {
  return sourceFile("tests/scenario/data");
}

/// `text` with the only occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The messages of all problems, one a line.
inline std::string messagesOf(const ParseResult& result) {
  std::string all;
  for (const Problem& problem : result.problems) all += problem.message + "\n";
  return all;
}
/// Those of a shipped scenario with edits.
inline std::string messagesOf(const std::string& shipped, const std::vector<Edit>& edits) {
  return messagesOf(parseScenario(shippedScenario(shipped), edits));
}

}  // namespace emscape::scenario::test

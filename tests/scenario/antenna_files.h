/// Antenna files written by tests, and the expected errors of broken ones.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {

/// A file in a separate folder, removed at the end of its scope.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content) : path_(folder_.write(name, content)) {}

  void rewrite(const std::string& content) const { test::writeFile(path_, content); }
  const std::string& path() const { return path_; }

 private:
  test::TemporaryFolder folder_;
  std::string path_;
};

/// Expects an Error (bad_input) at line:column of the file (0: none) whose message holds `part`.
inline void expectFault(const std::function<void()>& read, const std::string& file, int line, int column,
                        const std::string& part) {
  const Error error = test::thrownBy(read);
  EXPECT_EQ(error.code(), ErrorCode::bad_input);
  EXPECT_EQ(error.location().file, file);
  EXPECT_EQ(error.location().line, line) << error.what();
  EXPECT_EQ(error.location().column, column) << error.what();
  EXPECT_THAT(error.message(), testing::HasSubstr(part));
}

/// Reads a file truncated after each of its bytes, and with each byte replaced by a harmful one that varies:
/// the result must be an Error or an antenna.
inline void surviveDamage(const TemporaryFile& file, const std::string& content,
                          const std::function<void()>& read) {
  const auto attempt = [&](const std::string& damaged) {
    file.rewrite(damaged);
    try {
      read();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_FALSE(error.message().empty());
    }
  };
  for (std::size_t length = 0; length < content.size(); ++length) attempt(content.substr(0, length));
  const std::string hurtful("\0009-\n,\xff ", 7);
  for (std::size_t i = 0; i < content.size(); ++i) {
    std::string damaged = content;
    damaged[i] = hurtful[i % hurtful.size()];
    attempt(damaged);
  }
}

}  // namespace emscape::scenario

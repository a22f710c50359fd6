/// The errors that a call throws, for tests of bad input.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>

#include "emscape/base/error.h"

namespace emscape::test {

/// The text of the Error that `body` throws, with its location; empty if it throws none.
/// @param code  if given, the Error must have it
inline std::string errorOf(const std::function<void()>& body, std::optional<ErrorCode> code = {}) {
  try {
    body();
  } catch (const Error& error) {
    if (code) {
      EXPECT_EQ(error.code(), *code) << error.what();
    }
    return error.what();
  }
  return "";
}

/// The Error that `body` throws. If it throws none, the test fails and the Error is empty.
inline Error thrownBy(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no Error was thrown";
  return Error(ErrorCode::other, "");
}

}  // namespace emscape::test

/// The one exception of the project and the location in a file that it points to.
#pragma once

#include <stdexcept>
#include <string>

namespace emscape {

/// Kind of failure; its value is the exit status of the programs.
enum class ErrorCode { other = 1, usage = 2, bad_input = 3, device = 4, check_failed = 5 };

/// A location in a text file. line and column count from 1; 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", without the parts that are unknown.
std::string toString(const SourceLocation& location);

/// A remedy that a program can propose after an error, in terms of its own options.
enum class Hint {
  none,
  allow_missing_terrain  ///< FieldOptions::allow_missing_terrain computes the field with holes
};

/// Thrown where input comes in. The message names the value, the allowed range and its unit; what() starts
/// with the location if it is known.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message);
  Error(ErrorCode code, const SourceLocation& location, const std::string& message, Hint hint = Hint::none);

  ErrorCode code() const { return code_; }
  const SourceLocation& location() const { return location_; }
  /// The message without the location.
  const std::string& message() const { return message_; }
  Hint hint() const { return hint_; }

 private:
  ErrorCode code_;
  SourceLocation location_;
  std::string message_;
  Hint hint_ = Hint::none;
};

}  // namespace emscape

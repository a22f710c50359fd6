/// The exception of all libraries, and the location in a file that it refers to.
#pragma once

#include <stdexcept>
#include <string>

namespace emscape {

/// Kind of failure. The value is the exit status of the programs.
enum class ErrorCode { other = 1, usage = 2, bad_input = 3, device = 4, check_failed = 5 };

/// A location in a text file. line and column count from 1; 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", without the parts that are unknown.
std::string toString(const SourceLocation& location);

/// A remedy for an error, which a program can propose in terms of its own options.
enum class Hint {
  none,
  allow_missing_terrain  ///< set FieldOptions::allow_missing_terrain: the field is computed with holes
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

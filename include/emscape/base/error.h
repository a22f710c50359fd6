/// The one exception of the project and the place in a file that it points to.
#pragma once

#include <stdexcept>
#include <string>

namespace emscape {

/// What went wrong, as the process's exit status tells it.
enum class ErrorCode { other = 1, usage = 2, bad_input = 3, device = 4, check_failed = 5 };

/// A place in a text file. line and column count from 1; 0 means unknown.
struct FilePlace {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", without the parts that are unknown.
std::string toString(const FilePlace& place);

/// Thrown where input comes in. The message names the value, the allowed range and its unit; what() starts
/// with the place where there is one.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message);
  Error(ErrorCode code, const FilePlace& place, const std::string& message);

  ErrorCode code() const { return code_; }
  const FilePlace& place() const { return place_; }
  /// The message without the place.
  const std::string& message() const { return message_; }

 private:
  ErrorCode code_;
  FilePlace place_;
  std::string message_;
};

}  // namespace emscape

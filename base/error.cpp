#include "emscape/base/error.h"

namespace emscape {

std::string toString(const SourceLocation& place) {
  std::string text = place.file;
  if (place.line > 0) {
    text += ":" + std::to_string(place.line);
    if (place.column > 0) text += ":" + std::to_string(place.column);
  }
  return text;
}

Error::Error(ErrorCode code, const std::string& message)
    : std::runtime_error(message), code_(code), message_(message) {}

Error::Error(ErrorCode code, const SourceLocation& place, const std::string& message, Hint hint)
    : std::runtime_error(place.file.empty() ? message : toString(place) + ": " + message),
      code_(code),
      place_(place),
      message_(message),
      hint_(hint) {}

}  // namespace emscape

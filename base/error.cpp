#include "emscape/base/error.h"

#include "base/text/readable_text.h"

namespace emscape {

std::string toString(const SourceLocation& location) {
  std::string text = location.file;
  if (location.line > 0) {
    text += ":" + std::to_string(location.line);
    if (location.column > 0) text += ":" + std::to_string(location.column);
  }
  return text;
}

Error::Error(ErrorCode code, const std::string& message) : Error(code, SourceLocation{}, message) {}

Error::Error(ErrorCode code, const SourceLocation& location, const std::string& message, Hint hint)
    : std::runtime_error(readableText(location.file.empty() ? message : toString(location) + ": " + message)),
      code_(code),
      location_(location),
      message_(readableText(message)),
      hint_(hint) {}

}  // namespace emscape

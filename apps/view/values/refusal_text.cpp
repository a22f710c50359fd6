#include "apps/view/values/refusal_text.h"

#include <algorithm>
#include <sstream>

#include "scenario/file/parameter_words.h"

namespace emscape::view {
namespace {

/// Position behind the digits that begin at a position.
std::size_t behindDigits(const std::string& text, std::size_t at) {
  return std::min(text.find_first_not_of("0123456789", at), text.size());
}

/// Removes "FILE:LINE:COLUMN: " or "FILE:LINE: " from the front.
void removePlace(std::string& line) {
  for (std::size_t colon = line.find(':'); colon != std::string::npos; colon = line.find(':', colon + 1)) {
    std::size_t end = behindDigits(line, colon + 1);
    if (end == colon + 1) continue;
    if (line.compare(end, 2, ": ") != 0 && end < line.size() && line[end] == ':') {
      const std::size_t column = end + 1;
      end = behindDigits(line, column);
      if (end == column) continue;
    }
    if (line.compare(end, 2, ": ") != 0) continue;
    line.erase(0, end + 2);
    return;
  }
}

/// "'emitters' has 'a' twice" becomes "another emitter is named 'a'".
void sayAnother(std::string& line) {
  static const std::string kTwice = "' twice";
  for (const std::string kind : {"emitter", "platform", "receiver", "target"}) {
    const std::string has = "'" + kind + "s' has '";
    const std::size_t begin = line.find(has), end = line.rfind(kTwice);
    if (begin == std::string::npos || end == std::string::npos || end < begin + has.size()) continue;
    line.replace(end, kTwice.size(), "'");
    line.replace(begin, has.size(), "another " + kind + " is named '");
  }
}

void removeOtherLines(std::string& line) {
  static const std::string kFirst = "; first at line ";
  for (std::size_t at = line.find(kFirst); at != std::string::npos; at = line.find(kFirst, at)) {
    const std::size_t end = behindDigits(line, at + kFirst.size());
    if (end == at + kFirst.size()) {
      at = end;
    } else {
      line.erase(at, end - at);
    }
  }
}

}  // namespace

std::string refusalText(const std::string& error, const std::vector<scenario::Edit>& edits) {
  std::string text;
  std::istringstream lines(error);
  for (std::string line; std::getline(lines, line);) {
    for (const scenario::Edit& edit : edits) {
      const std::string prefix = toString(edit) + ": ";
      if (line.compare(0, prefix.size(), prefix) == 0) line.erase(0, prefix.size());
    }
    removePlace(line);
    sayAnother(line);
    removeOtherLines(line);
    text += (text.empty() ? "" : "\n") + line;
  }
  return scenario::inWords(text);
}

}  // namespace emscape::view

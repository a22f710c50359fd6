#include "apps/view/values/refusal_text.h"

#include <regex>
#include <sstream>

#include "scenario/file/parameter_words.h"

namespace emscape::view {

std::string refusalText(const std::string& error, const std::vector<scenario::Edit>& edits) {
  static const std::regex place(R"(^[^\n]*?:\d+(:\d+)?: )"), other_line(R"(; first at line \d+)"),
      twice(R"('(emitter|platform|receiver|target)s' has '(.*)' twice)");
  std::string text;
  std::istringstream lines(error);
  for (std::string line; std::getline(lines, line);) {
    for (const scenario::Edit& edit : edits) {
      const std::string prefix = toString(edit) + ": ";
      if (line.compare(0, prefix.size(), prefix) == 0) line.erase(0, prefix.size());
    }
    line = std::regex_replace(line, place, "");
    line = std::regex_replace(line, twice, "another $1 is named '$2'");
    text += (text.empty() ? "" : "\n") + std::regex_replace(line, other_line, "");
  }
  return scenario::inWords(text);
}

}  // namespace emscape::view

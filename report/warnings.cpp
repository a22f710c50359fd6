#include "report/warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>
#include <unordered_map>
#include <unordered_set>

#include "emscape/base/log.h"

namespace emscape::report {

std::vector<std::string> joinedWarnings(const std::vector<std::string>& warnings) {
  static const std::regex kOfEmitter("((?:[^']*: )?)emitter '([^']*)': (.*)");
  static const std::regex kNumber(R"((\B-)?\b\d+(\.\d+)?\b)");
  constexpr std::size_t kMaxNames = 5;
  struct Kind {
    std::string of;                                 // the series in front, such as "the original: "
    std::string form;                               // the text with '#' for each number
    std::unordered_set<std::string> emitters;       // empty: the warning of no emitter
    std::vector<std::string> names;                 // of the first emitters
    std::size_t count = 0;                          // warnings of this form
    std::vector<std::vector<std::string>> numbers;  // by position in the text, one per warning
  };
  std::vector<Kind> kinds;
  std::unordered_map<std::string, std::size_t> kind_of_form;  // of the warnings of emitters
  for (const std::string& warning : warnings) {
    std::smatch parts;
    if (!std::regex_match(warning, parts, kOfEmitter)) {
      kinds.push_back({"", warning, {}, {}, 1, {}});
      continue;
    }
    const std::string of = parts[1], text = parts[3], emitter = "'" + parts[2].str() + "'";
    const std::string form = std::regex_replace(text, kNumber, "#");
    const auto [known, is_new] = kind_of_form.emplace(of + form, kinds.size());
    if (is_new) kinds.push_back({of, form, {}, {}, 0, {}});
    Kind& kind = kinds[known->second];
    if (kind.emitters.insert(emitter).second && kind.names.size() < kMaxNames) kind.names.push_back(emitter);
    ++kind.count;
    std::size_t place = 0;
    for (std::sregex_iterator number(text.begin(), text.end(), kNumber), end; number != end;
         ++number, ++place) {
      if (kind.numbers.size() <= place) kind.numbers.emplace_back();
      kind.numbers[place].push_back(number->str());
    }
  }
  std::vector<std::string> lines;
  for (const Kind& kind : kinds) {
    if (kind.emitters.empty()) {
      lines.push_back(kind.form);
      continue;
    }
    const std::size_t others = kind.emitters.size() - kind.names.size();
    std::string line = fmt::format("{}emitter{} {}", kind.of, kind.emitters.size() > 1 ? "s" : "",
                                   fmt::join(kind.names, ", "));
    line += others == 0 ? ": " : fmt::format(" and {} other{}: ", others, others > 1 ? "s" : "");
    std::size_t place = 0;
    for (const char character : kind.form) {
      if (character != '#' || place >= kind.numbers.size()) {
        line += character;
        continue;
      }
      const std::vector<std::string>& numbers = kind.numbers[place++];
      const auto [min, max] =
          std::minmax_element(numbers.begin(), numbers.end(),
                              [](const auto& a, const auto& b) { return std::stod(a) < std::stod(b); });
      const bool is_one_each = kind.count == kind.names.size();
      line += *min == *max  ? *min
              : is_one_each ? fmt::format("{}", fmt::join(numbers, ", "))
                            : fmt::format("{} to {}", *min, *max);
    }
    lines.push_back(line);
  }
  return lines;
}

void logWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& line : joinedWarnings(warnings)) logWarning(line);
}

}  // namespace emscape::report

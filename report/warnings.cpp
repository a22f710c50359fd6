#include "report/warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"

namespace emscape::report {

namespace {

/// The parts of "OF: emitter 'NAME': TEXT", of which "OF: " may be missing and has no quotation mark.
struct WarningOfEmitter {
  std::string of, emitter, text;
};

std::optional<WarningOfEmitter> partsOf(const std::string& warning) {
  static const std::string kEmitter = "emitter '", kEnd = "': ";
  const std::size_t begin = warning.find(kEmitter);
  if (begin == std::string::npos || warning.find('\'') < begin) return std::nullopt;
  const bool follows = begin >= 2 && warning.compare(begin - 2, 2, ": ") == 0;
  const std::size_t name = begin + kEmitter.size(), end = warning.find('\'', name);
  if ((begin > 0 && !follows) || end == std::string::npos || warning.compare(end, kEnd.size(), kEnd) != 0)
    return std::nullopt;
  return WarningOfEmitter{warning.substr(0, begin), "'" + warning.substr(name, end - name) + "'",
                          warning.substr(end + kEnd.size())};
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool isWordPart(char c) {
  return isDigit(c) || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// A text with '#' for each of its numbers, which are no parts of words.
/// @param numbers  receives the numbers
std::string withoutNumbers(const std::string& text, std::vector<std::string>& numbers) {
  std::string form;
  for (std::size_t i = 0; i < text.size();) {
    const auto wordAt = [&](std::size_t at) { return at < text.size() && isWordPart(text[at]); };
    const bool is_signed = text[i] == '-' && (i == 0 || !isWordPart(text[i - 1]));
    const std::size_t begin = is_signed ? i + 1 : i;
    const auto digitsEnd = [&](std::size_t at) {
      while (at < text.size() && isDigit(text[at])) ++at;
      return at;
    };
    const auto exponentEnd = [&](std::size_t at) {
      if (at >= text.size() || (text[at] != 'e' && text[at] != 'E')) return at;
      const std::size_t digits =
          at + 1 + (at + 1 < text.size() && (text[at + 1] == '+' || text[at + 1] == '-'));
      const std::size_t last = digitsEnd(digits);
      return last > digits ? last : at;
    };
    const std::size_t whole = digitsEnd(begin);
    const bool has_decimals = whole < text.size() && text[whole] == '.' && digitsEnd(whole + 1) > whole + 1;
    const std::size_t decimals = has_decimals ? digitsEnd(whole + 1) : whole;
    std::size_t end = begin;  // of the longest number that is not the begin of a word
    for (const std::size_t at : {whole, exponentEnd(whole), decimals, exponentEnd(decimals)})
      if (at > end && !wordAt(at)) end = at;
    const bool may_begin = is_signed || i == 0 || !isWordPart(text[i - 1]);
    if (end == begin || !may_begin) {
      form += text[i++];
      continue;
    }
    numbers.push_back(text.substr(i, end - i));
    form += '#';
    i = end;
  }
  return form;
}

/// Numbers of any length: beyond a double's range they are infinite.
double numberIn(const std::string& text) {
  return std::strtod(text.c_str(), nullptr);
}

}  // namespace

std::vector<std::string> joinedWarnings(const std::vector<std::string>& warnings) {
  constexpr std::size_t kMaxNames = 5, kMaxTexts = 3;
  struct Kind {
    std::string of;                                 // the series in front, such as "the original: "
    std::string form;                               // the text with '#' for each number
    std::unordered_set<std::string> emitters;       // empty: the warning of no emitter
    std::vector<std::string> names;                 // of the first emitters
    std::size_t count = 0;                          // warnings of this form
    std::vector<std::vector<std::string>> numbers;  // by position in the text, one per warning
    std::vector<std::string> texts;                 // of no emitter
  };
  std::vector<Kind> kinds;
  std::unordered_map<std::string, std::size_t> kind_of_form, kind_of_text;  // of emitters, and of none
  for (const std::string& warning : warnings) {
    const std::optional<WarningOfEmitter> parts = partsOf(warning);
    std::vector<std::string> numbers;
    if (!parts) {
      const auto [known, is_new] = kind_of_text.emplace(withoutNumbers(warning, numbers), kinds.size());
      if (is_new) kinds.emplace_back();
      kinds[known->second].texts.push_back(warning);
      continue;
    }
    const std::string &of = parts->of, &emitter = parts->emitter, form = withoutNumbers(parts->text, numbers);
    const auto [known, is_new] = kind_of_form.emplace(of + form, kinds.size());
    if (is_new) kinds.push_back({of, form, {}, {}, 0, {}, {}});
    Kind& kind = kinds[known->second];
    if (kind.emitters.insert(emitter).second && kind.names.size() < kMaxNames) kind.names.push_back(emitter);
    ++kind.count;
    if (kind.numbers.size() < numbers.size()) kind.numbers.resize(numbers.size());
    for (std::size_t place = 0; place < numbers.size(); ++place)
      kind.numbers[place].push_back(numbers[place]);
  }
  std::vector<std::string> lines;
  for (const Kind& kind : kinds) {
    if (kind.emitters.empty()) {
      const bool is_short = kind.texts.size() <= kMaxTexts;
      lines.insert(lines.end(), kind.texts.begin(), is_short ? kind.texts.end() : kind.texts.begin() + 1);
      if (!is_short) lines.back() += fmt::format(" ({} more with other numbers)", kind.texts.size() - 1);
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
                              [](const auto& a, const auto& b) { return numberIn(a) < numberIn(b); });
      const bool is_one_each = kind.count == kind.names.size();
      line += *min == *max  ? *min
              : is_one_each ? fmt::format("{}", fmt::join(numbers, ", "))
                            : fmt::format("{} to {}", *min, *max);
    }
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> withoutChecks(std::vector<std::string> warnings, const ReadScenarios& scenarios) {
  const auto isOfCheck = [&](const std::string& warning) {
    for (const auto& scenario : scenarios) {
      for (const std::string& known : warningsOf(*scenario)) {
        // "A: " of a comparison may be in front
        const bool ends_so = warning.size() >= known.size() &&
                             warning.compare(warning.size() - known.size(), known.size(), known) == 0;
        if (ends_so) return true;
      }
    }
    return false;
  };
  warnings.erase(std::remove_if(warnings.begin(), warnings.end(), isOfCheck), warnings.end());
  return warnings;
}

void logWarnings(const std::vector<std::string>& warnings, const ReadScenarios& scenarios) {
  for (const std::string& line : joinedWarnings(withoutChecks(warnings, scenarios))) logWarning(line);
}

}  // namespace emscape::report

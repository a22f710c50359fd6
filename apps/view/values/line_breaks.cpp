#include "apps/view/values/line_breaks.h"

#include <algorithm>

namespace emscape::view {
namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// "12", "-3.5", "(1e6", "36.4": not "P.526" and "12,", after which a line may end.
bool isNumber(std::string_view word) {
  const std::size_t first = word.find_first_of("0123456789");
  return first != std::string_view::npos && isDigit(word.back()) &&
         std::none_of(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(first),
                      [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); });
}

/// The end of the character at a position.
std::size_t nextCharacter(std::string_view text, std::size_t at) {
  ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U) ++at;
  return at;
}

class Breaker {
 public:
  Breaker(float width, const std::function<float(std::string_view)>& widthOf)
      : width_(width), widthOf_(widthOf) {}

  std::string broken(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = endOfPart(text, at);
      add(text.substr(at, end - at));
      at = end;
    }
    return result_;
  }

 private:
  /// A part has the blanks before it, and words between which no line ends.
  static std::size_t endOfPart(std::string_view text, std::size_t begin) {
    for (std::size_t at = begin;;) {
      const std::size_t word = std::min(text.find_first_not_of(' ', at), text.size());
      const std::size_t end = std::min(text.find(' ', word), text.size());
      if (end == text.size() || !isNumber(text.substr(word, end - word))) return end;
      at = end;
    }
  }

  void add(std::string_view part) {
    const float part_width = widthOf_(part);
    if (used_ + part_width <= width_) return append(part, part_width);
    const std::size_t first = std::min(part.find_first_not_of(' '), part.size());
    const std::string_view words = part.substr(first);
    const float words_width = widthOf_(words);
    const std::size_t end = words.find(' ');
    if (words_width > width_ && end != std::string_view::npos) {  // a row of numbers
      add(part.substr(0, first + end));
      return add(part.substr(first + end));
    }
    if (!result_.empty()) newLine();
    if (words_width <= width_) return append(words, words_width);
    cut(words);
  }

  void cut(std::string_view word) {
    while (!word.empty()) {
      std::size_t end = nextCharacter(word, 0);
      while (end < word.size() && widthOf_(word.substr(0, nextCharacter(word, end))) <= width_)
        end = nextCharacter(word, end);
      const std::size_t slash = end < word.size() ? word.rfind('/', end - 1) : std::string_view::npos;
      if (slash != std::string_view::npos && slash > 0) end = slash + 1;
      append(word.substr(0, end), widthOf_(word.substr(0, end)));
      word.remove_prefix(end);
      if (!word.empty()) newLine();
    }
  }

  void append(std::string_view text, float text_width) {
    result_ += text;
    used_ += text_width;
  }

  void newLine() {
    result_ += '\n';
    used_ = 0;
  }

  const float width_;
  const std::function<float(std::string_view)>& widthOf_;
  std::string result_;
  float used_ = 0;
};

}  // namespace

std::string withLineBreaks(const std::string& text, float width,
                           const std::function<float(std::string_view)>& widthOf) {
  std::string result;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (at > 0) result += '\n';
    result += Breaker(width, widthOf).broken(std::string_view(text).substr(at, end - at));
    at = end + 1;
  }
  return result;
}

}  // namespace emscape::view

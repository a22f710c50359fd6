#include "apps/view/values/search_text.h"

#include <locale.h>
#include <wctype.h>

#include <algorithm>
#include <string>

#include "base/text/utf8.h"

namespace emscape::view {
namespace {

std::wstring withoutCase(std::string_view text) {
  static const locale_t unicode = newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
  std::wstring folded;
  while (!text.empty()) {
    const std::size_t length = utf8SequenceLength(text);
    const auto c = static_cast<wint_t>(length == 0 ? static_cast<unsigned char>(text[0])
                                                   : codePointOf(text.substr(0, length)));
    // By way of the capital: a letter may have two small ones.
    folded += static_cast<wchar_t>(unicode != nullptr ? towlower_l(towupper_l(c, unicode), unicode) : c);
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return folded;
}

}  // namespace

bool isFound(std::string_view typed, std::string_view text) {
  while (!typed.empty() && typed.front() == ' ') typed.remove_prefix(1);
  while (!typed.empty() && typed.back() == ' ') typed.remove_suffix(1);
  return typed.empty() || withoutCase(text).find(withoutCase(typed)) != std::wstring::npos;
}

}  // namespace emscape::view

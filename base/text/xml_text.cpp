#include "base/text/xml_text.h"

#include "base/text/utf8.h"

namespace emscape {

std::string escapedXml(std::string_view text) {
  std::string result;
  for (const char c : xmlCharacters(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace emscape

#include "recording/common/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "emscape/base/error.h"
#include "recording/common/byte_source.h"
#include "recording/common/text.h"

namespace emscape::interop {

namespace {

struct XmlFault {
  std::size_t at = 0;  ///< byte
  std::string message;
};

std::optional<XmlFault> faultOf(std::string_view text, pugi::xml_document& document,
                                pugi::xml_encoding encoding = pugi::encoding_auto) {
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default, encoding);
  if (result) return std::nullopt;
  const auto at = std::min<std::size_t>(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)),
                                        text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  return XmlFault{at, fmt::format("line {}: no XML: {}", line, result.description())};
}

}  // namespace

std::string parseXml(std::string_view text, pugi::xml_document& document) {
  const auto fault = faultOf(text, document);
  return fault ? fault->message : "";
}

std::string loadXml(ByteSource& source, const std::string& name, pugi::xml_document& document,
                    std::string* told) {
  std::string text = readAll(source, name, kMaxXmlBytes);
  // pugixml knows Unicode and Latin-1. Zero bytes are those of UTF-16 and UTF-32.
  const bool is_other = !isUtf8(text) && text.find('\0') == std::string::npos;
  if (is_other) text = utf8Of(text, declaredEncoding(text.substr(0, 200)), told);
  const auto fault = faultOf(text, document, is_other ? pugi::encoding_utf8 : pugi::encoding_auto);
  if (!fault) return source.failure();
  // Of a file that was cut, the fault is in its last element.
  constexpr std::size_t kLastElement = 400;
  const bool is_cut = document.document_element() && fault->at + kLastElement >= text.size() &&
                      text.find('>', fault->at) == std::string::npos;
  if (!is_cut) throw Error(ErrorCode::bad_input, {name, 0, 0}, fault->message);
  return fault->message + ": the file was cut there";
}

void loadXmlFile(const std::string& file, pugi::xml_document& document) {
  const std::string torn = loadXml(*openFile(file), file, document);
  if (!torn.empty()) throw Error(ErrorCode::bad_input, {file, 0, 0}, torn);
}

std::string_view nameOf(const pugi::xml_node& node) {
  std::string_view name = node.name();
  const std::size_t at = name.find(':');
  return at == std::string_view::npos ? name : name.substr(at + 1);
}

pugi::xml_node childOf(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node& child : node.children()) {
    if (nameOf(child) == name) return child;
  }
  return {};
}

std::string textOf(const pugi::xml_node& node, std::string_view name) {
  const std::string text = childOf(node, name).child_value();
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

}  // namespace emscape::interop

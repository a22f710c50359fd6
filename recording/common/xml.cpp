#include "recording/common/xml.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"
#include "recording/common/byte_source.h"

namespace emscape::interop {

std::string parseXml(std::string_view text, pugi::xml_document& document) {
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_auto);
  if (result) return "";
  const auto at = std::min<std::size_t>(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)),
                                        text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  return fmt::format("line {}: no XML: {}", line, result.description());
}

void loadXml(ByteSource& source, const std::string& name, pugi::xml_document& document) {
  const std::string text = readAll(source, name, kMaxXmlBytes);
  const std::string fault = parseXml(text, document);
  if (!fault.empty()) throw Error(ErrorCode::bad_input, {name, 0, 0}, fault);
}

void loadXmlFile(const std::string& file, pugi::xml_document& document) {
  loadXml(*openFile(file), file, document);
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

/// Reading of XML files of other programs. Entities other than the five of XML, document types and whatever
/// they refer to are never resolved.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace emscape::interop {

class ByteSource;

/// Largest XML file (bytes): a document is held in memory.
constexpr std::size_t kMaxXmlBytes = std::size_t{256} << 20;

/// @throws Error (bad_input) that names the file and, in a faulty one, the line
void loadXmlFile(const std::string& file, pugi::xml_document& document);
/// @param name  of the file, for messages
/// @param told  receives how letters are read that are not in the stated encoding; may be null
/// @return where the file was cut, if it was: the document has what stands before; empty: it is whole
std::string loadXml(ByteSource& source, const std::string& name, pugi::xml_document& document,
                    std::string* told = nullptr);
/// The reason why a text is no XML document; empty if it is one.
std::string parseXml(std::string_view text, pugi::xml_document& document);

/// Name of an element without the prefix of its namespace.
std::string_view nameOf(const pugi::xml_node& node);
/// First child of a name, whatever the prefix of its namespace is; null if there is none.
pugi::xml_node childOf(const pugi::xml_node& node, std::string_view name);
/// Text of a child, without blanks around it.
std::string textOf(const pugi::xml_node& node, std::string_view name);

}  // namespace emscape::interop

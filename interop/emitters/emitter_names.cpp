#include "interop/emitters/emitter_names.h"

#include <pugixml.hpp>

#include "base/text/utf8.h"
#include "emscape/base/error.h"
#include "recording/common/xml.h"

namespace emscape::interop {
namespace {

constexpr const char* kEmitterNames = "75";

}  // namespace

std::map<int, std::string> readEmitterNames(const std::string& file) {
  pugi::xml_document document;
  loadXmlFile(file, document);
  std::map<int, std::string> names;
  for (const pugi::xml_node& list : childOf(document, "ebv").children()) {
    if (nameOf(list) != "enum" || std::string(list.attribute("uid").value()) != kEmitterNames) continue;
    for (const pugi::xml_node& row : list.children()) {
      const int number = row.attribute("value").as_int(-1);
      const std::string name = xmlCharacters(row.attribute("description").value()).substr(0, 150);
      if (nameOf(row) == "enumrow" && number >= 0 && number <= 65535 && !name.empty())
        names[number] = xmlCharacters(name);
    }
  }
  if (names.empty()) {
    throw Error(ErrorCode::bad_input, {file, 0, 0},
                "no emitter names: <ebv> has no <enum uid=\"75\">; give the file SISO-REF-010.xml");
  }
  return names;
}

}  // namespace emscape::interop

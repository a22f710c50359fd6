#include "volume/vtk/vtk_xml_write.h"

#include <sstream>

#include "base/files/file_patch.h"
#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "base/text/utf8.h"
#include "volume/stored_range.h"
#include "volume/volume_json.h"
#include "volume/vtk/vtk_xml.h"

namespace emscape::volume {
namespace {

using Json = nlohmann::ordered_json;

/// VTK writes texts as character codes, with a zero at the end.
std::string characterNumbers(const std::string& text) {
  std::string numbers;
  for (const char character : text) numbers += std::to_string(static_cast<unsigned char>(character)) + " ";
  return numbers + "0";
}

/// Description of a volume for its array in the field data. Blanks at the end of the JSON text make the
/// number of characters independent of the range, and blanks after the codes their length, so that
/// setVtkRange() can replace the text in place.
std::string descriptionText(const Json& description) {
  constexpr std::size_t kMaxRangeCharacters = 2 * 24;  // of two doubles
  constexpr std::size_t kMaxCodeLength = 4;            // a code of three digits and a blank
  const std::string range = dumpJson(description["range_min"]) + dumpJson(description["range_max"]);
  const std::string blanks(kMaxRangeCharacters - range.size(), ' ');
  const std::size_t codes_length = characterNumbers(range + blanks).size();
  return characterNumbers(dumpJson(description, 2) + blanks) +
         std::string(kMaxCodeLength * kMaxRangeCharacters + 1 - codes_length, ' ');
}

}  // namespace

std::string numberText(double value) {
  return dumpJson(nlohmann::json(value));
}

pugi::xml_node appendVtkRoot(pugi::xml_document& document, const char* type) {
  pugi::xml_node root = document.append_child("VTKFile");
  root.append_attribute("type") = type;
  root.append_attribute("version") = "1.0";
  root.append_attribute("byte_order") = "LittleEndian";
  root.append_attribute("header_type") = "UInt64";
  return root.append_child(type);
}

void appendFieldData(pugi::xml_node data_set, double time_s, FieldTextType text_type,
                     const std::vector<std::pair<std::string, Json>>& descriptions) {
  pugi::xml_node field = data_set.append_child("FieldData");
  const auto addArray = [&](const char* element, const char* type, const std::string& name,
                            const std::string& text, std::size_t tuples) {
    pugi::xml_node array = field.append_child(element);
    array.append_attribute("type") = type;
    array.append_attribute("Name") = xmlCharacters(name).c_str();
    array.append_attribute("NumberOfTuples") = static_cast<unsigned long long>(tuples);
    array.append_attribute("format") = "ascii";
    array.text() = text.c_str();
  };
  addArray("DataArray", "Float64", "TimeValue", numberText(time_s), 1);
  for (const auto& [quantity, description] : descriptions) {
    const std::string text = descriptionText(description);
    if (text_type == FieldTextType::string) {
      addArray("Array", "String", "emscape:" + quantity, text, 1);
    } else {
      addArray("DataArray", "UInt8", "emscape:" + quantity, text, spelledText(text).size() + 1);
    }
  }
}

void AppendedArrays::add(pugi::xml_node parent, const AppendedArray& array) {
  pugi::xml_node node = parent.append_child("DataArray");
  node.append_attribute("type") = array.type;
  node.append_attribute("Name") = xmlCharacters(array.name).c_str();
  if (array.components > 1) node.append_attribute("NumberOfComponents") = array.components;
  node.append_attribute("format") = "appended";
  node.append_attribute("offset") = static_cast<unsigned long long>(offset_);
  offset_ += sizeof(std::uint64_t) + array.size;
  arrays_.push_back(array);
}

void AppendedArrays::write(const std::filesystem::path& path, const pugi::xml_document& document) const {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else it ends silently if memory is exhausted
  document.save(text, "  ");
  const std::string whole = text.str();
  writeWhole(path, [&](std::ostream& stream) {
    stream << whole.substr(0, whole.rfind("</VTKFile>")) << "  <AppendedData encoding=\"raw\">\n_";
    for (const AppendedArray& array : arrays_) {
      stream.write(reinterpret_cast<const char*>(&array.size), sizeof(array.size));
      stream.write(static_cast<const char*>(array.bytes), static_cast<std::streamsize>(array.size));
    }
    stream << "\n  </AppendedData>\n</VTKFile>\n";
  });
}

void setVtkRange(const std::filesystem::path& path, const char* type,
                 const std::vector<StoredRange>& ranges) {
  const VtkXmlFile file(path, type);
  std::vector<FilePatch> patches;
  for (const StoredRange& range : ranges) {
    const std::string before = file.storedFieldText("emscape:" + xmlCharacters(range.quantity));
    if (before.empty()) failNoSuchQuantity(path, range.quantity);
    Json description = parseJson(spelledText(before), path.string());
    if (!description.contains("range_min")) failNoSuchQuantity(path, range.quantity);
    description["range_min"] = numberToJson(range.min);
    description["range_max"] = numberToJson(range.max);
    const std::string after = descriptionText(description);
    if (after.size() != before.size())
      file.fail("the text that describes " + range.quantity + " has another length");
    patches.push_back({file.headOffsetOf(before), after});
  }
  patchFile(path, patches);
}

}  // namespace emscape::volume

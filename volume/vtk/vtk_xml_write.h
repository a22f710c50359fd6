/// Writes the XML files of VTK with appended data. Internal to the module.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "emscape/volume/format/file.h"

namespace emscape::volume {

/// Shortest text that reads back to the same number.
std::string numberText(double value);

/// Appends the element VTKFile. @param type  for example "ImageData"
/// @return its child of that name
pugi::xml_node appendVtkRoot(pugi::xml_document& document, const char* type);

/// string: shown as text by VTK's programs. uint8: the same codes as numbers, for readers of meshes that know
/// arrays of numbers only, such as meshio's.
enum class FieldTextType { string, uint8 };

/// Appends TimeValue, and for each quantity a text `emscape:NAME` with its description.
void appendFieldData(pugi::xml_node data_set, double time_s, FieldTextType text_type,
                     const std::vector<std::pair<std::string, nlohmann::ordered_json>>& descriptions);

/// An array of the appended data. Its bytes must outlive AppendedArrays::write().
struct AppendedArray {
  std::string name;
  const char* type;
  const void* bytes;
  std::uint64_t size;
  int components = 1;
};

/// The appended data of a file.
class AppendedArrays {
 public:
  /// Appends an array, and its DataArray to `parent`.
  void add(pugi::xml_node parent, const AppendedArray& array);
  /// Writes the file, atomically. @throws Error (other)
  void write(const std::filesystem::path& path, const pugi::xml_document& document) const;

 private:
  std::vector<AppendedArray> arrays_;
  std::uint64_t offset_ = 0;
};

/// setStoredRange() for files with appendFieldData().
void setVtkRange(const std::filesystem::path& path, const char* type, const std::vector<StoredRange>& ranges);

}  // namespace emscape::volume

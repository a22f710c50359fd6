#include <fstream>
#include <pugixml.hpp>
#include <sstream>

#include "base/whole_file.h"
#include "emscape/base/parallel.h"
#include "volume/stored_range.h"
#include "volume/volume_json.h"
#include "volume/vti.h"
#include "volume/vtk_xml.h"

namespace emscape::volume {
namespace {

using Json = nlohmann::ordered_json;

/// An array of the appended data.
struct Appended {
  std::string name;
  const char* type;
  const void* bytes;
  std::uint64_t size;
};

/// Shortest text that reads back to the same number.
std::string numberText(double value) {
  return nlohmann::json(value).dump();
}

std::string vectorText(const Vec3d& vector) {
  return numberText(vector.x) + " " + numberText(vector.y) + " " + numberText(vector.z);
}

std::string extentText(const Dims& dims) {
  return "0 " + std::to_string(dims.x - 1) + " 0 " + std::to_string(dims.y - 1) + " 0 " +
         std::to_string(dims.z - 1);
}

/// VTK writes texts as character codes, with a zero at the end.
std::string characterNumbers(const std::string& text) {
  std::string numbers;
  for (const char character : text) numbers += std::to_string(static_cast<unsigned char>(character)) + " ";
  return numbers + "0";
}

std::vector<std::uint8_t> validVoxels(const DenseVolume& volume) {
  const Dims& dims = volume.grid.dims;
  std::vector<std::uint8_t> valid(volume.values.size());
  parallelFor(dims.z, 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      for (int j = 0; j < dims.y; ++j) {
        std::uint8_t* row = valid.data() + volume.grid.index(0, j, k);
        for (int i = 0; i < dims.x; ++i) row[i] = volume.isMasked(i, j, k) ? 0 : 1;
      }
    }
  });
  return valid;
}

void checkVolumes(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes) {
  for (const DenseVolume* volume : volumes) {
    checkVolume(*volume, {path.string()});
    if (volume->grid != volumes.front()->grid) {
      throw Error(ErrorCode::bad_input, {path.string()},
                  "the volumes " + volumes.front()->info.quantity + " and " + volume->info.quantity +
                      " are on different grids; a .vti file has one");
    }
  }
}

/// Description of a volume for its array in the field data. Blanks at the end make the length independent of
/// the range, so that setVtiRange() can replace the text in place.
std::string descriptionText(const Json& description) {
  constexpr std::size_t kMaxRangeCharacters =
      4 * 2 * 24;  // two doubles, up to four characters for each of theirs
  const auto lengthOf = [](const Json& json) { return characterNumbers(json.dump()).size(); };
  std::string text = dumpJson(description);
  text.pop_back();
  const std::size_t range_characters =
      lengthOf(description["range_min"]) + lengthOf(description["range_max"]);
  return characterNumbers(text) + std::string(kMaxRangeCharacters - range_characters, ' ');
}

void addFieldData(pugi::xml_node image, const std::vector<const DenseVolume*>& volumes) {
  pugi::xml_node field = image.append_child("FieldData");
  const auto addArray = [&](const char* element, const char* type, const std::string& name,
                            const std::string& text) {
    pugi::xml_node array = field.append_child(element);
    array.append_attribute("type") = type;
    array.append_attribute("Name") = name.c_str();
    array.append_attribute("NumberOfTuples") = 1;
    array.append_attribute("format") = "ascii";
    array.text() = text.c_str();
  };
  addArray("DataArray", "Float64", "TimeValue", numberText(volumes.front()->info.time_s));
  for (const DenseVolume* volume : volumes) {
    addArray("Array", "String", "emscape:" + volume->info.quantity, descriptionText(toJson(*volume, false)));
  }
}

/// All before the first byte of the appended data.
std::string headText(const std::vector<const DenseVolume*>& volumes, const std::vector<Appended>& arrays) {
  const Grid& grid = volumes.front()->grid;
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("VTKFile");
  root.append_attribute("type") = "ImageData";
  root.append_attribute("version") = "1.0";
  root.append_attribute("byte_order") = "LittleEndian";
  root.append_attribute("header_type") = "UInt64";
  pugi::xml_node image = root.append_child("ImageData");
  image.append_attribute("WholeExtent") = extentText(grid.dims).c_str();
  image.append_attribute("Origin") = vectorText(grid.first_center_m).c_str();
  image.append_attribute("Spacing") = vectorText(grid.spacing_m).c_str();
  addFieldData(image, volumes);
  pugi::xml_node piece = image.append_child("Piece");
  piece.append_attribute("Extent") = extentText(grid.dims).c_str();
  pugi::xml_node points = piece.append_child("PointData");
  points.append_attribute("Scalars") = volumes.front()->info.quantity.c_str();
  unsigned long long offset = 0;
  for (const Appended& array : arrays) {
    pugi::xml_node node = points.append_child("DataArray");
    node.append_attribute("type") = array.type;
    node.append_attribute("Name") = array.name.c_str();
    node.append_attribute("format") = "appended";
    node.append_attribute("offset") = offset;
    offset += sizeof(std::uint64_t) + array.size;
  }
  std::ostringstream text;
  document.save(text, "  ");
  const std::string whole = text.str();
  return whole.substr(0, whole.rfind("</VTKFile>")) + "  <AppendedData encoding=\"raw\">\n_";
}

}  // namespace

void writeVti(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes) {
  checkVolumes(path, volumes);
  if (volumes.empty()) throw Error(ErrorCode::bad_input, {path.string()}, "no volume to write");
  std::vector<Appended> arrays;
  std::vector<std::vector<std::int32_t>> indices;
  std::vector<std::vector<std::uint8_t>> masks;
  indices.reserve(volumes.size());
  masks.reserve(volumes.size());
  bool one_mask = true;
  for (const DenseVolume* volume : volumes) {
    const bool categorical = volume->info.categorical;
    if (categorical) indices.push_back(toIndices(*volume, {path.string()}));
    const void* bytes = categorical ? static_cast<const void*>(indices.back().data()) : volume->values.data();
    arrays.push_back(
        {volume->info.quantity, categorical ? "Int32" : "Float32", bytes, volume->values.size() * 4});
    one_mask = one_mask && volume->first_valid_k == volumes.front()->first_valid_k;
  }
  for (const DenseVolume* volume : volumes) {
    if (volume->first_valid_k.empty()) continue;
    masks.push_back(validVoxels(*volume));
    arrays.push_back({one_mask ? "valid" : "valid:" + volume->info.quantity, "UInt8", masks.back().data(),
                      masks.back().size()});
    if (one_mask) break;
  }
  const std::string head = headText(volumes, arrays);
  writeWhole(path, [&](std::ostream& stream) {
    stream << head;
    for (const Appended& array : arrays) {
      stream.write(reinterpret_cast<const char*>(&array.size), sizeof(array.size));
      stream.write(static_cast<const char*>(array.bytes), static_cast<std::streamsize>(array.size));
    }
    stream << "\n  </AppendedData>\n</VTKFile>\n";
  });
}

void setVtiRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges) {
  const VtkXmlFile file(path, "ImageData");
  std::vector<FilePatch> patches;
  for (const StoredRange& range : ranges) {
    const std::string before = file.fieldText("emscape:" + range.quantity);
    if (before.empty()) failNoSuchQuantity(path, range.quantity);
    Json description = parseJson(spelledText(before), path.string());
    description["range_min"] = numberToJson(range.min);
    description["range_max"] = numberToJson(range.max);
    const std::string after = descriptionText(description);
    if (after.size() != before.size())
      file.fail("the text that describes " + range.quantity + " has another length");
    patches.push_back({file.headOffsetOf(before), after});
  }
  patchFile(path, patches);
}

void writePvd(const std::filesystem::path& path, const std::vector<PvdEntry>& entries) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("VTKFile");
  root.append_attribute("type") = "Collection";
  root.append_attribute("version") = "0.1";
  root.append_attribute("byte_order") = "LittleEndian";
  pugi::xml_node collection = root.append_child("Collection");
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (const PvdEntry& entry : entries) {
    const std::filesystem::path beside = entry.file.lexically_relative(folder);
    const bool below = !beside.empty() && *beside.begin() != "..";
    pugi::xml_node node = collection.append_child("DataSet");
    node.append_attribute("timestep") = numberText(entry.time_s).c_str();
    node.append_attribute("part") = 0;
    node.append_attribute("file") = (below ? beside : entry.file).generic_string().c_str();
  }
  writeWhole(path, [&](std::ostream& stream) { document.save(stream, "  "); });
}

}  // namespace emscape::volume

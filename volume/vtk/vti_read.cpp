#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>

#include "base/memory.h"
#include "emscape/volume/statistics.h"
#include "volume/description_check.h"
#include "volume/foreign.h"
#include "volume/volume_json.h"
#include "volume/voxel_type.h"
#include "volume/vtk/vti.h"
#include "volume/vtk/vtk_xml.h"

namespace emscape::volume {
namespace {

constexpr char kMask[] = "valid";

template <class Number, std::size_t count>
std::array<Number, count> numbers(const VtkXmlFile& file, const pugi::xml_node& node, const char* attribute) {
  std::istringstream text(node.attribute(attribute).value());
  text.imbue(std::locale::classic());
  std::array<Number, count> values{};
  for (Number& value : values) {
    if (!(text >> value)) {
      file.fail(std::string(attribute) + "=\"" + node.attribute(attribute).value() +
                "\": " + std::to_string(count) + " numbers are needed");
    }
  }
  return values;
}

std::optional<VoxelType> voxelTypeOf(const std::string& vtk_type) {
  static const std::map<std::string, VoxelType> by_name = {
      {"Int8", VoxelType::int8},       {"UInt8", VoxelType::uint8},    {"Int16", VoxelType::int16},
      {"UInt16", VoxelType::uint16},   {"Int32", VoxelType::int32},    {"UInt32", VoxelType::uint32},
      {"Float32", VoxelType::float32}, {"Float64", VoxelType::float64}};
  const auto found = by_name.find(vtk_type);
  if (found == by_name.end()) return std::nullopt;
  return found->second;
}

/// True if the places differ by less than 1e-6 of the spacing: programs write fewer digits.
bool isSamePlace(const Grid& a, const Grid& b) {
  const auto agrees = [](double spacing_a_m, double spacing_b_m, double first_a_m, double first_b_m) {
    const double tolerance_m = 1e-6 * spacing_a_m;
    return std::abs(spacing_a_m - spacing_b_m) <= tolerance_m &&
           std::abs(first_a_m - first_b_m) <= tolerance_m;
  };
  return agrees(a.spacing_m.x, b.spacing_m.x, a.first_center_m.x, b.first_center_m.x) &&
         agrees(a.spacing_m.y, b.spacing_m.y, a.first_center_m.y, b.first_center_m.y) &&
         agrees(a.spacing_m.z, b.spacing_m.z, a.first_center_m.z, b.first_center_m.z);
}

/// A volume without values and mask.
struct VtiDescription {
  DenseVolume volume;
  bool is_ours = false;                ///< by metadata of this array; else the range is not known yet
  const char* why_not_ours = nullptr;  ///< for copied metadata: how they differ
};

class VtiFile {
 public:
  explicit VtiFile(const std::filesystem::path& path) : file_(path, "ImageData"), path_(path.string()) {
    image_ = file_.root().child("ImageData");
    const pugi::xml_node piece = image_.child("Piece");
    if (!piece || piece.next_sibling("Piece")) file_.fail("image data in one piece can be read");
    arrays_ = piece.child("PointData");
    cells_ = !arrays_.child("DataArray");
    if (cells_) arrays_ = piece.child("CellData");
    grid_ = gridOf(piece);
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const pugi::xml_node& array : arrays_.children("DataArray")) {
      const std::string name = array.attribute("Name").value();
      if (name != kMask && name.rfind(std::string(kMask) + ":", 0) != 0) names.push_back(name);
    }
    if (names.empty()) file_.fail("no array of voxels in it");
    return names;
  }

  VtiDescription describe(const std::string& name) const {
    VtiDescription description;
    DenseVolume& volume = description.volume;
    const std::string json = file_.fieldText("emscape:" + name);
    if (!json.empty()) {
      volume = fromJson(parseJson(json, path_), path_);
      if (volume.grid.dims != grid_.dims) {
        description.why_not_ours = "the image has other dims than in its metadata";
      } else if (!isSamePlace(grid_, volume.grid)) {
        description.why_not_ours = "the image has another place or spacing than in its metadata";
      } else {
        description.is_ours = true;
        return description;
      }
    }
    volume = DenseVolume();
    volume.grid = grid_;
    volume.info.quantity = name.empty() ? kUnnamedArray : name;
    volume.info.floor = kNoFloor;
    const std::optional<double> time_s = file_.timeValue();
    volume.info.time_s = time_s.value_or(0);
    volume.info.has_time = time_s.has_value();
    checkTime(volume.info.time_s, "TimeValue", {path_});
    return description;
  }

  DenseVolume read(const std::string& name, VtiDescription description) const {
    DenseVolume& volume = description.volume;
    volume.values = valuesOf(arrayNamed(name));
    readMask(volume, name);
    checkVolume(volume, {path_});
    if (!description.is_ours) setRangeFromValues(volume);
    return std::move(volume);
  }

  /// A text for warnings, if there are arrays that the format does not read.
  std::string omission() const {
    std::string names;
    if (!cells_) {
      for (const pugi::xml_node& array : image_.child("Piece").child("CellData").children("DataArray"))
        names += (names.empty() ? "cell data " : ", ") + arrayName(array);
    }
    return names;
  }

 private:
  Grid gridOf(const pugi::xml_node& piece) const {
    const auto extent = numbers<int, 6>(file_, image_, "WholeExtent");
    if (numbers<int, 6>(file_, piece, "Extent") != extent) file_.fail("image data in one piece can be read");
    const auto origin = numbers<double, 3>(file_, image_, "Origin");
    const auto spacing = numbers<double, 3>(file_, image_, "Spacing");
    Grid grid;
    const int more = cells_ ? 0 : 1;
    int counts[3];
    double first[3];
    for (int axis = 0; axis < 3; ++axis) {
      const long long count = static_cast<long long>(extent[2 * axis + 1]) - extent[2 * axis] + more;
      counts[axis] = static_cast<int>(std::clamp<long long>(count, 0, INT32_MAX));
      first[axis] = origin[axis] + (extent[2 * axis] + (cells_ ? 0.5 : 0.0)) * spacing[axis];
    }
    grid.dims = {counts[0], counts[1], counts[2]};
    grid.spacing_m = {spacing[0], spacing[1], spacing[2]};
    grid.first_center_m = {first[0], first[1], first[2]};
    checkGrid(grid, "", {path_});
    if (image_.attribute("Direction")) {
      checkAxes(numbers<double, 9>(file_, image_, "Direction"), {1, 1, 1}, "", {path_});
    }
    return grid;
  }

  pugi::xml_node arrayNamed(const std::string& name) const {
    for (const pugi::xml_node& array : arrays_.children("DataArray")) {
      if (name == array.attribute("Name").value()) return array;
    }
    return {};
  }

  UnsetVector<float> valuesOf(const pugi::xml_node& array) const {
    const std::string name = array.attribute("Name").value();
    const int components = array.attribute("NumberOfComponents").as_int(1);
    if (components != 1) {
      file_.fail("array " + name + " has " + std::to_string(components) + " components; one can be read");
    }
    const std::optional<VoxelType> type = voxelTypeOf(array.attribute("type").value());
    if (!type)
      file_.fail("array " + name + " is of type " + array.attribute("type").value() +
                 ", which cannot be read");
    const auto count = static_cast<std::uint64_t>(grid_.dims.count());
    requireMemory({"array " + name + " of " + std::to_string(count) + " values",
                   count * (static_cast<std::uint64_t>(bytesOf(*type)) + sizeof(float)), "another file"},
                  {path_});
    const std::vector<std::uint8_t> bytes =
        file_.arrayBytes(array, count * static_cast<std::uint64_t>(bytesOf(*type)));
    return toFloats(bytes.data(), count, *type, file_.bigEndian());
  }

  void readMask(DenseVolume& volume, const std::string& name) const {
    pugi::xml_node array = arrayNamed(std::string(kMask) + ":" + name);
    if (!array) array = arrayNamed(kMask);
    if (!array) return;
    const UnsetVector<float> valid = valuesOf(array);
    const Dims& dims = grid_.dims;
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) {
        int k = 0;
        while (k < dims.z && valid[static_cast<std::size_t>(grid_.index(i, j, k))] == 0) ++k;
        volume.first_valid_k.push_back(static_cast<std::uint16_t>(k));
      }
    }
  }

  VtkXmlFile file_;
  std::string path_;
  pugi::xml_node image_;
  pugi::xml_node arrays_;
  bool cells_ = false;  ///< the arrays are cell data
  Grid grid_;
};

/// The time of a series' step; 0 if it has none.
double timestepOf(const pugi::xml_node& node, const std::filesystem::path& path) {
  const pugi::xml_attribute attribute = node.attribute("timestep");
  if (!attribute) return 0;
  const std::string_view text = attribute.value();
  const std::string name = "timestep=\"" + std::string(text) + "\"";
  std::string_view rest = text;
  const std::optional<double> time_s = leadingNumber(text, &rest);
  if (!time_s || rest.find_first_not_of(' ') != std::string_view::npos) {
    throw Error(ErrorCode::bad_input, {path.string()}, name + " is not a number of seconds");
  }
  checkTime(*time_s, name + ":", {path.string()});
  return *time_s;
}

}  // namespace

DenseVolume readVti(const std::filesystem::path& path, const std::string& array_name) {
  const VtiFile file(path);
  std::vector<std::string> names = file.names();
  if (!array_name.empty())
    names = {names[indexOfName(names, array_name, kUnnamedArray, "array", path.string())]};
  std::vector<DenseVolume> volumes = readableOf(path.string(), names, 1, [&](const std::string& name) {
    VtiDescription description = file.describe(name);
    if (description.why_not_ours)
      warnOfCopiedMetadata(path.string(), "array " + name, description.why_not_ours);
    return file.read(name, std::move(description));
  });
  return std::move(volumes.front());
}

std::vector<DenseVolume> describeVti(const std::filesystem::path& path) {
  const VtiFile file(path);
  const std::vector<std::string> names = file.names();
  return readableOf(
      path.string(), names, names.size(),
      [&](const std::string& name) {
        VtiDescription description = file.describe(name);
        if (description.is_ours) return std::move(description.volume);
        DenseVolume volume = file.read(name, std::move(description));
        volume.values = {};
        volume.first_valid_k = {};
        return volume;
      },
      file.omission());
}

std::vector<PvdEntry> readPvd(const std::filesystem::path& path) {
  const VtkXmlFile file(path, "Collection");
  std::vector<PvdEntry> entries;
  std::map<double, std::string> parts;  // by time
  for (const pugi::xml_node& node : file.root().child("Collection").children("DataSet")) {
    const std::filesystem::path name = node.attribute("file").value();
    if (name.empty()) file.fail("a DataSet names no file");
    const double time_s = timestepOf(node, path);
    const std::string part = node.attribute("part").as_string("0");
    const auto [other, is_first] = parts.emplace(time_s, part);
    if (!is_first && other->second != part) {
      file.fail("timestep=\"" + std::string(node.attribute("timestep").value()) + "\" has the parts " +
                other->second + " and " + part + "; series of one part can be read");
    }
    entries.push_back({time_s, path.parent_path() / name});
  }
  if (entries.empty()) file.fail("the series has no file");
  return entries;
}

}  // namespace emscape::volume

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>

#include "emscape/volume/mesh_file.h"
#include "volume/description_check.h"
#include "volume/volume_json.h"
#include "volume/voxel_type.h"
#include "volume/vtk_xml.h"

namespace emscape::volume {
namespace {

/// Copies numbers out of a file's bytes.
template <class Stored, class To>
std::vector<To> copied(const std::vector<std::uint8_t>& bytes, bool big_endian) {
  std::vector<To> numbers(bytes.size() / sizeof(Stored));
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    std::uint8_t digits[sizeof(Stored)];
    std::memcpy(digits, bytes.data() + n * sizeof(Stored), sizeof(Stored));
    if (big_endian) std::reverse(digits, digits + sizeof(Stored));
    Stored number;
    std::memcpy(&number, digits, sizeof(Stored));
    numbers[n] = static_cast<To>(number);
  }
  return numbers;
}

class VtuFile {
 public:
  explicit VtuFile(const std::filesystem::path& path)
      : file_(path, "UnstructuredGrid"), path_(path.string()) {
    piece_ = file_.root().child("UnstructuredGrid").child("Piece");
    if (!piece_ || piece_.next_sibling("Piece")) file_.fail("an unstructured grid in one piece can be read");
    points_ = countOf("NumberOfPoints", kMaxMeshPoints);
    cells_ = countOf("NumberOfCells", kMaxMeshCells);
  }

  /// Names of the arrays of one component in the point data.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const pugi::xml_node& array : piece_.child("PointData").children("DataArray")) {
      const std::string name = array.attribute("Name").value();
      // vtkGhostType and similar arrays mark points for VTK's own use.
      const bool is_field = array.attribute("NumberOfComponents").as_int(1) == 1 && name.rfind("vtk", 0) != 0;
      if (is_field) names.push_back(name);
    }
    if (names.empty()) {
      file_.fail(piece_.child("CellData").child("DataArray")
                     ? "no point data of one component in it; cell data are not read"
                     : "no point data of one component in it");
    }
    return names;
  }

  TetrahedralMesh mesh() const {
    TetrahedralMesh mesh;
    const pugi::xml_node array = piece_.child("Points").child("DataArray");
    if (!array || array.attribute("NumberOfComponents").as_int(1) != 3) {
      file_.fail("Points: an array of three components is needed");
    }
    const std::vector<double> numbers = floats(array, 3 * points_);
    mesh.points_m.resize(points_);
    for (std::size_t p = 0; p < mesh.points_m.size(); ++p)
      mesh.points_m[p] = {numbers[3 * p], numbers[3 * p + 1], numbers[3 * p + 2]};
    checkTypes();
    const std::vector<std::int64_t> corners = integers(cellArray("connectivity"), 4 * cells_);
    mesh.cells.resize(cells_);
    for (std::size_t n = 0; n < corners.size(); ++n) {
      const bool is_point = corners[n] >= 0 && corners[n] < static_cast<std::int64_t>(points_);
      if (!is_point) {
        file_.fail("cell " + std::to_string(n / 4) + ": point " + std::to_string(corners[n]) +
                   ": must be 0.." + std::to_string(static_cast<long long>(points_) - 1));
      }
      mesh.cells[n / 4][n % 4] = static_cast<std::int32_t>(corners[n]);
    }
    return mesh;
  }

  /// A field without values, on a mesh that has only a frame. @param ours true if the file describes it
  MeshField describe(const std::string& name, bool& ours) const {
    const std::string json = spelledText(file_.fieldText("emscape:" + name));
    ours = !json.empty();
    if (ours) return meshFieldFromJson(parseJson(json, path_), path_);
    MeshField field;
    field.mesh = std::make_shared<TetrahedralMesh>();
    field.info.quantity = name.empty() ? "scalars" : name;
    field.info.floor = kNoFloor;
    const std::optional<double> time_s = file_.timeValue();
    field.info.time_s = time_s.value_or(0);
    field.info.has_time = time_s.has_value();
    checkTime(field.info.time_s, "TimeValue", {path_});
    return field;
  }

  std::vector<float> values(const std::string& name) const {
    for (const pugi::xml_node& array : piece_.child("PointData").children("DataArray")) {
      if (name == array.attribute("Name").value()) {
        const std::vector<double> numbers = floats(array, points_);
        return {numbers.begin(), numbers.end()};
      }
    }
    file_.fail("no array \"" + name + "\"");
  }

  [[noreturn]] void fail(const std::string& what) const { file_.fail(what); }

 private:
  std::uint64_t countOf(const char* attribute, long long most) const {
    const std::string text = piece_.attribute(attribute).value();
    const bool digits =
        !text.empty() && text.size() < 19 &&
        std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
    if (!digits || std::stoll(text) < 1 || std::stoll(text) > most) {
      file_.fail(std::string(attribute) + "=\"" + text + "\": must be 1.." + std::to_string(most));
    }
    return static_cast<std::uint64_t>(std::stoll(text));
  }

  pugi::xml_node cellArray(const char* name) const {
    for (const pugi::xml_node& array : piece_.child("Cells").children("DataArray")) {
      if (std::string(name) == array.attribute("Name").value()) return array;
    }
    file_.fail(std::string("Cells: there is no array ") + name);
  }

  /// Every cell is a tetrahedron.
  void checkTypes() const {
    const std::vector<std::int64_t> types = integers(cellArray("types"), cells_);
    const auto other =
        std::find_if(types.begin(), types.end(), [](auto type) { return type != kVtkTetrahedron; });
    if (other != types.end()) {
      file_.fail("cell " + std::to_string(other - types.begin()) + " is of VTK type " +
                 std::to_string(*other) + "; tetrahedra (10) can be read");
    }
    const std::vector<std::int64_t> offsets = integers(cellArray("offsets"), cells_);
    for (std::size_t n = 0; n < offsets.size(); ++n) {
      if (offsets[n] != 4 * static_cast<std::int64_t>(n + 1)) {
        file_.fail("cell " + std::to_string(n) + ": offset " + std::to_string(offsets[n]) + ": must be " +
                   std::to_string(4 * (n + 1)) + ", as a tetrahedron has four points");
      }
    }
  }

  template <class To>
  std::vector<To> numbers(const pugi::xml_node& array, std::uint64_t count) const {
    const std::string type = array.attribute("type").value();
    const bool big = file_.bigEndian();
    const auto bytes = [&](std::uint64_t size) { return file_.arrayBytes(array, count * size); };
    if (type == "Int64") return copied<std::int64_t, To>(bytes(8), big);
    if (type == "UInt64") return copied<std::uint64_t, To>(bytes(8), big);
    if (type == "Int32") return copied<std::int32_t, To>(bytes(4), big);
    if (type == "UInt32") return copied<std::uint32_t, To>(bytes(4), big);
    if (type == "Int16") return copied<std::int16_t, To>(bytes(2), big);
    if (type == "UInt16") return copied<std::uint16_t, To>(bytes(2), big);
    if (type == "Int8") return copied<std::int8_t, To>(bytes(1), big);
    if (type == "UInt8") return copied<std::uint8_t, To>(bytes(1), big);
    if constexpr (std::is_floating_point_v<To>) {
      if (type == "Float32") return copied<float, To>(bytes(4), big);
      if (type == "Float64") return copied<double, To>(bytes(8), big);
    }
    file_.fail("array " + arrayName(array) + " is of type \"" + type + "\", which cannot be read here");
  }
  std::vector<double> floats(const pugi::xml_node& array, std::uint64_t count) const {
    return numbers<double>(array, count);
  }
  std::vector<std::int64_t> integers(const pugi::xml_node& array, std::uint64_t count) const {
    return numbers<std::int64_t>(array, count);
  }

  VtkXmlFile file_;
  std::string path_;
  pugi::xml_node piece_;
  std::uint64_t points_ = 0, cells_ = 0;
};

}  // namespace

MeshFile readMesh(const std::filesystem::path& path, const std::string& name) {
  const VtuFile file(path);
  const SourceLocation location{path.string()};
  std::vector<std::string> names = file.names();
  if (!name.empty()) {
    std::string list;
    for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      file.fail("no array \"" + name + "\"; the file holds " + list);
    }
    names = {name};
  }
  MeshFile result;
  auto mesh = std::make_shared<TetrahedralMesh>(file.mesh());
  for (const std::string& each : names) {
    bool ours = false;
    MeshField field = file.describe(each, ours);
    mesh->frame = field.mesh->frame;
    mesh->georeferenced = field.mesh->georeferenced;
    field.mesh = mesh;
    field.values = file.values(each);
    checkMeshField(field, location);
    if (!ours) setRangeFromValues(field);
    result.fields.push_back(std::move(field));
  }
  result.inverted_cells = orientCells(*mesh, location);
  result.faces = std::make_shared<MeshFaces>(facesOf(*mesh, location));
  result.touching_faces = touchingFaces(*mesh, *result.faces, location);
  result.mesh = std::move(mesh);
  return result;
}

std::vector<VolumeInfo> listMesh(const std::filesystem::path& path) {
  const VtuFile file(path);
  std::vector<VolumeInfo> infos;
  bool ours = false;
  for (const std::string& name : file.names()) infos.push_back(file.describe(name, ours).info);
  return infos;
}

}  // namespace emscape::volume

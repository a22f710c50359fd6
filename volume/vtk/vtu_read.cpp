#include <algorithm>
#include <cctype>
#include <cmath>

#include "volume/description_check.h"
#include "volume/foreign.h"
#include "volume/mesh/mesh_file.h"
#include "volume/volume_json.h"
#include "volume/vtk/vtk_xml.h"

namespace emscape::volume {
namespace {

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
    const std::string json = file_.fieldText("emscape:" + name);
    ours = !json.empty();
    if (ours) return meshFieldFromJson(parseJson(json, path_), path_);
    MeshField field;
    field.mesh = std::make_shared<TetrahedralMesh>();
    field.info.quantity = name.empty() ? kUnnamedArray : name;
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

  std::vector<double> floats(const pugi::xml_node& array, std::uint64_t count) const {
    return file_.numbers<double>(array, count);
  }
  std::vector<std::int64_t> integers(const pugi::xml_node& array, std::uint64_t count) const {
    return file_.numbers<std::int64_t>(array, count);
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
  if (!name.empty()) names = {names[indexOfName(names, name, kUnnamedArray, "array", location.file)]};
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

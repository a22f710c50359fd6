#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "base/text/utf8.h"
#include "volume/mesh/mesh_file.h"
#include "volume/volume_json.h"
#include "volume/vtk/vtk_xml.h"
#include "volume/vtk/vtk_xml_write.h"

namespace emscape::volume {
namespace {

void checkFields(const std::filesystem::path& path, const std::vector<const MeshField*>& fields) {
  const SourceLocation location{path.string()};
  if (fields.empty()) throw Error(ErrorCode::bad_input, location, "no field to write");
  std::set<std::string> names;
  for (const MeshField* field : fields) {
    checkMeshField(*field, location);
    if (field->mesh != fields.front()->mesh) {
      throw Error(ErrorCode::bad_input, location,
                  "the fields " + fields.front()->info.quantity + " and " + field->info.quantity +
                      " are on different meshes; a .vtu file has one");
    }
    if (!names.insert(field->info.quantity).second) {
      throw Error(ErrorCode::bad_input, location, "two fields of " + field->info.quantity);
    }
  }
}

/// The values of a categorical field as whole numbers; NaN becomes the floor.
std::vector<std::int32_t> indicesOf(const MeshField& field) {
  std::vector<std::int32_t> indices;
  for (const float value : field.values) {
    indices.push_back(static_cast<std::int32_t>(std::lround(std::isnan(value) ? field.info.floor : value)));
  }
  return indices;
}

}  // namespace

bool isMeshFile(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return ending == ".vtu";
}

void writeMesh(const std::filesystem::path& path, const std::vector<const MeshField*>& fields) {
  checkFields(path, fields);
  const TetrahedralMesh& mesh = *fields.front()->mesh;
  std::vector<std::vector<std::int32_t>> indices;
  std::vector<std::int64_t> offsets(mesh.cells.size());
  for (std::size_t n = 0; n < offsets.size(); ++n) offsets[n] = 4 * static_cast<std::int64_t>(n + 1);
  const std::vector<std::uint8_t> types(mesh.cells.size(), kVtkTetrahedron);

  pugi::xml_document document;
  pugi::xml_node grid = appendVtkRoot(document, "UnstructuredGrid");
  std::vector<std::pair<std::string, nlohmann::ordered_json>> descriptions;
  for (const MeshField* field : fields) descriptions.emplace_back(field->info.quantity, toJson(*field));
  appendFieldData(grid, fields.front()->info.time_s, FieldTextType::uint8, descriptions);
  pugi::xml_node piece = grid.append_child("Piece");
  piece.append_attribute("NumberOfPoints") = static_cast<unsigned long long>(mesh.points_m.size());
  piece.append_attribute("NumberOfCells") = static_cast<unsigned long long>(mesh.cells.size());
  AppendedArrays appended;
  pugi::xml_node values = piece.append_child("PointData");
  values.append_attribute("Scalars") = xmlCharacters(fields.front()->info.quantity).c_str();
  for (const MeshField* field : fields) {
    const bool categorical = field->info.categorical;
    if (categorical) indices.push_back(indicesOf(*field));
    const void* bytes = categorical ? static_cast<const void*>(indices.back().data()) : field->values.data();
    appended.add(values,
                 {field->info.quantity, categorical ? "Int32" : "Float32", bytes, field->values.size() * 4});
  }
  static_assert(sizeof(Vec3d) == 3 * sizeof(double), "points are written as they lie in memory");
  appended.add(piece.append_child("Points"),
               {"Points", "Float64", mesh.points_m.data(), mesh.points_m.size() * sizeof(Vec3d), 3});
  pugi::xml_node cells = piece.append_child("Cells");
  appended.add(cells, {"connectivity", "Int32", mesh.cells.data(), mesh.cells.size() * 16});
  appended.add(cells, {"offsets", "Int64", offsets.data(), offsets.size() * 8});
  appended.add(cells, {"types", "UInt8", types.data(), types.size()});
  appended.write(path, document);
}

void setMeshRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges) {
  setVtkRange(path, "UnstructuredGrid", ranges);
}

}  // namespace emscape::volume

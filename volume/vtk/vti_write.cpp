#include <pugixml.hpp>

#include "base/files/whole_file.h"
#include "base/text/utf8.h"
#include "emscape/base/parallel.h"
#include "volume/stored_range.h"
#include "volume/volume_json.h"
#include "volume/vtk/vti.h"
#include "volume/vtk/vtk_xml_write.h"

namespace emscape::volume {
namespace {

std::string vectorText(const Vec3d& vector) {
  return numberText(vector.x) + " " + numberText(vector.y) + " " + numberText(vector.z);
}

std::string extentText(const Dims& dims) {
  return "0 " + std::to_string(dims.x - 1) + " 0 " + std::to_string(dims.y - 1) + " 0 " +
         std::to_string(dims.z - 1);
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

}  // namespace

void writeVti(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes) {
  checkVolumes(path, volumes);
  if (volumes.empty()) throw Error(ErrorCode::bad_input, {path.string()}, "no volume to write");
  std::vector<AppendedArray> arrays;
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
  pugi::xml_document document;
  const Grid& grid = volumes.front()->grid;
  pugi::xml_node image = appendVtkRoot(document, "ImageData");
  image.append_attribute("WholeExtent") = extentText(grid.dims).c_str();
  image.append_attribute("Origin") = vectorText(grid.first_center_m).c_str();
  image.append_attribute("Spacing") = vectorText(grid.spacing_m).c_str();
  std::vector<std::pair<std::string, nlohmann::ordered_json>> descriptions;
  for (const DenseVolume* volume : volumes)
    descriptions.emplace_back(volume->info.quantity, toJson(*volume, false));
  appendFieldData(image, volumes.front()->info.time_s, FieldTextType::string, descriptions);
  pugi::xml_node piece = image.append_child("Piece");
  piece.append_attribute("Extent") = extentText(grid.dims).c_str();
  pugi::xml_node points = piece.append_child("PointData");
  points.append_attribute("Scalars") = xmlCharacters(volumes.front()->info.quantity).c_str();
  AppendedArrays appended;
  for (const AppendedArray& array : arrays) appended.add(points, array);
  appended.write(path, document);
}

void setVtiRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges) {
  setVtkRange(path, "ImageData", ranges);
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
  writeWhole(
      path, [&](std::ostream& stream) { document.save(stream, "  "); }, Replaces::any);
}

}  // namespace emscape::volume

/// Fields on tetrahedra as files: VTK unstructured grids (.vtu), for example for ParaView.
///
/// One piece; cells of VTK type 10 (tetrahedra). Point data: one array per quantity, named by it, Float32, or
/// Int32 for categorical ones; NaN (of categorical ones: the floor) where no field is known. Points are
/// Float64. Appended raw, little endian. Field data as in .vti: TimeValue, and for each quantity a string
/// `emscape:NAME` with its description as JSON, frame included.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "emscape/volume/format/file.h"
#include "emscape/volume/mesh/mesh.h"

namespace emscape::volume {

/// True for names that end in .vtu.
bool isMeshFile(const std::filesystem::path& path);

/// Writes fields of one mesh, atomically. @throws Error (bad_input) for no field, different meshes, two
/// fields of one name, or a malformed field; (other) if writing fails
void writeMesh(const std::filesystem::path& path, const std::vector<const MeshField*>& fields);

/// Contents of a file.
struct MeshFile {
  std::shared_ptr<const TetrahedralMesh> mesh;
  std::shared_ptr<const MeshFaces> faces;
  long long inverted_cells = 0;  ///< in the file; oriented when read
  long long touching_faces = 0;  ///< see touchingFaces()
  std::vector<MeshField> fields;
};

/// Reads files of writeMesh() exactly; from other programs, point data with one component, as text or in
/// binary form (appended or inline, raw or base64, uncompressed or compressed with zlib). The mesh is
/// oriented and checked (orientCells(), facesOf(), touchingFaces()). Sizes are checked against the size of
/// the file before memory is allocated.
/// @param name  of one field; empty: all
/// @throws Error (bad_input), which lists the file's fields if none has that name
MeshFile readMesh(const std::filesystem::path& path, const std::string& name = "");

/// Names and descriptions of the fields. The range of an array that writeMesh() did not write is not known:
/// 0, 0.
std::vector<VolumeInfo> listMesh(const std::filesystem::path& path);

/// setStoredRange() for a file that writeMesh() wrote.
void setMeshRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges);

}  // namespace emscape::volume

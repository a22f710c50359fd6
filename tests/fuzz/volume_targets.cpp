// Readers of volumes and of fields on meshes.
#include "emscape/base/error.h"
#include "emscape/volume/format/file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"
#include "tests/volume/sample_volumes.h"
#include "volume/format/raw.h"
#include "volume/mesh/mesh_file.h"
#include "volume/vtk/vti.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

/// Calls a reader even if the previous one has thrown.
template <class Read>
void always(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    checkFuzzMessage(error.what());
  }
}

/// Lists and reads a file, and changes its range in place.
void readVolumeFile(const fs::path& file, const std::string&) {
  always([&] { volume::listVolume(file); });
  always([&] { volume::readVolume(file); });
  always([&] { volume::readVolume(file, "power_density_dbwm2"); });
  volume::setStoredRange(file, {{"power_density_dbwm2", -1, 1}});
}

/// A sidecar: the volume is the file without the ending .json.
void readBySidecar(const fs::path& file, const std::string& bytes) {
  readVolumeFile(fs::path(file).replace_extension(), bytes);
}

void readMeshFile(const fs::path& file, const std::string&) {
  always([&] { volume::listMesh(file); });
  always([&] { volume::readMesh(file); });
  volume::setMeshRange(file, {{"density", -1, 1}});
}

/// The output of writeVolumes(). @param name  with the format's extension  @param wanted  one of the files
/// written
std::string written(const volume::DenseVolume& volume, const std::string& name, const std::string& wanted) {
  const TemporaryFolder folder;
  volume::writeVolumes(folder / name, {&volume});
  return readFile(folder / wanted);
}

std::vector<volume::DenseVolume> samples() {
  return {volume::test::fieldVolume({5, 5, 6}), volume::test::categoricalVolume({4, 5, 5}),
          volume::test::plainVolume({3, 2, 2})};
}

/// The samples in a format. @param sidecar  their descriptions instead of their values
std::vector<std::string> seedsOf(const std::string& format, bool sidecar = false) {
  std::vector<std::string> seeds;
  for (const volume::DenseVolume& sample : samples())
    seeds.push_back(written(sample, "a." + format, "a." + format + (sidecar ? ".json" : "")));
  return seeds;
}

std::vector<std::string> meshSeeds() {
  const TemporaryFolder folder;
  volume::TetrahedralMesh mesh = boxMesh({2, 3, 2}, {-200.25, 0, 100}, {300, 500, 200}, 0.1);
  mesh.frame = {FrameKind::altitude, 36.3, -84.2, 100};
  mesh.georeferenced = true;
  const volume::MeshField field = fieldOn(std::move(mesh), [](const Vec3d& p) { return p.x / 3 + p.z; });
  volume::writeMesh(folder / "a.vtu", {&field});
  return {readFile(folder / "a.vtu"),
          R"(<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="1" NumberOfCells="0"><Points><DataArray type="Float64" NumberOfComponents="3"
format="binary">GAAAAAAAAAAAAPA/AAAAAAAA8D8AAAAAAADwPw==</DataArray></Points></Piece>
</UnstructuredGrid></VTKFile>)"};
}

/// The first sample as PATH, so that a sidecar has a file.
std::function<void(const fs::path&)> volumeOf(const std::string& format) {
  return [format](const fs::path& folder) {
    const volume::DenseVolume sample = samples().front();
    volume::writeVolumes(folder / ("input." + format), {&sample});
  };
}

const FuzzTargetsAdded added({
    {"vti", "input.vti", readVolumeFile,
     [] {
       std::vector<std::string> seeds = seedsOf("vti");
       seeds.emplace_back(
           R"(<VTKFile type="ImageData" byte_order="LittleEndian" header_type="UInt32"><ImageData
WholeExtent="2 3 0 1 0 0" Origin="10 20 30" Spacing="1 2 3"><Piece Extent="2 3 0 1 0 0"><PointData>
<DataArray Name="d" type="UInt8" format="binary">BAAAAAECA/o=</DataArray></PointData></Piece></ImageData>
</VTKFile>)");
       return seeds;
     }},
    {"vtu", "input.vtu", readMeshFile, meshSeeds},
    {"pvd", "input.pvd",
     [](const fs::path& file, const std::string&) {
       always([&] { volume::readPvd(file); });
       volume::seriesOf(file);
     },
     [] {
       const TemporaryFolder folder;
       volume::writePvd(folder / "a.pvd",
                        {{0, folder / "a_0001.vti"}, {1.5, folder / "a_0002.vti"}, {3, "/b/c.vti"}});
       return std::vector<std::string>{readFile(folder / "a.pvd")};
     }},
    {"vdb", "input.vdb", readVolumeFile, [] { return seedsOf("vdb"); }},
    {"nvdb", "input.nvdb", readVolumeFile, [] { return seedsOf("nvdb"); }},
    {"nvdb_json", "input.nvdb.json", readBySidecar, [] { return seedsOf("nvdb", true); }, volumeOf("nvdb")},
    {"raw_json", "input.raw.json", readBySidecar, [] { return seedsOf("raw", true); }, volumeOf("raw")},
    {"raw_name", "",
     [](const fs::path&, const std::string& bytes) {
       if (bytes.find('\0') == std::string::npos) volume::rawLayoutFromName(bytes);
     },
     [] {
       return std::vector<std::string>{"engine_256x256x110_uint8.raw", "a_2x3x4_float32_be.raw"};
     }},
    {"dat", "input.dat", [](const fs::path& file, const std::string&) { volume::readVolume(file); },
     [] { return std::vector<std::string>{std::string("\2\0\1\0\2\0abcdefgh", 14)}; }},
});

}  // namespace
}  // namespace emscape::test

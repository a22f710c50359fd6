#include "playback/series/series_files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/files/file_digest.h"
#include "base/files/own_file.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/playback/series/series_writer.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/format/file.h"
#include "playback/series/file_names.h"
#include "playback/series/series_journal.h"
#include "playback/series/series_state.h"
#include "volume/mesh/mesh_file.h"
#include "volume/vtk/vti.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVtkFormat = "vti";

/// Formats with a JSON sidecar.
bool hasSidecar(const fs::path& file) {
  return file.extension() == ".raw" || file.extension() == ".nvdb";
}

std::string sidecarOf(const std::string& name) {
  return name + ".json";
}

bool holdsFog(const fs::path& file) {
  return file.extension() == ".vdb" || file.extension() == ".nvdb";
}

/// The default transfer function's opacity, of which the greatest becomes 1: a grid that programs which
/// expect a fog draw without settings. Voxels without a field are empty.
volume::DenseVolume fogOf(const volume::DenseVolume& field, const ValueRange& range) {
  volume::DenseVolume fog;
  fog.grid = field.grid;
  fog.first_valid_k = field.first_valid_k;
  fog.info = field.info;
  fog.info.quantity = "density";
  fog.info.unit.clear();
  fog.info.categorical = false;
  fog.info.floor = fog.info.range_min = 0;
  fog.info.range_max = 1;
  fog.info.extra["density_of"] = field.info.quantity;
  const render::TransferFunction look =
      render::defaultTransferFunction(field.info, volume::ValueRange{range.min, range.max});
  double greatest = 0;
  for (const auto& point : look.opacities) greatest = std::max(greatest, point.opacity);
  fog.values.resize(field.values.size());
  parallelFor(field.grid.dims.z, 1, [&](int begin, int end) {
    const auto layer = static_cast<std::size_t>(field.grid.dims.x) * field.grid.dims.y;
    for (std::size_t n = begin * layer; n < end * layer; ++n) {
      const float value = field.values[n];
      const bool is_empty = std::isnan(value) || value <= field.info.floor || greatest == 0;
      fog.values[n] = is_empty ? 0.0F : static_cast<float>(look.opacity(value) / greatest);
    }
  });
  return fog;
}

/// True for the name of a volume or of its sidecar.
bool isVolumeName(fs::path name) {
  if (name.extension() == ".json") name = name.stem();
  const std::string ending = name.extension();
  const std::vector<volume::FileFormat> formats = volume::fileFormats();
  return ending == std::string(".") + kMeshFormat ||
         std::any_of(formats.begin(), formats.end(),
                     [&](const volume::FileFormat& format) { return ending == "." + format.name; });
}

/// The list of the VTK files of a series; empty if it has none.
std::string indexOf(const std::map<std::string, FileDigest>& files) {
  for (const auto& [name, digest] : files) {
    const std::string ending = fs::path(name).extension();
    if (ending == ".vti" || ending == ".vtu") return name.substr(0, name.rfind('_')) + ".pvd";
  }
  return "";
}

}  // namespace

std::vector<std::string> writableFormats() {
  std::vector<std::string> names;
  for (const volume::FileFormat& format : volume::fileFormats()) {
    if (format.writable) names.push_back(format.name);
  }
  return names;
}

SeriesFiles::SeriesFiles(fs::path folder, const std::string& name, const std::vector<std::string>& formats,
                         std::vector<std::string> channels, std::vector<double> times_s,
                         std::shared_ptr<const emfield::TerrainMesh> mesh)
    : folder_(std::move(folder)),
      name_(fileNameOf(name)),
      formats_(formats.begin(), formats.end()),
      channels_(std::move(channels)),
      channel_file_names_(distinctFileNames(channels_)),
      times_s_(std::move(times_s)),
      mesh_(std::move(mesh)) {}

std::vector<SeriesFiles::VolumeFile> SeriesFiles::volumeFilesOf(int step) const {
  std::vector<VolumeFile> files;
  std::vector<volume::FileFormat> formats = volume::fileFormats();
  formats.push_back({kMeshFormat, true, true});
  for (const volume::FileFormat& format : formats) {
    if (formats_.count(format.name) == 0) continue;
    const fs::path file = volume::seriesFile(folder_, name_, step + 1, format.name).filename();
    if (format.several || channels_.size() == 1) {
      files.push_back({file.string(), {}});
      for (std::size_t c = 0; c < channels_.size(); ++c) files.back().channels.push_back(c);
    } else {
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        files.push_back({file.stem().string() + "_" + channel_file_names_[c] + "." + format.name, {c}});
      }
    }
  }
  return files;
}

std::vector<std::string> SeriesFiles::namesOf(int step) const {
  std::vector<std::string> names;
  for (const VolumeFile& file : volumeFilesOf(step)) {
    names.push_back(file.name);
    if (hasSidecar(file.name)) names.push_back(sidecarOf(file.name));
  }
  return names;
}

void SeriesFiles::write(int step, std::vector<volume::Volume> channels, const std::vector<ValueRange>& ranges,
                        const ValueRange* fog_range) const {
  std::vector<std::shared_ptr<const volume::DenseVolume>> on_host;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    volume::VolumeInfo info = channels[c].info();
    info.range_min = ranges[c].empty() ? info.floor : ranges[c].min;
    info.range_max = ranges[c].empty() ? info.floor : ranges[c].max;
    channels[c].setInfo(std::move(info));
    on_host.push_back(channels[c].host());
  }
  std::optional<volume::DenseVolume> fog;
  if (fog_range != nullptr) fog = fogOf(*on_host.front(), *fog_range);
  for (const VolumeFile& file : volumeFilesOf(step)) {
    if (volume::isMeshFile(file.name)) {
      writeOnMesh(file.name, on_host);
      continue;
    }
    std::vector<const volume::DenseVolume*> volumes;
    for (const std::size_t c : file.channels) volumes.push_back(on_host[c].get());
    if (fog && holdsFog(file.name)) volumes.push_back(&*fog);
    volume::writeVolumes(folder_ / file.name, volumes);
  }
}

void SeriesFiles::writeOnMesh(const std::string& name,
                              const std::vector<std::shared_ptr<const volume::DenseVolume>>& channels) const {
  std::vector<volume::MeshField> fields;
  for (const auto& channel : channels) fields.push_back(mesh_->field(*channel));
  std::vector<const volume::MeshField*> each;
  for (const volume::MeshField& field : fields) each.push_back(&field);
  volume::writeMesh(folder_ / name, each);
}

std::set<std::string> SeriesFiles::setRanges(int step, const std::vector<ValueRange>& ranges) const {
  std::set<std::string> changed;
  for (const VolumeFile& file : volumeFilesOf(step)) {
    std::vector<volume::StoredRange> stored;
    for (const std::size_t c : file.channels) {
      if (!ranges[c].empty()) stored.push_back({channels_[c], ranges[c].min, ranges[c].max});
    }
    const auto setRange = volume::isMeshFile(file.name) ? volume::setMeshRange : volume::setStoredRange;
    setRange(folder_ / file.name, stored);
    changed.insert(hasSidecar(file.name) ? sidecarOf(file.name) : file.name);
  }
  return changed;
}

bool SeriesFiles::hasIndex() const {
  return formats_.count(kVtkFormat) != 0 || formats_.count(kMeshFormat) != 0;
}

void SeriesFiles::writeIndex(const std::vector<bool>& finished) const {
  const std::string format = mesh_ ? kMeshFormat : kVtkFormat;
  std::vector<volume::PvdEntry> entries;
  for (std::size_t step = 0; step < finished.size(); ++step) {
    if (!finished[step]) continue;
    entries.push_back(
        {times_s_[step], volume::seriesFile(folder_, name_, static_cast<int>(step) + 1, format)});
  }
  volume::writePvd(folder_ / indexName(), entries);
}

bool SeriesFiles::isReadWithSeries(const fs::path& file) const {
  for (const volume::FileFormat& format : volume::fileFormats()) {
    if (volume::isVolumeFile(file) && volume::formatOf(file).name == format.name) return true;
    if (formats_.count(format.name) != 0) return false;
  }
  return volume::isMeshFile(file);
}

void SeriesFiles::requireNone(const std::vector<fs::path>& inputs) const {
  const std::map<std::string, FileDigest> present = SeriesJournal(folder_).files();
  std::set<std::string> names = ownNames();
  names.insert({indexOf(present), "series.json", "series.steps"});
  for (const auto& [name, digest] : present) names.insert(name);
  for (const fs::path& input : inputs) {
    std::error_code failed;
    const fs::path target = fs::weakly_canonical(fs::absolute(input, failed), failed);
    for (const fs::path& file : {fs::absolute(input, failed), target}) {
      if (fs::equivalent(file.parent_path(), folder_, failed) && names.count(file.filename().string()) != 0) {
        throw Error(
            ErrorCode::usage, {input.string()},
            "is a file of the scenario, and has the name of a file of the series; use another folder");
      }
    }
  }
}

std::set<std::string> SeriesFiles::ownNames() const {
  std::set<std::string> names;
  for (int step = 0; step < static_cast<int>(times_s_.size()); ++step) {
    for (const std::string& name : namesOf(step)) names.insert(name);
  }
  if (hasIndex()) names.insert(indexName());
  return names;
}

void SeriesFiles::requireFree() const {
  std::set<std::string> own = ownNames();
  own.insert({"series.steps", "series.json"});
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    std::error_code ignored;
    const bool is_replaced = own.count(entry.path().filename().string()) != 0;
    // Folders and devices are never replaced; UnfinishedFile names them.
    const bool counts = is_replaced ? entry.is_symlink(ignored) || entry.is_regular_file(ignored)
                                    : entry.is_regular_file(ignored) && isReadWithSeries(entry);
    if (!counts) continue;
    throw Error(
        ErrorCode::usage, {entry.path().string()},
        std::string("is in the folder, which has no description of a series (series.json), and would ") +
            (is_replaced ? "be replaced" : "be read with the series") + "; move it, or use another folder");
  }
}

void SeriesFiles::requireOwnDescription() const {
  std::set<std::string> names = ownNames();
  names.insert({"series.json", "series.steps"});
  for (const std::string& name : names) {
    std::error_code ignored;
    const fs::file_status status = fs::status(folder_ / name, ignored);
    if (!fs::exists(status) || fs::is_regular_file(status)) continue;
    throw Error(ErrorCode::usage, {(folder_ / name).string()},
                "is no file, and the series has a file of that name; move it away, or use another folder");
  }
  requireOwn(folder_ / "series.json");
  if (hasIndex()) requireOwn(folder_ / indexName());
}

void SeriesFiles::requireOwnFilesOf(int step) const {
  for (const std::string& name : namesOf(step)) requireOwn(folder_ / name);
}

fs::perms SeriesFiles::removeOld() const {
  requireOwnDescription();
  const SeriesJournal journal(folder_);
  journal.requireOwn();
  const std::map<std::string, FileDigest> ours = journal.files();
  const std::string index = indexOf(ours);
  const std::set<std::string> replaced = ownNames();
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    std::error_code ignored;  // as of a link to itself
    if (!entry.is_regular_file(ignored)) continue;
    const std::string name = entry.path().filename();
    const auto listed = ours.find(name);
    // A killed process may have set a range that the journal does not list.
    if (listed == ours.end() ? name == index && isOwn(entry)
                             : isVolumeName(name) && (digestOf(entry) == listed->second || isOwn(entry))) {
      files.push_back(entry);
    } else if (replaced.count(name) != 0) {
      requireOwn(entry);
    } else if (isReadWithSeries(entry)) {
      throw Error(
          ErrorCode::usage, {entry.path().string()},
          "is not a file of the present series, and would be read with the new one; remove it, or use "
          "another folder");
    }
  }
  // Last, so that a removal that is interrupted can be repeated.
  for (const char* const name : {"series.steps", "series.json"}) files.push_back(folder_ / name);
  fs::perms permissions = fs::perms::all;
  for (const fs::path& file : files) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_regular_file(status)) permissions &= status.permissions() | fs::perms::owner_all;
    fs::remove(file);
  }
  return permissions;
}

}  // namespace emscape::playback

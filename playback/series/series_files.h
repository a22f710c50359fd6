/// The volume files of a series: names and writing. Internal to the module.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "emscape/emfield/columns/terrain_mesh.h"
#include "emscape/playback/frames/field_series.h"
#include "emscape/volume/volume.h"

namespace emscape::playback {

class SeriesFiles {
 public:
  /// @param name      of the scenario
  /// @param formats   of writableFormats()
  /// @param channels  names, in the order of the volumes
  /// @param mesh      on which fields are written; null: none
  SeriesFiles(std::filesystem::path folder, const std::string& name, const std::vector<std::string>& formats,
              std::vector<std::string> channels, std::vector<double> times_s,
              std::shared_ptr<const emfield::TerrainMesh> mesh = nullptr);

  /// Names in the folder of all files of a step, sidecars included; always in the same order.
  std::vector<std::string> namesOf(int step) const;

  /// Writes a step in every format.
  /// @param ranges  that the files state, one per channel; an empty one is stated as the floor
  /// @param fog_range  of the first channel's colours, for a grid "density"; null: without one
  /// @throws Error (other, device); then there is no file of the failed format
  void write(int step, std::vector<volume::Volume> channels, const std::vector<ValueRange>& ranges,
             const ValueRange* fog_range = nullptr) const;

  /// Changes the ranges in a step's files. @param ranges one per channel; empty ranges are not changed
  /// @return the names of the files that may have changed
  /// @throws Error
  std::set<std::string> setRanges(int step, const std::vector<ValueRange>& ranges) const;

  /// True if writeIndex() has a list of files to write.
  bool hasIndex() const;
  /// Writes the list. @param finished  one per step
  void writeIndex(const std::vector<bool>& finished) const;

  /// @throws Error (usage) if one of the files is in the folder and has the name of a file of this or of the
  /// present series: it would be replaced or removed
  void requireNone(const std::vector<std::filesystem::path>& inputs) const;

  /// For a folder without the description of a series.
  /// @throws Error (usage) if it has a file that this series would replace, or that is read with the series
  void requireFree() const;

  /// For a folder with the description of a series, before it is resumed or replaced.
  /// @throws Error (usage) as requireOwn(), of the description and of the list of files; and for a folder
  /// that has the name of a file
  void requireOwnDescription() const;
  /// @throws Error (usage) as requireOwn(), of the volumes of a step
  void requireOwnFilesOf(int step) const;

  /// Removes the present series from the folder: its description, and the files that its journal lists.
  /// @throws Error (usage) if one of them, or of those that this series writes, is not as it was written, or
  /// a reader of the folder would take another volume as part of this series; then nothing is removed
  /// @return permissions that all of its files had: who may read them does not change
  std::filesystem::perms removeOld() const;

 private:
  std::string indexName() const { return name_ + ".pvd"; }
  /// Names of the files that this series writes, without its description.
  std::set<std::string> ownNames() const;
  /// A volume file of a step and the channels in it.
  struct VolumeFile {
    std::string name;
    std::vector<std::size_t> channels;
  };
  std::vector<VolumeFile> volumeFilesOf(int step) const;
  /// True for a file that volume::seriesOf() of the folder returns besides, or instead of, files of this
  /// series.
  bool isReadWithSeries(const std::filesystem::path& file) const;
  void writeOnMesh(const std::string& name,
                   const std::vector<std::shared_ptr<const volume::DenseVolume>>& channels) const;

  const std::filesystem::path folder_;
  const std::string name_;
  const std::set<std::string> formats_;
  const std::vector<std::string> channels_;
  const std::vector<std::string> channel_file_names_;
  const std::vector<double> times_s_;
  const std::shared_ptr<const emfield::TerrainMesh> mesh_;
};

}  // namespace emscape::playback

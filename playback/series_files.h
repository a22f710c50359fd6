/// The files of a series: which there are, what they are called, and writing them.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "emscape/volume/volume.h"

namespace emscape::app {

class SeriesFiles {
 public:
  /// What can be written.
  static std::vector<std::string> formatNames();

  /// @param formats  of formatNames()
  SeriesFiles(std::filesystem::path folder, const std::string& name, const std::vector<std::string>& formats,
              std::vector<double> times_s);

  /// Writes a step in every format; one thread at a time.
  /// @throws Error (other, device); then no file of the format that failed is there
  void write(int step, const std::vector<volume::Volume>& channels) const;

  /// Removes the files of any series of this name, and series.json, from the folder.
  void removeOld() const;

 private:
  void writeVtkIndex(int last_step) const;

  const std::filesystem::path folder_;
  const std::string name_;
  const std::set<std::string> formats_;
  const std::vector<double> times_s_;
};

}  // namespace emscape::app

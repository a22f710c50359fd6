/// A file that holds all maps of a folder.
#pragma once

#include <filesystem>
#include <memory>

#include "emscape/study/map_folder.h"

namespace emscape::study {

/// Takes the maps one by one. The file is written under a temporary name; destroyed before finish(), it is
/// removed.
class MapCollection {
 public:
  virtual ~MapCollection() = default;
  /// @throws Error (other) naming the file
  virtual void add(const Map& map) = 0;
  /// Completes the file and gives it its name. @throws Error (other) naming the file
  virtual void finish() = 0;
};

/// @param study  outlives the collection
using MakeCollection = std::unique_ptr<MapCollection> (*)(const std::filesystem::path& file,
                                                          const MapStudy& study);

}  // namespace emscape::study

/// A file that contains all maps of a folder.
#pragma once

#include <filesystem>
#include <memory>

#include "study/maps/map_study.h"

namespace emscape::study {

/// Receives the maps one by one. The file is written under a temporary name; it is removed if the object is
/// destroyed before finish().
class MapCollection {
 public:
  virtual ~MapCollection() = default;
  /// @throws Error (other) naming the file
  virtual void add(const Map& map) = 0;
  /// Completes the file and renames it. @throws Error (other) naming the file
  virtual void finish() = 0;
};

/// @param study  outlives the collection
using MakeCollection = std::unique_ptr<MapCollection> (*)(const std::filesystem::path& file,
                                                          const MapStudy& study);

}  // namespace emscape::study

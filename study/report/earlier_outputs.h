/// Files that an earlier run left in a folder of maps.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace emscape::study {

/// The outputs that a folder's study.json lists; none if there is no such file or it has another form.
class EarlierOutputs {
 public:
  explicit EarlierOutputs(const std::filesystem::path& folder);

  /// Removes those in the folder's maps/ that were not written again and still have the listed size and
  /// checksum.
  /// @param written  relative to the folder
  void removeExcept(const std::set<std::string>& written) const;

 private:
  std::filesystem::path folder_;
  nlohmann::ordered_json outputs_;  ///< as digestJson() makes them
};

}  // namespace emscape::study

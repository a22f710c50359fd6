/// What a volume is, all but its values, as JSON: the header of raw files, the sidecar of .nvdb, field data
/// of .vti. Internal to the module.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Grid and info; the mask as "first_valid_k" where `with_mask` and there is one.
nlohmann::ordered_json toJson(const DenseVolume& volume, bool with_mask);

/// A volume without values. Keys that are missing keep their defaults, all but dims. "voxels", if there, must
/// agree with them: whoever allocates for dims that a damaged file states should not find that out
/// afterwards.
/// @throws Error (bad_input) that names file and key
DenseVolume fromJson(const nlohmann::ordered_json& json, const std::string& file);

/// @throws Error (bad_input) with line and column
nlohmann::ordered_json parseJson(const std::string& text, const std::string& file);

/// Numbers, and infinities and NaN, which JSON has not, as text.
nlohmann::ordered_json numberToJson(double value);

/// The member of a JSON object, which must be there and of the type; @throws Error (bad_input)
template <class Value>
Value requiredFromJson(const nlohmann::ordered_json& json, const char* key, const std::string& file) {
  try {
    return json.at(key).get<Value>();
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::bad_input, {file}, "key " + std::string(key) + ": " + error.what());
  }
}

/// Indented text that ends in a newline; bytes that are not UTF-8 are replaced.
std::string dumpJson(const nlohmann::ordered_json& json);

/// NAME.raw.json beside NAME.raw, NAME.nvdb.json beside NAME.nvdb.
std::filesystem::path sidecarOf(const std::filesystem::path& path);

}  // namespace emscape::volume

/// Volumes and fields on meshes without their values as JSON: the header of raw files, the sidecar of .nvdb,
/// field data of .vti and .vtu. Internal to the module.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/files/json_reading.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/mesh/mesh.h"

namespace emscape::volume {

/// Grid and info; the mask as "first_valid_k" if `with_mask` and there is one.
nlohmann::ordered_json toJson(const DenseVolume& volume, bool with_mask);

/// A volume without values. Missing keys have their defaults, except dims, which is required. "voxels", if
/// present, must agree with dims, so that a damaged file is detected before memory is allocated.
/// @throws Error (bad_input) that names file and key
DenseVolume fromJson(const nlohmann::ordered_json& json, const std::string& file);

/// The info of a field and the frame of its mesh.
nlohmann::ordered_json toJson(const MeshField& field);

/// A field without values, on a mesh that has only a frame. @throws Error (bad_input) that names file and key
MeshField meshFieldFromJson(const nlohmann::ordered_json& json, const std::string& file);

/// @throws Error (bad_input) with line and column
nlohmann::ordered_json parseJson(const std::string& text, const std::string& file);

/// Numbers; infinities and NaN, which JSON does not have, as text.
nlohmann::ordered_json numberToJson(double value);

/// The member of a JSON object, which must exist and have this type; @throws Error (bad_input)
template <class Value>
Value requiredFromJson(const nlohmann::ordered_json& json, const char* key, const std::string& file) {
  try {
    return json.at(key).get<Value>();
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::bad_input, {file}, "key " + std::string(key) + ": " + faultOf(error));
  }
}

/// The sidecar's name: NAME.raw.json for NAME.raw, NAME.nvdb.json for NAME.nvdb.
std::filesystem::path sidecarOf(const std::filesystem::path& path);

}  // namespace emscape::volume

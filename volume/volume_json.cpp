#include "volume/volume_json.h"

#include <cmath>
#include <limits>

#include "base/text/utc.h"
#include "volume/description_check.h"

namespace emscape::volume {
namespace {

using Json = nlohmann::ordered_json;

double numberFromJson(const Json& json) {
  if (!json.is_string()) return json.get<double>();
  const auto text = json.get<std::string>();
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (text == "-inf") return -std::numeric_limits<double>::infinity();
  if (text == "nan") return std::numeric_limits<double>::quiet_NaN();
  throw Error(ErrorCode::bad_input, "\"" + text + "\" is neither a number nor inf, -inf or nan");
}

Json vectorToJson(const Vec3d& vector) {
  return Json::array({numberToJson(vector.x), numberToJson(vector.y), numberToJson(vector.z)});
}

Vec3d vectorFromJson(const Json& json) {
  if (!json.is_array() || json.size() != 3) throw Error(ErrorCode::bad_input, "three numbers are needed");
  return {numberFromJson(json[0]), numberFromJson(json[1]), numberFromJson(json[2])};
}

int checkedInt(const Json& json, long long greatest) {
  const bool whole =
      json.is_number_integer() && !(json.is_number_unsigned() && json.get<std::uint64_t>() > INT32_MAX);
  const long long value = whole ? json.get<long long>() : -1;
  if (value < 0 || value > greatest) {
    throw Error(ErrorCode::bad_input, json.dump() + " is not a whole number 0.." + std::to_string(greatest));
  }
  return static_cast<int>(value);
}

Dims dimsFromJson(const Json& json) {
  if (!json.is_array() || json.size() != 3)
    throw Error(ErrorCode::bad_input, "three whole numbers are needed");
  return {checkedInt(json[0], INT32_MAX), checkedInt(json[1], INT32_MAX), checkedInt(json[2], INT32_MAX)};
}

FrameOrigin frameFromJson(const Json& json) {
  FrameOrigin frame;
  const auto kind = json.at("kind").get<std::string>();
  if (kind == toString(FrameKind::enu)) {
    frame.kind = FrameKind::enu;
  } else if (kind != toString(FrameKind::altitude)) {
    throw Error(ErrorCode::bad_input, "kind \"" + kind + "\" is neither altitude nor enu");
  }
  frame.latitude_deg = json.at("latitude_deg").get<double>();
  frame.longitude_deg = json.at("longitude_deg").get<double>();
  frame.height_msl_m = json.at("height_msl_m").get<double>();
  return frame;
}

/// ISO 8601; empty: none.
std::string timeFromJson(const Json& value) {
  const auto text = value.get<std::string>();
  if (!text.empty() && !parseUtc_ms(text))
    throw Error(ErrorCode::bad_input, value.dump().substr(0, 40) + " is not a time YYYY-MM-DDTHH:MM:SSZ");
  return text;
}

void setMember(VolumeInfo& info, const std::string& key, const Json& value) {
  if (key == "quantity") info.quantity = value.get<std::string>();
  if (key == "unit") info.unit = value.get<std::string>();
  if (key == "time_s") {
    info.time_s = numberFromJson(value);
    info.has_time = true;
  }
  if (key == "time_utc") info.time_utc = timeFromJson(value);
  if (key == "floor") info.floor = requireFloat(numberFromJson(value));
  if (key == "range_min") info.range_min = requireFloat(numberFromJson(value));
  if (key == "range_max") info.range_max = requireFloat(numberFromJson(value));
  if (key == "categorical") info.categorical = value.get<bool>();
  if (key == "extra") info.extra = value.get<std::map<std::string, std::string>>();
}

void setMember(DenseVolume& volume, const std::string& key, const Json& value) {
  Grid& grid = volume.grid;
  setMember(volume.info, key, value);
  if (key == "dims") grid.dims = dimsFromJson(value);
  if (key == "spacing_m") grid.spacing_m = vectorFromJson(value);
  if (key == "first_center_m") grid.first_center_m = vectorFromJson(value);
  if (key == "frame") {
    grid.frame = frameFromJson(value);
    grid.georeferenced = true;
  }
  if (key == "first_valid_k") {
    if (!value.is_array()) throw Error(ErrorCode::bad_input, "a list of whole numbers is needed");
    for (const Json& layer : value) {
      volume.first_valid_k.push_back(static_cast<std::uint16_t>(checkedInt(layer, kMaxVoxelsPerAxis)));
    }
  }
}

/// Calls set(key, value) for each member. @throws Error (bad_input) that names file and key
template <class Set>
void eachMember(const Json& json, const std::string& file, const char* what, const Set& set) {
  if (!json.is_object())
    throw Error(ErrorCode::bad_input, {file}, std::string("no JSON object that describes ") + what);
  for (const auto& [key, value] : json.items()) {
    try {
      set(key, value);
    } catch (const Error& error) {
      throw Error(ErrorCode::bad_input, {file}, "key " + key + ": " + error.message());
    } catch (const nlohmann::json::exception& error) {
      throw Error(ErrorCode::bad_input, {file}, "key " + key + ": " + faultOf(error));
    }
  }
}

/// Beginning of errors about a volume or field.
std::string prefixOf(const VolumeInfo& info) {
  return info.quantity.empty() ? "" : "volume " + info.quantity + ": ";
}

Json frameToJson(const FrameOrigin& frame) {
  return {{"kind", toString(frame.kind)},
          {"latitude_deg", frame.latitude_deg},
          {"longitude_deg", frame.longitude_deg},
          {"height_msl_m", frame.height_msl_m}};
}

/// The members after those of the geometry.
void addInfo(Json& json, const VolumeInfo& info, bool georeferenced, const FrameOrigin& frame) {
  if (georeferenced) json["frame"] = frameToJson(frame);
  for (const auto& [key, text] : standardWords(georeferenced, frame)) json[key] = text;
  json["time_s"] = numberToJson(info.time_s);
  json["time_utc"] = info.time_utc;
  json["floor"] = numberToJson(info.floor);
  json["range_min"] = numberToJson(info.range_min);
  json["range_max"] = numberToJson(info.range_max);
  json["categorical"] = info.categorical;
  json["extra"] = info.extra;
}

}  // namespace

Json numberToJson(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

Json toJson(const DenseVolume& volume, bool with_mask) {
  const Grid& grid = volume.grid;
  const VolumeInfo& info = volume.info;
  Json json;
  json["quantity"] = info.quantity;
  json["unit"] = info.unit;
  json["dims"] = {grid.dims.x, grid.dims.y, grid.dims.z};
  json["voxels"] = grid.dims.count();
  json["spacing_m"] = vectorToJson(grid.spacing_m);
  json["first_center_m"] = vectorToJson(grid.first_center_m);
  addInfo(json, info, grid.georeferenced, grid.frame);
  if (with_mask && !volume.first_valid_k.empty()) json["first_valid_k"] = volume.first_valid_k;
  return json;
}

DenseVolume fromJson(const Json& json, const std::string& file) {
  DenseVolume volume;
  volume.grid.spacing_m = {1, 1, 1};
  volume.info.has_time = false;
  eachMember(json, file, "a volume",
             [&](const std::string& key, const Json& value) { setMember(volume, key, value); });
  const std::string who = prefixOf(volume.info);
  checkGrid(volume.grid, who, {file});
  // One of the two is no range.
  if (!json.contains("range_min") || !json.contains("range_max"))
    volume.info.range_min = volume.info.range_max = 0;
  checkInfo(volume.info, who, {file});
  if (json.contains("voxels") && json["voxels"] != volume.grid.dims.count()) {
    throw Error(ErrorCode::bad_input, {file},
                "key voxels: " + json["voxels"].dump() + " is not the product of the dims");
  }
  return volume;
}

Json toJson(const MeshField& field) {
  Json json;
  json["quantity"] = field.info.quantity;
  json["unit"] = field.info.unit;
  addInfo(json, field.info, field.mesh->georeferenced, field.mesh->frame);
  return json;
}

MeshField meshFieldFromJson(const Json& json, const std::string& file) {
  MeshField field;
  field.info.has_time = false;
  auto mesh = std::make_shared<TetrahedralMesh>();
  eachMember(json, file, "a field", [&](const std::string& key, const Json& value) {
    setMember(field.info, key, value);
    if (key != "frame") return;
    mesh->frame = frameFromJson(value);
    mesh->georeferenced = true;
  });
  const std::string who = prefixOf(field.info);
  if (mesh->georeferenced) checkFrame(mesh->frame, who, {file});
  checkInfo(field.info, who, {file});
  field.mesh = mesh;
  return field;
}

Json parseJson(const std::string& text, const std::string& file) {
  return readJson<Json>(text, file, [](Json& json) { return std::move(json); });
}

std::filesystem::path sidecarOf(const std::filesystem::path& path) {
  std::filesystem::path sidecar = path;
  sidecar += ".json";
  return sidecar;
}

}  // namespace emscape::volume

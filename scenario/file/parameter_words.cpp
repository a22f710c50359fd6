#include "scenario/file/parameter_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "propagation/registry/model_info.h"
#include "scenario/file/schema.h"

namespace emscape::scenario {
namespace {

struct Key {
  const char* key;
  const char* name;  ///< empty: the key's stem
  bool is_expert = false;
};

constexpr std::array<Key, 67> kKeys{{
    {"beamwidth_az_deg", "beamwidth, azimuth"},
    {"beamwidth_el_deg", "beamwidth, elevation"},
    {"side_lobe_db", "side lobes"},
    {"taper", "", true},
    {"taper_side_lobe_db", "side lobes of the taper", true},
    {"max_elevation_deg", "highest elevation"},
    {"spacing_wavelengths", "spacing, wavelengths", true},
    {"element_exponent", "", true},
    {"azimuth_file", "file of azimuths"},
    {"elevation_file", "file of elevations"},
    {"rate_rpm", "turns per minute"},
    {"rate_deg_s", "sweep rate"},
    {"width_deg", "sector width"},
    {"propagation", "propagation model"},
    {"antenna_noise", "", true},
    {"antenna_temperature_k", "", true},
    {"cross_polar_isolation_db", "cross-polar isolation", true},
    {"pulses", "pulses integrated"},
    {"pfa", "false alarm probability"},
    {"swerling", "Swerling case"},
    {"detection", "detection method", true},
    {"beam_shape_loss", "", true},
    {"cfar_cells", "CFAR cells", true},
    {"binary_threshold", "M of M-of-N detection", true},
    {"required_signal_to_jammer_db", "required signal to jamming", true},
    {"target_rcs_m2", "target's cross section"},
    {"prf_hz", "pulse repetition"},
    {"land_gamma_db", "gamma of the land", true},
    {"target_radial_speed_m_s", "target's radial speed", true},
    {"mti", "Doppler filter"},
    {"improvement_limit_db", "", true},
    {"surface_spread_m_s", "spread of land and sea", true},
    {"rain_spread_m_s", "spread of rain", true},
    {"active_s", "active times"},
    {"blink", "on and off by turns"},
    {"on_s", "on"},
    {"off_s", "off"},
    {"height_msl_m", "height above sea"},
    {"height_agl_m", "height above ground"},
    {"height_ellipsoid_m", "height above ellipsoid"},
    {"points", "track points"},
    {"sidc", "symbol code (SIDC)"},
    {"center_frequency_hz", "centre frequency"},
    {"required_sinr_db", "required SINR"},
    {"rcs_m2", "radar cross section"},
    {"rcs_file", "file of cross sections"},
    {"combine", "combination"},
    {"radar_look", "radars look"},
    {"floor", "lowest stored value", true},
    {"count_threshold_dbwm2", "counted from", true},
    {"detection_threshold", "", true},
    {"exposure_group", "exposure of"},
    {"k_factor", "earth radius factor k"},
    {"vapour_g_m3", "water vapour"},
    {"rain_mm_h", "rain rate"},
    {"rain_height_m", "rain height", true},
    {"gases", "gas losses"},
    {"refraction", "", true},
    {"sea_level_refractivity", "", true},
    {"climate", "", true},
    {"relative_permittivity", "permittivity", true},
    {"conductivity_s_m", "", true},
    {"roughness_m", "", true},
    {"surface_msl_m", "surface above sea", true},
    {"irregularity_m", "terrain irregularity", true},
    {"frame", "", true},
    {"dims", "voxels"},
}};

struct Choice {
  const char *key, *choice, *title;
};

constexpr std::array<Choice, 26> kChoices{{
    {"pattern", "isotropic", "isotropic: the same in all directions"},
    {"pattern", "gaussian", "Gaussian beam"},
    {"pattern", "sinc", "uniform aperture: sin x / x"},
    {"pattern", "cosecant2", "cosecant squared: search radar"},
    {"pattern", "phased_array", "phased array"},
    {"pattern", "file", "measured: a file"},
    {"pattern", "cuts", "measured: two cuts"},
    {"kind", "dwell_list", "list of dwells"},
    {"kind", "fixed", "fixed"},
    {"kind", "rotate", "rotating"},
    {"kind", "sector", "sector, to and fro"},
    {"kind", "raster", "raster of bars"},
    {"kind", "track", "follows its targets"},
    {"combine", "sum", "sum of the emitters"},
    {"combine", "max", "strongest emitter"},
    {"combine", "per_emitter", "each emitter alone"},
    {"combine", "per_band", "each band alone"},
    {"radar_look", "scan", "where the scan points"},
    {"radar_look", "target", "at the targets"},
    {"exposure_group", "general_public", "the general public"},
    {"exposure_group", "occupational", "workers"},
    {"kind", "pulse_doppler", "pulse Doppler"},
    {"kind", "max_hold", "maximum over the interval"},
    {"kind", "mean", "mean over the interval"},
    {"kind", "instant", "an instant"},
    {"kind", "cumulative", "cumulative over the interval"},
}};

/// How long the losses of an emitter take, in comparison with the other models.
const char* costOf(const propagation::ModelCost& cost) {
  if (cost.voxel_ns <= 100) return cost.emitter_s > 1 ? "slow" : "fast";
  if (cost.voxel_ns <= 500) return "medium";
  return cost.voxel_ns <= 2000 ? "slow" : "very slow";
}

/// The names of all keys of a format, by key.
void collectNames(const ObjectSpec& spec, std::map<std::string, std::string>& names) {
  for (const KeySpec& key : spec.keys) {
    names.emplace(key.name, wordsOf(key.name, document::stemOf(key)).name);
    const ValueSpec* value = &key.value;
    while (value->type == document::ValueType::list && value->item) value = value->item.get();
    if (value->object != nullptr) collectNames(*value->object, names);
  }
}

}  // namespace

KeyWords wordsOf(const std::string& key, const std::string& stem) {
  const auto found = std::find_if(kKeys.begin(), kKeys.end(), [&](const Key& row) { return key == row.key; });
  KeyWords words{stem, false};
  if (found != kKeys.end()) {
    words.is_expert = found->is_expert;
    if (*found->name != '\0') words.name = found->name;
  }
  std::replace(words.name.begin(), words.name.end(), '_', ' ');
  return words;
}

std::string titleOf(const std::string& key, const std::string& choice) {
  if (key == "propagation") {
    const propagation::ModelInfo* const model = propagation::modelNamed(choice);
    if (model != nullptr) return fmt::format("{}; {}", model->title, costOf(model->cost));
  }
  for (const Choice& row : kChoices) {
    if (key == row.key && choice == row.choice) return row.title;
  }
  std::string words = choice;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string inWords(const std::string& message) {
  static const std::map<std::string, std::string> names = [] {
    std::map<std::string, std::string> all;
    collectNames(scenarioSpec(), all);
    return all;
  }();
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    const std::size_t end = message[at] == '\'' ? message.find('\'', at + 1) : std::string::npos;
    const auto name =
        end == std::string::npos ? names.end() : names.find(message.substr(at + 1, end - at - 1));
    if (name == names.end()) {
      text += message[at++];
    } else {
      text += name->second;
      at = end + 1;
    }
  }
  return text;
}

}  // namespace emscape::scenario

#include "interop/importing/emitter_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/count_text.h"
#include "base/text/utf8.h"
#include "document/schema_check.h"
#include "document/section.h"
#include "emscape/base/units.h"
#include "scenario/file/parse_sections.h"
#include "scenario/schema/sections.h"

namespace emscape::interop {
namespace {

namespace fs = std::filesystem;

/// Sectors up to this width (deg) are the beam's own, larger ones are searched.
constexpr double kWidestBeam_deg = 15;
/// Assumed where a recording tells that a beam turns or sweeps, but neither it nor the database how fast.
constexpr double kAssumedRate_rpm = 6, kAssumedRate_deg_s = 30;
/// A beamwidth from here on (deg) is no beam's.
constexpr double kAllAround_deg = 359;
/// A half sweep from here on (deg) is a motion of the beam.
constexpr double kSweeps_deg = 2;
constexpr std::size_t kMaxDwells = 5000, kMaxActive = 10000;
constexpr double kShortestActive_s = 1e-3;  // the decimals that are written

bool known(double value) {
  return !std::isnan(value);
}

std::string printable(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size();) {
    const std::size_t length = utf8SequenceLength(std::string_view(name).substr(i));
    if (text.size() + length > 150) break;
    const std::string_view one = std::string_view(name).substr(i, std::max<std::size_t>(length, 1));
    if (length > 0 && !firstUnprintable(one)) text += one;
    i += one.size();
  }
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "unnamed";
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// An antenna whose files are named from another folder.
DocumentNodePtr movedAntenna(const DocumentNodePtr& antenna, const std::string& database,
                             const fs::path& folder) {
  MapBuilder moved(antenna);
  for (const char* key : {"file", "azimuth_file", "elevation_file"}) {
    const std::string name = moved.textOf(key);
    if (name.empty() || fs::path(name).is_absolute()) continue;
    const fs::path absolute = fs::absolute(fs::path(database).parent_path() / name).lexically_normal();
    moved.set(
        key, textNode(absolute.lexically_relative(fs::absolute(folder).lexically_normal()).generic_string()));
  }
  return moved.node();
}

/// Gain of an antenna of a database. @throws Error (bad_input)
double gain_dbi(const DocumentNodePtr& antenna, const std::string& database) {
  scenario::ParseContext context;
  context.file = database;
  const document::Section section(context.file, antenna.get(), scenario::antennaSpec());
  const scenario::AntennaPtr made = scenario::parseAntenna(section, context);
  document::requireNoProblem(context.problems);
  return made ? made->gain_dbi : 0;
}

/// Why an emitter is not added to a platform of the base; empty if it is.
std::string presentFault(const std::vector<const scenario::Emitter*>& present, const DocumentNodePtr& emitter,
                         const std::string& name) {
  const std::string told = MapBuilder(emitter).textOf("kind");
  const std::string kind = told.empty() ? scenario::toString(scenario::EmitterKind::transmitter) : told;
  for (const scenario::Emitter* has : present) {
    if (has->name == name || scenario::toString(has->kind) == kind)
      return fmt::format("its platform has '{}' in the base", has->name);
  }
  return "";
}

}  // namespace

std::string UniqueNames::unique(const std::string& name) {
  const std::string base = printable(name);
  std::string candidate = base;
  for (int i = 2; !used_.insert(candidate).second; ++i) candidate = fmt::format("{} {}", base, i);
  if (candidate != base) numbered_.push_back(candidate);
  return candidate;
}

void EmitterMaker::count(const std::string& name, const std::string& source, const std::string& fault) {
  const auto found = std::find_if(uses_.begin(), uses_.end(), [&](const ImportedEmitters& use) {
    return use.name == name && use.source == source && use.fault == fault;
  });
  if (found != uses_.end()) {
    ++found->count;
  } else if (uses_.size() < 1000) {
    uses_.push_back({name, source, fault, 1});
  }
}

std::vector<std::string> EmitterMaker::notes() const {
  std::vector<std::string> notes;
  if (sectors_ > 0) {
    notes.push_back(
        fmt::format("{} wider than {} deg: taken as the sector that the beam searches "
                    "(--beamwidth beam takes them as the beam)",
                    countText(sectors_, "beam is", "beams are"), kWidestBeam_deg));
  }
  if (assumed_turns_ > 0) {
    notes.push_back(
        fmt::format("{} at an unknown rate: {} rpm or {} deg/s are assumed; give "
                    "the rate in the database's scan",
                    countText(assumed_turns_, "beam turns or sweeps", "beams turn or sweep"),
                    kAssumedRate_rpm, kAssumedRate_deg_s));
  }
  if (beams_cut_ > 0) {
    notes.push_back(fmt::format("{} more than {} settings; the later ones are left out",
                                countText(beams_cut_, "beam has", "beams have"), kMaxPieces));
  }
  return notes;
}

DocumentNodePtr EmitterMaker::antennaOfSweep(const BeamState& state) const {
  const bool is_beam = beamwidth_ != BeamwidthMeaning::scan && known(state.beamwidth_az_deg);
  double azimuth = is_beam ? state.beamwidth_az_deg : 2 * state.azimuth_half_sweep_deg;
  double elevation = is_beam ? state.beamwidth_el_deg : 2 * state.elevation_half_sweep_deg;
  if (!known(azimuth) || azimuth <= 0) azimuth = 10;
  if (!known(elevation) || elevation <= 0) elevation = 10;
  MapBuilder antenna;
  antenna.set("pattern", textNode("gaussian"));
  antenna.set("beamwidth_az_deg", numberNode(std::clamp(azimuth, 0.1, 360.0), 4));
  antenna.set("beamwidth_el_deg", numberNode(std::clamp(elevation, 0.1, 180.0), 4));
  return antenna.node();
}

EmitterMaker::Origin EmitterMaker::originOf(const RecordedObject& object, const RecordedBeam& beam) const {
  if (const EmitterRow* row = findRow(database_, object, &beam)) {
    // The figures of a radar or jammer are not those of a radio.
    const std::string kind = MapBuilder(row->emitter).textOf("kind");
    if (beam.kind != BeamKind::transmitter || kind == "transmitter")
      return {row->emitter, row->name, row->source, row->file, row->antenna_height_m};
  }
  if (beam.kind == BeamKind::transmitter) {  // such PDUs tell all but the antenna
    MapBuilder radio;
    radio.set("kind", textNode("transmitter"));
    radio.set("antenna", MapBuilder().set("pattern", textNode("isotropic")).node());
    return {radio.node(), "radio", "the recording; an isotropic antenna", "", 0};
  }
  if (database_.unmatched != Unmatched::use_default) return {};
  MapBuilder emitter(database_.default_emitter);
  const bool is_radar = emitter.textOf("kind") == "radar";
  if (is_radar && !emitter.find("receiver")) {
    emitter.set(
        "receiver",
        MapBuilder().set("noise_figure_db", numberNode(5)).set("bandwidth_hz", numberNode(1e6)).node());
  }
  return {emitter.node(), "default", "the database's default", database_.default_file, 0};
}

void EmitterMaker::setPower(MapBuilder& emitter, const Origin& origin, const BeamPiece* piece,
                            std::string& fault) const {
  if (piece != nullptr && known(piece->state.erp_dbm)) {
    const double gain =
        gain_dbi(MapBuilder(origin.emitter).find("antenna") ? MapBuilder(origin.emitter).find("antenna")
                                                            : emitter.find("antenna"),
                 origin.file);
    const double losses_db = known(emitter.numberOf("losses_db")) ? emitter.numberOf("losses_db") : 0;
    const double power_w = dbToRatio(piece->state.erp_dbm - gain + losses_db - 30);
    if (power_w > 0 && power_w <= 1e12) {
      emitter.set("power_w", numberNode(power_w, 7));
      return;
    }
  }
  if (piece != nullptr && known(piece->state.power_dbm)) {
    const double power_w = dbToRatio(piece->state.power_dbm - 30);
    if (power_w > 0 && power_w <= 1e12) {
      emitter.set("power_w", numberNode(power_w, 7));
      return;
    }
  }
  if (!emitter.find("power_w")) fault = "neither the recording nor the database has a power";
}

void EmitterMaker::setScan(MapBuilder& emitter, const BeamPiece& piece) {
  const BeamState& state = piece.state;
  MapBuilder scan(emitter.find("scan"));
  const std::string kind = scan.textOf("kind");
  double half_sweep_deg = state.azimuth_half_sweep_deg;
  if (known(state.beamwidth_az_deg) && emitter.textOf("kind") == "radar") {
    const bool is_sector = beamwidth_ == BeamwidthMeaning::scan || (beamwidth_ == BeamwidthMeaning::by_size &&
                                                                    state.beamwidth_az_deg > kWidestBeam_deg);
    if (is_sector) {
      half_sweep_deg = state.beamwidth_az_deg / 2;
      if (state.beamwidth_az_deg < kAllAround_deg) ++sectors_;
    }
  }
  const std::vector<Pointing> pointings = reduced(piece.pointings, kMaxDwells);
  const double azimuth_deg = pointings.empty() ? 0 : std::remainder(pointings.front().azimuth_deg, 360);
  const double elevation_deg =
      pointings.empty() ? 0 : std::clamp(pointings.front().elevation_deg, -90.0, 90.0);
  if (half_sweep_deg > 179) {
    if (kind == "rotate") return;
    ++assumed_turns_;
    scan = MapBuilder().set("kind", textNode("rotate")).set("rate_rpm", numberNode(kAssumedRate_rpm));
    if (elevation_deg != 0) scan.set("elevation_deg", numberNode(elevation_deg, 5));
    emitter.set("scan", scan.node());
    return;
  }
  if (known(half_sweep_deg) && half_sweep_deg >= kSweeps_deg) {
    if (kind != "sector" && kind != "raster") {
      ++assumed_turns_;
      scan = MapBuilder().set("kind", textNode("sector")).set("rate_deg_s", numberNode(kAssumedRate_deg_s));
    }
    scan.set("width_deg", numberNode(2 * half_sweep_deg, 5));
    if (azimuth_deg != 0) scan.set("azimuth_deg", numberNode(azimuth_deg, 5));
    if (elevation_deg != 0) scan.set("elevation_deg", numberNode(elevation_deg, 5));
    emitter.set("scan", scan.node());
    return;
  }
  if (pointings.empty()) return;  // that of the database
  if (pointings.size() == 1) {
    scan = MapBuilder().set("kind", textNode("fixed"));
    if (azimuth_deg != 0) scan.set("azimuth_deg", numberNode(azimuth_deg, 6));
    if (elevation_deg != 0) scan.set("elevation_deg", numberNode(elevation_deg, 6));
    emitter.set("scan", scan.node());
    return;
  }
  // The list is repeated from t = 0; between its pointings and after the last one the beam stays.
  std::vector<DocumentNodePtr> dwells;
  double begin_s = 0;
  for (std::size_t i = 0; i < pointings.size(); ++i) {
    const double end_s = i + 1 < pointings.size() ? pointings[i + 1].begin_s : window_.end_s + 1;
    const double duration_s = std::min(end_s - begin_s, 1e6);
    if (duration_s < 1e-6) continue;
    dwells.push_back(
        MapBuilder()
            .set("azimuth_deg", decimalNode(std::remainder(pointings[i].azimuth_deg, 360), 2))
            .set("elevation_deg", decimalNode(std::clamp(pointings[i].elevation_deg, -90.0, 90.0), 2))
            .set("duration_s", decimalNode(duration_s, 6))
            .node());
    begin_s = end_s;
  }
  emitter.set("scan",
              MapBuilder().set("kind", textNode("dwell_list")).set("dwells", listNode(dwells)).node());
}

DocumentNodePtr EmitterMaker::emitterNode(const Origin& origin, const BeamPiece* piece,
                                          const std::vector<TimeSpan>& active, const std::string& name,
                                          const std::string& platform, std::string& fault) {
  MapBuilder source(origin.emitter);
  MapBuilder emitter;
  emitter.set("name", textNode(name)).set("platform", textNode(platform));
  for (const char* key : {"kind", "frequency_hz", "bandwidth_hz", "power_w"})
    emitter.set(key, source.find(key));
  if (!emitter.find("kind")) emitter.set("kind", textNode("transmitter"));
  for (const document::MapEntry& entry : source.entries()) {
    if (!emitter.find(entry.key)) emitter.set(entry.key, entry.value);
  }
  if (!emitter.find("antenna") && piece != nullptr) emitter.set("antenna", antennaOfSweep(piece->state));
  if (const DocumentNodePtr antenna = source.find("antenna"))
    emitter.set("antenna", movedAntenna(antenna, origin.file, folder_));
  const bool is_radar = emitter.textOf("kind") == "radar";
  if (piece != nullptr) {
    const BeamState& state = piece->state;
    if (known(state.frequency_hz)) emitter.set("frequency_hz", numberNode(state.frequency_hz, 8));
    if (known(state.bandwidth_hz) && !is_radar && state.bandwidth_hz <= 1e11)
      emitter.set("bandwidth_hz", numberNode(state.bandwidth_hz, 6));
    const bool has_pulses = known(state.prf_hz) && known(state.pulse_width_s) && state.prf_hz <= 1e8 &&
                            state.pulse_width_s * state.prf_hz < 1;
    if (is_radar && has_pulses) {
      emitter.set("waveform", MapBuilder(emitter.find("waveform"))
                                  .set("prf_hz", numberNode(state.prf_hz, 6))
                                  .set("pulse_width_s", numberNode(state.pulse_width_s, 6))
                                  .node());
    }
    setScan(emitter, *piece);
  }
  if (!emitter.find("frequency_hz")) {
    fault = "neither the recording nor the database has a frequency";
    return nullptr;
  }
  const double frequency_hz = emitter.numberOf("frequency_hz");
  if (!(frequency_hz >= 1e6 && frequency_hz <= 1e12)) {
    fault = fmt::format("a frequency of {:.6g} Hz, outside 1 MHz to 1 THz", frequency_hz);
    return nullptr;
  }
  setPower(emitter, origin, piece, fault);
  if (!fault.empty()) return nullptr;
  const bool is_always =
      active.size() == 1 && active[0].begin_s <= window_.begin_s && active[0].end_s >= window_.end_s;
  if (!is_always) {
    std::vector<DocumentNodePtr> spans;
    for (const TimeSpan& span : active) {
      const bool is_written = span.end_s - std::max(span.begin_s, 0.0) >= kShortestActive_s;
      if (spans.size() < kMaxActive && is_written)
        spans.push_back(listNode({decimalNode(std::max(span.begin_s, 0.0), 3), decimalNode(span.end_s, 3)}));
    }
    if (spans.empty()) {
      fault = "on for less than 1 ms";
      return nullptr;
    }
    emitter.set("active_s", listNode(spans));
  }
  return emitter.node();
}

void EmitterMaker::makeOfBeam(const RecordedObject& object, const RecordedBeam& beam,
                              const std::vector<TimeSpan>& presence, const std::string& platform,
                              const std::vector<const scenario::Emitter*>& present, double& height_m,
                              std::vector<DocumentNodePtr>& emitters) {
  bool cut = false;
  const std::vector<BeamPiece> pieces = piecesOf(beam, presence, cut);
  if (pieces.empty()) return count(beam.name, "", "never on within these times");
  const Origin origin = originOf(object, beam);
  if (!origin.emitter) {
    return count(beam.name, "",
                 database_.unmatched == Unmatched::ignore ? "not in the database, and unmatched: ignore"
                                                          : "not in the database");
  }
  const std::string name = joinedName(platform, origin.name);
  const std::string has = presentFault(present, origin.emitter, name);
  if (!has.empty()) return count(origin.name, "", has);
  if (cut) ++beams_cut_;
  for (const BeamPiece& piece : pieces) {
    std::string fault;
    const DocumentNodePtr emitter =
        emitterNode(origin, &piece, piece.active, names_.unique(name), platform, fault);
    count(fault.empty() ? origin.name : beam.name, origin.source, fault);
    if (!emitter) continue;
    emitters.push_back(emitter);
    height_m = std::max({height_m, beam.height_m, origin.height_m});
  }
}

std::vector<DocumentNodePtr> EmitterMaker::make(const RecordedObject& object,
                                                const std::vector<const RecordedBeam*>& beams,
                                                const std::string& platform,
                                                const std::vector<const scenario::Emitter*>& present,
                                                double& height_m) {
  std::vector<DocumentNodePtr> emitters;
  const std::vector<TimeSpan> presence = presenceOf(object, window_);
  if (presence.empty()) return emitters;
  for (const RecordedBeam* beam : beams)
    makeOfBeam(object, *beam, presence, platform, present, height_m, emitters);
  if (!beams.empty()) return emitters;
  const EmitterRow* row = findRow(database_, object, nullptr);
  if (row == nullptr) return emitters;
  const std::string name = joinedName(platform, row->name);
  std::string fault = presentFault(present, row->emitter, name);
  if (!fault.empty()) {
    count(row->name, "", fault);
    return emitters;
  }
  const Origin origin{row->emitter, row->name, row->source, row->file, row->antenna_height_m};
  const DocumentNodePtr emitter =
      emitterNode(origin, nullptr, presence, names_.unique(name), platform, fault);
  count(row->name, row->source, fault);
  if (emitter) {
    emitters.push_back(emitter);
    height_m = std::max(height_m, row->antenna_height_m);
  }
  return emitters;
}

}  // namespace emscape::interop

#include <fmt/format.h>

#include <cmath>

#include "base/text/utc.h"
#include "recording/read_recording.h"
#include "scenario/file/parse_sections.h"

namespace emscape::scenario {
namespace {

SitePosition positionOf(const Section& section) {
  return {section.number("latitude_deg"), section.number("longitude_deg"),
          section.optionalNumber("height_msl_m"), section.optionalNumber("height_agl_m"), std::nullopt};
}

/// The points that the scenario itself lists.
std::vector<TrackPoint> listedTrack(const Section& track, ParseContext& context) {
  std::vector<TrackPoint> points;
  for (const Section& item : track.sections("points")) {
    const TrackPoint point{item.number("t_s"), positionOf(item), item.optionalNumber("heading_deg"),
                           item.optionalNumber("pitch_deg"), item.optionalNumber("roll_deg")};
    if (!points.empty() && point.t_s <= points.back().t_s) {
      context.problems.addError(
          item.locationOf("t_s"),
          fmt::format("'t_s' is {}, not above the {} s of the point before", point.t_s, points.back().t_s));
    }
    if (!points.empty() &&
        point.position.height_agl_m.has_value() != points.front().position.height_agl_m.has_value()) {
      context.problems.addError(item.location(), "all points of a track must have the same kind of height");
    }
    points.push_back(point);
  }
  return points;
}

std::vector<TrackPoint> useTrack(const Section& track, const std::string& name,
                                 const std::shared_ptr<const TrackFile>& read, ParseContext& context) {
  context.files.tracks[name] = read;
  for (const std::string& warning : read->warnings) {
    const std::string text = track.text("file") + ": " + warning;
    if (context.told_of_tracks.insert(text).second)
      context.problems.addWarning(track.locationOf("file"), text);
  }
  return read->points;
}

std::vector<TrackPoint> trackOf(const Section& track, ParseContext& context) {
  if (track.has("points")) return listedTrack(track, context);
  const std::string file = context.resolve(track.text("file"));
  const TrackChoice choice{track.text("object"), track.text("columns"),
                           track.optionalNumber("gap_s").value_or(0), track.optionalNumber("height_agl_m")};
  const auto nameOf = [&](const std::string& extra) {
    return fmt::format("{}\n{}\n{}\n{}", file, choice.columns, choice.object, extra);
  };
  const std::string name = nameOf(
      fmt::format("{} {} {}", choice.gap_s, choice.height_agl_m.value_or(std::nan("")), context.epoch_utc));
  for (const NamedFiles* read : {context.before, static_cast<const NamedFiles*>(&context.files)}) {
    const auto known = read != nullptr ? read->tracks.find(name) : context.files.tracks.end();
    if (read == nullptr || known == read->tracks.end()) continue;
    if (!context.addNamed(track, "file")) return {};
    return useTrack(track, name, known->second, context);
  }
  std::string bytes;
  interop::ReadOptions options;
  options.columns = choice.columns;
  options.uses_heights = !choice.height_agl_m;
  std::shared_ptr<const interop::Recording>& recording =
      context.recordings[fmt::format("{}\n{}\n{}", file, options.columns, options.uses_heights)];
  if (!context.addNamed(track, "file", recording ? nullptr : &bytes)) return {};
  TrackFile read;
  try {
    if (!recording && isRecordedTrack(bytes, choice))
      recording = std::make_shared<const interop::Recording>(interop::readRecordingIn(bytes, file, options));
    read = recording ? recordedTrack(*recording, choice, parseUtc_ms(context.epoch_utc))
                     : parseTrack(file, bytes, track.locationOf("file"), context.problems);
  } catch (const Error& error) {
    const SourceLocation location =
        error.location().file.empty() ? SourceLocation{file, 0, 0} : error.location();
    context.problems.addErrorElsewhere(track.locationOf("file"), location, error.message());
    return {};
  }
  applyChoice(choice, read.points);
  return useTrack(track, name, std::make_shared<const TrackFile>(std::move(read)), context);
}

/// Side of a symbol, its 4th digit. @return none if the digit is that of no side
std::optional<Side> sideOfSymbol(const std::string& sidc) {
  switch (sidc[3]) {
    case '0':  // pending
    case '1':
      return Side::unknown;
    case '2':  // assumed friend
    case '3':
      return Side::friendly;
    case '4':
      return Side::neutral;
    case '5':  // suspect
    case '6':
      return Side::hostile;
    default:
      return std::nullopt;
  }
}

void parseSymbol(const Section& section, Platform& platform, ParseContext& context) {
  if (section.has("side")) platform.side = section.choice<Side>("side");
  if (!section.has("sidc")) return;
  const std::string sidc = section.text("sidc");
  const bool has_digits = sidc.find_first_not_of("0123456789") == std::string::npos;
  if (!has_digits || (sidc.size() != 20 && sidc.size() != 30)) {
    context.problems.addError(
        section.locationOf("sidc"),
        fmt::format(
            "'sidc' is '{}': expected 20 or 30 digits, as MIL-STD-2525D and APP-6D have them, such as "
            "\"10031500002203000000\" for a friendly radar. For a frame without an icon, give 'side' instead",
            sidc));
    return;
  }
  const std::optional<Side> side = sideOfSymbol(sidc);
  if (!side) {
    context.problems.addError(
        section.locationOf("sidc"),
        fmt::format("the 4th digit of 'sidc' is {}: expected 0 or 1 (unknown), 2 or 3 (friend), 4 "
                    "(neutral), 5 or 6 (hostile)",
                    sidc[3]));
  } else if (platform.side && *platform.side != *side) {
    context.problems.addError(
        section.locationOf("side"),
        fmt::format("'side' is {}, but the 4th digit of 'sidc', {}, is that of {}: remove 'side', "
                    "or change the digit",
                    toString(*platform.side), sidc[3], toString(*side)));
  }
  platform.side = side;
  platform.sidc = sidc;
}

}  // namespace

Platform parsePlatform(const Section& section, ParseContext& context) {
  Platform platform;
  platform.name = section.text("name");
  platform.location = section.location();
  parseSymbol(section, platform, context);
  if (section.has("track")) {
    const Section track = section.section("track");
    platform.track = trackOf(track, context);
    platform.outside_track = track.choice<OutsideTrack>("outside");
    if (!platform.track.empty() && track.has("file"))
      platform.track_file = context.resolve(track.text("file"));
    return platform;
  }
  const Section position = section.section("position"), attitude = section.section("attitude");
  TrackPoint point;
  point.position = positionOf(position);
  point.position.height_ellipsoid_m = position.optionalNumber("height_ellipsoid_m");
  platform.track = {point};
  platform.attitude = {attitude.number("heading_deg"), attitude.number("pitch_deg"),
                       attitude.number("roll_deg")};
  return platform;
}

}  // namespace emscape::scenario

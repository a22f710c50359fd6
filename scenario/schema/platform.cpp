// Section of a platform, and the row of a track file.
#include "emscape/scenario/model/platform.h"

#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

namespace emscape::scenario {
namespace {

using document::DefaultValue;
using document::spec::byDefault;
using document::spec::listOf;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;

KeySpec heightMslKey() {
  return optional("height_msl_m", kHeight, "above EGM96 mean sea level");
}

KeySpec heightAglKey() {
  return optional("height_agl_m", kHeightAboveGround,
                  "above the ground; above mean sea level without terrain");
}

const ValueSpec kObjectName = document::spec::textOf(document::ValueType::text, 200);
const ValueSpec kColumnMap = document::spec::textOf(document::ValueType::text, 1000);
const ValueSpec kSymbolCode = document::spec::textOf(document::ValueType::text, 30);

const ObjectSpec& positionSpec() {
  static const ObjectSpec spec{"position",
                               "",
                               {latitudeKey(), longitudeKey(), heightMslKey(), heightAglKey(),
                                optional("height_ellipsoid_m", kHeight, "above the WGS84 ellipsoid")},
                               {{"height_msl_m", "height_agl_m", "height_ellipsoid_m"}}};
  return spec;
}

KeySpec headingKey(DefaultValue default_value) {
  return byDefault("heading_deg", kAngle, std::move(default_value), "clockwise from true north");
}

KeySpec pitchKey() {
  return byDefault("pitch_deg", kElevation, 0.0, "nose up");
}

KeySpec rollKey() {
  return byDefault("roll_deg", kAngle, 0.0, "right wing down");
}

const ObjectSpec& attitudeSpec() {
  static const ObjectSpec spec{"attitude", "", {headingKey(0.0), pitchKey(), rollKey()}};
  return spec;
}

const ObjectSpec& trackPointSpec() {
  static const ObjectSpec spec = [] {
    ObjectSpec row = trackRowSpec();
    row.name = "track point";
    return row;
  }();
  return spec;
}

const ObjectSpec& trackSpec() {
  static const ObjectSpec spec{
      "track",
      "",
      {optional("file", kFile,
                "CSV with a header line: t_s, latitude_deg, longitude_deg, height_msl_m or height_agl_m and, "
                "if wanted, heading_deg, pitch_deg, roll_deg; or a track of another program: GPX, KML, CZML, "
                "NMEA, STK, ACMI, DIS, SIMDIS, Cursor on Target, CSV with other columns; relative to the "
                "scenario's folder"),
       optional("object", kObjectName, "name or id of the object in a file with several"),
       optional("columns", kColumnMap,
                "columns of a CSV with other names: \"time=Zeit,latitude=Breite,longitude=Laenge,"
                "height=Hoehe:ft\""),
       optional("gap_s", number("s").above(0).to(1e8),
                "the platform is absent where the file has no position for longer; by default gaps are "
                "bridged"),
       optional("height_agl_m", kHeightAboveGround, "of all positions, in place of the heights in the file"),
       optional("points", listOf(object(trackPointSpec()), 2, kMaxItems),
                "the rows of such a file, in place of it"),
       byDefault("outside", choiceOf<OutsideTrack>(), "absent",
                 "before and after the track's time: the platform is not there, with all that it carries, or "
                 "it stands still at the track's end")},
      {{"file", "points"}},
      {{"object", "file"}, {"columns", "file"}, {"gap_s", "file"}, {"height_agl_m", "file"}}};
  return spec;
}

}  // namespace

KeySpec latitudeKey() {
  return required("latitude_deg", kLatitude, "geodetic, WGS84");
}

KeySpec longitudeKey() {
  return required("longitude_deg", kLongitude, "WGS84, positive eastwards");
}

const ObjectSpec& platformSpec() {
  static const ObjectSpec spec{
      "platform",
      "",
      {
          required("name", kName, "emitters, receivers and targets refer to it by this name"),
          optional("position", object(positionSpec()), "of a fixed site"),
          optional("attitude", object(attitudeSpec()), "of a fixed site; level and north by default"),
          optional("track", object(trackSpec()), "of a moving platform"),
          optional("side", choiceOf<Side>(), "colour and frame of its symbol; by default that of `sidc`"),
          optional("sidc", kSymbolCode,
                   "symbol, 20 or 30 digits of MIL-STD-2525D or APP-6D, in quotes: \"10031500002203000000\""),
      },
      {{"position", "track"}},
      {{"attitude", "position"}}};
  return spec;
}

const ObjectSpec& trackRowSpec() {
  static const ObjectSpec spec{
      "track file",
      "",
      {required("t_s", number("s").from(-1e8).to(1e8), "since the epoch"), latitudeKey(), longitudeKey(),
       heightMslKey(), heightAglKey(), headingKey({}), pitchKey(), rollKey()},
      {{"height_msl_m", "height_agl_m"}}};
  return spec;
}

}  // namespace emscape::scenario

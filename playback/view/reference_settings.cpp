/// Rows of the settings of coasts, graticules, places, pictures on the ground, and units.
#include "playback/view/settings_table.h"

namespace emscape::playback {
namespace {

namespace spec = document::spec;
using Table = SettingsTable;

constexpr int kMaxRingLists = 1000;
constexpr int kMaxPlaceFiles = 100;

}  // namespace

void addReferences(SettingsTable& table) {
  table
      .member(
          "coast", choiceOf<Shown>(), [](auto& view) -> auto& { return view.coast; },
          "coasts of [GSHHG](viewer.md#sea-land-and-coasts), if it is installed; auto: where no terrain is a "
          "sea "
          "by its heights")
      .withEffect(&ViewChange::ground)
      .withOption("--coast", "Coasts of GSHHG, if it is installed; default: auto")
      .withVerb("coast", "shown", "Coasts of GSHHG: auto, on or off; without a name the next one")
      .withAction("Coasts", "Shift+O");
  table
      .member(
          "graticule", choiceOf<Shown>(), [](auto& view) -> auto& { return view.graticule; },
          "lines of latitude and longitude on the ground; auto: on the smooth earth")
      .withEffect(&ViewChange::labels)
      .withOption("--graticule", "Lines of latitude and longitude; default: auto, on the smooth earth")
      .withVerb("graticule", "shown",
                "Lines of latitude and longitude: auto, on or off; without a name the next one")
      .withAction("Graticule", "Shift+G");
  table
      .member(
          "show_compass", switchSpec(), [](auto& view) -> auto& { return view.show_compass; },
          "draw the compass, with an arrow to the north")
      .withEffect(&ViewChange::labels)
      .withOption("--compass", "Draw the compass: on or off")
      .withVerb("compass", "on", "Draws the compass")
      .withAction("Compass", "Ctrl+Shift+N");
  table
      .member(
          "show_scale_bar", switchSpec(), [](auto& view) -> auto& { return view.show_scale_bar; },
          "draw a scale bar, as long as in the middle of the ground")
      .withEffect(&ViewChange::labels)
      .withOption("--scale-bar", "Draw a scale bar, as long as in the middle of the ground")
      .withVerb("scale_bar", "on", "Draws a scale bar")
      .withAction("Scale bar", "Shift+V");
  table
      .parsedList(
          "range_rings", kMaxRingLists, [](auto& view) -> auto& { return view.range_rings; }, parseRangeRings,
          "circles on the ground about emitters: `EMITTER:spacing_m=..[,count=..]`; without count up to the "
          "edge")
      .withTexts("list of texts", "none")
      .withEffect(&ViewChange::labels)
      .withOption("--range-rings",
                  "Circles on the ground about an emitter: EMITTER:spacing_m=..[,count=..]; may be repeated")
      .withVerb("range_rings", "rings",
                "Circles on the ground: a list of EMITTER:spacing_m=..[,count=..], or none");
  table
      .member(
          "places", spec::listOf(Table::textSpec(1), 0, kMaxPlaceFiles),
          [](auto& view) -> auto& { return view.places; },
          "files of points with names, lines and areas to draw on the ground (GeoJSON, GeoPackage and other "
          "vector "
          "files); relative to the folder of the view file, as `compare`")
      .withTexts("list of texts", "none")
      .withEffect(&ViewChange::labels)
      .withOption("--places",
                  "File of points with names, lines and areas on the ground: GeoJSON, GeoPackage, ...; may "
                  "be repeated")
      .withVerb("places", "files", "Points, lines and areas on the ground: a list of files, or none");
  table
      .member(
          "drape", Table::textSpec(), [](auto& view) -> auto& { return view.drape; },
          "picture on the ground (GeoTIFF or MBTiles), or land-cover: the classes of the terrain's land "
          "cover; relative to the folder of the view file, as `compare`")
      .withTexts("text", "none")
      .withEffect(&ViewChange::ground)
      .withOption("--drape",
                  "Picture on the ground, such as a chart or satellite image: GeoTIFF or MBTiles; "
                  "land-cover: the scenario's land cover")
      .withVerb("drape", "file", "Picture on the ground; an empty name removes it");
  table
      .member(
          "units", choiceOf<Units>(), [](auto& view) -> auto& { return view.units; },
          "metric: km, m, m/s; nautical: nautical miles, feet, knots")
      .withEffect(&ViewChange::labels)
      .withOption("--units", "Units of shown lengths and speeds; default: metric")
      .withVerb("units", "units",
                "metric (km, m, m/s) or nautical (NM, ft, kt); without a name the other one")
      .withAction("Units of length", "U");
  table
      .member(
          "field_unit", choiceOf<FieldUnit>(), [](auto& view) -> auto& { return view.field_unit; },
          "unit of shown power densities and field strengths: as computed, dBm/m², or V/m. Ranges and "
          "transfer "
          "functions are as computed")
      .withEffect(&ViewChange::labels)
      .withOption("--field-unit", "Unit of shown power densities and field strengths; default: stored")
      .withVerb("field_unit", "unit", "stored, dbm or v_per_m; without a name the next one")
      .withAction("Unit of the field", "Shift+U");
  table
      .member(
          "positions", choiceOf<PositionFormat>(), [](auto& view) -> auto& { return view.positions; },
          "positions in decimal degrees, in degrees, minutes and seconds, or in MGRS")
      .withEffect(&ViewChange::labels)
      .withOption("--positions", "Form of shown positions; default: decimal")
      .withVerb("positions", "form", "decimal, dms or mgrs; without a name the next one")
      .withAction("Form of positions", "Ctrl+U");
}

}  // namespace emscape::playback

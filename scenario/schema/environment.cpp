// Sections of the environment: region, terrain, atmosphere, ground.
#include "emscape/scenario/model/scenario.h"
#include "propagation/air/rain.h"
#include "propagation/p2108/p2108.h"
#include "scenario/limits.h"
#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

namespace emscape::scenario {
namespace {

using document::ValueType;
using document::spec::byDefault;
using document::spec::choice;
using document::spec::listOf;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;
using document::spec::simple;
using document::spec::textOf;
using propagation::Atmosphere;
using propagation::GasLosses;
using propagation::Ground;
using propagation::GroundKind;
using propagation::kRainRate;
using propagation::RadioClimate;
using propagation::RefractionProfile;

const ObjectSpec& originSpec() {
  static const ObjectSpec spec{
      "origin",
      "",
      {
          latitudeKey(),
          longitudeKey(),
          byDefault("height_msl_m", kHeight, 0.0, "bottom of the region, above EGM96 mean sea level"),
      }};
  return spec;
}

}  // namespace

const ObjectSpec& regionSpec() {
  static const ObjectSpec spec{
      "region",
      "",
      {
          required("origin", object(originSpec()), "centre of the region's bottom"),
          byDefault("frame", choice({toString(FrameKind::altitude), toString(FrameKind::enu)}), "altitude",
                    "altitude: x east and y north along the ground, z above mean sea level; enu: a Cartesian "
                    "box tangent at the origin"),
          required("size_m", listOf(number("m").from(1).to(4e6), 3, 3),
                   "extent along x, y and z; a voxel's x and y differ by at most 1000 times"),
          required("dims", listOf(kInteger.from(2).to(kMaxDim), 3, 3),
                   "voxels along x, y and z; at most 2^31 in all"),
      }};
  return spec;
}

namespace {

const ObjectSpec& elevationFileSpec() {
  static const ObjectSpec spec{
      "elevation file",
      "",
      {
          required("file", kFile, "a name as in `files`; the keys hold for all files that it stands for"),
          optional("vertical_datum", choiceOf<VerticalDatum>(),
                   "datum of its heights; by default what the file states"),
          optional(
              "height_unit", choiceOf<HeightUnit>(),
              "unit of its heights, us_ft: US survey feet; by default what the file states, else metres"),
          byDefault("band", kInteger.from(1).to(65536), 1.0, "that holds the heights"),
          optional("encoding", choiceOf<HeightEncoding>(), "of heights in the colours of a picture"),
          optional("crs", textOf(ValueType::text, 4096).printable(),
                   "coordinate reference system of its posts, such as EPSG:32633, if the file states none"),
          byDefault("swap_bytes", simple(ValueType::boolean), "false",
                    "true: the bytes of each height (whole numbers of 16 bits, real ones of 32) are in the "
                    "other order than the file states"),
          byDefault(
              "implausible", choiceOf<ImplausibleHeights>(), toString(ImplausibleHeights::error),
              "treatment of heights that are not on earth (-11500 to 9000 m) if they are more than 1 %: "
              "an error, or voids as fewer are"),
      }};
  return spec;
}

const ObjectSpec& landCoverSpec() {
  static const ObjectSpec spec{
      "land cover",
      "",
      {
          required("files", listOf(kFile, 1, kMaxItems),
                   "rasters of class codes, named as the elevation files; the first has priority"),
          optional("classes", choiceOf<CoverTable>(),
                   "meaning of the codes: ESA WorldCover, CORINE Land Cover, NLCD"),
          optional("table", kFile,
                   "meaning of the codes: CSV with the columns code,name,clutter_height_m,zone,land,color"),
      },
      {{"classes", "table"}}};
  return spec;
}

}  // namespace

const ObjectSpec& terrainSpec() {
  static const ObjectSpec spec{
      "terrain",
      "",
      {
          required("files", listOf(kFile.orObject(elevationFileSpec()), 1, kMaxItems),
                   "elevation files (HGT, DTED, GeoTIFF, VRT, ASCII grid, BIL, USGS DEM, Erdas Imagine, "
                   "netCDF, XYZ, GeoPackage), folders and patterns (`tiles/*.tif`) of them, .zip and .gz; "
                   "relative to the scenario's folder"),
          optional("vertical_datum", choiceOf<VerticalDatum>(),
                   "datum of the heights of all files without a key of their own; by default what each file "
                   "states, egm96 if it states none; egm2008 (Copernicus GLO-30) needs PROJ's or "
                   "GeographicLib's grid of it"),
          optional("missing", choiceOf<MissingTerrain>(),
                   "treatment of voids and of ground that no file covers: an error, sea (0 m), or no value; "
                   "by default an error for volumes and paths, no value on maps"),
          optional("land_cover", object(landCoverSpec()),
                   "classes of the ground: clutter heights and the sea for p1812 and p452, the sea for "
                   "parabolic_equation, kinds of land for the radars' clutter, colours of pictures"),
          optional(
              "surface_files", listOf(kFile.orObject(elevationFileSpec()), 1, kMaxItems),
              "a surface model, as `files`, which are then the bare earth: its height above the ground is "
              "the clutter height for p1812 and p452"),
      }};
  return spec;
}

const ObjectSpec& atmosphereSpec() {
  static const ObjectSpec spec{
      "atmosphere",
      "",
      {
          byDefault("k_factor", number().from(0.5).to(10), Atmosphere{}.k_factor,
                    "effective earth radius over earth radius"),
          byDefault("pressure_hpa", number("hPa").from(300).to(1100), Atmosphere{}.pressure_hpa,
                    "at sea level"),
          byDefault("temperature_k", number("K").from(180).to(340), Atmosphere{}.temperature_k,
                    "at sea level"),
          byDefault("vapour_g_m3", number("g/m3").from(0).to(100), Atmosphere{}.vapour_g_m3, "water vapour"),
          byDefault("rain_mm_h", number("mm/h").from(kRainRate.min).to(kRainRate.max), Atmosphere{}.rain_mm_h,
                    "rain rate, everywhere up to rain_height_m; its loss is added to every model's"),
          optional("rain_height_m", number("m").from(0).to(20000),
                   "upper limit of the rain, above mean sea level; by default by latitude (P.839-2), 5000 in "
                   "the tropics; P.839-4's maps differ from it by up to 1.7 km at middle latitudes"),
          byDefault("gases", choiceOf<GasLosses>(), toString(Atmosphere{}.gases),
                    "attenuation by oxygen and water vapour; auto: with every model except free_space and "
                    "horizon; p528 and p452 include their own"),
          byDefault("refraction", choiceOf<RefractionProfile>(), toString(Atmosphere{}.refraction),
                    "refractivity over height, for horizon, diffraction, two_ray and the directions of all "
                    "rays: linear, by k_factor, right up to about 10 km; exponential, from "
                    "sea_level_refractivity, at all heights"),
          byDefault("sea_level_refractivity", number().from(200).to(450), Atmosphere{}.sea_level_refractivity,
                    "N-units; for refraction: exponential, for itm, whose rays are bent by it, not by "
                    "k_factor, and "
                    "for the troposcatter of p1812 and p452"),
          byDefault("climate", choiceOf<RadioClimate>(), toString(Atmosphere{}.climate),
                    "for itm's statistics"),
          optional("refractivity", object(refractivitySpec()),
                   "profiles of the air, for parabolic_equation; not together with k_factor, which the other "
                   "models then have by default, or from kind: linear"),
      }};
  return spec;
}

const ObjectSpec& groundSpec() {
  static const ObjectSpec spec{
      "ground",
      "",
      {
          byDefault("kind", choiceOf<GroundKind>(), toString(Ground{}.kind),
                    "electrical constants of the ground; for sea and fresh water by frequency"),
          optional("relative_permittivity", number().from(1).to(200), "by default that of the kind"),
          optional("conductivity_s_m", number("S/m").from(0).to(100), "by default that of the kind"),
          byDefault("roughness_m", number("m").from(0).to(1000), Ground{}.roughness_m,
                    "standard deviation of the surface's height, for two_ray"),
          optional("surface_msl_m", kHeight,
                   "height of the smooth surface of two_ray and p528; by default of the ground below each "
                   "emitter"),
          optional(
              "sea_by_height", simple(ValueType::boolean),
              "true: sea where the terrain is at or below mean sea level; diffraction weighs the losses over "
              "sea and over this ground by their parts of the path; p1812 and p452 have their own, `zone`"),
          byDefault("terminal_clutter", choiceOf<propagation::TerminalClutterModel>(),
                    toString(Ground{}.terminal_clutter),
                    "p2108: loss by trees and buildings around low ends of paths, a statistic of towns and "
                    "suburbs (ITU-R P.2108-1, 3.2; 0.5 to 67 GHz, from 250 m on); not used where "
                    "`land_cover` or `surface_files` of the terrain tell what stands there, nor by p528 and "
                    "parabolic_equation"),
          byDefault(
              "terminal_clutter_percent",
              number("percent").from(propagation::kP2108Location.min).to(propagation::kP2108Location.max),
              Ground{}.terminal_clutter_percent, "of locations in which that loss is not exceeded"),
          byDefault(
              "terminal_clutter_below_m", number("m").from(0).to(100), Ground{}.terminal_clutter_below_m,
              "ends (antennas, targets, voxels) up to this height above the ground are within the clutter"),
          byDefault("terminal_clutter_ends", choice({"receiver", "both"}), "both",
                    "of earlier versions: each end's own height decides, whatever this key says"),
          byDefault(
              "terminal_clutter_combine", choiceOf<propagation::ClutterCombination>(),
              toString(Ground{}.terminal_clutter_combine),
              "with the excess loss of the model, without gases and rain: their sum, or the larger of both"),
      }};
  return spec;
}

}  // namespace emscape::scenario

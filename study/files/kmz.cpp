#include "study/files/kmz.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/files/unfinished_file.h"
#include "base/text/xml_text.h"
#include "emscape/base/units.h"
#include "emscape/playback/frames/scene.h"
#include "emscape/render/picture/image.h"
#include "render/annotate/hatching.h"
#include "render/annotate/overlay_parts.h"
#include "study/maps/gdal_support.h"
#include "study/picture/map_colors.h"
#include "study/picture/map_objects.h"

namespace emscape::study {
namespace {

/// A picture over a box of longitudes and latitudes.
struct Overlay {
  render::Image8 image;
  double north_deg = 0, south_deg = 0, east_deg = 0, west_deg = 0;
};

constexpr std::size_t kHatchPixels = 4;  ///< of the map, from line to line

std::array<std::uint8_t, 4> bytesOf(const std::optional<render::Rgb>& color) {
  if (!color) return {0, 0, 0, 0};
  const auto level = [](float part) { return static_cast<std::uint8_t>(std::lround(255 * part)); };
  return {level(color->r), level(color->g), level(color->b), 255};
}

/// Options of GDALWarp for the picture's projection, extent and size.
std::vector<std::string> warpOptions(const MapGrid& grid) {
  // Longitudes within 180 degrees of the map, so that a map across the antimeridian is not split.
  const auto earth = [](double middle_deg) {
    return fmt::format("+proj=longlat +datum=WGS84 +no_defs +lon_wrap={:.6f}", middle_deg);
  };
  std::vector<std::string> options{"-r", "near", "-of", "MEM", "-t_srs"};
  const bool has_north = grid.pixelAt(90, 0) >= 0;
  if (!has_north && grid.pixelAt(-90, 0) < 0) {
    options.push_back(earth(grid.positions[grid.pixels() / 2].longitude_deg));
    return options;
  }
  // GDAL finds no extent around a pole. The picture has all longitudes; its pixels are about those of the map
  // at its edge, and smaller nearer to the pole.
  constexpr int kMaxWidth = 8192;
  const double diagonal = std::hypot(grid.width, grid.height);
  const int width = static_cast<int>(std::min<double>(kMaxWidth, std::ceil(kPi * diagonal)));
  const int height = static_cast<int>(std::min<double>(kMaxWidth / 2, std::ceil(diagonal)));
  const double side = has_north ? 1 : -1;
  double edge_deg = 90;  // the latitude that is farthest from the pole, times `side`
  for (const emfield::Surface::Position& position : grid.positions) {
    edge_deg = std::fmin(edge_deg, side * position.latitude_deg);
  }
  const double pixel_deg = grid.cell_m / 111e3;
  edge_deg = std::max(-90.0, edge_deg - pixel_deg);  // places are the pixels' centres
  const double south_deg = has_north ? edge_deg : -90, north_deg = has_north ? 90 : -edge_deg;
  options.insert(options.end(),
                 {earth(0), "-te", "-180", fmt::format("{}", south_deg), "180", fmt::format("{}", north_deg),
                  "-ts", std::to_string(width), std::to_string(height),
                  // So that the part of the map that GDAL reads contains the whole circle.
                  "-wo", "SAMPLE_STEPS=101", "-wo", "SOURCE_EXTRA=10"});
  return options;
}

Overlay overlayOf(const MapGrid& grid, const Map& map, const render::Legend& legend,
                  const std::filesystem::path& file) {
  const scenario::GdalMessages messages;
  const gdal::Dataset raster = memoryRaster(grid, GDT_Byte, file);
  for (int channel = 1; channel < 4; ++channel) GDALAddBand(raster.get(), GDT_Byte, nullptr);
  std::vector<std::uint8_t> rgba;
  for (std::size_t p = 0; p < map.values.size(); ++p) {
    const std::size_t column = p % static_cast<std::size_t>(grid.width), row = p / grid.width;
    const bool is_line = isUnknown(map, p) && (column + row) % kHatchPixels == 0;
    const auto color = is_line ? std::optional(render::kHatchInk.color) : colorOf(map, legend, map.values[p]);
    for (const std::uint8_t byte : bytesOf(color)) rgba.push_back(byte);
  }
  if (GDALDatasetRasterIO(raster.get(), GF_Write, 0, 0, grid.width, grid.height, rgba.data(), grid.width,
                          grid.height, GDT_Byte, 4, nullptr, 4, 4 * grid.width, 1) != CE_None) {
    failWriting(messages, file);
  }
  std::vector<std::string> texts = warpOptions(grid);
  std::vector<char*> arguments;
  for (std::string& text : texts) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  GDALWarpAppOptions* const options = GDALWarpAppOptionsNew(arguments.data(), nullptr);
  GDALWarpAppOptionsSetProgress(options, goesOn, nullptr);
  GDALDatasetH source = raster.get();
  const gdal::Dataset warped(GDALWarp("", nullptr, 1, &source, options, nullptr));
  GDALWarpAppOptionsFree(options);
  if (warped == nullptr) failWriting(messages, file);

  Overlay overlay;
  const int width = GDALGetRasterXSize(warped.get()), height = GDALGetRasterYSize(warped.get());
  overlay.image.size = {width, height};
  overlay.image.rgba.resize(4 * static_cast<std::size_t>(width) * height);
  double transform[6];
  const bool is_read =
      GDALGetGeoTransform(warped.get(), transform) == CE_None &&
      GDALDatasetRasterIO(warped.get(), GF_Read, 0, 0, width, height, overlay.image.rgba.data(), width,
                          height, GDT_Byte, 4, nullptr, 4, 4 * width, 1) == CE_None;
  if (!is_read || messages.hasFailure()) failWriting(messages, file);
  overlay.west_deg = transform[0];
  overlay.east_deg = transform[0] + width * transform[1];
  overlay.north_deg = transform[3];
  overlay.south_deg = transform[3] + height * transform[5];
  return overlay;
}

render::Image8 legendPicture(const render::Legend& legend) {
  const render::Style style({1200, 900}, render::Theme::light);
  const double height = std::max(420.0, render::legendHeight(style, legend));
  const render::ImageSize size{static_cast<int>(std::ceil(render::legendWidth(style, legend))),
                               static_cast<int>(std::ceil(height))};
  render::Canvas canvas(size);
  canvas.rectangle({0, 0, static_cast<double>(size.width), static_cast<double>(size.height)},
                   {{1, 1, 1}, 0.85});
  render::drawLegend(canvas, style, legend);
  return canvas.pixels();
}

/// aabbggrr
std::string kmlColor(const render::Rgb& color) {
  const std::array<std::uint8_t, 4> bytes = bytesOf(color);
  return fmt::format("ff{:02x}{:02x}{:02x}", bytes[2], bytes[1], bytes[0]);
}

class Kmz : public MapCollection {
 public:
  Kmz(const std::filesystem::path& file, const MapStudy& study) : file_(file), study_(study) {
    const scenario::GdalMessages messages;
    zip_ = CPLCreateZip(file_.temporary().c_str(), nullptr);
    if (zip_ == nullptr) failWriting(messages, file_.file());
  }

  ~Kmz() override {
    const scenario::GdalMessages messages;
    if (zip_ != nullptr) CPLCloseZip(zip_);
  }

  void add(const Map& map) override {
    Folder& folder = folderOf(map);
    const render::Legend legend = legendOf(map);
    const std::string name = "files/" + fileNameOf(map) + ".png";
    const Overlay overlay = overlayOf(*study_.grid, map, legend, file_.file());
    write(name, render::encodePng(overlay.image));
    // The range of the colours may differ from time to time.
    const std::string legend_name = "files/legend_" + fileNameOf(map) + ".png";
    write(legend_name, render::encodePng(legendPicture(legend)));
    const std::string visibility = fmt::format("<visibility>{}</visibility>", folder.is_on ? 1 : 0);
    const std::string span = map.time_s ? spanOf(*map.time_s, endOf(study_, *map.time_s)) : "";
    const std::string title =
        escapedXml(map.description + (map.time_s ? fmt::format(", t = {} s", *map.time_s) : std::string()));
    folder.content += fmt::format(
        "<GroundOverlay><name>{}</name>{}{}<color>b8ffffff</color><Icon><href>{}</href></Icon><LatLonBox>"
        "<north>{:.9f}</north><south>{:.9f}</south><east>{:.9f}</east><west>{:.9f}</west></LatLonBox>"
        "</GroundOverlay>\n",
        title, visibility, span, name, overlay.north_deg, overlay.south_deg, overlay.east_deg,
        overlay.west_deg);
    folder.content += fmt::format(
        "<ScreenOverlay><name>legend</name>{}{}<Icon><href>{}</href></Icon>"
        "<overlayXY x=\"1\" y=\"0.5\" xunits=\"fraction\" yunits=\"fraction\"/>"
        "<screenXY x=\"0.99\" y=\"0.5\" xunits=\"fraction\" yunits=\"fraction\"/></ScreenOverlay>\n",
        visibility, span, legend_name);
  }

  void finish() override {
    std::string kml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n"
        "<Document><name>" +
        escapedXml(study_.title) + "</name><open>1</open>\n" + emitters() + tracks();
    for (const Folder& folder : folders_) {
      kml += fmt::format("<Folder><name>{}</name><visibility>{}</visibility>\n{}</Folder>\n",
                         escapedXml(folder.name), folder.is_on ? 1 : 0, folder.content);
    }
    write("doc.kml", kml + "</Document></kml>\n");
    {
      const scenario::GdalMessages messages;
      const CPLErr closed = CPLCloseZip(zip_);
      zip_ = nullptr;
      if (closed != CE_None || messages.hasFailure()) failWriting(messages, file_.file());
    }
    file_.publish(kAuxiliary);
  }

 private:
  struct Folder {
    std::string name, content;
    bool is_on = false;
  };

  Folder& folderOf(const Map& map) {
    const std::string name = map.title + (map.height ? ", " + describe(*map.height) : "");
    for (Folder& folder : folders_) {
      if (folder.name == name) return folder;
    }
    folders_.push_back({name, "", folders_.empty()});
    return folders_.back();
  }

  std::string spanOf(double begin_s, double end_s) const {
    return fmt::format("<TimeSpan><begin>{}</begin><end>{}</end></TimeSpan>", utcOf(study_, begin_s),
                       utcOf(study_, end_s));
  }

  void write(const std::string& name, const std::string& bytes) {
    const scenario::GdalMessages messages;
    const bool is_written =
        CPLCreateFileInZip(zip_, name.c_str(), nullptr) == CE_None &&
        CPLWriteFileInZip(zip_, bytes.data(), static_cast<int>(bytes.size())) == CE_None &&
        CPLCloseFileInZip(zip_) == CE_None;
    if (!is_written || messages.hasFailure()) failWriting(messages, file_.file());
  }

  std::string emitters() const {
    std::string text = "<Folder><name>emitters</name>\n";
    for (const MapEmitter& emitter : emittersOf(study_)) {
      const render::Rgb color = pointColorOf(*emitter.emitter);
      for (const MapPosition& at : emitter.positions) {
        const bool is_of_a_time = emitter.is_moving && study_.times_s.size() > 1;
        const std::string span = is_of_a_time ? spanOf(at.time_s, endOf(study_, at.time_s)) : "";
        text += fmt::format(
            "<Placemark><name>{}</name><description>{}, {:.6g} MHz, {:.6g} W{}</description>{}<Style>"
            "<IconStyle><color>{}</color><scale>0.8</scale></IconStyle></Style><Point>"
            "<altitudeMode>absolute</altitudeMode><coordinates>{:.8f},{:.8f},{:.2f}</coordinates></Point>"
            "</Placemark>\n",
            escapedXml(emitter.emitter->name), scenario::toString(emitter.emitter->kind),
            emitter.emitter->frequency_hz / 1e6, emitter.emitter->power_w,
            emitter.emitter->enabled ? "" : ", switched off", span, kmlColor(color),
            at.position.longitude_deg, at.position.latitude_deg, at.height_msl_m);
      }
    }
    return text + "</Folder>\n";
  }

  std::string tracks() const {
    std::string text = "<Folder><name>tracks</name>\n";
    for (const MapTrack& track : tracksOf(study_)) {
      text += fmt::format(
          "<Placemark><name>{}</name><Style><LineStyle><color>ff404040</color><width>2</width></LineStyle>"
          "</Style><LineString><altitudeMode>absolute</altitudeMode><coordinates>",
          escapedXml(track.platform->name));
      for (const MapPosition& at : track.positions) {
        text += fmt::format("{:.8f},{:.8f},{:.2f} ", at.position.longitude_deg, at.position.latitude_deg,
                            at.height_msl_m);
      }
      text += "</coordinates></LineString></Placemark>\n";
    }
    return text + "</Folder>\n";
  }

  UnfinishedFile file_;
  const MapStudy& study_;
  void* zip_ = nullptr;
  std::vector<Folder> folders_;
};

}  // namespace

std::unique_ptr<MapCollection> makeKmz(const std::filesystem::path& file, const MapStudy& study) {
  return std::make_unique<Kmz>(file, study);
}

}  // namespace emscape::study

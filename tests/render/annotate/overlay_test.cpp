#include "emscape/render/annotate/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/render/scene/renderer.h"
#include "tests/render/layered_picture.h"
#include "tests/render/scenes.h"

namespace emscape::render {
namespace {

const SceneBox kBox{{-15000, -15000, 0}, {15000, 15000, 6000}, 2.0};

Annotations everything(const TransferFunction& function) {
  Annotations annotations;
  annotations.title = "Title";
  annotations.subtitle = "subtitle";
  annotations.time = "t = 1 s";
  annotations.time_utc = "2026-06-01T06:00:01Z";
  annotations.note = "note";
  volume::VolumeInfo info;
  info.quantity = "power_density_dbwm2";
  info.unit = "dBW/m2";
  annotations.legend = legendOf(info, function);
  for (MarkerKind kind : {MarkerKind::radar, MarkerKind::transmitter, MarkerKind::jammer,
                          MarkerKind::receiver, MarkerKind::platform}) {
    Marker marker;
    marker.position_m = {1000.0 * static_cast<double>(annotations.markers.size()), -500, 900};
    marker.label = "marker";
    marker.kind = kind;
    marker.beam = Vec3d{1, 0, 0};
    marker.ground_m = 100;
    annotations.markers.push_back(marker);
  }
  for (const char* plane : {"horizontal:altitude_m=2000", "vertical:bearing_deg=40,offset_m=2000"})
    annotations.planes.push_back(parseCutPlane(plane));
  annotations.planes.insert(annotations.planes.begin() + 1, annotations.planes[0]);
  annotations.planes[1].on = false;
  std::swap(annotations.planes[1], annotations.planes[2]);
  annotations.tracks.push_back({MarkerKind::jammer,
                                {{-9000, 4000, 2500}, {0, 7000, 2500}, {40000, 7000, 2500}},
                                {},
                                0.5,
                                Affiliation::none});
  return annotations;
}

long long differingPixels(const Image8& a, const Image8& b) {
  return compare(a, b).erroneous;
}

TEST(Overlay, ClassesOnTheGroundAreListedAtTheLeftAboveTheCompass) {
  const ImageSize size{1200, 900};
  const Camera camera = makeCamera({}, kBox, size);
  const auto with = [&](int count) {
    Annotations annotations;
    annotations.axes = false;
    for (int n = 0; n < count; ++n)
      annotations.ground_classes.push_back({0, "class " + std::to_string(n), Rgb{1, 0, 0}});
    return compose(Image(size), camera, kBox, annotations);
  };
  const Image8 none = with(0);
  const auto redPixels = [&](const Image8& picture) {
    int red = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (std::equal(picture.at(x, y), picture.at(x, y) + 4, none.at(x, y))) continue;
        EXPECT_LT(x, size.width / 2);
        EXPECT_GT(y, 50);
        EXPECT_LT(y, size.height - 130);
        const std::uint8_t* const at = picture.at(x, y);
        if (at[0] > 250 && at[1] < 5) ++red;
      }
    }
    return red;
  };
  const int three = redPixels(with(3)), many = redPixels(with(300));
  EXPECT_NEAR(three, 3 * 15 * 15, 3 * 30) << "swatches without their corners";
  EXPECT_GT(many, 5 * three);
  EXPECT_LT(many, 30 * 15 * 15);
}

TEST(Overlay, LegendsOfManyCategoriesEndInsideThePicture) {
  const ImageSize size{800, 600};
  const Camera camera = makeCamera({}, kBox, size);
  const auto with = [&](int count) {
    Annotations annotations;
    volume::VolumeInfo info;
    info.quantity = "dominant_emitter";
    info.categorical = true;
    info.range_min = 0;
    info.range_max = 300;
    annotations.legend = legendOf(info, defaultTransferFunction(info));
    for (int n = 0; n < count; ++n) annotations.legend->categories.push_back({n, std::to_string(1000 + n)});
    annotations.axes = annotations.georeferenced = false;
    return compose(Image(size), camera, kBox, annotations);
  };
  const Image8 few = with(3), many = with(300);
  EXPECT_GT(differingPixels(few, many), 100);
  for (int x = 0; x < size.width; ++x) {
    for (int y = size.height - 3; y < size.height; ++y) {
      EXPECT_TRUE(std::equal(few.at(x, y), few.at(x, y) + 4, many.at(x, y))) << x << " " << y;
    }
  }
}

TEST(Overlay, SymbolsAndLabelsAreOfTheColumnsThatAreSeen) {
  const ImageSize size{800, 600};
  const Camera camera = makeCamera({}, kBox, size);
  Annotations annotations;
  annotations.axes = annotations.georeferenced = false;
  const Image8 empty = compose(Image(size), camera, kBox, annotations);
  Marker marker;
  marker.position_m = {0, 0, 3000};
  marker.label = "a name that is long";
  annotations.markers = {marker};
  const int at = static_cast<int>(project(camera, size, kBox.toDrawn(marker.position_m)).x);
  const auto drawn = [&](int first, int end) {
    Annotations part = annotations;
    part.first_column = first;
    part.end_column = end;
    const Image8 picture = compose(Image(size), camera, kBox, part);
    std::pair<int, int> columns{size.width, -1};
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (std::equal(empty.at(x, y), empty.at(x, y) + 4, picture.at(x, y))) continue;
        columns = {std::min(columns.first, x), std::max(columns.second, x)};
      }
    }
    return columns;
  };
  EXPECT_EQ(drawn(0, at - 5).second, -1) << "the symbol is in the other part";
  EXPECT_EQ(drawn(at + 5, size.width).second, -1);
  const int edge = 30;  // of the symbol, with room for its half
  EXPECT_LT(drawn(0, at + edge).second, at + edge) << "the name is at the left";
  EXPECT_LT(drawn(0, at + edge).first, at - edge);
  EXPECT_GE(drawn(at - edge, size.width).first, at - edge);
  EXPECT_GT(drawn(at - edge, size.width).second, at + edge);
}

TEST(Overlay, PicturesAreOpaqueInEverySizeThemeAndView) {
  const Annotations all = everything(testing::fog(0.5));
  for (ImageSize size : {ImageSize{1, 1}, ImageSize{7, 300}, ImageSize{160, 90}, ImageSize{640, 360}}) {
    for (Theme theme : {Theme::dark, Theme::light}) {
      for (const char* view :
           {"orbit", "orbit:elevation_deg=90", "orbit:elevation_deg=-90,projection=orthographic",
            "lookat:eye_x_m=0,eye_y_m=0,eye_z_m=2000,target_x_m=1,target_y_m=9,target_z_m=1900"}) {
        Annotations annotations = all;
        annotations.theme = theme;
        const Camera camera = makeCamera(parseCamera(view), kBox, size, overlayMargins(size, annotations));
        const Image8 picture =
            compose(Image(size), camera, kBox, annotations, [](const Vec3d&) { return true; });
        ASSERT_EQ(picture.size, size);
        for (std::size_t i = 3; i < picture.rgba.size(); i += 4) ASSERT_EQ(picture.rgba[i], 255);
      }
    }
  }
}

TEST(Overlay, EveryAnnotationIsSeen) {
  const ImageSize size{640, 360};
  const Annotations all = everything(testing::fog(0.5));
  const Camera camera = makeCamera({}, kBox, size, overlayMargins(size, all));
  const auto picture = [&](const Annotations& annotations) {
    return compose(Image(size), camera, kBox, annotations);
  };
  const Image8 complete = picture(all);
  const auto without = [&](void (*remove)(Annotations&)) {
    Annotations annotations = all;
    remove(annotations);
    return differingPixels(complete, picture(annotations));
  };
  EXPECT_GT(without([](Annotations& a) { a.title.clear(); }), 50);
  EXPECT_GT(without([](Annotations& a) { a.subtitle.clear(); }), 50);
  EXPECT_GT(without([](Annotations& a) { a.time.clear(); }), 50);
  EXPECT_GT(without([](Annotations& a) { a.time_utc.clear(); }), 50);
  EXPECT_GT(without([](Annotations& a) { a.note.clear(); }), 20);
  EXPECT_GT(without([](Annotations& a) { a.legend.reset(); }), 500);
  EXPECT_GT(without([](Annotations& a) { a.axes = false; }), 500);
  EXPECT_GT(without([](Annotations& a) { a.georeferenced = false; }), 50);
  EXPECT_GT(without([](Annotations& a) { a.markers.pop_back(); }), 50);
  EXPECT_GT(without([](Annotations& a) { a.markers[0].active = false; }), 20);
  EXPECT_GT(without([](Annotations& a) { a.tracks.clear(); }), 100);
  EXPECT_GT(without([](Annotations& a) { a.planes.erase(a.planes.begin() + 1); }), 200);
  EXPECT_GT(without([](Annotations& a) { a.planes[0].altitude_m = 2100; }), 200);
  EXPECT_EQ(without([](Annotations& a) { a.planes[2].altitude_m = 2100; }), 0) << "it is off";
  EXPECT_GT(without([](Annotations& a) { a.tracks[0].travelled = 1.5; }), 50);
  EXPECT_GT(without([](Annotations& a) { a.theme = Theme::light; }), 100000);
}

/// All opacities and levels.
Image gradients(ImageSize size) {
  Image cast(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float alpha = static_cast<float>(x) / static_cast<float>(size.width - 1);
      const float level = static_cast<float>(y) / static_cast<float>(size.height - 1);
      cast.at(x, y) = {alpha * level, alpha * (1 - level), alpha, alpha};
    }
  }
  return cast;
}

int largestDifference(const Image8& a, const Image8& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
  return largest;
}

TEST(Overlay, LayersEqualPictureComposedAtOnce) {
  const ImageSize size{320, 240};
  const Image8 cast = quantize(gradients(size));
  Annotations annotations = everything(testing::fog(0.5));
  OverlayLayers layers;
  for (Theme theme : {Theme::dark, Theme::light}) {
    annotations.theme = theme;
    const Camera camera = makeCamera({}, kBox, size, overlayMargins(size, annotations));
    const HiddenTest hidden = [](const Vec3d& position_m) { return position_m.x > 2000; };
    drawLayers(layers, size, camera, kBox, annotations, hidden);
    ASSERT_EQ(layers.behind.size(), static_cast<std::size_t>(size.count()));
    ASSERT_EQ(layers.front.size(), static_cast<std::size_t>(size.count()));
    EXPECT_LE(largestDifference(testing::putTogether(cast, layers),
                                compose(cast, camera, kBox, annotations, hidden)),
              2);
  }
}

TEST(Overlay, AQuantizedPictureIsAtMostOneLevelApart) {
  const ImageSize size{320, 240};
  const Image cast = gradients(size);
  const Annotations annotations = everything(testing::fog(0.5));
  const Camera camera = makeCamera({}, kBox, size, overlayMargins(size, annotations));
  const Image8 exact = compose(cast, camera, kBox, annotations);
  const Image8 quantized = compose(quantize(cast), camera, kBox, annotations);
  EXPECT_LE(largestDifference(exact, quantized), 1);
}

TEST(Overlay, HiddenMarkersAreDrawnDifferently) {
  const ImageSize size{640, 360};
  const Annotations all = everything(testing::fog(0.5));
  const Camera camera = makeCamera({}, kBox, size);
  const Image8 seen = compose(Image(size), camera, kBox, all);
  const Image8 hidden = compose(Image(size), camera, kBox, all, [](const Vec3d&) { return true; });
  EXPECT_GT(differingPixels(seen, hidden), 200);
}

TEST(Overlay, AnyLegendLeavesTheSceneTheSameRoom) {
  const ImageSize size{1200, 900};
  Annotations annotations = everything(testing::fog(0.5));
  const double with = overlayMargins(size, annotations).right;
  annotations.legend->quantity = "Detection probability of a radar";
  annotations.legend->unit = "";
  EXPECT_EQ(overlayMargins(size, annotations).right, with);
  annotations.legend->function.categorical = true;
  annotations.legend->categories = {{0, "a radar with a long name"}};
  EXPECT_EQ(overlayMargins(size, annotations).right, with);
  annotations.legend.reset();
  EXPECT_GT(with, overlayMargins(size, annotations).right + 0.03);
}

TEST(Overlay, TicksOfHorizontalAxesAreAtTheGroundsEdges) {
  const ImageSize size{640, 480};
  Annotations annotations;
  for (const char* view : {"orbit", "orbit:azimuth_deg=180", "orbit:azimuth_deg=180,elevation_deg=89",
                           "orbit:azimuth_deg=180,elevation_deg=90,projection=orthographic"}) {
    const Camera camera = makeCamera(parseCamera(view), kBox, size, overlayMargins(size, annotations));
    annotations.axes = true;
    const Image8 with = compose(Image(size), camera, kBox, annotations);
    annotations.axes = false;
    const Image8 without = compose(Image(size), camera, kBox, annotations);
    const Vec3d& low = kBox.lower_m;
    // The middle of each axis, 0 km, has a tick: a line of some pixels away from the box.
    int ticks = 0;
    for (const Vec3d& at :
         {Vec3d{0, low.y, low.z}, {0, -low.y, low.z}, {low.x, 0, low.z}, {-low.x, 0, low.z}}) {
      const Projected on_edge = project(camera, size, at), center = project(camera, size, {0, 0, low.z});
      const double away_px = std::hypot(on_edge.x - center.x, on_edge.y - center.y);
      const int x = static_cast<int>(std::lround(on_edge.x + 3 * (on_edge.x - center.x) / away_px));
      const int y = static_cast<int>(std::lround(on_edge.y + 3 * (on_edge.y - center.y) / away_px));
      bool is_drawn = false;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          is_drawn = is_drawn || !std::equal(with.at(x + dx, y + dy), with.at(x + dx, y + dy) + 4,
                                             without.at(x + dx, y + dy));
        }
      }
      ticks += is_drawn ? 1 : 0;
    }
    EXPECT_GE(ticks, 2) << view;
  }
}

TEST(Overlay, ScaleIsAMinimumOfTheSizeOfTextsThatSmallPicturesLimit) {
  const auto heightAt = [](ImageSize size, double scale) {
    Annotations annotations = everything(testing::fog(0.5));
    annotations.scale = scale;
    return legendHeading(size, annotations).height;
  };
  const ImageSize usual{1200, 900}, small{300, 225};
  EXPECT_DOUBLE_EQ(heightAt(usual, 0.5), heightAt(usual, 0));
  EXPECT_DOUBLE_EQ(heightAt(usual, 2), 2 * heightAt(usual, 0));
  EXPECT_LT(heightAt(small, 4), 0.2 * small.height);
}

/// Whether pictures differ in columns from..to-1.
bool differInColumns(const Image8& a, const Image8& b, int from, int to) {
  for (int y = 0; y < a.size.height; ++y) {
    if (!std::equal(a.at(from, y), a.at(from, y) + 4 * (to - from), b.at(from, y))) return true;
  }
  return false;
}

TEST(Overlay, ALongTitleEndsBeforeTheTime) {
  const ImageSize size{640, 480};
  Annotations annotations = everything(testing::fog(0.5));
  annotations.subtitle = annotations.time_utc = "";
  const Camera camera = makeCamera({}, kBox, size);
  const Image8 named = compose(Image(size), camera, kBox, annotations);
  annotations.title = std::string(80, 'm');
  const Image8 long_named = compose(Image(size), camera, kBox, annotations);
  annotations.title = std::string(200, 'm');
  const Image8 longer = compose(Image(size), camera, kBox, annotations);
  EXPECT_TRUE(differInColumns(named, long_named, 400, 500));
  EXPECT_FALSE(differInColumns(named, long_named, 562, 640));  // the time
  EXPECT_FALSE(differInColumns(long_named, longer, 0, 640));
}

TEST(Overlay, LongNamesDoNotSqueezeTheVolume) {
  const ImageSize size{640, 480};
  TransferFunction function = testing::fog(0);
  function.categorical = true;
  Annotations annotations = everything(function);
  annotations.legend->categories = {{0, "first"}, {1, std::string(120, 'm')}};
  EXPECT_LT(overlayMargins(size, annotations).right, 0.4);
  const Camera camera = makeCamera({}, kBox, size, overlayMargins(size, annotations));
  const Image8 picture = compose(Image(size), camera, kBox, annotations);
  annotations.legend->categories[1].name += "m";
  EXPECT_EQ(differingPixels(picture, compose(Image(size), camera, kBox, annotations)), 0);
  annotations.markers[0].label = std::string(120, 'm');
  const Image8 marked = compose(Image(size), camera, kBox, annotations);
  annotations.markers[0].label += "m";
  EXPECT_EQ(differingPixels(marked, compose(Image(size), camera, kBox, annotations)), 0);
  annotations.legend->function = testing::fog(0.5);
  annotations.legend->quantity = "SNR of " + std::string(120, 'm');
  annotations.legend->note = std::string(120, 'm');
  EXPECT_LT(overlayMargins(size, annotations).right, 0.4);
}

TEST(Overlay, DegenerateTransferFunctionsDoNotBreakTheLegend) {
  const ImageSize size{320, 240};
  TransferFunction function = testing::fog(0);
  const Camera camera = makeCamera({}, kBox, size);
  EXPECT_NO_THROW(compose(Image(size), camera, kBox, everything(function)));
  function.categorical = true;
  Annotations annotations = everything(function);
  annotations.legend->categories = {{0, "first"}, {1, "a category with a very long name indeed"}};
  EXPECT_NO_THROW(compose(Image(size), camera, kBox, annotations));
}

TEST(Overlay, ThemesHaveNames) {
  EXPECT_EQ(parseTheme("light"), Theme::light);
  EXPECT_THROW(parseTheme("blue"), Error);
}

TEST(Overlay, MarksTheIsoValueOnTheColourBar) {
  const ImageSize size{600, 400};
  Annotations annotations =
      everything(testing::makeFunction({{0, {0, 0, 0}}, {10, {1, 1, 1}}}, {{0, 0}, {10, 0.1}}));
  const Camera camera = makeCamera({}, kBox, size, overlayMargins(size, annotations));
  annotations.legend->iso_value = 5;
  const Image8 middle = compose(Image(size), camera, kBox, annotations);
  constexpr int kMiddle = 213, kMark = 12;  // rows
  double last_row = size.height;
  for (double value : {-5.0, 2.0, 8.0, 50.0}) {  // beyond the bar: beyond its ends
    annotations.legend->iso_value = value;
    const Image8 marked = compose(Image(size), camera, kBox, annotations);
    double rows = 0, count = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (std::abs(y - kMiddle) < kMark) continue;
        if (std::equal(marked.at(x, y), marked.at(x, y) + 4, middle.at(x, y))) continue;
        rows += y;
        ++count;
      }
    }
    ASSERT_GT(count, 20);
    EXPECT_LT(rows / count, last_row);
    last_row = rows / count;
  }
}

/// Pixels of a picture that differ with marks on the ground.
long long pixelsOfMarks(const Annotations& marks, const HiddenTest& hidden = {}) {
  Annotations annotations = marks;
  const ImageSize size{320, 240};
  const Camera camera = makeCamera(parseCamera("orbit"), kBox, size, overlayMargins(size, annotations));
  const Image8 with = compose(Image(size), camera, kBox, annotations, hidden);
  annotations.ground_lines.clear();
  annotations.ground_points.clear();
  return differingPixels(with, compose(Image(size), camera, kBox, annotations, hidden));
}

TEST(Overlay, MarksOnTheGroundAreDrawnWhereItDoesNotHideThem) {
  Annotations line;
  line.ground_lines = {{GroundInk::coast, {{-9000, 0, 0}, {0, 0, 0}, {9000, 0, 0}}, ""}};
  EXPECT_GT(pixelsOfMarks(line), 100);
  EXPECT_EQ(pixelsOfMarks(line, [](const Vec3d&) { return true; }), 0);
  const double kNaN = std::numeric_limits<double>::quiet_NaN();
  line.ground_lines[0].points_m = {{-9000, 0, kNaN}, {0, 0, 0}, {9000, 0, kNaN}};
  EXPECT_EQ(pixelsOfMarks(line), 0) << "over holes";
  Annotations point;
  point.ground_points = {{{0, 0, 0}, ""}};
  const long long dot = pixelsOfMarks(point);
  EXPECT_GT(dot, 4);
  point.ground_points[0].label = "harbour";
  EXPECT_GT(pixelsOfMarks(point), dot + 20);
  point.ground_points.push_back(point.ground_points[0]);
  EXPECT_GT(pixelsOfMarks(point), dot + 20) << "the second name is beside the first";
}

TEST(Overlay, SymbolsOfOnePositionStandSideBySide) {
  const ImageSize size{640, 480};
  Annotations annotations;
  annotations.axes = annotations.compass = false;
  const auto pixelsOf = [&](std::vector<MarkerKind> kinds) {
    const auto picture = [&] { return compose(Image(size), makeCamera({}, kBox, size), kBox, annotations); };
    annotations.markers.clear();
    const Image8 empty = picture();
    for (const MarkerKind kind : kinds) annotations.markers.emplace_back().kind = kind;
    return differingPixels(empty, picture());
  };
  const long long both = pixelsOf({MarkerKind::radar, MarkerKind::transmitter});
  EXPECT_GE(both, pixelsOf({MarkerKind::radar}) + 0.8 * pixelsOf({MarkerKind::transmitter}));
}

TEST(Overlay, HeightsOfLabelsAreInTheUnits) {
  const ImageSize size{640, 480};
  Annotations annotations;
  annotations.axes = annotations.compass = false;
  annotations.markers.resize(1);
  annotations.markers[0].label = "mast";
  annotations.markers[0].height_m = 304.8;
  const auto picture = [&] { return compose(Image(size), makeCamera({}, kBox, size), kBox, annotations); };
  const Image8 metric = picture();
  annotations.units = Units::nautical;
  const Image8 nautical = picture();
  EXPECT_GT(differingPixels(metric, nautical), 5);
  annotations.markers[0].height_m.reset();
  annotations.markers[0].detail = "1000 ft above sea";
  EXPECT_EQ(differingPixels(nautical, picture()), 0);
}

TEST(Overlay, AxesCountFromTheNamedOriginInTheUnits) {
  const ImageSize size{640, 480};
  const auto picture = [&](const Annotations& annotations) {
    const Camera camera = makeCamera(parseCamera("orbit"), kBox, size, overlayMargins(size, annotations));
    return compose(Image(size), camera, kBox, annotations);
  };
  Annotations annotations;
  const Image8 plain = picture(annotations);
  annotations.origin_longitude = "3°E";
  annotations.origin_latitude = "51.3°N";
  const Image8 named = picture(annotations);
  EXPECT_GT(differingPixels(plain, named), 50);
  annotations.units = Units::nautical;
  EXPECT_GT(differingPixels(named, picture(annotations)), 50);
  annotations.scale_bar = true;
  const Image8 with_bar = picture(annotations);
  annotations.compass = false;
  EXPECT_GT(differingPixels(with_bar, picture(annotations)), 200);
}

}  // namespace
}  // namespace emscape::render

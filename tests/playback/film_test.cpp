#include "playback/pictures/film.h"

#include "emscape/base/units.h"
#include "emscape/playback/pictures/painter.h"
#include "playback/frames/platform_tracks.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

Bookmark stop(double azimuth_deg, double distance, std::optional<double> time_s = {}) {
  Bookmark bookmark;
  bookmark.camera.azimuth_deg = azimuth_deg;
  bookmark.camera.distance = distance;
  bookmark.time_s = time_s;
  return bookmark;
}

TEST(Film, CameraFliesFromBookmarkToBookmarkAlongTheShorterArc) {
  const std::vector<Bookmark> stops{stop(350, 1), stop(10, 0.25), stop(100, 0.25)};
  EXPECT_EQ(toString(cameraOnPath(stops, 0)), toString(stops[0].camera));
  const render::CameraSpec middle = cameraOnPath(stops, 0.5);
  EXPECT_THAT(middle.azimuth_deg, DoubleNear(360, 1e-9));
  EXPECT_THAT(*middle.distance, DoubleNear(0.5, 1e-9)) << "by equal factors";
  EXPECT_EQ(toString(cameraOnPath(stops, 2)), toString(stops[2].camera));
  EXPECT_EQ(toString(cameraOnPath(stops, 9)), toString(stops[2].camera));
}

TEST(Film, TimesOfBookmarksAreKeptIfTheyAscend) {
  MadeFrames source(seconds(11));
  ViewState view;
  view.camera_path = CameraPath::bookmarks;
  view.bookmarks = {stop(0, 1, 2.0), stop(90, 1, 4.0)};
  const Film film = filmOf(view, source, std::nullopt);
  ASSERT_EQ(film.cameras.size(), 11U);
  EXPECT_EQ(film.cameras[2].azimuth_deg, 0);
  EXPECT_EQ(film.cameras[3].azimuth_deg, 45);
  EXPECT_EQ(film.cameras[4].azimuth_deg, 90);
  view.bookmarks[1].time_s.reset();
  EXPECT_EQ(filmOf(view, source, std::nullopt).cameras[5].azimuth_deg, 45) << "evenly";
  view.bookmarks.resize(1);
  EXPECT_THAT(errorOf([&] { filmOf(view, source, std::nullopt); }),
              HasSubstr("camera path: the view has 1 bookmark; expected at least 2"));
}

TEST(Film, VideosStateTheirSpeed) {
  MadeFrames source(seconds(11));
  ViewState view;
  view.size = {160, 120};
  EXPECT_EQ(filmOf(view, source, 5.0).speed, 5);
  EXPECT_FALSE(filmOf(view, source, std::nullopt).speed) << "pictures";
  view.film_speed = false;
  EXPECT_FALSE(filmOf(view, source, 5.0).speed);
  Painter painter(view, source, {});
  painter.setSpeed(5);
  painter.setFrame(source.frame(3));
  EXPECT_EQ(painter.annotations().time, "t = 3 s   ×5");
}

TEST(Painter, CameraFollowsAPlatform) {
  FrameSelection selection;
  selection.input = emscape::test::shippedScenario("jacksboro.yaml");
  selection.edits = {{"region.dims", "[8, 8, 4]"}};
  selection.independent = true;
  const auto source = openFrameSource(selection, {});
  ViewState view;
  view.size = {160, 120};
  view.follow = "helicopter";
  view.camera.distance = 0.3;
  Painter painter(view, *source, {});
  for (const double time_s : {0.0, 33.3}) {
    const Frame frame = source->frameAt(time_s);
    painter.setFrame(frame);
    const auto jammer = std::find_if(frame.markers.begin(), frame.markers.end(),
                                     [](const render::Marker& marker) { return marker.label == "jammer"; });
    ASSERT_NE(jammer, frame.markers.end());
    const auto at =
        render::project(painter.camera(), view.size, painter.sceneBox().toDrawn(jammer->position_m));
    const render::FrameMargins margins = render::overlayMargins(view.size, painter.annotations());
    EXPECT_NEAR(at.x, 160 * (1 + margins.left - margins.right) / 2, 2);
    EXPECT_NEAR(at.y, 120 * (1 + margins.top - margins.bottom) / 2, 2);
  }
  const Vec3d followed = painter.camera().forward;
  view.follow_mode = FollowMode::chase;
  view.camera.azimuth_deg = 180;
  painter.setFollowed(view);
  painter.setCamera(view.camera);
  const scenario::TrackPoint pose = scenario::pointAt(source->scene()->scenario->platforms[3], 33.3);
  const Vec3d forward = painter.camera().forward;
  EXPECT_GT(length(forward - followed), 0.01);
  const double bearing_deg = radToDeg(std::atan2(forward.x, forward.y));
  EXPECT_NEAR(std::remainder(bearing_deg - *pose.heading_deg, 360), 0, 1) << "from behind";
}

TEST(PlatformTracks, ATrailIsTheLastPartOfATrack) {
  render::Track track;
  track.points_m = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {20, 10, 0}};
  track.times_s = {0, 10, 20, 30};
  const render::Track trail = partOf(track, 15, 25);
  ASSERT_EQ(trail.points_m.size(), 3U);
  EXPECT_EQ(trail.points_m[0], (Vec3d{15, 0, 0}));
  EXPECT_EQ(trail.points_m[1], (Vec3d{20, 0, 0}));
  EXPECT_EQ(trail.points_m[2], (Vec3d{20, 5, 0}));
  EXPECT_EQ(trail.travelled, 2);
  EXPECT_TRUE(partOf(track, -20, -10).points_m.empty());
  EXPECT_EQ(partOf(track, -20, 5).points_m.size(), 2U);
}

}  // namespace
}  // namespace emscape::playback::test

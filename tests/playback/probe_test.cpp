#include "playback/editing/probe.h"

#include <algorithm>
#include <random>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/playback/frames/scene.h"
#include "emscape/scenario/model/snapshot.h"
#include "playback/editing/pick.h"
#include "tests/playback/playback_samples.h"
#include "volume/difference.h"

namespace emscape::playback::test {
namespace {

using testing::HasSubstr;
using Kind = VolumeSample::Kind;

/// 10 x 10 x 10 voxels of 100 m; the box begins at the frame's origin. value = x + 10 y + 100 z in voxels.
volume::DenseVolume madeVolume() {
  volume::DenseVolume volume;
  volume.grid.dims = {10, 10, 10};
  volume.grid.spacing_m = {100, 100, 100};
  volume.grid.first_center_m = {50, 50, 50};
  volume.info.quantity = "made";
  volume.info.unit = "dB";
  volume.info.floor = -1;
  for (int voxel = 0; voxel < 1000; ++voxel) volume.values.push_back(static_cast<float>(voxel));
  return volume;
}

TEST(SampleVolume, InterpolatesBetweenVoxelCentres) {
  const volume::DenseVolume volume = madeVolume();
  const VolumeSample center = sampleVolume(volume, volume.grid.center_m(3, 4, 5));
  EXPECT_EQ(center.kind, Kind::value);
  EXPECT_EQ(center.value, 543);
  EXPECT_EQ(center.voxel, (Dims{3, 4, 5}));
  const VolumeSample between = sampleVolume(volume, volume.grid.center_m(3, 4, 5) + Vec3d{50, 25, 10});
  EXPECT_NEAR(between.value, 543 + 0.5 + 2.5 + 10, 1e-3);
  // In the outer half voxel the values stay as at the outer centres.
  EXPECT_EQ(sampleVolume(volume, {0, 0, 0}).value, 0);
  EXPECT_EQ(sampleVolume(volume, {1000, 1000, 1000}).value, 999);
}

TEST(SampleVolume, ReportsWhyThereIsNoValue) {
  volume::DenseVolume volume = madeVolume();
  EXPECT_EQ(sampleVolume(volume, {-1, 500, 500}).kind, Kind::outside);
  EXPECT_EQ(sampleVolume(volume, {500, 500, 1001}).kind, Kind::outside);
  volume.first_valid_k.assign(100, 3);
  EXPECT_EQ(sampleVolume(volume, {500, 500, 250}).kind, Kind::masked);
  EXPECT_EQ(sampleVolume(volume, {500, 500, 350}).kind, Kind::value);
  // A masked neighbour does not contribute: the voxel's own value.
  EXPECT_EQ(sampleVolume(volume, volume.grid.center_m(4, 4, 3) - Vec3d{0, 0, 40}).value, 344);
  volume.values[static_cast<std::size_t>(volume.grid.index(1, 1, 8))] = -1;
  EXPECT_EQ(sampleVolume(volume, volume.grid.center_m(1, 1, 8)).kind, Kind::at_floor);
  volume.values[static_cast<std::size_t>(volume.grid.index(1, 1, 8))] = std::nanf("");
  EXPECT_EQ(sampleVolume(volume, volume.grid.center_m(1, 1, 8)).kind, Kind::masked);
  volume.info.categorical = true;
  EXPECT_EQ(sampleVolume(volume, volume.grid.center_m(3, 4, 5) + Vec3d{40, 0, 0}).value, 543);
}

TEST(Probe, DescribesValuesInWords) {
  volume::DenseVolume volume = madeVolume();
  volume.first_valid_k.assign(100, 1);
  volume.values.back() = -1;
  const auto textAt = [&](const Vec3d& position_m) {
    return probe(position_m, volume, nullptr, nullptr).text;
  };
  EXPECT_EQ(textAt(volume.grid.center_m(3, 4, 5)), "543 dB");
  EXPECT_EQ(textAt({-5, 0, 0}), "outside the volume's box");
  EXPECT_EQ(textAt({5, 5, 5}), "masked");
  EXPECT_EQ(textAt({999, 999, 999}), "no field above the floor of -1 dB");
  volume.info.unit = "";
  EXPECT_EQ(textAt({999, 999, 999}), "at most -1");
  volume.info.floor = 0;
  EXPECT_EQ(textAt({999, 999, 999}), "0") << "a probability";
  const ProbeReading reading = probe({5, 5, 5}, volume, nullptr, nullptr);
  EXPECT_FALSE(reading.height_msl_m);
  EXPECT_TRUE(reading.emitters.empty());
}

TEST(Probe, TellsLossesGainsAndNoDifference) {
  volume::DenseVolume volume = madeVolume();
  volume::VolumeInfo info;
  info.quantity = "power_density_dbwm2";
  info.unit = "dBW/m2";
  volume.info = volume::differenceInfo(info);
  volume.info.floor = 0;
  for (const auto& [value, text] :
       {std::pair(-12.5F, "-12.5 dB"), {10.0F, "10 dB"}, {0.0F, "no difference"}}) {
    std::fill(volume.values.begin(), volume.values.end(), value);
    EXPECT_EQ(probe({5, 5, 5}, volume, nullptr, nullptr).text, text);
  }
}

render::Camera cameraAt(const char* text, const render::SceneBox& box, render::ImageSize size) {
  return render::makeCamera(render::parseCamera(text), box, size);
}

constexpr render::ImageSize kSize{320, 240};

TEST(Pick, FindsGroundUnderAPixelAtAnyExaggeration) {
  const volume::DenseVolume volume = madeVolume();
  render::HeightField ground;  // a slope that rises to the east, 100 to 300 m
  ground.columns = ground.rows = 21;
  ground.spacing_x_m = ground.spacing_y_m = 50;
  for (int post = 0; post < 21 * 21; ++post)
    ground.heights_m.push_back(100 + 10.0F * static_cast<float>(post % 21));
  for (const char* projection : {"perspective", "orthographic"}) {
    for (const double exaggeration : {1.0, 3.0}) {
      const render::SceneBox box = render::sceneBoxOf(volume.grid, exaggeration);
      const render::Camera camera =
          cameraAt((std::string("orbit:elevation_deg=40,azimuth_deg=200,projection=") + projection).c_str(),
                   box, kSize);
      std::mt19937 random(2);
      for (int i = 0; i < 200; ++i) {
        // A point of the ground that its slope does not hide, seen from above.
        const double x = std::uniform_real_distribution<double>(0, 1000)(random),
                     y = std::uniform_real_distribution<double>(0, 1000)(random);
        const Vec3d point{x, y, 100 + x / 5};
        const render::Projected pixel = render::project(camera, kSize, box.toDrawn(point));
        const auto picked = pick(camera, box, kSize, pixel.x, pixel.y, volume, &ground);
        ASSERT_TRUE(picked);
        ASSERT_EQ(picked->on, PickedPoint::On::ground);
        if (length(picked->position_m - point) < 0.01) continue;
        // Another part of the ground hides it: the ground as it is cut at the box's side.
        const Vec3d& at = picked->position_m;
        EXPECT_TRUE(std::min({at.x, at.y, 1000 - at.x, 1000 - at.y}) < 1e-6) << at.x << " " << at.y;
      }
    }
  }
}

TEST(Pick, GroundAloneAndLevelsAreFoundToo) {
  const volume::DenseVolume volume = madeVolume();
  render::HeightField ground;
  ground.columns = ground.rows = 2;
  ground.spacing_x_m = ground.spacing_y_m = 1000;
  ground.heights_m.assign(4, 200);
  const render::SceneBox box = render::sceneBoxOf(volume.grid, 2);
  const render::Camera camera = cameraAt("orbit:elevation_deg=50", box, kSize);
  const Vec3d point{300, 400, 200};
  const render::Projected pixel = render::project(camera, kSize, box.toDrawn(point));
  const auto on_ground = pickGround(camera, box, kSize, pixel.x, pixel.y, ground);
  ASSERT_TRUE(on_ground);
  EXPECT_LT(length(*on_ground - point), 0.01);
  const auto on_level = pickLevel(camera, box, kSize, pixel.x, pixel.y, 200);
  ASSERT_TRUE(on_level);
  EXPECT_LT(length(*on_level - point), 0.01);
  EXPECT_FALSE(pickGround(camera, box, kSize, 0, 0, ground));
  EXPECT_FALSE(pickLevel(camera, box, kSize, 0, 0, 200));         // beside the box
  EXPECT_FALSE(pickLevel(camera, box, kSize, 160, 120, 100000));  // behind the eye
}

TEST(Pick, FindsSectionsOfPlanesAndIgnoresRemovedParts) {
  const volume::DenseVolume volume = madeVolume();
  render::HeightField ground;
  ground.columns = ground.rows = 2;
  ground.spacing_x_m = ground.spacing_y_m = 1000;
  ground.heights_m.assign(4, 200);
  const render::SceneBox box = render::sceneBoxOf(volume.grid, 2);
  const render::Camera camera = cameraAt("orbit:elevation_deg=50,azimuth_deg=180", box, kSize);
  const auto pickedAt = [&](const Vec3d& point, const std::vector<std::string>& planes) {
    std::vector<render::CutPlane> cuts;
    for (const std::string& plane : planes) cuts.push_back(render::parseCutPlane(plane));
    const render::Projected pixel = render::project(camera, kSize, box.toDrawn(point));
    return *pick(camera, box, kSize, pixel.x, pixel.y, volume, &ground, cuts);
  };
  const Vec3d on_ground{500, 500, 200}, in_air{500, 500, 600};
  EXPECT_EQ(pickedAt(on_ground, {}).on, PickedPoint::On::ground);
  // From above: the section comes first.
  const PickedPoint below = pickedAt(in_air, {"horizontal:altitude_m=600,keep=below"});
  EXPECT_EQ(below.on, PickedPoint::On::section);
  EXPECT_LT(length(below.position_m - in_air), 0.01);
  // What lies above is kept: the section ends the ray.
  const PickedPoint above = pickedAt(in_air, {"horizontal:altitude_m=600,keep=above"});
  EXPECT_EQ(above.on, PickedPoint::On::section);
  EXPECT_LT(length(above.position_m - in_air), 0.01);
  // A plane below the ground is not visible; one that is off has no effect.
  EXPECT_EQ(pickedAt(on_ground, {"horizontal:altitude_m=100,keep=above"}).on, PickedPoint::On::ground);
  EXPECT_EQ(pickedAt(on_ground, {"horizontal:altitude_m=600,keep=below,on=false"}).on,
            PickedPoint::On::ground);
  // The camera is in the south: what lies south of the line is gone, ground and all.
  const Vec3d on_wall{500, 600, 500};
  const PickedPoint wall = pickedAt(on_wall, {"vertical:bearing_deg=90,y_m=600,x_m=500,keep=left"});
  EXPECT_EQ(wall.on, PickedPoint::On::section);
  EXPECT_LT(length(wall.position_m - on_wall), 0.01);
  const Vec3d in_south{500, 200, 200};
  EXPECT_EQ(pickedAt(in_south, {"vertical:bearing_deg=90,y_m=600,x_m=500,keep=left,ground=keep"}).on,
            PickedPoint::On::ground);
}

TEST(Pick, FindsTheIsosurfaceBeforeTheGround) {
  const volume::DenseVolume volume = madeVolume();  // values grow upwards: the surface is a level
  render::HeightField ground;
  ground.columns = ground.rows = 2;
  ground.spacing_x_m = ground.spacing_y_m = 1000;
  ground.heights_m.assign(4, 200);
  const render::SceneBox box = render::sceneBoxOf(volume.grid, 1);
  const render::Camera camera = cameraAt("orbit:elevation_deg=-30,azimuth_deg=120", box, kSize);
  const Vec3d center{500, 500, 500};
  const render::Projected pixel = render::project(camera, kSize, center);
  const auto surface = pick(camera, box, kSize, pixel.x, pixel.y, volume, nullptr, {}, /*iso_value=*/500.0);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->on, PickedPoint::On::surface);
  EXPECT_NEAR(sampleVolume(volume, surface->position_m).value, 500, 0.1);
  const auto none = pick(camera, box, kSize, pixel.x, pixel.y, volume, &ground, {}, /*iso_value=*/5000.0);
  ASSERT_TRUE(none);
  EXPECT_NE(none->on, PickedPoint::On::surface);
}

TEST(Pick, WithoutGroundFindsTheLargestValueOfTheRayElseTheBox) {
  volume::DenseVolume volume = madeVolume();
  std::fill(volume.values.begin(), volume.values.end(), -1.0F);
  volume.values[static_cast<std::size_t>(volume.grid.index(5, 5, 5))] = 7;
  volume.values[static_cast<std::size_t>(volume.grid.index(5, 5, 6))] = 6;
  const render::SceneBox box = render::sceneBoxOf(volume.grid, 1);
  const render::Camera camera = cameraAt("orbit:elevation_deg=30,azimuth_deg=120", box, kSize);
  const Vec3d strong = volume.grid.center_m(5, 5, 5);
  const render::Projected pixel = render::project(camera, kSize, box.toDrawn(strong));
  const auto strongest = pick(camera, box, kSize, pixel.x, pixel.y, volume, nullptr);
  ASSERT_TRUE(strongest);
  EXPECT_EQ(strongest->on, PickedPoint::On::strongest);
  EXPECT_EQ(sampleVolume(volume, strongest->position_m).voxel, (Dims{5, 5, 5}));
  const render::Projected corner = render::project(camera, kSize, box.toDrawn({80, 80, 80}));
  const auto empty = pick(camera, box, kSize, corner.x, corner.y, volume, nullptr);
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->on, PickedPoint::On::box);
  EXPECT_NE(sampleVolume(volume, empty->position_m).kind, Kind::outside);
  EXPECT_FALSE(pick(camera, box, kSize, 0, 0, volume, nullptr));
}

/// A scenario with one emitter by free space, its field, and its ground.
struct Solved {
  LoadedScenario input;
  std::shared_ptr<const volume::DenseVolume> volume;
};
Solved solve(const std::string& file, const std::vector<scenario::Edit>& edits) {
  Solved solved;
  solved.input = loadScenarioWithTerrain(file, edits);
  emfield::FieldOptions options;
  options.backend = Backend::cpu;
  FieldSeries series(solved.input, {0.0}, options);
  solved.volume = series.compute(0).front().host();
  return solved;
}

TEST(Probe, AgreesWithTheVoxelAndWithTheBudgetOfThePath) {
  const TemporaryFolder folder;
  const Solved solved =
      solve(quickScenario(folder), {{"emitters.radar", "null"}, {"output", "{floor: -300}"}});
  const volume::Grid& grid = solved.volume->grid;
  std::mt19937 random(9);
  int values = 0;
  for (int i = 0; i < 300; ++i) {
    const int x = static_cast<int>(random() % 40), y = static_cast<int>(random() % 40),
              z = static_cast<int>(random() % 20);
    const Vec3d center = grid.center_m(x, y, z);
    const ProbeReading reading =
        probe(center, *solved.volume, solved.input.scenario, solved.input.terrain.get());
    ASSERT_EQ(reading.emitters.size(), 1u);
    ASSERT_TRUE(reading.emitters[0].budget) << reading.emitters[0].refusal;
    EXPECT_NEAR(*reading.height_msl_m, GeoFrame(grid.frame).heightMsl_m(center), 1e-9);
    if (reading.sample.kind != Kind::value) continue;
    ++values;
    EXPECT_NEAR(reading.sample.value, solved.volume->values[static_cast<std::size_t>(grid.index(x, y, z))],
                1e-4);
    EXPECT_NEAR(reading.emitters[0].budget->find("power_density_dbwm2")->value, reading.sample.value, 0.1);
  }
  EXPECT_GT(values, 200);
  // Between the centres: within interpolation, away from the emitter.
  const Vec3d between = grid.center_m(5, 5, 10) + grid.spacing_m * 0.4;
  const ProbeReading reading = probe(between, *solved.volume, solved.input.scenario, nullptr);
  EXPECT_NEAR(reading.emitters[0].budget->find("power_density_dbwm2")->value, reading.sample.value, 0.2);
}

TEST(Probe, HasHeightsOverRealGroundAndReportsPositionsBelowIt) {
  const std::string file = emscape::test::shippedScenario("jacksboro.yaml");
  const Solved solved = solve(file, {{"region.dims", "[40, 40, 20]"}});
  const volume::Grid& grid = solved.volume->grid;
  const auto ground = heightFieldOf(solved.input, grid);
  const render::SceneBox box = render::sceneBoxOf(grid, 0);
  const render::Camera camera = cameraAt("orbit:elevation_deg=60", box, kSize);
  const auto picked = pick(camera, box, kSize, 160, 120, *solved.volume, ground.get());
  ASSERT_TRUE(picked);
  ASSERT_EQ(picked->on, PickedPoint::On::ground);
  const auto readingAt = [&](double above_m) {
    return probe(picked->position_m + Vec3d{0, 0, above_m}, *solved.volume, solved.input.scenario,
                 solved.input.terrain.get());
  };
  // The height field has its own posts: between them the ground differs slightly from the terrain.
  EXPECT_NEAR(*readingAt(0).height_agl_m, 0, 15);
  EXPECT_NEAR(*readingAt(500).height_agl_m - *readingAt(0).height_agl_m, 500, 1e-6);
  EXPECT_EQ(readingAt(1000).sample.kind, Kind::value) << readingAt(1000).text;
  EXPECT_THAT(readingAt(1000).text, HasSubstr(" dBW/m2"));
  EXPECT_THAT(readingAt(-200).text, HasSubstr("masked: below the ground"));
  const ProbeReading reading = readingAt(1000);
  ASSERT_EQ(reading.emitters.size(), solved.input.scenario->emitters.size());
  // As in `emscape profile`: a platform at the point.
  auto with_point = std::make_shared<scenario::Scenario>(*solved.input.scenario);
  scenario::Platform platform;
  platform.name = "--to";
  platform.track.emplace_back();
  platform.track.back().position.latitude_deg = reading.position->latitude_deg;
  platform.track.back().position.longitude_deg = reading.position->longitude_deg;
  platform.track.back().position.height_msl_m = *reading.height_msl_m;
  with_point->platforms.push_back(platform);
  const scenario::Snapshot snapshot = scenario::snapshotAt(with_point, solved.input.terrain.get(), 0);
  for (std::size_t e = 0; e < reading.emitters.size(); ++e) {
    const emfield::PathBudget budget =
        emfield::pathBudget(snapshot, static_cast<int>(e),
                            {snapshot.platforms.back().position, snapshot.platforms.back().height_msl_m},
                            with_point->emitters[e].propagation.model, solved.input.terrain.get());
    ASSERT_TRUE(reading.emitters[e].budget) << reading.emitters[e].refusal;
    EXPECT_EQ(reading.emitters[e].budget->verdict, budget.verdict);
    EXPECT_NEAR(reading.emitters[e].budget->find("power_density_dbwm2")->value,
                budget.find("power_density_dbwm2")->value, 1e-6);
  }
  auto marched = std::make_shared<scenario::Scenario>(*solved.input.scenario);
  marched->emitters[0].propagation.model = propagation::PropagationModel::parabolic_equation;
  marched->emitters[0].propagation.parabolic_equation.max_angle_deg = 3;
  const double latitude_deg = 36.36, longitude_deg = -84.35;
  const double height_msl_m = solved.input.terrain->heightMsl_m(latitude_deg, longitude_deg) + 50;
  const Vec3d low = GeoFrame(grid.frame)
                        .toLocal({latitude_deg, longitude_deg,
                                  height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)});
  const ProbeReading over_steep = probe(low, *solved.volume, marched, solved.input.terrain.get());
  ASSERT_TRUE(over_steep.emitters[0].budget) << over_steep.emitters[0].refusal;
  EXPECT_THAT(over_steep.emitters[0].budget->warnings,
              ::testing::Contains(HasSubstr("of the length of its marches")));
}

TEST(Probe, PositionAtAnEmitterIsRefusedForThatEmitterOnly) {
  const TemporaryFolder folder;
  const Solved solved = solve(quickScenario(folder), {});
  const scenario::Snapshot snapshot = scenario::snapshotAt(solved.input.scenario, nullptr, 0);
  const Vec3d mast = GeoFrame(solved.volume->grid.frame).toLocal(snapshot.emitters[1].position);
  const ProbeReading reading = probe(mast, *solved.volume, solved.input.scenario, nullptr);
  EXPECT_TRUE(reading.emitters[0].budget);
  EXPECT_FALSE(reading.emitters[1].budget);
  EXPECT_NE(reading.emitters[1].refusal, "");
}

}  // namespace
}  // namespace emscape::playback::test

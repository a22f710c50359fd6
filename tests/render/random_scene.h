/// Random scenes for property tests of the renderer.
#pragma once

#include <random>

#include "emscape/render/scene/renderer.h"
#include "tests/render/scenes.h"

namespace emscape::render::testing {

/// Largest differences of a picture by packets of rays from the plain form, one ray after another.
inline ImageDifference differenceFromPlain(Renderer& renderer, ImageSize size) {
  const Image8 fast = quantize(renderer.render(size));
  RenderSettings settings = renderer.settings();
  settings.plain = true;
  renderer.setSettings(settings);
  return compare(fast, quantize(renderer.render(size)));
}

/// A renderer of a random scene: volume, ground, camera, mode, step.
inline void setRandomScene(Renderer& renderer, std::mt19937& random, ImageSize size) {
  const auto between = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  auto volume =
      makeEmeVolume({between(1, 30), between(1, 30), between(1, 20)}, static_cast<unsigned>(between(1, 99)));
  RenderSettings settings;
  settings.mode = static_cast<CompositingMode>(between(0, 3));
  settings.shading = between(0, 1) == 1;
  settings.step_voxels = 0.3 + 0.1 * between(0, 12);
  settings.exact = between(0, 1) == 1;
  settings.mida_gamma = 0.5 * between(-2, 2);
  settings.vertical_exaggeration = between(1, 3);
  settings.iso_value = between(-40, 10);
  settings.iso_opacity = 0.25 * between(1, 4);
  renderer.setSettings(settings);
  renderer.setVolume(volume);
  renderer.setTransferFunction(defaultTransferFunction(*volume));
  if (between(0, 2) > 0) {
    renderer.setHeightField(makeGround(volume->grid, between(2, 40), [](double x, double y) {
      return 100 + 80 * std::sin(x / 300) * std::sin(y / 400);
    }));
  } else {
    renderer.setHeightField(nullptr);
  }
  CameraSpec camera;
  camera.azimuth_deg = between(0, 359);
  camera.elevation_deg = between(-30, 90);
  camera.projection = between(0, 3) == 0 ? Projection::orthographic : Projection::perspective;
  renderer.setCamera(makeCamera(camera, renderer.sceneBox(), size));
  if (between(0, 2) > 0) return;
  settings.map_height_agl_m = 40.0 * between(0, 5);
  settings.map_opacity = 0.25 * between(1, 4);
  renderer.setSettings(settings);
}

/// One to three planes through the box of the renderer's volume.
inline void addRandomPlanes(Renderer& renderer, std::mt19937& random) {
  const auto part = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  const SceneBox box = renderer.sceneBox();
  const Vec3d size_m = box.upper_m - box.lower_m;
  RenderSettings settings = renderer.settings();
  const int count = 1 + static_cast<int>(random() % 3);
  for (int n = 0; n < count; ++n) {
    CutPlane plane;
    if (part() < 0.5) {
      plane.altitude_m = box.lower_m.z + part() * size_m.z;
    } else {
      plane.kind = CutPlane::Kind::vertical;
      plane.keep = CutPlane::Side::left;
      plane.x_m = box.lower_m.x + part() * size_m.x;
      plane.y_m = box.lower_m.y + part() * size_m.y;
      plane.bearing_deg = 360 * part();
    }
    settings.planes.push_back(part() < 0.5 ? flipped(plane) : plane);
  }
  renderer.setSettings(settings);
}

}  // namespace emscape::render::testing

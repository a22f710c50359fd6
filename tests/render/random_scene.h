/// Scenes by chance for the renderer's properties.
#pragma once

#include <random>

#include "emscape/render/renderer.h"
#include "tests/render/scenes.h"

namespace emscape::render::testing {

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
}

}  // namespace emscape::render::testing

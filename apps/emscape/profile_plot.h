/// The picture of a path: terrain on the effective earth, the ray over it, its first Fresnel zone, obstacles.
#pragma once

#include <functional>
#include <string>

#include "emscape/emfield/path_budget.h"
#include "emscape/render/image.h"

namespace emscape::render {
class Canvas;
}

namespace emscape::app {

/// True for names of plots: .png and .svg.
bool isPlotFile(const std::string& file);

/// Writes what `draw` draws, atomically. @throws Error (other) naming the file
void drawPlot(render::ImageSize size, const std::string& file,
              const std::function<void(render::Canvas&)>& draw);

/// Heights are drawn over the effective earth, so that the ray is straight and sea level curves. The file is
/// written atomically.
/// @throws Error (other) naming the file
void plotProfile(const emfield::PathBudget& budget, render::ImageSize size, const std::string& file);

}  // namespace emscape::app

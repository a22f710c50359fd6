/// A plot of links over time.
#pragma once

#include <string>

#include "emscape/render/picture/image.h"
#include "report/paths/link_report.h"

namespace emscape::report {

/// Draws the ratio of signal to noise and interference of each link, and the probabilities of detection of
/// each target, over time.
/// @param file  .png or .svg (isPlotFile)
void plotLinks(const NamedLinks& links, render::ImageSize size, const std::string& file);

}  // namespace emscape::report

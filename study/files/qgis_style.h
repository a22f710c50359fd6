/// Styles of the layers of a GeoPackage, which QGIS reads from the table layer_styles.
#pragma once

#include <string>
#include <vector>

namespace emscape::study {

/// A group of features that the legend lists and that can be switched on.
struct StyleRule {
  std::string label, filter;  ///< the filter is an expression of QGIS
  bool is_on = false;
};

/// Polygons filled with the colour of their field "color"; shown from "time" to "time_end".
std::string bandStyle(const std::vector<StyleRule>& rules);
/// Lines labelled with their field "level".
std::string contourStyle(const std::vector<StyleRule>& rules);
/// Points with their field "name", coloured by "color".
std::string emitterStyle();
/// Small squares without labels, because emitters have labels.
std::string siteStyle();
std::string trackStyle();

/// 'text' as a literal of an expression.
std::string expressionText(const std::string& text);

}  // namespace emscape::study

/// A comparison of two scenarios as a table, JSON and sections of a report.
#pragma once

#include <string>

#include "apps/emscape/common/console.h"
#include "emscape/study/compare/compare.h"
#include "emscape/study/report/html_report.h"

namespace emscape::app {

/// The entries of report.json other than the maps.
Json comparisonJson(const study::Comparison& comparison, const study::ComparedScenario& a,
                    const study::ComparedScenario& b);
/// Adds the sections "Gained and lost" and "Why". @param quantity  its name
void addSections(study::HtmlReport& report, const study::Comparison& comparison, const std::string& quantity);
void printComparison(const study::Comparison& comparison, const std::string& quantity);

}  // namespace emscape::app

/// What maps of coverage say, in sentences.
#pragma once

#include <string>
#include <vector>

#include "study/report/map_folder.h"

namespace emscape::study {

/// One sentence for each height: the share of the area that is covered, and what jamming takes away. Then
/// one on minimum heights, and one on the pixels without a known answer, if there are any. Empty for records
/// without these products.
std::vector<std::string> coverageSummary(const MapStudy& study, const std::vector<MapRecord>& records);

/// Names in a row: "'a', 'b' and 'c'".
/// @param many  instead of more than three names, with their number in place of {}
std::string namesText(const std::vector<std::string>& names, const std::string& conjunction,
                      const std::string& many);

}  // namespace emscape::study

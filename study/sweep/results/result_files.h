/// The results of a study as files for other programs.
#pragma once

#include <filesystem>
#include <string>

#include "study/sweep/results/study_folder.h"

namespace emscape::study {

/// The shortest text from which the number is read back; empty for NaN.
std::string csvNumber(double value);

/// One row per computed variant: number, name, parameters, measures.
/// @throws Error (other) that names the file
void writeResultsCsv(const std::filesystem::path& file, const StudySpec& study, const StudyResults& results);

/// netCDF-4: one dimension per parameter with its values as coordinates if the study only sweeps; else one
/// dimension `variant`. Missing values are NaN.
/// @throws Error (other) that names the file and GDAL's reason
void writeResultsNetcdf(const std::filesystem::path& file, const StudySpec& study,
                        const StudyResults& results);

}  // namespace emscape::study

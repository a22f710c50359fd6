/// A variant's measures as a row of the tables of parts.
#pragma once

#include <string>
#include <string_view>

#include "study/sweep/study_runner.h"

namespace emscape::study {

/// "3,1.5,,2": the variant and its measures; NaN is empty. Without the end of the line.
std::string rowOf(const VariantResult& result);
/// Reads a row, without its pixels.
/// @throws Error (bad_input) without a location, for a text that is not a row with this number of measures
VariantResult readRow(std::string_view row, std::size_t measures);

/// Pixels of a search for sites, eight in a byte.
std::string packedPixels(const std::vector<std::uint8_t>& pixels);
/// @param bytes  (pixels + 7) / 8
std::vector<std::uint8_t> unpackedPixels(std::string_view bytes, std::size_t pixels);

}  // namespace emscape::study

/// JSON for people: a value that fits on a line is written on one line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace emscape::document {

/// Strict JSON in UTF-8 that ends with a line end. Each member of the root is on a separate line, as are the
/// members of every other object or list that is longer than a line. Numbers have enough digits to be read
/// back exactly.
std::string jsonText(const nlohmann::ordered_json& root);

/// A float as the shortest decimal number that gives this float when it is read as a double and rounded.
nlohmann::ordered_json shortNumber(float value);

}  // namespace emscape::document

/// Checks a document against the table of the format.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/schema.h"

namespace emscape::document {

/// Reports every fault of an object: unknown and duplicate keys, missing ones, wrong types, values out of
/// range.
/// @param file  for the problems' locations
/// @return true if there is none
bool checkObject(const std::string& file, const DocumentNode& node, const ObjectSpec& spec,
                 ProblemList& problems);

/// The number in a scalar's text (YAML 1.2 core schema, decimal); none if it is not one.
/// Infinity and NaN are numbers here.
std::optional<double> numberOf(const std::string& text);

/// The errors of `problems`, one to a line; of more than 20 the first ones and how many further ones there
/// are.
std::string errorsText(const std::vector<Problem>& problems);

/// @throws Error (bad_input) if there is any problem: a single one with its location, several as one message
/// with one line each
void requireNoProblem(const ProblemList& problems);

/// The truth value in a scalar's text (YAML 1.2 core schema); none if it is not one.
std::optional<bool> booleanOf(const std::string& text);

/// The fault of a number, as `'name' is 95, outside the allowed range -90 to 90 deg`; empty if it has none.
std::string rangeFault(const std::string& name, const std::string& text, double value, const ValueSpec& spec);

/// The message for a key that an object does not have: with the missing unit suffix, or with the key that was
/// probably meant.
/// @param meant  set to the proposed names
std::string unknownKeyMessage(const std::string& key, const ObjectSpec& spec, const std::string* variant,
                              std::vector<std::string>* meant = nullptr);

/// ", did you mean 'x'?" with the closest of the names; empty if none is close.
std::string didYouMean(const std::string& word, const std::vector<std::string>& names,
                       std::string* closest = nullptr);

}  // namespace emscape::document

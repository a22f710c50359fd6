/// Names of enumerations on the command line: one table for both directions.
#pragma once

#include <cstddef>
#include <string>

#include "emscape/base/error.h"

namespace emscape::render {

template <class Value>
struct Named {
  Value value;
  const char* name;
};

template <class Value, std::size_t count>
const char* nameOf(const Named<Value> (&table)[count], Value value) {
  for (const Named<Value>& row : table) {
    if (row.value == value) return row.name;
  }
  return "";
}

/// @throws Error (usage) that lists the allowed values of `what`
template <class Value, std::size_t count>
Value parseName(const Named<Value> (&table)[count], const char* what, const std::string& name) {
  std::string allowed;
  for (const Named<Value>& row : table) {
    if (name == row.name) return row.value;
    allowed += (allowed.empty() ? "" : ", ") + std::string(row.name);
  }
  throw Error(ErrorCode::usage, "unknown " + std::string(what) + " '" + name + "': expected " + allowed);
}

}  // namespace emscape::render

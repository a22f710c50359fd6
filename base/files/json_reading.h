/// Reading of JSON, with readable messages instead of those of the library.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "emscape/base/error.h"

namespace emscape {

/// Description of a fault: "type must be number, but is string", "key 'dims' not found", "type
/// cannot be array".
inline std::string faultOf(const nlohmann::json::exception& error) {
  std::string text = error.what();  // "[json.exception.type_error.302] type must be ..."
  const std::size_t prefix = text.find("] ");
  if (text.front() == '[' && prefix != std::string::npos) text.erase(0, prefix + 2);
  const std::size_t found = text.rfind(" with ");  // "cannot use at() with string"
  if (text.rfind("cannot use ", 0) == 0 && found != std::string::npos)
    return "type cannot be " + text.substr(found + 6);
  return text;
}

/// Parses a text and calls read() with it.
/// @param advice  ends the messages, such as "; start the series again"; may be empty
/// @throws Error (bad_input): not JSON, with line and column; a value that is missing or has the wrong type.
/// Errors of read() without a location get that of the file.
template <class Json, class Read>
auto readJson(std::string_view text, const std::string& file, const Read& read,
              const std::string& advice = "") {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
    const SourceLocation location{file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
                                  1 + static_cast<int>(before.size() - line_begin)};
    throw Error(ErrorCode::bad_input, location, "not valid JSON" + advice);
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, faultOf(error) + advice);
  }
  try {
    return read(json);
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, faultOf(error) + advice);
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(ErrorCode::bad_input, {file, 0, 0}, error.message() + advice);
  }
}

}  // namespace emscape

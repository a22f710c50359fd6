/// Writing of JSON.
#pragma once

#include <string>

namespace emscape {

/// JSON text in UTF-8. Bytes that are not UTF-8, which names of files may have, become U+FFFD; dump() alone
/// would throw.
/// @tparam Json    nlohmann::json or nlohmann::ordered_json
/// @param  indent  of each level (blanks); -1: all on one line
template <class Json>
std::string dumpJson(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace emscape

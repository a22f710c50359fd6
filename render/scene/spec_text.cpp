#include "render/scene/spec_text.h"

#include <fmt/format.h>

#include <cstdlib>

#include "emscape/base/error.h"

namespace emscape::render {

SpecText::SpecText(std::string what, std::string text, const std::set<std::string>& kinds,
                   const std::string& expected)
    : what_(std::move(what)), text_(std::move(text)) {
  const std::size_t colon = text_.find(':');
  kind_ = text_.substr(0, colon);
  if (kinds.count(kind_) == 0) refuse("expected " + expected);
  if (colon == std::string::npos) return;
  std::size_t begin = colon + 1;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text_.find(',', begin);
    const std::string part = text_.substr(begin, end == std::string::npos ? end : end - begin);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) refuse(fmt::format("'{}': expected KEY=VALUE", part));
    const std::string key = part.substr(0, equals);
    if (!keys_.insert(key).second) refuse(fmt::format("{} is given twice", key));
    entries_.emplace_back(key, part.substr(equals + 1));
  }
}

double SpecText::number(const std::string& key, const std::string& value, double least,
                        double largest) const {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != '\0' || !(number >= least && number <= largest)) {
    refuse(fmt::format("{} '{}': expected a number {}..{}", key, value, least, largest));
  }
  return number;
}

void SpecText::refuse(const std::string& why) const {
  throw Error(ErrorCode::usage, fmt::format("{} '{}': {}", what_, text_, why));
}

void SpecText::refuseKey(const std::string& key, const std::string& allowed) const {
  refuse(fmt::format("unknown key '{}': expected {}", key, allowed));
}

}  // namespace emscape::render

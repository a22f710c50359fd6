#include "playback/series/file_names.h"

#include <algorithm>
#include <set>

#include "document/text_file.h"

namespace emscape::playback {
namespace {

/// So that two names, a step, an ending and the suffix of an unfinished file are shorter than the 255 bytes
/// that file systems allow.
constexpr std::size_t kMaxLength = 80;

}  // namespace

std::string fileNameOf(const std::string& name) {
  const auto isForeign = [](char c) {
    return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '-');
  };
  std::string result = name;
  std::replace_if(result.begin(), result.end(), isForeign, '_');
  if (result.size() > kMaxLength) {
    document::ContentHash hash;
    hash.add(name);
    result = result.substr(0, kMaxLength - 1 - hash.hex().size()) + "-" + hash.hex();
  }
  return result;
}

std::vector<std::string> distinctFileNames(const std::vector<std::string>& names) {
  std::vector<std::string> distinct;
  std::set<std::string> used;
  for (const std::string& name : names) {
    const std::string plain = fileNameOf(name);
    std::string candidate = plain;
    for (int number = 2; !used.insert(candidate).second; ++number)
      candidate = plain + "-" + std::to_string(number);
    distinct.push_back(candidate);
  }
  return distinct;
}

}  // namespace emscape::playback

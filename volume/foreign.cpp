#include "volume/foreign.h"

#include <mutex>

#include "emscape/base/log.h"

namespace emscape::volume {

void warnOfCopiedMetadata(const std::string& file, const std::string& who, const std::string& why) {
  logWarning(file + ": " + who + ": " + why +
             ", which another program must have copied; it is read as that program's");
}

void warnOfOmissions(const std::string& file, const std::vector<std::string>& reasons) {
  if (reasons.empty()) return;
  std::string text = file + ": left out: ";
  for (const std::string& reason : reasons) text += (&reason == &reasons.front() ? "" : "; ") + reason;
  static std::mutex mutex;
  static std::string last;  // a program lists a file repeatedly before it reads it
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (text == last) return;
    last = text;
  }
  logWarning(text);
}

std::size_t indexOfName(const std::vector<std::string>& names, const std::string& name, const char* unnamed,
                        const char* kind, const std::string& file) {
  const auto shown = [&](const std::string& own) { return own.empty() ? unnamed : own; };
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (names[n] == name) return n;
  }
  std::string list;
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (shown(names[n]) == name) return n;
    list += (n == 0 ? "" : ", ") + shown(names[n]);
  }
  throw Error(ErrorCode::bad_input, {file},
              "no " + std::string(kind) + " \"" + name + "\"; the file holds " + list);
}

}  // namespace emscape::volume

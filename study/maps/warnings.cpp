#include "study/maps/warnings.h"

namespace emscape::study {
namespace {

std::string withoutCount(std::string warning) {
  const std::size_t open = warning.rfind(" (");
  if (open == std::string::npos) return warning;
  const std::size_t end = warning.find_first_not_of("0123456789", open + 2);
  const bool has_count =
      end != std::string::npos && end > open + 2 && warning.compare(end, std::string::npos, " times)") == 0;
  if (has_count) warning.erase(open);
  return warning;
}

}  // namespace

void addOnce(std::set<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& warning : more) all.insert(withoutCount(warning));
}

}  // namespace emscape::study

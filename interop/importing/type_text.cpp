#include "interop/importing/type_text.h"

#include <fmt/format.h>

#include <array>

namespace emscape::interop {
namespace {

template <std::size_t N>
const char* wordOf(const std::array<const char*, N>& words, int index) {
  return index >= 0 && index < static_cast<int>(N) ? words[static_cast<std::size_t>(index)] : "other";
}

/// Kind and domain of an entity type. @see SISO-REF-010, UID 7 and 8
std::string disText(const std::array<int, 7>& type) {
  constexpr std::array kKinds{
      "other",  "platform", "munition",   "life form",        "environmental object", "cultural feature",
      "supply", "radio",    "expendable", "sensor or emitter"};
  constexpr std::array kDomains{"other", "land", "air", "sea", "subsurface", "space"};
  constexpr std::array kTargets{"other",         "anti-air",       "anti-armor", "anti-guided weapon",
                                "anti-radar",    "anti-satellite", "anti-ship",  "anti-submarine",
                                "anti-personnel"};
  const std::string kind = wordOf(kKinds, type[0]);
  if (type[0] == 1) return fmt::format("{} platform", wordOf(kDomains, type[1]));
  if (type[0] == 2) return fmt::format("{} munition", wordOf(kTargets, type[1]));
  return kind;
}

}  // namespace

std::string typeText(const RecordedObject& object) {
  if (object.keys.dis_entity_type)
    return fmt::format("{} ({})", disText(*object.keys.dis_entity_type), object.type);
  if (!object.keys.cot_type.empty()) {
    return fmt::format("{}, {} ({})", toString(object.domain),
                       object.side == Side::unknown ? "unknown side" : toString(object.side), object.type);
  }
  return object.type.empty() ? "without a type" : object.type;
}

}  // namespace emscape::interop

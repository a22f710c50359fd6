#include "apps/common/components.h"

#include <fmt/core.h>

//
#include <hwy/highway.h>

#include <cstdint>

#include "apps/common/version.h"
#include "emscape/base/cuda/device.h"

namespace emscape::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kOwnLicence = "Apache-2.0";

/// Names of Highway's instruction sets in a mask, the widest vectors first.
std::string instructionSets(std::int64_t mask) {
  const auto nameOf = [](std::int64_t bit) -> std::string {
    if (bit == HWY_AVX3) return "AVX-512";
    return bit == HWY_SCALAR || bit == HWY_EMU128 ? "plain" : hwy::TargetName(bit);
  };
  std::string names;
  for (std::int64_t bit = 1; bit > 0 && bit <= HWY_SCALAR; bit <<= 1) {
    if ((mask & bit) != 0) names += (names.empty() ? "" : ", ") + nameOf(bit);
  }
  return names;
}

std::string gpuText() {
  const std::string cuda = cudaOfBuild();
  if (cuda.empty()) return "this build has no CUDA";
  const Device device = findDevice();
  std::string text = device.usable ? device.name : "none, " + device.why_not;
  if (device.usable)
    text += fmt::format(", {} MiB, {} free", device.total_bytes >> 20, device.free_bytes >> 20);
  return text + fmt::format(" ({})", cuda);
}

const char* linkageText(Linkage linkage) {
  switch (linkage) {
    case Linkage::shared:
      return "shared library";
    case Linkage::static_:
      return "static library";
    case Linkage::headers:
      break;
  }
  return "headers";
}

/// A licence in the form of CycloneDX: an identifier by itself, anything else as an expression.
Json licenceJson(const std::string& spdx) {
  const bool is_identifier =
      spdx.find(' ') == std::string::npos && spdx.rfind("LicenseRef-", 0) == std::string::npos;
  if (is_identifier) return Json::array({{{"license", {{"id", spdx}}}}});
  return Json::array({{{"expression", spdx}}});
}

std::string referenceOf(const Component& component) {
  return fmt::format("{}@{}", component.name, component.version);
}

}  // namespace

std::string versionText() {
  const std::int64_t compiled = HWY_TARGETS;
  return fmt::format("emscape {}\nBuild: {}\nInstruction sets: {}; this processor: {}\nGPU: {}", kVersion,
                     kBuild, instructionSets(compiled), instructionSets(compiled & hwy::SupportedTargets()),
                     gpuText());
}

std::string licencesText() {
  std::string text = fmt::format("emscape {}: {}\nIt is linked with, or contains:\n", kVersion, kOwnLicence);
  for (const Component& component : kComponents) {
    text += fmt::format("  {:<24} {:<12} {:<42} {}\n", component.name, component.version, component.licence,
                        linkageText(component.linkage));
  }
  text.pop_back();
  return text;
}

Json billOfMaterials() {
  const std::string own = std::string("emscape@") + kVersion;
  Json components = Json::array(), references = Json::array();
  for (const Component& component : kComponents) {
    Json properties = Json::array({{{"name", "emscape:linkage"}, {"value", linkageText(component.linkage)}}});
    if (*component.library != '\0')
      properties.push_back({{"name", "emscape:library"}, {"value", component.library}});
    components.push_back({{"type", "library"},
                          {"bom-ref", referenceOf(component)},
                          {"name", component.name},
                          {"version", component.version},
                          {"licenses", licenceJson(component.licence)},
                          {"properties", properties}});
    references.push_back(referenceOf(component));
  }
  const Json program = {{"type", "application"},
                        {"bom-ref", own},
                        {"name", "emscape"},
                        {"version", kVersion},
                        {"licenses", licenceJson(kOwnLicence)},
                        {"properties", Json::array({{{"name", "emscape:build"}, {"value", kBuild}}})}};
  return {{"bomFormat", "CycloneDX"},
          {"specVersion", "1.5"},
          {"version", 1},
          {"metadata", {{"component", program}}},
          {"components", components},
          {"dependencies", Json::array({{{"ref", own}, {"dependsOn", references}}})}};
}

}  // namespace emscape::app

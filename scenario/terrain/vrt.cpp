#include "scenario/terrain/vrt.h"

#include <cpl_minixml.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include "base/whole_file.h"
#include "emscape/base/error.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeadBytes = 4096;
constexpr std::uintmax_t kMaxVrtBytes = std::uintmax_t{16} << 20;
constexpr int kMaxNesting = 4;

std::string foreignSource(const fs::path& file, int nesting);

bool looksLikeVrt(const fs::path& file) {
  std::string head(kHeadBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head.find("<VRTDataset") != std::string::npos;
}

/// @param element  an element that names a source
std::string faultOfSource(const CPLXMLNode& element, const fs::path& vrt, int nesting) {
  const std::string name = CPLGetXMLValue(&element, nullptr, "");
  if (name.empty()) return "names a source without a name";
  const bool relative = std::string(CPLGetXMLValue(&element, "relativeToVRT", "0")) == "1";
  const fs::path folder = fs::absolute(vrt).parent_path().lexically_normal();
  const fs::path source = fs::absolute(relative ? folder / name : fs::path(name)).lexically_normal();
  const fs::path inside = source.lexically_relative(folder);
  const bool is_file = name.find('<') == std::string::npos && name.compare(0, 4, "/vsi") != 0;
  if (!is_file || inside.empty() || *inside.begin() == "..") {
    return "names '" + name + "', which is not in its own folder";
  }
  return foreignSource(source, nesting + 1);
}

std::string faultOfElements(const CPLXMLNode* first, const fs::path& vrt, int nesting) {
  for (const CPLXMLNode* node = first; node != nullptr; node = node->psNext) {
    if (node->eType != CXT_Element) continue;
    const std::string name = node->pszValue;
    const bool is_source = name == "SourceFilename" || name == "SourceDataset";
    const std::string fault =
        is_source ? faultOfSource(*node, vrt, nesting) : faultOfElements(node->psChild, vrt, nesting);
    if (!fault.empty()) return fault;
  }
  return "";
}

std::string foreignSource(const fs::path& file, int nesting) {
  std::error_code ignored;  // invalid names, for example too long ones, are refused by GDAL
  if (!fs::is_regular_file(file, ignored) || !looksLikeVrt(file)) return "";
  if (nesting > kMaxNesting)
    return "names VRTs that name VRTs, more than " + std::to_string(kMaxNesting) + " deep";
  const std::string text = readWholeText(file, kMaxVrtBytes);
  const std::unique_ptr<CPLXMLNode, void (*)(CPLXMLNode*)> root(CPLParseXMLString(text.c_str()),
                                                                CPLDestroyXMLNode);
  return root ? faultOfElements(root.get(), file, nesting) : "is not a VRT that can be read";
}

}  // namespace

std::string foreignSourceOfVrt(const std::string& file) {
  try {
    return foreignSource(file, 0);
  } catch (const Error& error) {
    return error.message();
  }
}

}  // namespace emscape::scenario

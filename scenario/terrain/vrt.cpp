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

bool looksLikeVrt(const fs::path& file) {
  std::string head(kHeadBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head.find("<VRTDataset") != std::string::npos;
}

/// Collects the sources of VRTs.
class Sources {
 public:
  /// Adds the file, or what it names if it is a VRT.
  void add(const fs::path& file, int nesting) {
    if (!visited_.insert(file).second) return;
    std::error_code ignored;  // invalid names, for example too long ones, are refused by GDAL
    if (!fs::is_regular_file(file, ignored) || !looksLikeVrt(file)) {
      if (nesting > 0) files_.insert(file);
      return;
    }
    if (nesting > kMaxNesting)
      refuse("names VRTs that name VRTs, more than " + std::to_string(kMaxNesting) + " deep");
    const std::string text = readWholeText(file, kMaxVrtBytes);
    const std::unique_ptr<CPLXMLNode, void (*)(CPLXMLNode*)> root(CPLParseXMLString(text.c_str()),
                                                                  CPLDestroyXMLNode);
    if (!root) refuse("is not a VRT that can be read");
    addElements(root.get(), file, nesting);
  }

  const std::set<fs::path>& files() const { return files_; }

 private:
  [[noreturn]] static void refuse(const std::string& fault) { throw Error(ErrorCode::bad_input, fault); }

  void addElements(const CPLXMLNode* first, const fs::path& vrt, int nesting) {
    for (const CPLXMLNode* node = first; node != nullptr; node = node->psNext) {
      if (node->eType != CXT_Element) continue;
      const std::string name = node->pszValue;
      if (name == "SourceFilename" || name == "SourceDataset") {
        addSource(*node, vrt, nesting);
      } else {
        addElements(node->psChild, vrt, nesting);
      }
    }
  }

  /// @param element  an element that names a source
  void addSource(const CPLXMLNode& element, const fs::path& vrt, int nesting) {
    const std::string name = CPLGetXMLValue(&element, nullptr, "");
    if (name.empty()) refuse("names a source without a name");
    const bool relative = std::string(CPLGetXMLValue(&element, "relativeToVRT", "0")) == "1";
    const fs::path folder = fs::absolute(vrt).parent_path().lexically_normal();
    const fs::path source = fs::absolute(relative ? folder / name : fs::path(name)).lexically_normal();
    const fs::path inside = source.lexically_relative(folder);
    const bool is_file = name.find('<') == std::string::npos && name.compare(0, 4, "/vsi") != 0;
    if (!is_file || inside.empty() || *inside.begin() == "..")
      refuse("names '" + name + "', which is not in its own folder");
    add(source, nesting + 1);
  }

  std::set<fs::path> visited_, files_;
};

}  // namespace

std::set<fs::path> sourcesOfVrt(const std::string& file) {
  Sources sources;
  sources.add(file, 0);
  return sources.files();
}

}  // namespace emscape::scenario

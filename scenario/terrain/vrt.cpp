#include "scenario/terrain/vrt.h"

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "base/files/file_reading.h"
#include "base/geodesy/gdal.h"
#include "emscape/base/error.h"
#include "scenario/terrain/raster_access.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeadBytes = 4096;
constexpr std::uintmax_t kMaxVrtBytes = std::uintmax_t{16} << 20;
constexpr int kMaxNesting = 4;

using Names = std::set<std::string_view>;

/// Elements and attributes, in lower case, of the mosaics, extracts and reprojections that gdalbuildvrt,
/// gdal_translate and gdalwarp write. GDAL knows others, which name files in other ways or call functions.
const Names kAllowedNames = {
    "?xml", "version", "encoding", "standalone", "vrtdataset", "subclass", "rasterxsize", "rasterysize",
    "srs", "dataaxistosrsaxismapping", "mapping", "coordinateepoch", "geotransform", "blockxsize",
    "blockysize", "overviewlist", "resampling", "maskband", "overview",
    // bands
    "vrtrasterband", "datatype", "band", "nodatavalue", "hidenodatavalue", "description", "unittype",
    "offset", "scale",
    // sources
    "simplesource", "complexsource", "averagedsource", "kernelfilteredsource", "sourceband",
    "sourceproperties", "srcrect", "dstrect", "xoff", "yoff", "xsize", "ysize", "shared", "nodata",
    "usemaskband", "scaleoffset", "scaleratio", "colortablecomponent", "exponent", "srcmin", "srcmax",
    "dstmin", "dstmax", "clamp", "lut", "kernel", "normalized", "size", "coefs",
    // reprojections
    "gdalwarpoptions", "warpmemorylimit", "resamplealg", "workingdatatype", "option", "name", "bandlist",
    "bandmapping", "src", "dst", "srcnodatareal", "srcnodataimag", "dstnodatareal", "dstnodataimag",
    "srcalphaband", "dstalphaband", "cutline", "cutlineblenddist", "transformer", "approxtransformer",
    "maxerror", "basetransformer", "genimgprojtransformer", "srcgeotransform", "srcinvgeotransform",
    "dstgeotransform", "dstinvgeotransform", "reprojecttransformer", "reprojectiontransformer", "sourcesrs",
    "targetsrs", "options", "key", "srcgcptransformer", "gcptransformer", "srctpstransformer",
    "tpstransformer", "order", "reversed"};
/// Elements that hold descriptions, in any form.
const Names kDescriptions = {"metadata", "categorynames",           "colorinterp", "colortable", "histograms",
                             "gcplist",  "gdalrasterattributetable"};
/// Elements that name a source, and their attribute. GDAL takes an attribute of such a name for one, too.
const Names kSources = {"sourcefilename", "sourcedataset"};
constexpr const char* kIsRelative = "relativetovrt";

/// GDAL does not distinguish upper and lower case.
std::string lowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

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
    if (std::string fault = sidecars_.faultOf(file); !fault.empty()) refuse(fault);
    std::error_code ignored;  // invalid names, for example too long ones, are refused by GDAL
    if (!fs::is_regular_file(file, ignored) || !looksLikeVrt(file)) {
      if (nesting > 0) files_.insert(file);
      return;
    }
    if (nesting > kMaxNesting)
      refuse("names VRTs that name VRTs, more than " + std::to_string(kMaxNesting) + " deep");
    const std::string text = readWholeText(file, kMaxVrtBytes);
    const gdal::Owned<CPLDestroyXMLNode> root(CPLParseXMLString(text.c_str()));
    if (!root) refuse("is not a VRT that can be read");
    addElements(root.get(), file, nesting);
  }

  const std::set<fs::path>& files() const { return files_; }

 private:
  [[noreturn]] static void refuse(const std::string& fault) { throw Error(ErrorCode::bad_input, fault); }

  void addElements(const CPLXMLNode* first, const fs::path& vrt, int nesting) {
    for (const CPLXMLNode* node = first; node != nullptr; node = node->psNext) {
      if (node->eType != CXT_Element && node->eType != CXT_Attribute) continue;
      const std::string name = lowerCase(node->pszValue);
      if (node->eType == CXT_Element && kSources.count(name) != 0) {
        addSource(*node, vrt, nesting);
      } else if (kAllowedNames.count(name) != 0) {
        addElements(node->psChild, vrt, nesting);
      } else if (kDescriptions.count(name) == 0) {
        refuse("has '" + std::string(node->pszValue) +
               "', which is not allowed: only mosaics, extracts and reprojections of files are read, as "
               "gdalbuildvrt, gdal_translate and gdalwarp write them");
      }
    }
  }

  /// @param element  an element that names a source
  void addSource(const CPLXMLNode& element, const fs::path& vrt, int nesting) {
    for (const CPLXMLNode* node = element.psChild; node != nullptr; node = node->psNext) {
      const bool is_known = node->eType != CXT_Attribute || lowerCase(node->pszValue) == kIsRelative ||
                            kAllowedNames.count(lowerCase(node->pszValue)) != 0;
      if (!is_known || node->eType == CXT_Element)
        refuse("has '" + std::string(node->pszValue) + "' in the name of a source");
    }
    const std::string name = CPLGetXMLValue(&element, nullptr, "");
    if (name.empty()) refuse("names a source without a name");
    const std::string is_relative = CPLGetXMLValue(&element, kIsRelative, "0");
    if (is_relative != "0" && is_relative != "1")
      refuse("has relativeToVRT=\"" + is_relative + "\", which must be 0 or 1");
    const fs::path folder = fs::absolute(vrt).parent_path().lexically_normal();
    const fs::path source =
        fs::absolute(is_relative == "1" ? folder / name : fs::path(name)).lexically_normal();
    const fs::path inside = source.lexically_relative(folder);
    // GDAL takes names with colons, such as http://..., for those of servers and databases.
    if (name.find_first_of("<{:") != std::string::npos)
      refuse("names '" + name + "': names of sources with '<', '{' or ':' are not allowed");
    if (name.compare(0, 4, "/vsi") == 0 || inside.empty() || *inside.begin() == "..")
      refuse("names '" + name + "', which is not a file in its own folder");
    add(source, nesting + 1);
  }

  std::set<fs::path> visited_, files_;
  Sidecars sidecars_;
};

}  // namespace

std::set<fs::path> sourcesOfVrt(const std::string& file) {
  Sources sources;
  sources.add(file, 0);
  return sources.files();
}

}  // namespace emscape::scenario

#include "scenario/terrain/file_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/geodesy/gdal_file.h"
#include "base/geodesy/netcdf_header.h"
#include "base/text/shell_word.h"
#include "emscape/base/error.h"
#include "scenario/terrain/file_remedies.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 100000;
constexpr int kMaxMembers = 100000;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool isPacked(const std::string& name) {
  return lowerEnding(name) == ".zip" || lowerEnding(name) == ".gz";
}

bool isRasterName(const std::string& name) {
  static const std::set<std::string> kEndings{".tif", ".tiff", ".hgt", ".dt0", ".dt1", ".dt2", ".vrt", ".asc",
                                              ".dem", ".bil",  ".flt", ".img", ".nc",  ".xyz", ".gpkg"};
  return kEndings.count(lowerEnding(name)) != 0;
}

/// What products have beside their heights, or programs derive from them: ASTER, SRTM, Copernicus, ALOS,
/// GEBCO, TanDEM-X, ArcticDEM and REMA; gdaldem.
bool isMaskName(const std::string& name) {
  static const std::set<std::string> kMasks{
      "num",    "swb",      "wbm",     "edm",      "flm",       "hem",      "msk", "stk",
      "att",    "qai",      "tid",     "am2",      "amp",       "cov",      "lsm", "wam",
      "browse", "count",    "mad",     "mindate",  "maxdate",   "tri",      "tpi", "aspect",
      "slope",  "datamask", "bitmask", "matchtag", "hillshade", "roughness"};
  const std::string stem = lower(fs::path(name).stem().string());
  const std::size_t bar = stem.find_last_of("_-");
  return kMasks.count(bar == std::string::npos ? stem : stem.substr(bar + 1)) != 0;
}

/// What macOS adds to archives and foreign disks for the properties of files.
bool isOfMacOs(const std::string& name) {
  return fs::path(name).filename().string().rfind("._", 0) == 0 ||
         name.find("__MACOSX/") != std::string::npos;
}

bool isHeightsName(const std::string& name) {
  return isRasterName(name) && !isMaskName(name);
}

/// A VRT in a folder is a mosaic of the files beside it.
void dropMosaics(std::vector<std::string>& files) {
  const auto isVrt = [](const std::string& file) { return lowerEnding(file) == ".vrt"; };
  if (!std::all_of(files.begin(), files.end(), isVrt))
    files.erase(std::remove_if(files.begin(), files.end(), isVrt), files.end());
}

std::vector<std::string> filesOfFolder(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code failed;
  bool has_folders = false;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().string();
    std::error_code ignored;
    has_folders = has_folders || at->is_directory(ignored);
    if (isElevationName(name) && !isMaskName(name) && !isOfMacOs(name) && at->is_regular_file(ignored))
      files.push_back(name);
    if (files.size() > kMaxFiles)
      throw Error(ErrorCode::bad_input,
                  fmt::format("elevation files: folder {} has more than {} of them; name a "
                              "pattern, such as {}/N4*.hgt",
                              folder, kMaxFiles, folder));
  }
  if (failed)
    throw Error(ErrorCode::bad_input,
                fmt::format("elevation files: folder {}: {}", folder, failed.message()));
  if (files.empty())
    throw Error(ErrorCode::bad_input,
                "elevation files: folder " + folder +
                    " has none (by their endings, and no masks: .tif .hgt .dt0 .dt1 .dt2 .asc .bil .dem "
                    ".flt .img .nc .xyz .gpkg .vrt .zip .gz)" +
                    (has_folders ? "; those of its folders are named by a pattern, such as " + folder +
                                       "/*/*.tif, or " + folder + "/*/*/*.png for tiles with `encoding`"
                                 : ""));
  std::sort(files.begin(), files.end());
  dropMosaics(files);
  return files;
}

std::vector<std::string> filesOfPattern(const std::string& pattern) {
  glob_t found{};
  const int failed = glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> files;
  for (std::size_t k = 0; failed == 0 && k < found.gl_pathc; ++k) files.emplace_back(found.gl_pathv[k]);
  globfree(&found);
  if (files.empty())
    throw Error(ErrorCode::bad_input, "elevation files: no file matches the pattern " + pattern);
  if (files.size() > kMaxFiles)
    throw Error(ErrorCode::bad_input, fmt::format("elevation files: {} files match the pattern {}, more than "
                                                  "the allowed {}",
                                                  files.size(), pattern, kMaxFiles));
  return files;
}

std::string vsiNameOf(const std::string& file, const std::string& member) {
  const std::string local = gdal::localName(file);
  if (lowerEnding(file) == ".gz") return "/vsigzip/" + local;
  return "/vsizip/{" + local + "}" + (member.empty() ? "" : "/" + member);
}

/// GDAL would write the size of the content into a file beside a .gz.
class NoGzipProperties {
 public:
  NoGzipProperties() { CPLSetThreadLocalConfigOption(kKey, "NO"); }
  ~NoGzipProperties() { CPLSetThreadLocalConfigOption(kKey, nullptr); }

 private:
  static constexpr const char* kKey = "CPL_VSIL_GZIP_WRITE_PROPERTIES";
};

}  // namespace

std::vector<std::string> membersOfZip(const std::string& file) {
  gdal::prepare();
  const gdal::Owned<CSLDestroy> list(VSIReadDirRecursive(vsiNameOf(file, "").c_str()));
  std::vector<std::string> members;
  for (char** at = list.get(); at != nullptr && *at != nullptr; ++at) {
    if (!isOfMacOs(*at)) members.emplace_back(*at);
    if (members.size() > kMaxMembers)
      throw Error(ErrorCode::bad_input,
                  fmt::format("archive {} has more than {} members", file, kMaxMembers));
  }
  std::sort(members.begin(), members.end());
  return members;
}

std::string packedFileText(const std::string& file) {
  constexpr std::size_t kMaxNames = 4;
  std::string begin(4, '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin.rfind("\x1F\x8B", 0) == 0)
    return fmt::format("it is packed by gzip; unpack it (gunzip {}) and name the file in it",
                       shellWord(file));
  if (begin != "PK\x03\x04") return "";
  const GdalMessages quiet;
  const std::vector<std::string> members = membersOfZip(file);
  if (members.empty()) return "it is an archive (ZIP) that cannot be read";
  const auto end = members.begin() + static_cast<std::ptrdiff_t>(std::min(members.size(), kMaxNames));
  return fmt::format(
      "it is an archive (ZIP) of {}{}; unpack it (unzip {}) and name {}",
      fmt::join(members.begin(), end, ", "),
      members.size() > kMaxNames ? fmt::format(" and {} more", members.size() - kMaxNames) : "",
      shellWord(file), members.size() == 1 ? "that file" : "one of them");
}

std::string lowerEnding(const std::string& name) {
  return lower(fs::path(name).extension().string());
}

std::string unpackedContent(const ElevationSource& source, std::size_t max_bytes) {
  const GdalMessages messages;
  const NoGzipProperties no_properties;
  const auto fail = [&](const std::string& problem) {
    throw Error(ErrorCode::bad_input, messages.explain(problem));
  };
  const gdal::Owned<VSIFCloseL> stream(VSIFOpenL(vsiNameOf(source.file, source.member).c_str(), "rb"));
  if (!stream) fail("cannot be unpacked");
  std::string content;
  constexpr std::size_t kPart = std::size_t{1} << 22;
  for (;;) {
    const std::size_t before = content.size();
    content.resize(before + kPart);
    const std::size_t got = VSIFReadL(&content[before], 1, kPart, stream.get());
    content.resize(before + got);
    if (content.size() > max_bytes)
      fail(fmt::format("is larger than {} MiB when unpacked; unpack it and name the unpacked file",
                       max_bytes >> 20));
    if (got < kPart) break;
  }
  if (messages.hasFailure()) fail("cannot be unpacked");
  return content;
}

bool isElevationName(const std::string& name) {
  if (lowerEnding(name) == ".gz") return isRasterName(fs::path(name).stem().string());
  return isRasterName(name) || lowerEnding(name) == ".zip";
}

std::vector<std::string> elevationFilesOf(const std::string& name) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored)) return filesOfFolder(name);
  if (name.find_first_of("*?") != std::string::npos && !fs::exists(name, ignored))
    return filesOfPattern(name);
  return {name};
}

std::vector<ElevationSource> sourcesIn(const std::string& file) {
  if (!isPacked(file)) return {{file}};
  if (const std::string fault = gdal::faultOfName(file); !fault.empty())
    return {{file}};  // TerrainFile says it
  const std::string stem = fs::path(file).stem().string();
  if (lowerEnding(file) == ".gz") {
    if (lowerEnding(stem) == ".tar")
      throw Error(ErrorCode::bad_input,
                  file + ": a tar archive is not read; unpack it (tar xf) and name the folder");
    return {{file, stem}};
  }
  gdal::prepare();
  const GdalMessages messages;
  std::vector<ElevationSource> sources;
  const std::vector<std::string> members = membersOfZip(file);
  for (const std::string& member : members) {
    if (isHeightsName(member)) sources.push_back({file, member});
  }
  const std::string foreign = members.empty() ? foreignContentOf(file) : "";
  if (!foreign.empty()) throw Error(ErrorCode::bad_input, file + ": " + foreign);
  if (sources.empty())
    throw Error(ErrorCode::bad_input,
                members.empty()
                    ? messages.explain(file + ": cannot be read as a ZIP archive")
                    : fmt::format("{}: none of its {} members is an elevation file by its ending, "
                                  "such as {}; unpack it (unzip {}) and name the file that is meant",
                                  file, members.size(), members.front(), shellWord(file)));
  return sources;
}

std::vector<ElevationSource> sourcesOf(const TerrainSpec& spec, std::size_t item) {
  std::vector<ElevationSource> all;
  try {
    const std::vector<std::string> files = elevationFilesOf(spec.files[item]);
    for (const std::string& file : files) {
      try {
        for (ElevationSource& source : sourcesIn(file)) all.push_back(std::move(source));
      } catch (const Error&) {
        if (files.size() == 1) throw;  // beside others, an archive may be anything
      }
    }
    if (all.empty() && !files.empty()) sourcesIn(files.front());
  } catch (const Error& error) {
    throw Error(error.code(), item < spec.locations.size() ? spec.locations[item] : SourceLocation{},
                error.message());
  }
  return all;
}

TerrainFileKeys keysOf(const TerrainSpec& spec, std::size_t item) {
  TerrainFileKeys keys = item < spec.keys.size() ? spec.keys[item] : TerrainFileKeys{};
  if (!keys.vertical_datum) keys.vertical_datum = spec.vertical_datum;
  return keys;
}

std::optional<TileCorner> cornerInName(const std::string& name) {
  const std::string text = lower(fs::path(name).filename().string());
  const auto isDigits = [&](std::size_t at, std::size_t count) {
    if (at + count > text.size()) return false;
    return std::all_of(text.begin() + static_cast<std::ptrdiff_t>(at),
                       text.begin() + static_cast<std::ptrdiff_t>(at + count),
                       [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  std::optional<TileCorner> found;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if ((text[k] != 'n' && text[k] != 's') || !isDigits(k + 1, 2)) continue;
    const std::size_t digits = isDigits(k + 1, 3) ? 3 : 2;  // of the latitude: also N034E135
    std::size_t east = k + 1 + digits;
    if (east < text.size() && (text[east] == '_' || text[east] == '-' || text[east] == ' ')) ++east;
    if (east >= text.size() || (text[east] != 'e' && text[east] != 'w') || !isDigits(east + 1, 3)) continue;
    const int latitude_deg = std::stoi(text.substr(k + 1, digits)),
              longitude_deg = std::stoi(text.substr(east + 1, 3));
    if (latitude_deg > 90 || longitude_deg > 180) continue;
    const TileCorner corner{text[k] == 's' ? -latitude_deg : latitude_deg,
                            text[east] == 'w' ? -longitude_deg : longitude_deg};
    const bool is_another =
        found && (found->latitude_deg != corner.latitude_deg || found->longitude_deg != corner.longitude_deg);
    if (is_another) return std::nullopt;
    found = corner;
  }
  return found;
}

MemoryFiles::MemoryFiles() {
  static std::atomic<int> counter{0};
  folder_ = fmt::format("/vsimem/emscape_terrain_{}/", ++counter);
}

MemoryFiles::~MemoryFiles() {
  for (const std::string& name : names_) VSIUnlink((folder_ + name).c_str());
}

std::string MemoryFiles::add(const std::string& name, std::string content) {
  contents_.push_back(std::make_unique<std::string>(std::move(content)));
  std::string& bytes = *contents_.back();
  const std::string path = folder_ + name;
  const gdal::Owned<VSIFCloseL> file(
      VSIFileFromMemBuffer(path.c_str(), reinterpret_cast<GByte*>(bytes.data()), bytes.size(), FALSE));
  names_.push_back(name);
  return path;
}

std::string MemoryFiles::unpack(const ElevationSource& source) {
  gdal::prepare();
  const fs::path member = source.member;
  if (lowerEnding(source.file) == ".zip") {
    static const std::set<std::string> kBeside{".hdr", ".prj", ".tfw", ".blw",
                                               ".ige", ".shx", ".dbf", ".cpg"};
    for (const std::string& other : membersOfZip(source.file)) {
      const fs::path path = other;
      if (path.parent_path() == member.parent_path() && path.stem() == member.stem() &&
          kBeside.count(lowerEnding(other)) != 0)
        add(path.filename().string(), unpackedContent({source.file, other}));
    }
  }
  std::string content = unpackedContent(source);
  if (content.rfind("CDF", 0) == 0) {
    std::istringstream stream(content);
    if (const std::string fault = faultOfNetcdfHeader(stream, content.size()); !fault.empty())
      throw Error(ErrorCode::bad_input, fault);
  }
  return add(member.filename().string(), std::move(content));
}

std::vector<const char*> MemoryFiles::siblings() const {
  std::vector<const char*> names;
  for (const std::string& name : names_) names.push_back(name.c_str());
  names.push_back(nullptr);
  return names;
}

}  // namespace emscape::scenario

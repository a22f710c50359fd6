#include "apps/emscape/series_files.h"

#include <algorithm>
#include <regex>

#include "apps/emscape/file_names.h"
#include "base/error.h"
#include "volume/raw.h"
#include "volume/vdb.h"

namespace emscape::app {
namespace {

namespace fs = std::filesystem;

using Channels = std::vector<const volume::DenseVolume*>;

/// One volume a file: the channel is in its name where there are several.
fs::path pathOfChannel(const fs::path& stem, const std::string& ending, const Channels& channels,
                       std::size_t c) {
  const std::string channel = channels.size() > 1 ? "_" + fileNameOf(channels[c]->info.quantity) : "";
  return stem.string() + channel + ending;
}

struct Format {
  const char* name;
  /// @param stem  path without an ending
  void (*write)(const fs::path& stem, const Channels& channels);
};

const Format kFormats[]{
    {"vdb", [](const fs::path& stem,
               const Channels& channels) { volume::writeVdb(stem.string() + ".vdb", channels); }},
    {"raw",
     [](const fs::path& stem, const Channels& channels) {
       for (std::size_t c = 0; c < channels.size(); ++c)
         volume::writeRaw(pathOfChannel(stem, ".raw", channels, c), *channels[c]);
     }},
};

}  // namespace

const std::vector<std::string>& SeriesFiles::formatNames() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Format& format : kFormats) names.emplace_back(format.name);
    return names;
  }();
  return kNames;
}

SeriesFiles::SeriesFiles(fs::path folder, const std::string& name, std::vector<std::string> formats,
                         std::vector<double> times_s)
    : folder_(std::move(folder)),
      name_(fileNameOf(name)),
      formats_(std::move(formats)),
      times_s_(std::move(times_s)) {}

void SeriesFiles::write(int step,
                        const std::vector<std::shared_ptr<const volume::DenseVolume>>& channels) const {
  Channels pointers;
  for (const auto& channel : channels) pointers.push_back(channel.get());
  const fs::path stem = folder_ / numberedName(name_, step + 1);
  for (const Format& format : kFormats) {
    if (std::find(formats_.begin(), formats_.end(), format.name) != formats_.end())
      format.write(stem, pointers);
  }
}

void SeriesFiles::removeOld() const {
  // name_ is letters, digits, '_' and '-' alone: nothing in it means anything to a regular expression.
  const std::regex ours(name_ + R"(_\d{4,}(_[\w-]+)?\.(vdb|nvdb|vti|raw|json|raw\.json)|)" + name_ +
                        R"(\.pvd|series\.json)");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), ours))
      fs::remove(entry.path());
  }
}

}  // namespace emscape::app

#include "apps/emscape/series_files.h"

#include <regex>

#include "apps/emscape/file_names.h"
#include "emscape/volume/file.h"
#include "emscape/volume/vti.h"

namespace emscape::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVtkFormat = "vti";

}  // namespace

std::vector<std::string> SeriesFiles::formatNames() {
  std::vector<std::string> names;
  for (const volume::FileFormat& format : volume::fileFormats()) {
    if (format.writable) names.push_back(format.name);
  }
  return names;
}

SeriesFiles::SeriesFiles(fs::path folder, const std::string& name, const std::vector<std::string>& formats,
                         std::vector<double> times_s)
    : folder_(std::move(folder)),
      name_(fileNameOf(name)),
      formats_(formats.begin(), formats.end()),
      times_s_(std::move(times_s)) {}

void SeriesFiles::write(int step, const std::vector<volume::Volume>& channels) const {
  std::vector<std::shared_ptr<const volume::DenseVolume>> on_host;
  for (const volume::Volume& channel : channels) on_host.push_back(channel.host());
  std::vector<const volume::DenseVolume*> volumes;
  for (const auto& volume : on_host) volumes.push_back(volume.get());
  for (const volume::FileFormat& format : volume::fileFormats()) {
    if (formats_.count(format.name) == 0) continue;
    const fs::path file = volume::seriesFile(folder_, name_, step + 1, format.name);
    if (format.several || volumes.size() == 1) {
      volume::writeVolumes(file, volumes);
    } else {
      for (const volume::DenseVolume* volume : volumes) {
        const std::string stem = file.stem().string() + "_" + fileNameOf(volume->info.quantity);
        volume::writeVolumes(folder_ / (stem + "." + format.name), {volume});
      }
    }
    if (format.name == kVtkFormat) writeVtkIndex(step);
  }
}

void SeriesFiles::writeVtkIndex(int last_step) const {
  std::vector<volume::PvdEntry> entries;
  for (int step = 0; step <= last_step; ++step) {
    entries.push_back(
        {times_s_[static_cast<std::size_t>(step)], volume::seriesFile(folder_, name_, step + 1, kVtkFormat)});
  }
  volume::writePvd(folder_ / (name_ + ".pvd"), entries);
}

void SeriesFiles::removeOld() const {
  // name_ is letters, digits, '_' and '-' alone: nothing in it means anything to a regular expression.
  const std::regex ours(name_ + R"(_\d{4,}(_[\w-]+)?\.(vdb|nvdb|vti|raw|nvdb\.json|raw\.json)|)" + name_ +
                        R"(\.pvd|series\.json)");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), ours))
      fs::remove(entry.path());
  }
}

}  // namespace emscape::app

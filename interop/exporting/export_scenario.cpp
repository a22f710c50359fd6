#include "interop/export_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/files/unfinished_file.h"
#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "interop/exporting/writers.h"
#include "recording/dis/pdu.h"
#include "scenario/file/source.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::interop {
namespace {

namespace fs = std::filesystem;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

[[noreturn]] void failZip(const scenario::GdalMessages& messages, const fs::path& file) {
  throw Error(ErrorCode::other, {file.string(), 0, 0}, messages.explain("cannot write the zip file"));
}

struct ExportFormat {
  const char* ending;
  const char* name;
  /// Null for a capture, which is no text.
  long long (*write)(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows);
  bool has_beams = true;
  bool is_zip = false;
};
constexpr ExportFormat kFormats[] = {
    {".zip.acmi", "ACMI 2.2", writeAcmi, true, true},
    {".acmi", "ACMI 2.2", writeAcmi},
    {".pcap", "DIS version 7", nullptr},
    {".asi", "SIMDIS ASI", writeAsi},
    {".cot", "Cursor on Target", writeCot},
    {".czml", "CZML 1.0", writeCzml, false},
    {".kml", "KML 2.2", writeKml, false},
};

const ExportFormat& formatOf(const std::string& file) {
  for (const ExportFormat& format : kFormats) {
    if (endsWith(file, format.ending)) return format;
  }
  throw Error(ErrorCode::usage, fmt::format("'{}' is no name of a recording; it ends in {}", file,
                                            fmt::join(exportFormats(), ", ")));
}

/// Writes an ACMI text into a zip file.
long long writeZip(const ExportJob& job, const fs::path& file, Replaces replaces,
                   std::vector<ExportedRow>& rows) {
  UnfinishedFile unfinished(file, replaces);
  const scenario::GdalMessages messages;
  void* const zip = CPLCreateZip(unfinished.temporary().c_str(), nullptr);
  if (zip == nullptr) failZip(messages, file);
  const std::string stem = file.filename().string();
  const std::string inner = stem.substr(0, stem.size() - std::string(".zip.acmi").size()) + ".txt.acmi";
  bool is_sound = CPLCreateFileInZip(zip, inner.c_str(), nullptr) == CE_None;
  std::string piece;
  const auto flush = [&] {
    is_sound = is_sound && CPLWriteFileInZip(zip, piece.data(), static_cast<int>(piece.size())) == CE_None;
    piece.clear();
  };
  long long records = 0;
  try {
    records = writeAcmi(
        job,
        [&](const std::string& text) {
          piece += text;
          if (piece.size() > 65536) flush();
        },
        rows);
  } catch (...) {
    CPLCloseZip(zip);
    throw;
  }
  flush();
  is_sound = CPLCloseFileInZip(zip) == CE_None && is_sound;
  if (CPLCloseZip(zip) != CE_None || !is_sound || messages.hasFailure()) failZip(messages, file);
  unfinished.publish();
  return records;
}

/// What the scenario has and the recording cannot carry: the sections of its file but those of which it is
/// made.
std::string missingText(const scenario::Scenario& scenario, const ExportFormat& format, std::size_t rows) {
  std::vector<std::string> missing;
  if (!format.has_beams) {
    missing.emplace_back("times and directions of emitters");
    if (rows < scenario.emitters.size())
      missing.emplace_back(
          fmt::format("all emitters of a platform but the first ({})", scenario.emitters.size() - rows));
  }
  for (const document::MapEntry& entry : scenario.source->root->entries) {
    const auto isOneOf = [&](const auto& keys) {
      return std::find(std::begin(keys), std::end(keys), entry.key) != std::end(keys);
    };
    constexpr std::string_view kCarried[] = {"schema_version", "name",      "epoch",   "duration_s",
                                             "step_s",         "platforms", "emitters"};
    if (!isOneOf(kCarried)) missing.push_back(entry.key);
  }
  const bool has_symbols =
      std::any_of(scenario.platforms.begin(), scenario.platforms.end(),
                  [](const scenario::Platform& platform) { return !platform.sidc.empty(); });
  if (has_symbols) missing.emplace_back("symbols (sidc)");
  return fmt::format("not in the recording: {}; emscape import --base {} takes them from the scenario",
                     fmt::join(missing, ", "), scenario.file);
}

}  // namespace

std::vector<std::string> exportFormats() {
  std::vector<std::string> endings;
  for (const ExportFormat& format : kFormats) endings.emplace_back(format.ending);
  return endings;
}

ExportResult exportScenario(const std::shared_ptr<const scenario::Scenario>& scenario,
                            const scenario::Terrain* terrain, const std::string& file,
                            const ExportOptions& options, const ProgressSink& progress) {
  const ExportFormat& format = formatOf(file);
  const bool is_capture = format.write == nullptr;
  ExportResult result;
  result.file = file;
  result.format = format.name;
  ExportJob job{*scenario, terrain, options.step_s > 0 ? options.step_s : 1, progress, {}};
  requireFewRecords(*scenario, job.step_s);
  result.emitters = file + ".emitters.yaml";
  const Replaces replaces = options.replace ? Replaces::any : Replaces::nothing;
  if (!options.replace) requireNew({file, result.emitters});
  if (options.czml_packets) job.czml_packets = options.czml_packets();
  std::vector<ExportedRow> rows;
  if (format.is_zip) {
    result.records = writeZip(job, file, replaces, rows);
  } else {
    writeWhole(
        file,
        [&](std::ostream& stream) {
          result.records = is_capture ? writeCapture(job, stream, rows)
                                      : format.write(
                                            job, [&](const std::string& piece) { stream << piece; }, rows);
        },
        replaces);
  }
  const std::string database =
      databaseText(*scenario, rows, fs::absolute(result.emitters).parent_path().string());
  writeWhole(
      result.emitters, [&](std::ostream& stream) { stream << database; }, replaces);
  const std::string missing = missingText(*scenario, format, rows.size());
  result.notes.push_back(missing);
  const bool needs_epoch = !endsWith(file, ".acmi") && !is_capture && !endsWith(file, ".asi");
  if (needs_epoch && scenario->clock.epoch_utc.empty())
    result.notes.emplace_back("the scenario has no epoch: t = 0 is written as 1970-01-01T00:00:00Z");
  const int changed = is_capture ? countChangedMarkings(*scenario) : 0;
  if (changed > 0) {
    result.notes.push_back(fmt::format(
        "names of platforms that are cut to {} characters, or have ? for those that are not ASCII: {}",
        dis::kMarkingBytes, changed));
  }
  result.platforms = static_cast<int>(scenario->platforms.size());
  result.emitter_count = static_cast<int>(scenario->emitters.size());
  return result;
}

}  // namespace emscape::interop

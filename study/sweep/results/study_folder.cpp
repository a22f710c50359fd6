#include "study/sweep/results/study_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/files/file_digest.h"
#include "base/files/file_reading.h"
#include "base/files/folder.h"
#include "base/files/folder_lock.h"
#include "base/files/json_reading.h"
#include "base/files/json_writing.h"
#include "base/files/unfinished_file.h"
#include "base/files/whole_file.h"
#include "base/text/csv_cell.h"
#include "emscape/base/error.h"
#include "study/sweep/results/part_rows.h"
#include "study/sweep/results/result_files.h"

namespace emscape::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kManifest = "manifest.json";
constexpr int kManifestVersion = 1;
constexpr const char* kCsv = "results.csv";
constexpr const char* kNetcdf = "results.nc";

/// Reads a record of this program.
template <class Read>
auto readRecord(const fs::path& file, const Read& read) {
  return readJson<Json>(readWholeText(file), file.string(), read, "; remove the file to compute it again");
}

[[noreturn]] void failForeign(const fs::path& file, const std::string& found, const std::string& expected) {
  throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
              fmt::format("belongs to another study (hash {}, not {}): the study, its scenario, one of "
                          "their files or the program has changed; choose another folder or remove this one",
                          found, expected));
}

/// Size and checksum of a file in the record of its part.
Json digestRecord(const FileDigest& digest) {
  return {{"bytes", digest.bytes}, {"crc32", digest.crc32}};
}

FileDigest digestOfText(const std::string& text) {
  FileDigest digest;
  addToDigest(text, digest);
  return digest;
}

/// The checksum of a record, without the member "crc32" that contains it.
std::uint32_t recordChecksum(Json record) {
  record.erase("crc32");
  return digestOfText(dumpJson(record)).crc32;
}

/// The kept files according to a manifest or the command line.
KeptFiles keptOf(const Json& manifest) {
  const std::string name = manifest.value("kept", toString(KeptFiles::nothing));
  for (const KeptFiles kept : {KeptFiles::maps, KeptFiles::volumes}) {
    if (name == toString(kept)) return kept;
  }
  return KeptFiles::nothing;
}

/// @throws Error (bad_input) without a location
std::uint64_t countOf(const Json& record, const char* key, std::uint64_t most) {
  const Json count = record.value(key, Json(0u));
  if (!count.is_number_unsigned() || count.get<std::uint64_t>() > most) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{} is {}, not a whole number from 0 to {}", key, count.dump(), most));
  }
  return count;
}
int partsOf(const Json& record) {
  return static_cast<int>(countOf(record, "parts", INT_MAX));
}

}  // namespace

StudyFolder::StudyFolder(fs::path folder, const StudySpec& study, const StudyPlan& plan, std::string version)
    : folder_(std::move(folder)), study_(study), plan_(plan), version_(std::move(version)) {}

std::vector<std::string> StudyFolder::results(const StudySpec& study) {
  std::vector<std::string> names{kCsv, kNetcdf, "report.html"};
  if (study.sites) names.emplace_back(kSites);
  return names;
}

std::optional<StudyFolder::Manifest> StudyFolder::readManifest() const {
  const fs::path file = folder_ / kManifest;
  if (!fs::exists(file)) return std::nullopt;
  return readRecord(file, [&](const Json& json) {
    if (!json.is_object() || !json.contains("hash") || !json["hash"].is_string()) {
      throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
                  "is no manifest of a study of emscape; choose another folder");
    }
    const Json version = json.value("schema_version", Json());
    if (version != kManifestVersion) {
      throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
                  fmt::format("'schema_version' is {}; this program reads {}; choose another folder",
                              version.dump(), kManifestVersion));
    }
    const std::string hash = json["hash"];
    if (hash != study_.hash) failForeign(file, hash, study_.hash);
    const Manifest manifest{partsOf(json), keptOf(json)};
    if (manifest.parts < 1) throw Error(ErrorCode::bad_input, "has no number of parts");
    return std::optional(manifest);
  });
}

std::optional<int> StudyFolder::partsOfManifest() const {
  const std::optional<Manifest> manifest = readManifest();
  return manifest ? std::optional(manifest->parts) : std::nullopt;
}

void StudyFolder::begin(int parts, std::optional<KeptFiles> kept) {
  for (const fs::path& written : {folder_, makeFolderIn(folder_, "parts")}) removeAbandonedFiles(written);
  parts_ = parts;
  // Of processes that begin at the same time one writes the manifest, and the others use it.
  const fs::path file = folder_ / kManifest;
  std::unique_ptr<FolderLock> lock;
  while (lock == nullptr && !fs::exists(file)) {
    lock = FolderLock::tryLock(folder_, ".manifest.lock");
    if (lock == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (const std::optional<Manifest> manifest = readManifest()) {
    kept_ = manifest->kept;
    if (manifest->parts != parts) {
      throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
                  fmt::format("the folder's study has {} parts, not {}", manifest->parts, parts));
    }
    if (kept && *kept != kept_) {
      throw Error(
          ErrorCode::bad_input, {file.string(), 0, 0},
          fmt::format("the folder keeps {} of each variant, not {}", toString(kept_), toString(*kept)));
    }
    return;
  }
  kept_ = kept.value_or(KeptFiles::nothing);
  const VariantSet& variants = study_.variants;
  writeWhole(file, [&](std::ostream& out) {
    out << "{\n  \"schema_version\": " << kManifestVersion << ",\n  \"emscape\": " << Json(version_)
        << ",\n  \"name\": " << Json(study_.name) << ",\n  \"hash\": " << Json(study_.hash)
        << ",\n  \"parts\": " << parts;
    if (kept_ != KeptFiles::nothing) out << ",\n  \"kept\": " << Json(toString(kept_));
    out << ",\n  \"measures\": [";
    for (std::size_t m = 0; m < study_.measures.size(); ++m) {
      out << (m > 0 ? ", " : "")
          << Json{{"name", study_.measures[m].name}, {"unit", unitOf(study_.measures[m])}};
    }
    out << "],\n  \"variants\": [";
    for (std::size_t v = 0; v < variants.count(); ++v) {
      Json set = Json::object();
      for (const scenario::Edit& edit : variants.edits(v)) set[edit.path] = edit.value;
      out << (v > 0 ? ",\n    " : "\n    ")
          << Json{{"variant", v}, {"name", variants.name(v)}, {"set", std::move(set)}};
    }
    out << "\n  ]\n}\n";
  });
}

fs::path StudyFolder::partFile(int part, const char* ending) const {
  return folder_ / "parts" / fmt::format("part_{:05}.{}", part, ending);
}

bool StudyFolder::hasPart(int part) const {
  const fs::path file = partFile(part, "json");
  if (!fs::exists(file)) return false;
  return readRecord(file, [&](const Json& record) {
    const std::string hash = record.value("hash", "");
    const int parts = partsOf(record);
    if (hash != study_.hash || parts != parts_) {
      failForeign(file, fmt::format("{} in {} parts", hash, parts),
                  fmt::format("{} in {}", study_.hash, parts_));
    }
    const auto require = [&](bool is_as_written, const fs::path& changed, const char* fault) {
      if (is_as_written) return;
      throw Error(ErrorCode::bad_input, {changed.string()},
                  fmt::format("{}; put it back as it was, or move {} away: --resume computes the part again",
                              fault, partFile(part, "*").string()));
    };
    require(record.contains("crc32"), file, "has no checksum, as parts of earlier versions");
    require(record["crc32"] == recordChecksum(record), file, "was changed since it was written");
    for (const char* const ending : endingsOfPart()) {
      const fs::path beside = partFile(part, ending);
      std::error_code ignored;
      require(fs::is_regular_file(beside, ignored), beside, "is not there");
      require(record.at(ending) == digestRecord(digestOf(beside)), beside,
              "was changed since it was written");
    }
    return true;
  });
}

std::vector<const char*> StudyFolder::endingsOfPart() const {
  if (study_.sites) return {"csv", "bits"};
  return {"csv"};
}

std::vector<int> StudyFolder::missingParts() const {
  std::vector<int> missing;
  for (int part = 1; part <= parts_; ++part) {
    if (!hasPart(part)) missing.push_back(part);
  }
  return missing;
}

std::vector<std::size_t> StudyFolder::variantsOf(int part) const {
  const PartRange range = rangeOfPart(plan_.order.size(), part, parts_);
  const auto begin = plan_.order.begin();
  return {begin + static_cast<std::ptrdiff_t>(range.begin), begin + static_cast<std::ptrdiff_t>(range.end)};
}

void StudyFolder::requireReplaceable(int part) const {
  for (const char* const ending : endingsOfPart()) requireOwn(partFile(part, ending));
}

std::unique_ptr<PartJournal> StudyFolder::journal(int part) const {
  requireReplaceable(part);
  return std::make_unique<PartJournal>(partFile(part, "rows"), variantsOf(part), study_.measures.size());
}

std::uintmax_t StudyFolder::journalBytes(int part) const {
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(partFile(part, "rows"), failed);
  return failed ? 0 : bytes;
}

void StudyFolder::writePart(int part, const PartJournal& journal) const {
  const std::vector<VariantResult> results = journal.results();
  std::string table = "variant", bits;
  for (const StudyMeasure& measure : study_.measures) table += ',' + csvCell(measure.name);
  table += '\n';
  for (const VariantResult& result : results) {
    table += rowOf(result) + '\n';
    bits += packedPixels(result.pixels);
  }
  const PartRange range = rangeOfPart(plan_.order.size(), part, parts_);
  Json record{{"hash", study_.hash},
              {"part", part},
              {"parts", parts_},
              {"order", {range.begin, range.end}},
              {"emscape", version_},
              {"machines", journal.machines()},
              {"pixels", results.empty() ? 0 : results.front().pixels.size()},
              {"warnings", journal.warnings()}};
  std::vector<OutputFile> files;
  for (const std::string ending : endingsOfPart()) {
    const std::string& text = ending == "csv" ? table : bits;
    record[ending] = digestRecord(digestOfText(text));
    files.push_back({partFile(part, ending.c_str()), [&text](std::ostream& out) { out << text; }});
  }
  record["crc32"] = recordChecksum(record);
  files.push_back({partFile(part, "json"), [&](std::ostream& out) { out << dumpJson(record, 2) << '\n'; }});
  writeWhole(files);
  std::error_code ignored;
  fs::remove(partFile(part, "rows"), ignored);
}

void StudyFolder::readPart(int part, StudyResults& results) const {
  const std::size_t pixels = readRecord(partFile(part, "json"), [&](const Json& record) {
    for (const auto& machine : record.value("machines", Json::array())) results.machines.insert(machine);
    for (const auto& warning : record.value("warnings", Json::array())) results.warnings.insert(warning);
    return countOf(record, "pixels", SIZE_MAX);
  });
  const fs::path file = partFile(part, "csv");
  const std::string text = readWholeText(file);
  const std::vector<std::size_t> variants = variantsOf(part);
  const std::size_t measures = study_.measures.size();
  const auto fail = [&](std::size_t row, const std::string& why) {
    throw Error(ErrorCode::bad_input, {file.string(), static_cast<int>(row) + 2, 0},
                why + "; remove the part's files to compute it again");
  };
  std::size_t begin = std::min(text.find('\n'), text.size() - 1) + 1;
  for (std::size_t row = 0; row < variants.size(); ++row) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) fail(row, "the file ends early");
    VariantResult result;
    try {
      result = readRow(std::string_view(text).substr(begin, end - begin), measures);
    } catch (const Error& error) {
      fail(row, error.message());
    }
    if (result.variant != variants[row]) fail(row, fmt::format("variant {} is expected", variants[row]));
    std::copy(result.values.begin(), result.values.end(),
              results.values.begin() + static_cast<std::ptrdiff_t>(result.variant * measures));
    results.is_computed[result.variant] = true;
    begin = end + 1;
  }
  if (!study_.sites) return;
  const std::size_t bytes = (pixels + 7) / 8;
  const std::string bits = readWholeText(partFile(part, "bits"));
  if (pixels > 8 * bits.size() || bits.size() != bytes * variants.size())
    fail(0, "the .bits file beside it has the wrong size");
  for (std::size_t row = 0; row < variants.size(); ++row) {
    results.pixels[variants[row]] = unpackedPixels(std::string_view(bits).substr(row * bytes, bytes), pixels);
  }
}

StudyResults StudyFolder::read() const {
  const std::size_t count = study_.variants.count();
  StudyResults results;
  results.values.assign(count * study_.measures.size(), NAN);
  results.is_computed.assign(count, false);
  if (study_.sites) results.pixels.resize(count);
  for (int part = 1; part <= parts_; ++part) {
    if (hasPart(part)) readPart(part, results);
  }
  return results;
}

void StudyFolder::writeResults(const StudyResults& results) const {
  writeResultsCsv(folder_ / kCsv, study_, results);
  writeResultsNetcdf(folder_ / kNetcdf, study_, results);
}

std::string describeVariant(const StudySpec& study, std::size_t variant) {
  std::string text = study.variants.name(variant);
  for (const scenario::Edit& edit : study.variants.edits(variant)) {
    text += (text.empty() ? "" : ", ") + toString(edit);
  }
  return text;
}

}  // namespace emscape::study

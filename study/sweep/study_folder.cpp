#include "emscape/study/study_folder.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/whole_file.h"
#include "emscape/base/error.h"
#include "study/sweep/result_files.h"

namespace emscape::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void makeFolder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    throw Error(ErrorCode::other,
                fmt::format("{}: the folder cannot be made ({})", folder.string(), failed.message()));
  }
}

Json readJson(const fs::path& file) {
  try {
    return Json::parse(readWholeText(file));
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
                fmt::format("is no JSON ({}); remove it to compute it again", error.what()));
  }
}

[[noreturn]] void failForeign(const fs::path& file, const std::string& found, const std::string& expected) {
  throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
              fmt::format("belongs to another study (hash {}, not {}): the study, its scenario, one of "
                          "their files or the program has changed; choose another folder or remove this one",
                          found, expected));
}

/// Eight pixels in a byte.
std::string packed(const std::vector<VariantResult>& results) {
  std::string bytes;
  for (const VariantResult& result : results) {
    for (std::size_t p = 0; p < result.pixels.size(); p += 8) {
      unsigned byte = 0;
      for (std::size_t b = 0; b < 8 && p + b < result.pixels.size(); ++b) {
        byte |= static_cast<unsigned>(result.pixels[p + b] != 0) << b;
      }
      bytes += static_cast<char>(byte);
    }
  }
  return bytes;
}

}  // namespace

StudyFolder::StudyFolder(fs::path folder, const StudySpec& study, const StudyPlan& plan, std::string version)
    : folder_(std::move(folder)), study_(study), plan_(plan), version_(std::move(version)) {}

std::optional<int> StudyFolder::partsOfManifest() const {
  const fs::path file = folder_ / "manifest.json";
  if (!fs::exists(file)) return std::nullopt;
  const Json manifest = readJson(file);
  const std::string hash = manifest.value("hash", "");
  if (hash != study_.hash) failForeign(file, hash, study_.hash);
  const int parts = manifest.value("parts", 0);
  if (parts < 1) throw Error(ErrorCode::bad_input, {file.string(), 0, 0}, "has no number of parts");
  return parts;
}

void StudyFolder::begin(int parts) {
  makeFolder(folder_ / "parts");
  removeStaleTemporaries(folder_);
  removeStaleTemporaries(folder_ / "parts");
  parts_ = parts;
  if (const std::optional<int> planned = partsOfManifest()) {
    if (*planned == parts) return;
    throw Error(ErrorCode::bad_input, {(folder_ / "manifest.json").string(), 0, 0},
                fmt::format("the folder's study has {} parts, not {}", *planned, parts));
  }
  const VariantSet& variants = study_.variants;
  writeWhole(folder_ / "manifest.json", [&](std::ostream& out) {
    out << "{\n  \"schema_version\": 1,\n  \"emscape\": " << Json(version_)
        << ",\n  \"name\": " << Json(study_.name) << ",\n  \"hash\": " << Json(study_.hash)
        << ",\n  \"parts\": " << parts << ",\n  \"measures\": [";
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
  const Json record = readJson(file);
  const std::string hash = record.value("hash", "");
  if (hash != study_.hash || record.value("parts", 0) != parts_) {
    failForeign(file, fmt::format("{} in {} parts", hash, record.value("parts", 0)),
                fmt::format("{} in {}", study_.hash, parts_));
  }
  return true;
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

void StudyFolder::writePart(int part, const std::vector<VariantResult>& results,
                            const std::set<std::string>& warnings, const std::string& machine) const {
  std::vector<OutputFile> files;
  files.push_back({partFile(part, "csv"), [&](std::ostream& out) {
                     out << "variant";
                     for (const StudyMeasure& measure : study_.measures) out << ',' << csvCell(measure.name);
                     out << '\n';
                     for (const VariantResult& result : results) {
                       out << result.variant;
                       for (const double value : result.values) out << ',' << csvNumber(value);
                       out << '\n';
                     }
                   }});
  if (study_.sites) {
    files.push_back({partFile(part, "bits"), [&](std::ostream& out) { out << packed(results); }});
  }
  const PartRange range = rangeOfPart(plan_.order.size(), part, parts_);
  const Json record{{"hash", study_.hash},
                    {"part", part},
                    {"parts", parts_},
                    {"order", {range.begin, range.end}},
                    {"emscape", version_},
                    {"machine", machine},
                    {"pixels", results.empty() ? 0 : results.front().pixels.size()},
                    {"warnings", warnings}};
  files.push_back({partFile(part, "json"), [&](std::ostream& out) { out << record.dump(2) << '\n'; }});
  writeWhole(files);
}

void StudyFolder::readPart(int part, StudyResults& results) const {
  const Json record = readJson(partFile(part, "json"));
  results.machines.insert(record.value("machine", ""));
  for (const auto& warning : record.value("warnings", Json::array())) results.warnings.insert(warning);
  const fs::path file = partFile(part, "csv");
  const std::string text = readWholeText(file);
  const std::vector<std::size_t> variants = variantsOf(part);
  const auto fail = [&](std::size_t row, const std::string& why) {
    throw Error(ErrorCode::bad_input, {file.string(), static_cast<int>(row) + 2, 0},
                why + "; remove the part's files to compute it again");
  };
  const char *at = text.data() + std::min(text.find('\n'), text.size() - 1) + 1, *const end = text.data() +
                                                                                              text.size();
  for (std::size_t row = 0; row < variants.size(); ++row) {
    std::size_t variant = 0;
    auto read = std::from_chars(at, end, variant);
    if (read.ec != std::errc() || variant != variants[row]) {
      fail(row, fmt::format("variant {} is expected", variants[row]));
    }
    at = read.ptr;
    for (std::size_t m = 0; m < study_.measures.size(); ++m) {
      double value = NAN;
      if (at == end || *at++ != ',') fail(row, fmt::format("has less than {} measures", m + 1));
      if (at != end && *at != ',' && *at != '\n') {
        read = std::from_chars(at, end, value);
        if (read.ec != std::errc()) fail(row, "holds text that is no number");
        at = read.ptr;
      }
      results.values[variant * study_.measures.size() + m] = value;
    }
    if (at == end || *at++ != '\n') fail(row, "does not end after its last measure");
    results.is_computed[variant] = true;
  }
  if (!study_.sites) return;
  const std::size_t pixels = record.value("pixels", std::size_t{0}), bytes = (pixels + 7) / 8;
  const std::string bits = readWholeText(partFile(part, "bits"));
  if (bits.size() != bytes * variants.size()) fail(0, "the .bits file beside it has the wrong size");
  for (std::size_t row = 0; row < variants.size(); ++row) {
    std::vector<std::uint8_t>& of_variant = results.pixels[variants[row]];
    of_variant.resize(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
      of_variant[p] = static_cast<unsigned char>(bits[row * bytes + p / 8]) >> (p % 8) & 1u;
    }
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
  writeResultsCsv(folder_ / "results.csv", study_, results);
  writeResultsNetcdf(folder_ / "results.nc", study_, results);
}

std::string describeVariant(const StudySpec& study, std::size_t variant) {
  std::string text = study.variants.name(variant);
  for (const scenario::Edit& edit : study.variants.edits(variant)) {
    text += (text.empty() ? "" : ", ") + toString(edit);
  }
  return text;
}

}  // namespace emscape::study

/// The folder of a study: its manifest, the results of its parts, and the results of all.
///
///     manifest.json          the study's hash, its number of parts, the variants and their settings
///     parts/part_00003.csv   variant, measures; written when the part is complete
///     parts/part_00003.bits  of a search for sites: the pixels of each variant
///     parts/part_00003.json  the hash, the machines, warnings, checksums; written last
///     parts/part_00003.rows  the finished variants of an incomplete part
///     variants/              the kept files of each variant (VariantFiles)
///     results.csv results.nc report.html
///     sites.geojson          of a search for sites
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "study/sweep/results/part_journal.h"
#include "study/sweep/study_plan.h"
#include "study/sweep/study_runner.h"
#include "study/sweep/variant_files.h"

namespace emscape::study {

/// The results of all finished parts.
struct StudyResults {
  std::vector<double> values;                     ///< [variant][measure]; NaN: none
  std::vector<bool> is_computed;                  ///< of each variant
  std::set<std::string> warnings;                 ///< each once
  std::set<std::string> machines;                 ///< backend and instruction set of the parts
  std::vector<std::vector<std::uint8_t>> pixels;  ///< of a search for sites: VariantResult::pixels

  double value(std::size_t variant, std::size_t measure, std::size_t measures) const {
    return values[variant * measures + measure];
  }
};

class StudyFolder {
 public:
  static constexpr const char* kSites = "sites.geojson";
  /// Names of the files in the folder that each merging of the parts writes again.
  static std::vector<std::string> results(const StudySpec& study);

  /// @param version  of the program
  StudyFolder(std::filesystem::path folder, const StudySpec& study, const StudyPlan& plan,
              std::string version);

  /// The number of parts in the folder's manifest; empty without a manifest.
  /// @throws Error (bad_input) if the manifest is that of another study, or cannot be read
  std::optional<int> partsOfManifest() const;
  /// Writes the manifest, unless it exists.
  /// @param kept  files to keep of each variant; none: as in the manifest, else nothing
  /// @throws Error (bad_input) if the folder has another study, another number of parts, or keeps other
  /// files; (other)
  void begin(int parts, std::optional<KeptFiles> kept = std::nullopt);

  int parts() const { return parts_; }
  /// The files that are kept of each variant; after begin().
  KeptFiles kept() const { return kept_; }
  /// @throws Error (bad_input) if the part belongs to another study, or was changed since it was written
  bool hasPart(int part) const;
  /// @throws Error (bad_input) as hasPart()
  std::vector<int> missingParts() const;

  /// The variants of a part, in the plan's order.
  std::vector<std::size_t> variantsOf(int part) const;
  /// @throws Error (usage) as requireOwn() for a file of an incomplete part, which writePart() would replace
  void requireReplaceable(int part) const;
  /// The finished variants of an incomplete part. @throws Error (usage) as requireReplaceable()
  std::unique_ptr<PartJournal> journal(int part) const;
  /// Size of the journal (bytes), which grows with each finished variant; 0 without a journal.
  std::uintmax_t journalBytes(int part) const;
  /// Writes a complete part, and removes its journal.
  /// @throws Error (other)
  void writePart(int part, const PartJournal& journal) const;

  /// @throws Error (bad_input) as hasPart(), and for a part that cannot be read
  StudyResults read() const;

  /// Writes results.csv and results.nc.
  /// @throws Error (other)
  void writeResults(const StudyResults& results) const;

  const std::filesystem::path& path() const { return folder_; }

 private:
  struct Manifest {
    int parts = 0;
    KeptFiles kept = KeptFiles::nothing;
  };
  std::optional<Manifest> readManifest() const;
  std::filesystem::path partFile(int part, const char* ending) const;
  /// Of the files of a part beside its record.
  std::vector<const char*> endingsOfPart() const;
  void readPart(int part, StudyResults& results) const;

  std::filesystem::path folder_;
  const StudySpec& study_;
  const StudyPlan& plan_;
  std::string version_;
  int parts_ = 0;
  KeptFiles kept_ = KeptFiles::nothing;
};

/// Description of a variant by the parameters that distinguish it: "name; path=value, path=value".
std::string describeVariant(const StudySpec& study, std::size_t variant);

}  // namespace emscape::study

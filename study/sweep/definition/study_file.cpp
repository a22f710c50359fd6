#include "study/sweep/definition/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "base/files/file_digest.h"
#include "base/files/file_reading.h"
#include "document/schema_check.h"
#include "document/text_file.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/file_kind.h"
#include "scenario/map/vector_file.h"
#include "study/sweep/definition/study_format.h"
#include "study/sweep/definition/study_reading.h"

namespace emscape::study {
namespace {

namespace fs = std::filesystem;
using document::Section;

constexpr std::uintmax_t kMaxStudyBytes = std::uintmax_t{64} << 20;

void readMaps(StudyReading& reading, const Section& root) {
  StudySpec& spec = reading.spec;
  spec.name = root.has("name") ? root.text("name") : fs::path(reading.file).stem().string();
  reading.reportAt(root.locationOf("times"),
                   [&] { spec.times_s = scenario::parseTimes(root.text("times"), spec.base->clock); });
  spec.area = areaOf(spec.base->region);
  if (root.has("area")) {
    reading.reportAt(root.locationOf("area"), [&] {
      spec.area = parseArea(root.text("area"));
      const std::string mistake = mistakenAreaText(spec.area, spec.base->region);
      if (!mistake.empty()) throw Error(ErrorCode::bad_input, "area: " + mistake);
    });
  }
  const scenario::Region& region = spec.base->region;
  spec.cell_m =
      root.has("cell_m") ? root.number("cell_m") : std::max(1.0, std::round(region.size_m.x / region.dims.x));
  spec.crs = root.text("crs");
}

}  // namespace

std::string StudyReading::resolve(const std::string& name) const {
  return (fs::path(file).parent_path() / name).lexically_normal().string();
}

bool hasControlCharacter(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; });
}

void StudyReading::addVectors(const std::string& name) {
  for (const std::string& part : scenario::VectorFile(name).files()) {
    if (std::count(spec.files.begin(), spec.files.end(), part) == 0) spec.files.push_back(part);
  }
}

std::string StudyReading::nameOf(const Section& section) {
  std::string name = section.text("name");
  if (hasControlCharacter(name))
    fault(section.locationOf("name"), "'name' has a line break or another control character");
  return name;
}

MapGrid mapGridOf(const StudySpec& study) {
  try {
    return makeMapGrid(study.area, study.cell_m, study.crs);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::usage) throw;
    throw Error(ErrorCode::bad_input, {study.file, 0, 0}, error.message());
  }
}

StudySpec loadStudy(const std::string& file, const std::vector<scenario::Edit>& edits,
                    const std::string& version, bool tries_values) {
  StudyReading reading;
  reading.tries_values = tries_values;
  reading.file = file;
  if (const std::string other = scenario::foreignFileText(file); !other.empty())
    throw Error(ErrorCode::bad_input, {file, 0, 0}, other);
  const std::string bytes = readWholeText(file, kMaxStudyBytes);
  reading.original =
      document::readDocument(file, document::checkedUtf8(file, bytes, "a study"), reading.problems);
  if (!reading.original) {
    document::requireNoProblem(reading.problems);
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "the file is empty");
  }
  using scenario::DocumentKind;
  const std::string other =
      scenario::otherDocumentText(scenario::documentKindOf(*reading.original), DocumentKind::study);
  if (!other.empty()) throw Error(ErrorCode::bad_input, {file, 0, 0}, other);
  const document::DocumentNodePtr node = checkable(file, *reading.original);
  document::checkObject(file, *node, studyFormat(), reading.problems);
  document::requireNoProblem(reading.problems);
  const Section root(file, node.get(), studyFormat());
  StudySpec& spec = reading.spec;
  spec.file = file;
  const std::string base = reading.resolve(root.text("scenario"));
  std::error_code failed;
  if (!fs::exists(base, failed)) {
    throw Error(ErrorCode::bad_input, root.locationOf("scenario"),
                base + ": " + (failed ? failed.message() : "no such file") + "; a scenario");
  }
  spec.base = scenario::loadScenario(base, edits, scenario::ReadFor::chosen_times);
  readMaps(reading, root);
  readMeasures(reading, root);
  readVariants(reading, root);
  document::requireNoProblem(reading.problems);
  addFilesOfVariants(reading);

  document::ContentHash hash;
  hash.add(version);
  hash.add(bytes);
  hash.add(spec.base->hash);
  const auto add = [&hash](const std::string& name) {
    const std::uint32_t crc32 = digestOf(name).crc32;
    hash.add(fmt::format("{:08x}", crc32));
    return crc32;
  };
  for (const std::string& name : spec.files) add(name);
  if (spec.base->terrain) {
    for (const std::string& name : spec.base->terrain->rasters()) spec.rasters.emplace_back(name, add(name));
  }
  spec.hash = hash.hex();
  return std::move(spec);
}

}  // namespace emscape::study

#include <algorithm>
#include <set>

#include "document/edit_path.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"
#include "study/sweep/definition/study_reading.h"

namespace emscape::study {
namespace {

/// True if a value can be the name of a file, or contain one.
bool canNameFile(const document::ValueSpec& spec) {
  if (spec.type == document::ValueType::file || (spec.item && canNameFile(*spec.item))) return true;
  return spec.object != nullptr &&
         std::any_of(spec.object->keys.begin(), spec.object->keys.end(),
                     [](const document::KeySpec& key) { return canNameFile(key.value); });
}

bool canNameFile(const scenario::Scenario& base, const std::string& path) {
  try {
    return canNameFile(*document::resolvePath(path, base.source->root, scenario::scenarioSpec()).spec);
  } catch (const Error&) {  // the path exists only after other edits
    return true;
  }
}

}  // namespace

void addFilesOfVariants(StudyReading& reading) {
  StudySpec& spec = reading.spec;
  const std::vector<std::string> of_base = scenario::filesOf(*spec.base);
  std::set<std::string> known(of_base.begin(), of_base.end());
  for (const VariantFactor& factor : spec.variants.factors()) {
    std::vector<std::size_t> columns;
    for (std::size_t column = 0; column < factor.paths.size(); ++column) {
      if (canNameFile(*spec.base, factor.paths[column])) columns.push_back(column);
    }
    std::set<std::vector<std::string>> done;  // values of these columns
    for (std::size_t setting = 0; !columns.empty() && setting < factor.count; ++setting) {
      std::vector<std::string> values;
      for (const std::size_t column : columns) values.push_back(factor.value(setting, column));
      if (!done.insert(std::move(values)).second) continue;
      std::vector<scenario::Edit> edits;
      for (std::size_t column = 0; column < factor.paths.size(); ++column) {
        const std::string& value = factor.value(setting, column);
        if (!value.empty()) edits.push_back({factor.paths[column], value});
      }
      // A setting that is valid only together with others is not known here.
      const auto edited = scenario::editScenario(*spec.base, edits).scenario;
      if (edited == nullptr) continue;
      for (const std::string& file : scenario::filesOf(*edited)) {
        if (known.insert(file).second) spec.files.push_back(file);
      }
    }
  }
}

}  // namespace emscape::study

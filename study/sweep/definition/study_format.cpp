#include "study/sweep/definition/study_format.h"

#include <fmt/format.h>

#include <functional>

#include "document/text_edit.h"
#include "emscape/base/error.h"
#include "emscape/study/maps/products.h"
#include "study/sweep/definition/sample_points.h"

namespace emscape::study {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;
using document::KeySpec;
using document::NodeKind;
using document::ObjectSpec;
using document::ValueType;
namespace spec = document::spec;

constexpr int kMaxItems = 100000;
constexpr double kMaxNumber = 1e300;
const document::ValueSpec kText = spec::textOf(ValueType::text, 4096);
const document::ValueSpec kFile = spec::textOf(ValueType::file, 4096);
const document::ValueSpec kNumber = spec::number().from(-kMaxNumber).to(kMaxNumber);
const document::ValueSpec kPositive = spec::number().above(0).to(kMaxNumber);
const document::ValueSpec kCount = spec::simple(ValueType::integer).from(2).to(1e7);

document::ValueSpec productNames() {
  std::vector<std::string> names;
  for (const ProductInfo& row : productTable()) names.emplace_back(row.name);
  return spec::choice(std::move(names));
}

const ObjectSpec kNothing{"set", "", {}};
const ObjectSpec kVariant{"variant",
                          "",
                          {spec::required("name", kText, "in tables and reports"),
                           spec::optional("set", spec::object(kNothing), "PATH: VALUE of each change")}};
const ObjectSpec kLinear{
    "linear range",
    "",
    {spec::required("from", kNumber, "first value"), spec::required("to", kNumber, "last value"),
     spec::required("count", kCount, "number of values")}};
const ObjectSpec kLogarithmic{
    "logarithmic range",
    "",
    {spec::required("from", kPositive, "first value"), spec::required("to", kPositive, "last value"),
     spec::required("count", kCount, "number of values")}};
/// Further paths that get the same value.
const KeySpec kAlso =
    spec::optional("also", spec::listOf(kText, 1, 100), "further paths that get the same value");
const ObjectSpec kSweep{"sweep of a parameter",
                        "",
                        {spec::optional("values", spec::listOf(kText, 1, kMaxItems), "a list"),
                         spec::optional("linear", spec::object(kLinear), "equal differences"),
                         spec::optional("log", spec::object(kLogarithmic), "equal ratios"), kAlso},
                        {{"values", "linear", "log"}}};
const ObjectSpec kNormal{"normal distribution",
                         "",
                         {spec::required("mean", kNumber, ""), spec::required("deviation", kPositive, "")}};
const ObjectSpec kUniform{
    "uniform distribution", "", {spec::required("from", kNumber, ""), spec::required("to", kNumber, "")}};
const ObjectSpec kLognormal{
    "lognormal distribution",
    "",
    {spec::required("median", kPositive, ""),
     spec::required("deviation_db", kPositive, "standard deviation of 10 log10 of the value")}};
const ObjectSpec kDistribution{"distribution",
                               "",
                               {spec::optional("normal", spec::object(kNormal), ""),
                                spec::optional("uniform", spec::object(kUniform), ""),
                                spec::optional("lognormal", spec::object(kLognormal), ""), kAlso},
                               {{"normal", "uniform", "lognormal"}}};
const ObjectSpec kSamples{
    "samples",
    "",
    {spec::required("count", spec::simple(ValueType::integer).from(1).to(1e6), "number of samples"),
     spec::byDefault("seed", spec::simple(ValueType::integer).from(0).to(2147483647), 1.0,
                     "other numbers, other samples"),
     spec::byDefault("method", spec::choice({"latin_hypercube", "sobol"}), "latin_hypercube", ""),
     spec::required("parameters", spec::listOf(spec::object(kDistribution), 1, kMaxSobolDimensions),
                    "PATH: distribution; at most 21")}};
const ObjectSpec kSites{
    "sites",
    "",
    {spec::required("platform", kText, "name of the platform that is placed"),
     spec::optional("candidates", kFile, "points (GeoPackage, GeoJSON or any other file of GDAL)"),
     spec::optional("grid_m", spec::number("m").above(0).to(1e6), "distance of candidates over the area"),
     spec::byDefault("choose", spec::simple(ValueType::integer).from(1).to(1000), 1.0, "number of sites"),
     spec::optional("maximise", kText, "name of a measure of an area; default: the first")},
    {{"candidates", "grid_m"}}};

ObjectSpec measureSpec() {
  return {"measure",
          "",
          {spec::required("name", kText, "in tables and reports"),
           spec::byDefault("product", productNames(), "covered", "as of emscape coverage"),
           spec::byDefault("height", kText, "agl:150", "one height, agl:METRES or msl:METRES"),
           spec::optional("quantity", kText, "default: the study's"),
           spec::optional("threshold", kNumber, "default: the study's"),
           spec::byDefault("over", kFile, "region", "region, or a file of polygons"),
           spec::optional("unit", spec::choice({"km2", "percent", "s", "m", "dB"}),
                          "km2 or percent of an area; else the product's"),
           spec::optional("statistic", spec::choice({"mean", "min", "max"}),
                          "of the product over the area; default: mean, of areas none")}};
}

/// A copy with the values of a key changed.
DocumentNodePtr withKey(const DocumentNodePtr& node, const std::string& key,
                        const std::function<DocumentNodePtr(const DocumentNodePtr&)>& change) {
  auto copy = std::make_shared<DocumentNode>(*node);
  for (document::MapEntry& entry : copy->entries) {
    if (entry.key == key) entry.value = change(entry.value);
  }
  return copy;
}

DocumentNodePtr asText(const DocumentNodePtr& node) {
  auto copy = std::make_shared<DocumentNode>(*node);
  if (node->kind == NodeKind::scalar) copy->quoted = true;
  return copy;
}

DocumentNodePtr withFlowTexts(const DocumentNodePtr& list) {
  auto copy = std::make_shared<DocumentNode>(*list);
  for (DocumentNodePtr& item : copy->items) {
    auto text = std::make_shared<DocumentNode>();
    text->kind = NodeKind::scalar;
    text->position = item->position;
    text->quoted = true;
    text->text = item->kind == NodeKind::null ? "null" : document::flowText(*item, false);
    item = text;
  }
  return copy;
}

/// The values of a map as a list. @throws Error (bad_input) where it is not a map
DocumentNodePtr asList(const std::string& file, const std::string& key, const std::string& values,
                       const DocumentNodePtr& node) {
  if (node->kind != NodeKind::map) {
    throw Error(ErrorCode::bad_input, {file, node->position.line, node->position.column},
                fmt::format("'{}' must be a map from the scenario's paths to {}", key, values));
  }
  auto list = std::make_shared<DocumentNode>();
  list->kind = NodeKind::sequence;
  list->position = node->position;
  for (const document::MapEntry& entry : node->entries) list->items.push_back(entry.value);
  return list;
}

DocumentNodePtr eachItem(const DocumentNodePtr& list,
                         const std::function<DocumentNodePtr(const DocumentNodePtr&)>& change) {
  auto copy = std::make_shared<DocumentNode>(*list);
  for (DocumentNodePtr& item : copy->items) item = change(item);
  return copy;
}

}  // namespace

const ObjectSpec& studyFormat() {
  static const ObjectSpec kMeasure = measureSpec();
  static const ObjectSpec kStudy{
      "study",
      "",
      {spec::required("schema_version", spec::simple(ValueType::integer).from(1).to(1), ""),
       spec::optional("name", kText, "default: the file's name"),
       spec::required("scenario", kFile, "which the variants edit"),
       spec::optional("variants", spec::listOf(spec::object(kVariant), 1, kMaxItems).distinct(), ""),
       spec::optional("sweep", spec::listOf(spec::object(kSweep), 1, 100), "PATH: values"),
       spec::optional("samples", spec::object(kSamples), ""),
       spec::optional("sites", spec::object(kSites), ""),
       spec::required("measures", spec::listOf(spec::object(kMeasure), 1, 1000).distinct(), ""),
       spec::byDefault("quantity", kText, "detection_probability", ""),
       spec::optional("threshold", kNumber, "default: that of emscape coverage"),
       spec::byDefault("times", kText, "0", "BEGIN:END:STEP, BEGIN:END or T (s)"),
       spec::optional("cell_m", spec::number("m").above(0).to(1e6), "default: the scenario's voxels"),
       spec::optional("area", kText, "default: the scenario's region"),
       spec::byDefault("crs", kText, "utm", "")}};
  return kStudy;
}

DocumentNodePtr checkable(const std::string& file, const DocumentNode& root) {
  DocumentNodePtr study = std::make_shared<DocumentNode>(root);
  for (const char* key : {"times", "area", "crs"}) study = withKey(study, key, asText);
  study = withKey(study, "sweep", [&](const DocumentNodePtr& sweep) {
    return eachItem(asList(file, "sweep", "their values", sweep),
                    [](const DocumentNodePtr& one) { return withKey(one, "values", withFlowTexts); });
  });
  study = withKey(study, "samples", [&](const DocumentNodePtr& samples) {
    return withKey(samples, "parameters", [&](const DocumentNodePtr& parameters) {
      return asList(file, "parameters", "their distributions", parameters);
    });
  });
  study = withKey(study, "variants", [](const DocumentNodePtr& variants) {
    return eachItem(variants, [](const DocumentNodePtr& variant) {
      return withKey(withKey(variant, "name", asText), "set", [](const DocumentNodePtr& set) {
        if (set->kind != NodeKind::map) return set;
        auto empty = std::make_shared<DocumentNode>(*set);
        empty->entries.clear();
        return DocumentNodePtr(empty);
      });
    });
  });
  return withKey(study, "measures", [](const DocumentNodePtr& measures) {
    return eachItem(measures,
                    [](const DocumentNodePtr& measure) { return withKey(measure, "height", asText); });
  });
}

const DocumentNode* childOf(const DocumentNode* node, const std::string& key) {
  if (node == nullptr) return nullptr;
  for (const document::MapEntry& entry : node->entries) {
    if (entry.key == key) return entry.value.get();
  }
  return nullptr;
}

}  // namespace emscape::study

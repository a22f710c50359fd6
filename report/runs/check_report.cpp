#include "report/runs/check_report.h"

#include <algorithm>

#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "report/text.h"

namespace emscape::report {
namespace {

using emfield::FigureCheck;

Json toJson(const FigureCheck& figure) {
  return {{"figure", figure.figure},       {"max_abs_error", figure.max_abs_error},
          {"tolerance", figure.tolerance}, {"unit", figure.unit},
          {"pass", figure.pass()},         {"worst_line", figure.worst_line}};
}

void addRow(Text& out, const std::string& name, int cases, const FigureCheck& figure) {
  out.add("{:<40} {:>6}  {:<32} {:>10.3g} {:>10.3g} {:<9} {}\n", name, cases > 0 ? std::to_string(cases) : "",
          figure.figure, figure.max_abs_error, figure.tolerance, figure.unit,
          figure.pass() ? "pass" : fmt::format("MISS (line {})", figure.worst_line));
}

}  // namespace

bool CheckReport::pass() const {
  return !checked.empty() && unreadable.empty() &&
         std::all_of(checked.begin(), checked.end(),
                     [](const Outcome& outcome) { return outcome.check.pass(); });
}

CheckReport checkReport(const std::string& folder, const ProgressSink& progress) {
  CheckReport report;
  report.folder = emfield::findDatasets(folder);
  double done = 0;
  for (const emfield::ReferenceDataset* dataset : report.folder.present) {
    progress("figures", done++ / static_cast<double>(report.folder.present.size()));
    const WorkPart part(dataset->name, 0, 0);
    if (dataset->check == nullptr) {
      report.not_checked.push_back(dataset->name);
      continue;
    }
    try {
      report.checked.push_back({dataset, dataset->check(report.folder.root / dataset->name)});
    } catch (const Error& error) {
      report.unreadable.push_back({dataset->name, error.what()});
    }
  }
  progress("figures", 1);
  return report;
}

Json toJson(const CheckReport& report) {
  Json datasets = Json::array();
  for (const CheckReport::Outcome& outcome : report.checked) {
    const FigureCheck& main = outcome.check.figures.front();
    Json figures = Json::array();
    for (const FigureCheck& figure : outcome.check.figures) figures.push_back(toJson(figure));
    datasets.push_back({{"name", outcome.dataset->name},
                        {"cases", outcome.check.cases},
                        {"max_abs_error", main.max_abs_error},
                        {"tolerance", main.tolerance},
                        {"unit", main.unit},
                        {"pass", outcome.check.pass()},
                        {"figures", figures}});
  }
  Json unreadable = Json::array();
  for (const auto& [name, fault] : report.unreadable)
    unreadable.push_back({{"name", name}, {"fault", fault}});
  return {{"datasets", datasets},           {"unreadable", unreadable},
          {"pass", report.pass()},          {"not_checked", report.not_checked},
          {"absent", report.folder.absent}, {"unknown", report.folder.unknown}};
}

std::string checkText(const CheckReport& report) {
  Text out;
  out.add("{:<40} {:>6}  {:<32} {:>10} {:>10} {:<9} {}\n", "dataset", "cases", "figure", "max error",
          "tolerance", "unit", "result");
  for (const CheckReport::Outcome& outcome : report.checked) {
    const auto& figures = outcome.check.figures;
    addRow(out, outcome.dataset->name, outcome.check.cases, figures.front());
    for (std::size_t i = 1; i < figures.size(); ++i) addRow(out, "", 0, figures[i]);
  }
  for (const auto& [name, fault] : report.unreadable) out.add("{:<40} cannot be read: {}\n", name, fault);
  for (const std::string& name : report.not_checked)
    out.add("{:<40} not checked: no model answers to it\n", name);
  for (const std::string& name : report.folder.absent) out.add("{:<40} not checked: absent\n", name);
  for (const std::string& name : report.folder.unknown) out.add("{:<40} not checked: unknown\n", name);
  return out.take();
}

}  // namespace emscape::report

#include "report/paths/choices_report.h"

namespace emscape::report {

Json choicesJson(const std::vector<emfield::EmitterChoice>& choices) {
  Json all = Json::array();
  for (const emfield::EmitterChoice& choice : choices) {
    all.push_back(
        {{"emitter", choice.emitter}, {"model", choice.model}, {"name", choice.name}, {"text", choice.text}});
  }
  return all;
}

}  // namespace emscape::report

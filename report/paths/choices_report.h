/// Automatic choices of models, as JSON.
#pragma once

#include <vector>

#include "emfield/excess/model_choices.h"
#include "report/json.h"

namespace emscape::report {

/// [{"emitter", "model", "name", "text"}]
Json choicesJson(const std::vector<emfield::EmitterChoice>& choices);

}  // namespace emscape::report

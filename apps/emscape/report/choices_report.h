/// Automatic choices of models, as JSON.
#pragma once

#include <vector>

#include "apps/emscape/common/console.h"
#include "emfield/excess/model_choices.h"

namespace emscape::app {

/// [{"emitter", "model", "name", "text"}]
Json choicesJson(const std::vector<emfield::EmitterChoice>& choices);

}  // namespace emscape::app

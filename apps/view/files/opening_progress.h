/// Progress of an input that is opened beside the one on screen.
#pragma once

#include <string>

#include "emscape/base/work.h"

namespace emscape::view {

struct OpeningProgress {
  std::string file;
  WorkProgress progress;
};

}  // namespace emscape::view

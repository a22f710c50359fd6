// Cells cast by a GPU, in a build without CUDA.
#include "emscape/base/error.h"
#include "render/cells/cell_caster.h"

namespace emscape::render {

std::unique_ptr<CellCaster> makeCudaCellCaster() {
  throw Error(ErrorCode::device, "cells cast by the GPU: this build has no CUDA");
}

}  // namespace emscape::render

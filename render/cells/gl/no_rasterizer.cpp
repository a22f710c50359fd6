// CellRasterizer in a build without libepoxy.
#include "emscape/base/error.h"
#include "render/cells/cell_rasterizer.h"

namespace emscape::render::gl {

struct CellRasterizer::Impl {};

CellRasterizer::CellRasterizer() {
  throw Error(ErrorCode::device, "projection of cells needs OpenGL: this build has no libepoxy");
}
CellRasterizer::~CellRasterizer() = default;
CellRasterizer::Use::Use(CellRasterizer& rasterizer) : rasterizer_(rasterizer) {}
CellRasterizer::Use::~Use() = default;
const std::string& CellRasterizer::device() const {
  static const std::string none;
  return none;
}
void CellRasterizer::setTransfer(const LinearTransfer&) {}
void CellRasterizer::begin(const CellView&) {}
CellRasterizer::Batch CellRasterizer::nextBatch() {
  return {};
}
void CellRasterizer::draw(std::size_t) {}
void CellRasterizer::drawAround(float) {}
void CellRasterizer::fetch(Image&) {}
std::size_t CellRasterizer::sentFloats() const {
  return 0;
}
double CellRasterizer::drawMs() const {
  return 0;
}

}  // namespace emscape::render::gl

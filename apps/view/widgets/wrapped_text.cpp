#include "apps/view/widgets/wrapped_text.h"

#include <imgui.h>

#include "apps/view/values/line_breaks.h"
#include "apps/view/widgets/glyphs.h"

namespace emscape::view {

std::string wrapped(const std::string& text, float width) {
  ImFont& font = *ImGui::GetFont();
  const float size = ImGui::GetFontSize();
  return withLineBreaks(drawable(text), width, [&font, size](std::string_view part) {
    return font.CalcTextSizeA(size, FLT_MAX, 0, part.data(), part.data() + part.size()).x;
  });
}

void textWrapped(const std::string& text) {
  ImGui::TextUnformatted(wrapped(text, ImGui::GetContentRegionAvail().x).c_str());
}

}  // namespace emscape::view

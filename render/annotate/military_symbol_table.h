/// Drawings of MIL-STD-2525 and APP-6, made by scripts/make-military-symbols, which describes their text.
#pragma once

namespace emscape::render {

struct SymbolDrawing {
  const char* set;   ///< symbol set of a SIDC: "10" land units, ...
  const char* code;  ///< of an icon: the entity of a SIDC, or a name with a point; of a frame: F, H, N or U
  const char* drawing;
};

extern const SymbolDrawing kFrames[], kIcons[];
extern const int kFramesCount, kIconsCount;

}  // namespace emscape::render

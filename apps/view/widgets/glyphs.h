/// Characters of all scripts in the window. Dear ImGui draws one glyph per character, from left to right, out
/// of an atlas with a fixed set of characters. Others are added when a text has them, drawn as in pictures:
/// single characters, and runs of scripts that are shaped or written from right to left, each as one glyph.
#pragma once

#include <imgui.h>

#include <map>
#include <string>

namespace emscape::view {

/// Of the atlas of glyphs, pixels.
inline constexpr int kAtlasWidth = 2048;

/// For the thread of the window.
class Glyphs {
 public:
  /// The glyphs of the window.
  static Glyphs& ofWindow();

  /// Characters of the font file that are always there: Latin, Greek, Cyrillic, signs. Ends with 0.
  static const ImWchar* ranges();

  /// Adds a character, or those of a text, such as of a field in which it is edited.
  void need(char32_t character);
  void need(const std::string& text);
  /// The text for Dear ImGui: a run that needs shaping is one character for private use.
  std::string drawable(const std::string& text);

  /// True if characters were added since the last drawInto().
  bool hasNew() const { return has_new_; }
  /// Reserves places in an atlas before it is built. @param size_px  of the font
  void addTo(ImFontAtlas& atlas, ImFont* font, float size_px);
  /// Draws the glyphs into the built atlas.
  void drawInto(ImFontAtlas& atlas);

 private:
  struct Glyph {
    std::string text;
    int rect = -1;  ///< in the atlas
  };

  void add(ImWchar id, const std::string& text);
  ImWchar idOf(const std::string& run);
  void forget();

  std::map<ImWchar, Glyph> glyphs_;
  std::map<std::string, ImWchar> runs_;
  std::map<std::string, std::string> shown_;  ///< of the texts with runs
  float size_px_ = 0;
  bool has_new_ = false;
};

/// Glyphs::ofWindow().drawable(text)
std::string drawable(const std::string& text);

}  // namespace emscape::view

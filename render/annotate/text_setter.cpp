#include "render/annotate/text_setter.h"

#include <pango/pangocairo.h>

#include <memory>
#include <mutex>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/memory.h"
#include "base/text/utf8.h"
#include "base/threads.h"
#include "emscape/base/log.h"

namespace emscape::render {
namespace {

/// In the order of preference. Without them fontconfig would choose the face of Han characters by the locale.
constexpr const char* kFamilies =
    "DejaVu Sans,Noto Sans,Noto Sans Arabic,Noto Sans Hebrew,Noto Sans Devanagari,Noto Sans Bengali,"
    "Noto Sans Tamil,Noto Sans Thai,Noto Sans Georgian,Noto Sans Armenian,Noto Sans CJK SC,sans-serif";
/// A language of which Pango knows nothing has every script; others send it to the locale for some scripts.
constexpr const char* kLanguage = "xx";
constexpr std::size_t kMaxLines = 4096;
/// Threads of Pango at the same time, at most, for the first text of a font; it ends the program where one is
/// refused: two each for the font and its fallbacks. One before them, that reads the configuration, may not
/// have ended yet on a busy machine.
constexpr int kThreadsOfPango = 4;
/// Of them and their tables; the threads' stacks and heaps are addresses alone.
constexpr std::size_t kFonts_bytes = std::size_t{96} << 20;

/// A line in a font. Fonts and lines of Pango are for one thread at a time: `mutex` is held while one is
/// used.
class TextSetter {
 public:
  static TextSetter& instance() {
    static auto* const setter = new TextSetter();  // as long as the program: worker threads may still draw
    return *setter;
  }

  std::mutex mutex;

  PangoLayoutLine* line(const std::string& text, double size_px, Weight weight) {
    std::string key = std::to_string(size_px) + (weight == Weight::bold ? "b" : "n") + text;
    const auto known = lines_.find(key);
    if (known != lines_.end()) return pango_layout_get_line_readonly(known->second.get(), 0);
    if (lines_.size() >= kMaxLines) lines_.clear();
    if (fonts_used_.count({size_px, weight}) == 0) requireThreads(kThreadsOfPango);
    const std::string characters = xmlCharacters(text);
    LayoutPtr layout(pango_layout_new(context_.get()), g_object_unref);
    pango_layout_set_single_paragraph_mode(layout.get(), TRUE);
    pango_font_description_set_absolute_size(font_.get(), size_px * PANGO_SCALE);
    pango_font_description_set_weight(font_.get(),
                                      weight == Weight::bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_layout_set_font_description(layout.get(), font_.get());
    pango_layout_set_text(layout.get(), characters.data(), static_cast<int>(characters.size()));
    const auto added = lines_.emplace(std::move(key), std::move(layout)).first;
    PangoLayoutLine* const line = pango_layout_get_line_readonly(added->second.get(), 0);
    fonts_used_.emplace(size_px, weight);
    if (pango_layout_get_unknown_glyphs_count(added->second.get()) > 0) warnOfBoxes(characters);
    return line;
  }

 private:
  using LayoutPtr = std::unique_ptr<PangoLayout, void (*)(void*)>;

  TextSetter()
      : fonts_((requireForFonts(), pango_cairo_font_map_new_for_font_type(CAIRO_FONT_TYPE_FT)),
               g_object_unref),
        context_(pango_font_map_create_context(fonts_.get()), g_object_unref),
        font_(pango_font_description_from_string(kFamilies), pango_font_description_free) {
    // Glyphs are not aligned to whole pixels, for uniform spacing at small sizes.
    const std::unique_ptr<cairo_font_options_t, void (*)(cairo_font_options_t*)> options(
        cairo_font_options_create(), cairo_font_options_destroy);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_SLIGHT);
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    pango_cairo_context_set_font_options(context_.get(), options.get());
    pango_context_set_round_glyph_positions(context_.get(), FALSE);
    pango_context_set_language(context_.get(), pango_language_from_string(kLanguage));
  }

  /// What Pango and fontconfig, which wait or end the program without it, need for the first text.
  static void requireForFonts() {
    requireMemory({"the text of a picture", kFonts_bytes, "a higher limit is needed (ulimit -v)"}, {});
    requireThreads(kThreadsOfPango);
  }

  /// Once: further texts lack the same font.
  void warnOfBoxes(const std::string& text) {
    if (std::exchange(has_warned_, true)) return;
    logWarning("characters of '" + text +
               "' and perhaps others are drawn as empty boxes: no font that is installed has them; the "
               "packages fonts-dejavu-core (Latin, Greek, Cyrillic) and fonts-noto (others) have");
  }

  bool has_warned_ = false;
  std::unique_ptr<PangoFontMap, void (*)(void*)> fonts_;
  std::unique_ptr<PangoContext, void (*)(void*)> context_;
  std::unique_ptr<PangoFontDescription, void (*)(PangoFontDescription*)> font_;
  std::unordered_map<std::string, LayoutPtr> lines_;  ///< by text, size and weight
  std::set<std::pair<double, Weight>> fonts_used_;
};

}  // namespace

void requireFonts() {
  TextSetter::instance();
}

double lineWidth(const std::string& text, double size_px, Weight weight) {
  TextSetter& setter = TextSetter::instance();
  const std::lock_guard lock(setter.mutex);
  PangoRectangle extent;
  pango_layout_line_get_extents(setter.line(text, size_px, weight), nullptr, &extent);
  return static_cast<double>(extent.width) / PANGO_SCALE;
}

void fillLine(cairo_t* cairo, const std::string& text, double size_px, Weight weight, const Point2& begin) {
  TextSetter& setter = TextSetter::instance();
  const std::lock_guard lock(setter.mutex);
  cairo_move_to(cairo, begin.x, begin.y);
  pango_cairo_show_layout_line(cairo, setter.line(text, size_px, weight));
}

void addLineToPath(cairo_t* cairo, const std::string& text, double size_px, Weight weight,
                   const Point2& begin) {
  TextSetter& setter = TextSetter::instance();
  const std::lock_guard lock(setter.mutex);
  cairo_move_to(cairo, begin.x, begin.y);
  pango_cairo_layout_line_path(cairo, setter.line(text, size_px, weight));
}

}  // namespace emscape::render

#include "apps/view/widgets/glyphs.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text/utf8.h"
#include "render/annotate/canvas.h"

namespace emscape::view {
namespace {

constexpr ImWchar kFirstRun = 0xE000, kLastRun = 0xF8FF;  // for private use
constexpr std::size_t kMaxGlyphs = 6000;
// Of DejaVu Sans: Dear ImGui's size is ascent and descent, together 2384/2048 of the em.
constexpr float kEm = 2048.0F / 2384, kAscent = 1901.0F / 2384;

struct Range {
  char32_t first, last;
};
template <std::size_t n>
bool isIn(const Range (&ranges)[n], char32_t c) {
  return std::any_of(ranges, ranges + n,
                     [c](const Range& range) { return c >= range.first && c <= range.last; });
}

bool isRightToLeft(char32_t c) {
  constexpr Range kRanges[] = {
      {0x590, 0x8FF}, {0xFB1D, 0xFDFF}, {0xFE70, 0xFEFF}, {0x10800, 0x10FFF}, {0x1E800, 0x1EFFF}};
  return isIn(kRanges, c);
}

/// Scripts with letters that join, combine or change their order; and what has no 16-bit character.
bool needsShaping(char32_t c) {
  constexpr Range kRanges[] = {
      {0x900, 0x109F}, {0x1100, 0x11FF}, {0x1700, 0x1CFF}, {0x300, 0x36F}, {0x10000, 0x10FFFF}};
  return isRightToLeft(c) || isIn(kRanges, c);
}

bool isLetter(char32_t c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= 0xC0 && c < 0x2000) || c >= 0x3040;
}

/// Calls `use` with the place, the length and the value of each character.
template <class Use>
void forCharacters(const std::string& text, const Use& use) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8SequenceLength(std::string_view(text).substr(at));
    if (length > 0) use(at, length, codePointOf(std::string_view(text).substr(at, length)));
    at += std::max<std::size_t>(length, 1);
  }
}

/// A part of a text that is drawn as one glyph.
struct Run {
  std::size_t begin, end;
  bool is_right_to_left;
};

/// A text that begins with a script from right to left is one run, since its words stand from right to left;
/// elsewhere such words form a run with the blanks between them.
std::vector<Run> runsOf(const std::string& text) {
  std::vector<Run> runs;
  bool begins_right = false, has_letter = false;
  std::size_t before = 0;  // begin of the character before
  forCharacters(text, [&](std::size_t at, std::size_t length, char32_t c) {
    if (!has_letter && isLetter(c)) {
      has_letter = true;
      begins_right = isRightToLeft(c);
    }
    if (needsShaping(c)) {
      const bool is_right = isRightToLeft(c), is_mark = c >= 0x300 && c <= 0x36F;
      const bool goes_on =
          !runs.empty() && (runs.back().end == at || (is_right && runs.back().is_right_to_left &&
                                                      text.find_first_not_of(' ', runs.back().end) == at));
      if (goes_on) {
        runs.back().end = at + length;
      } else {
        runs.push_back({is_mark ? before : at, at + length, is_right});
      }
    }
    before = at;
  });
  if (begins_right) return {{0, text.size(), true}};
  return runs;
}

std::string utf8Of(ImWchar c) {
  return {static_cast<char>(0xE0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 0x3F)),
          static_cast<char>(0x80 | (c & 0x3F))};
}

bool isAscii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

}  // namespace

Glyphs& Glyphs::ofWindow() {
  static Glyphs glyphs;
  return glyphs;
}

const ImWchar* Glyphs::ranges() {
  static const ImWchar kRanges[] = {0x20,   0x24F,  0x370,  0x52F,  0x1E00, 0x1FFF, 0x2010,
                                    0x2044, 0x2070, 0x20BF, 0x2190, 0x21FF, 0x2200, 0x22FF,
                                    0x2300, 0x23FF, 0x25A0, 0x25FF, 0xFFFD, 0xFFFD, 0};
  return kRanges;
}

void Glyphs::add(ImWchar id, const std::string& text) {
  glyphs_[id].text = text;
  has_new_ = true;
}

/// What is still shown comes back with the next frame.
void Glyphs::forget() {
  glyphs_.clear();
  runs_.clear();
  shown_.clear();
}

void Glyphs::need(char32_t character) {
  if (character < 0x80 || character > 0xFFFF || (character >= kFirstRun && character <= kLastRun)) return;
  const auto id = static_cast<ImWchar>(character);
  for (const ImWchar* range = ranges(); *range; range += 2) {
    if (id >= range[0] && id <= range[1]) return;
  }
  if (glyphs_.count(id) != 0) return;
  if (glyphs_.size() >= kMaxGlyphs) forget();
  add(id, id < 0x800 ? std::string{static_cast<char>(0xC0 | id >> 6), static_cast<char>(0x80 | (id & 0x3F))}
                     : utf8Of(id));
}

void Glyphs::need(const std::string& text) {
  if (isAscii(text)) return;
  forCharacters(text, [this](std::size_t, std::size_t, char32_t c) { need(c); });
}

std::string Glyphs::drawable(const std::string& text) {
  if (isAscii(text)) return text;
  const auto known = shown_.find(text);
  if (known != shown_.end()) return known->second;
  forCharacters(text, [this](std::size_t, std::size_t, char32_t c) {
    if (!needsShaping(c)) need(c);
  });
  std::string result;
  std::size_t at = 0;
  for (const Run& run : runsOf(text)) {
    result += text.substr(at, run.begin - at) + utf8Of(idOf(text.substr(run.begin, run.end - run.begin)));
    at = run.end;
  }
  result += text.substr(at);
  if (shown_.size() >= kMaxGlyphs) shown_.clear();
  return shown_[text] = result;
}

ImWchar Glyphs::idOf(const std::string& run) {
  const auto known = runs_.find(run);
  if (known != runs_.end()) return known->second;
  if (glyphs_.size() >= kMaxGlyphs) forget();
  const auto id = static_cast<ImWchar>(kFirstRun + runs_.size());
  runs_[run] = id;
  add(id, run);
  return id;
}

void Glyphs::addTo(ImFontAtlas& atlas, ImFont* font, float size_px) {
  size_px_ = size_px;
  const render::Canvas measure({1, 1});
  const int below = static_cast<int>(std::ceil(0.4F * size_px));
  const int baseline = static_cast<int>(std::ceil(1.1F * size_px));
  const float ascent = std::floor(kAscent * size_px + 1);  // as Dear ImGui rounds it
  for (auto& [id, glyph] : glyphs_) {
    const auto width = static_cast<float>(measure.textBox(glyph.text, kEm * size_px).width);
    const int room_px = kAtlasWidth - 2;
    const int width_px = std::min(static_cast<int>(std::ceil(width)) + 2, room_px);
    glyph.rect = atlas.AddCustomRectFontGlyph(font, id, width_px, baseline + below, width,
                                              {-1, ascent - static_cast<float>(baseline)});
  }
  has_new_ = false;
}

void Glyphs::drawInto(ImFontAtlas& atlas) {
  unsigned char* pixels = nullptr;
  int atlas_width = 0, atlas_height = 0;
  atlas.GetTexDataAsAlpha8(&pixels, &atlas_width, &atlas_height);
  const double em = kEm * size_px_, baseline = std::ceil(1.1F * size_px_);
  for (const auto& [id, glyph] : glyphs_) {
    const ImFontAtlasCustomRect& rect = *atlas.GetCustomRectByIndex(glyph.rect);
    if (!rect.IsPacked()) continue;
    render::Canvas canvas({rect.Width, rect.Height});
    constexpr double kToBaseline = 0.36;  // of Canvas::text(), in sizes
    canvas.text(glyph.text, {1, baseline - kToBaseline * em}, em, {{1, 1, 1}});
    const render::Image8 image = canvas.pixels();
    for (int y = 0; y < rect.Height; ++y) {
      for (int x = 0; x < rect.Width; ++x)
        pixels[(rect.Y + y) * atlas_width + rect.X + x] = image.at(x, y)[3];
    }
  }
}

std::string drawable(const std::string& text) {
  return Glyphs::ofWindow().drawable(text);
}

}  // namespace emscape::view

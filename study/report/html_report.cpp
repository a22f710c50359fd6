#include "study/report/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "base/files/whole_file.h"
#include "base/text/xml_text.h"

namespace emscape::study {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 sans-serif; color: #21262d; max-width: 1100px; margin: 2em auto; padding: 0 1em; }
h1 { margin-bottom: 0; } h2 { margin-top: 2em; border-bottom: 1px solid #c9d1d9; }
.subtitle { color: #57606a; margin-top: 0; }
.summary, .warnings { border-left: 5px solid #0072b2; background: #f0f6fb; padding: 0.5em 1em; margin: 1em 0; }
.summary p { margin: 0.4em 0; font-size: 1.1em; }
.warnings { border-color: #d55e00; background: #fdf3ea; } .warnings p { margin: 0.2em 0; font-weight: bold; }
.warnings ul { margin: 0.2em 0; padding-left: 1.2em; }
table { border-collapse: collapse; margin: 1em 0; } caption { text-align: left; color: #57606a; }
thead th { background: #f3f5f8; border-bottom: 2px solid #c9d1d9; }
th, td { padding: 0.25em 0.8em; border-bottom: 1px solid #d8dee4; text-align: left; vertical-align: top; }
.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
figure { margin: 1.5em 0; } figure img { max-width: 100%; height: auto; }
figcaption { color: #57606a; }
@media print { h2 { break-after: avoid; } figure, table { break-inside: avoid; } }
)";

/// Base 64 of RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      group = group << 8 | (b < count ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    }
    for (std::size_t d = 0; d < 4; ++d) text += d <= count ? kDigits[group >> (18 - 6 * d) & 63U] : '=';
  }
  return text;
}

bool isNumber(const std::string& cell) {
  char* end = nullptr;
  std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == '\0';
}

/// True for columns that hold numbers: their heading and all their cells are aligned on the right.
std::vector<bool> numberColumns(const ReportTable& table) {
  std::vector<bool> columns(table.columns.size(), false);
  for (const std::vector<std::string>& row : table.rows) {
    for (std::size_t c = 0; c < std::min(row.size(), columns.size()); ++c)
      columns[c] = columns[c] || isNumber(row[c]);
  }
  return columns;
}

}  // namespace

HtmlReport::HtmlReport(const std::string& title, const std::string& subtitle)
    : title_(title), subtitle_(subtitle) {}

void HtmlReport::summary(const std::string& sentence) {
  summary_ += "<p>" + escapedXml(sentence) + "</p>\n";
}

void HtmlReport::warnings(const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  warnings_ += fmt::format("<p>⚠ {}</p>\n<ul>\n",
                           texts.size() == 1 ? "1 warning" : fmt::format("{} warnings", texts.size()));
  for (const std::string& text : texts) warnings_ += "<li>" + escapedXml(text) + "</li>\n";
  warnings_ += "</ul>\n";
}

void HtmlReport::section(const std::string& title) {
  sections_.push_back(title);
  body_ += fmt::format("<h2 id=\"section{}\">{}</h2>\n", sections_.size(), escapedXml(title));
}

void HtmlReport::paragraph(const std::string& text) {
  body_ += "<p>" + escapedXml(text) + "</p>\n";
}

void HtmlReport::folded(const std::string& title, const std::string& text) {
  body_ += fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", escapedXml(title),
                       escapedXml(text));
}

void HtmlReport::facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  body_ += "<table>\n";
  for (const auto& [name, value] : facts) {
    body_ += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escapedXml(name), escapedXml(value));
  }
  body_ += "</table>\n";
}

void HtmlReport::table(const ReportTable& table) {
  body_ += "<table>\n";
  if (!table.caption.empty()) body_ += "<caption>" + escapedXml(table.caption) + "</caption>\n";
  const std::vector<bool> is_number = numberColumns(table);
  const auto addRow = [&](const char* tag, const std::vector<std::string>& cells) {
    body_ += "<tr>";
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const char* const style = c < is_number.size() && is_number[c] ? " class=\"number\"" : "";
      body_ += fmt::format("<{0}{1}>{2}</{0}>", tag, style, escapedXml(cells[c]));
    }
    body_ += "</tr>\n";
  };
  body_ += "<thead>";
  addRow("th", table.columns);
  body_ += "</thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) addRow("td", row);
  body_ += "</tbody></table>\n";
}

void HtmlReport::picture(const render::Image8& image, const std::string& text) {
  body_ += fmt::format("<figure><img alt=\"{}\" width=\"{}\" src=\"data:image/png;base64,{}\"></figure>\n",
                       escapedXml(text), image.size.width, base64(render::encodePng(image)));
}

void HtmlReport::drawing(const std::string& svg, const std::string& caption) {
  // As a picture, because drawings of Cairo use the same names of parts, with a number that counts the
  // drawings of the process.
  static const std::string kName = "id=\"surface";
  std::string unnumbered = svg;
  for (std::size_t at = 0; (at = unnumbered.find(kName, at)) != std::string::npos; at += kName.size()) {
    const std::size_t number = at + kName.size(), end = unnumbered.find_first_not_of("0123456789", number);
    if (end != std::string::npos && end > number && unnumbered[end] == '"')
      unnumbered.erase(number, end - number);
  }
  body_ += fmt::format(
      "<figure><img alt=\"{0}\" "
      "src=\"data:image/svg+xml;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
      escapedXml(caption), base64(unnumbered));
}

std::string HtmlReport::html() const {
  std::string contents;
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    contents += fmt::format("<li><a href=\"#section{}\">{}</a></li>\n", s + 1, escapedXml(sections_[s]));
  }
  const auto box = [](const char* name, const std::string& inner) {
    return inner.empty() ? std::string() : fmt::format("<div class=\"{}\">\n{}</div>\n", name, inner);
  };
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
      "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n<p class=\"subtitle\">{2}</p>\n"
      "{3}{4}<ul>\n{5}</ul>\n{6}</body>\n</html>\n",
      escapedXml(title_), kStyle, escapedXml(subtitle_), box("summary", summary_), box("warnings", warnings_),
      contents, body_);
}

void HtmlReport::write(const std::filesystem::path& file) const {
  writeWhole(file, [&](std::ostream& out) { out << html(); });
}

}  // namespace emscape::study

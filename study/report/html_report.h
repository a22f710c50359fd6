/// A report as one self-contained HTML file: inline pictures, no scripts, no external resources.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "emscape/render/picture/image.h"

namespace emscape::study {

struct ReportTable {
  std::vector<std::string> columns;            ///< titles
  std::vector<std::vector<std::string>> rows;  ///< of as many cells as there are columns
  std::string caption;                         ///< may be empty
};

/// Collects the parts of a report in the order in which they are added. Texts are plain; characters that HTML
/// reserves are escaped.
class HtmlReport {
 public:
  /// @param subtitle  may be empty
  HtmlReport(const std::string& title, const std::string& subtitle);

  /// A sentence of the summary, which stands above all sections.
  void summary(const std::string& sentence);
  /// Messages that a reader must not miss, below the summary.
  void warnings(const std::vector<std::string>& texts);
  /// Begins a section. The table of contents at the top lists it.
  void section(const std::string& title);
  void paragraph(const std::string& text);
  /// A text in its own lines, which the reader unfolds.
  void folded(const std::string& title, const std::string& text);
  /// Names and their values: inputs, versions, areas.
  void facts(const std::vector<std::pair<std::string, std::string>>& facts);
  /// Adds a table. Cells with a number are right-aligned.
  void table(const ReportTable& table);
  /// @param text  the picture in words; not shown, since pictures have a title
  void picture(const render::Image8& image, const std::string& text);
  /// A drawing as an SVG document (Canvas::svg).
  void drawing(const std::string& svg, const std::string& caption);

  /// The report as HTML 5 in UTF-8.
  std::string html() const;
  /// @throws Error (other) naming the file
  void write(const std::filesystem::path& file) const;

 private:
  std::string title_, subtitle_, summary_, warnings_, body_;
  std::vector<std::string> sections_;
};

}  // namespace emscape::study

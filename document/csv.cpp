#include "document/csv.h"

#include <algorithm>
#include <fstream>

#include "document/text_file.h"

namespace emscape::document {

namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// The length of a quoted cell with its quotes. @param text  begins with a quote
/// @return npos if it is not a quoted cell, which ends before a separator or at the end of the line
std::size_t quotedLength(std::string_view text, char separator) {
  for (std::size_t end = text.find('"', 1); end != std::string_view::npos; end = text.find('"', end + 1)) {
    if (text.substr(end + 1, 1) == "\"") {
      ++end;
      continue;
    }
    const std::size_t next = text.find_first_not_of(kBlanks, end + 1);
    return next == std::string_view::npos || text[next] == separator ? end + 1 : std::string_view::npos;
  }
  return std::string_view::npos;
}

}  // namespace

void CsvReader::split(std::string_view line, std::vector<CsvCell>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t first = std::min(line.find_first_not_of(kBlanks, begin), line.size());
    std::size_t end = std::min(line.find(separator_, begin), line.size());
    const bool is_empty = first >= end;
    const std::size_t at = is_empty ? begin : first;
    std::string_view text = trimmed(line.substr(begin, end - begin));
    const std::size_t quoted = !is_empty && line[first] == '"' ? quotedLength(line.substr(first), separator_)
                                                               : std::string_view::npos;
    if (quoted != std::string_view::npos) {
      end = std::min(line.find(separator_, first + quoted), line.size());
      text = line.substr(first + 1, quoted - 2);
      if (text.find('"') != std::string_view::npos) {
        std::string& single = unquoted_.emplace_back();
        for (std::size_t i = 0; i < text.size(); i += text[i] == '"' ? 2 : 1) single += text[i];
        text = single;
      }
      text = trimmed(text);
    }
    cells.push_back({text, static_cast<int>(characterCount(line.substr(0, at))) + 1});
    begin = end + 1;
  }
}

bool CsvReader::next(CsvRow& row) {
  while (begin_ < text_.size()) {
    const std::size_t end = std::min(text_.find_first_of("\r\n", begin_), text_.size());
    const std::string_view line = text_.substr(begin_, end - begin_);
    begin_ = end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++line_;
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first == std::string_view::npos || line[first] == '#') continue;
    row.line = line_;
    split(line, row.cells);
    const bool is_empty = std::all_of(row.cells.begin(), row.cells.end(),
                                      [](const CsvCell& cell) { return cell.text.empty(); });
    if (!is_empty) return true;
  }
  return false;
}

char separatorOf(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    const auto count = [&](char separator) { return std::count(line.begin(), line.end(), separator); };
    const char other = count(';') >= count('\t') ? ';' : '\t';
    return count(other) > count(',') ? other : ',';
  }
  return ',';
}

std::optional<CsvFault> headerFault(const std::vector<CsvCell>& header) {
  const std::size_t separator = header.front().text.find_first_of(";\t");
  if (header.size() == 1 && separator != std::string_view::npos) {
    return CsvFault{header.front().column,
                    std::string("columns are separated by commas, not ") +
                        (header.front().text[separator] == ';' ? "semicolons" : "tabs") +
                        "; numbers have decimal points"};
  }
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i].text.empty())
      return CsvFault{header[i].column, "column " + std::to_string(i + 1) + " has no name"};
  }
  return std::nullopt;
}

std::vector<std::string> csvColumnsOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string begin(4096, '\0');
  stream.read(begin.data(), std::streamsize(begin.size()));
  begin.resize(std::size_t(stream.gcount()));
  if (begin.compare(0, 3, "\xEF\xBB\xBF") == 0) begin.erase(0, 3);
  CsvReader reader(begin);
  std::vector<std::string> names;
  CsvRow row;
  if (!reader.next(row)) return names;
  for (const CsvCell& cell : row.cells) names.emplace_back(cell.text);
  return names;
}

}  // namespace emscape::document

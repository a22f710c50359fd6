#include "document/csv.h"

#include <algorithm>

#include "document/text_file.h"

namespace emscape::document {

namespace {

constexpr std::string_view kBlanks = " \t";

void split(std::string_view line, std::vector<CsvCell>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view cell = line.substr(begin, end - begin);
    const std::size_t first = cell.find_first_not_of(kBlanks);
    const bool is_empty = first == std::string_view::npos;
    const std::size_t at = begin + (is_empty ? 0 : first);
    cells.push_back(
        {is_empty ? std::string_view() : cell.substr(first, cell.find_last_not_of(kBlanks) - first + 1),
         static_cast<int>(characterCount(line.substr(0, at))) + 1});
    begin = end + 1;
  }
}

}  // namespace

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
    return true;
  }
  return false;
}

}  // namespace emscape::document

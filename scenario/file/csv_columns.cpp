#include "scenario/file/csv_columns.h"

#include <fstream>

#include "document/csv.h"

namespace emscape::scenario {

std::vector<std::string> csvColumnsOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string begin(4096, '\0');
  stream.read(begin.data(), std::streamsize(begin.size()));
  begin.resize(std::size_t(stream.gcount()));
  if (begin.compare(0, 3, "\xEF\xBB\xBF") == 0) begin.erase(0, 3);
  document::CsvReader reader(begin);
  std::vector<std::string> names;
  document::CsvRow row;
  if (!reader.next(row)) return names;
  for (const document::CsvCell& cell : row.cells) names.emplace_back(cell.text);
  return names;
}

}  // namespace emscape::scenario

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "recording/common/tally.h"
#include "recording/dis/big_endian.h"
#include "recording/dis/datagrams.h"
#include "recording/dis/pdu.h"

namespace emscape::interop::dis {
namespace {

/// @return false if the text is not numbers of one or two hexadecimal digits
bool readHex(std::string_view text, std::vector<std::uint8_t>& bytes) {
  bytes.clear();
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ' || text[at] == '\t') {
      ++at;
      continue;
    }
    std::uint8_t byte = 0;
    const char* const begin = text.data() + at;
    const auto [end, fault] = std::from_chars(begin, text.data() + text.size(), byte, 16);
    const auto digits = static_cast<std::size_t>(end - begin);
    const bool ends = at + digits == text.size() || text[at + digits] == ' ' || text[at + digits] == '\t';
    if (fault != std::errc() || !ends) return false;
    bytes.push_back(byte);
    at += digits;
  }
  return true;
}

}  // namespace

void readHexLog(ByteSource& source, ReadingTally& tally, const DatagramSink& sink) {
  LineReader lines(source);
  std::vector<std::uint8_t> bytes;
  double time_s = 0;
  bool has_time = false;
  for (std::string_view line; lines.next(line);) {
    if (line.empty()) continue;
    const bool is_cut = !lines.isTerminated();
    if (!has_time) {
      double value = 0;
      const auto [end, fault] = std::from_chars(line.data(), line.data() + line.size(), value);
      if (fault != std::errc() || end != line.data() + line.size() || !std::isfinite(value)) {
        countBad(tally, fmt::format("line {}", lines.line()), "a time in seconds was expected");
        continue;
      }
      time_s = value;
      has_time = true;
      continue;
    }
    if (!readHex(line, bytes)) {
      countBad(tally, fmt::format("line {}", lines.line()), "bytes in hexadecimal were expected");
    } else if (const auto header = decodeHeader(bytes.data(), bytes.size());
               is_cut && !header) {  // a whole PDU at the end may lack its line end
      tally.torn = fmt::format("line {}: within a PDU", lines.line());
    } else {
      sink({time_s, bytes.data(), bytes.size()});
    }
    has_time = false;
  }
  if (has_time) tally.torn = fmt::format("line {}: a time without its PDU", lines.line());
}

void readSession(ByteSource& source, ReadingTally& tally, const DatagramSink& sink) {
  RecordReader reader(source);
  std::vector<std::uint8_t> bytes;
  for (;;) {
    const std::uint64_t at = reader.offset();
    if (!reader.read(10, bytes)) {
      if (!bytes.empty()) tally.torn = fmt::format("byte {}: within the header of a record", at);
      return;
    }
    BigEndianReader head(bytes.data(), bytes.size());
    const auto time_ms = static_cast<std::int64_t>(head.u64());
    const std::size_t size = head.u16();
    if (size > kMaxPduBytes) {
      tally.torn =
          fmt::format("byte {}: a record of {} bytes, more than the allowed {}", at, size, kMaxPduBytes);
      return;
    }
    if (!reader.read(size, bytes)) {
      tally.torn = fmt::format("byte {}: within a PDU", at);
      return;
    }
    sink({static_cast<double>(time_ms) / 1000, bytes.data(), bytes.size()});
  }
}

}  // namespace emscape::interop::dis

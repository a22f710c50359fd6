#include "volume/vtk/vtk_xml.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>

#include "base/files/file_reading.h"
#include "emscape/base/work.h"

namespace emscape::volume {
namespace {

constexpr std::string_view kEnd = "</VTKFile>";
constexpr std::string_view kBlanks = " \t\r\n";
/// Blanks and line ends that may follow the end.
constexpr std::size_t kTail = 64;
/// Limit of a text in binary form: more than the description of any volume.
constexpr std::uint64_t kMaxTextBytes = 1 << 20;

/// Value of a base64 digit, -1 for other characters.
int digitOf(std::uint8_t character) {
  if (character >= 'A' && character <= 'Z') return character - 'A';
  if (character >= 'a' && character <= 'z') return character - 'a' + 26;
  if (character >= '0' && character <= '9') return character - '0' + 52;
  if (character == '+') return 62;
  if (character == '/') return 63;
  return -1;
}

/// Decodes up to the first character that is not a digit. VTK encodes a header and the data after it
/// separately, so that padding may occur in the middle; it ends a group of four.
/// @param max_bytes  stops after this number of bytes
std::vector<std::uint8_t> fromBase64(const std::uint8_t* begin, const std::uint8_t* end,
                                     std::uint64_t max_bytes) {
  std::vector<std::uint8_t> bytes;
  const auto* at = std::find_if(begin, end, [](std::uint8_t character) { return digitOf(character) >= 0; });
  for (; end - at >= 4 && bytes.size() < max_bytes; at += 4) {
    std::uint32_t group = 0;
    int digits = 0;
    while (digits < 4 && digitOf(at[digits]) >= 0)
      group = group << 6 | static_cast<std::uint32_t>(digitOf(at[digits++]));
    if (digits < 2) break;
    group <<= 6 * (4 - digits);
    for (int i = 0; i < digits - 1; ++i) bytes.push_back(static_cast<std::uint8_t>(group >> (16 - 8 * i)));
  }
  return bytes;
}

/// Copies numbers out of a file's bytes.
template <class Stored, class To>
std::vector<To> copied(const std::vector<std::uint8_t>& bytes, bool big_endian) {
  std::vector<To> numbers(bytes.size() / sizeof(Stored));
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    std::uint8_t digits[sizeof(Stored)];
    std::memcpy(digits, bytes.data() + n * sizeof(Stored), sizeof(Stored));
    if (big_endian) std::reverse(digits, digits + sizeof(Stored));
    Stored number;
    std::memcpy(&number, digits, sizeof(Stored));
    numbers[n] = static_cast<To>(number);
  }
  return numbers;
}

}  // namespace

VtkXmlFile::VtkXmlFile(const std::filesystem::path& path, const char* type)
    : file_(path.string()), type_(type), bytes_(readWhole(path)) {
  const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  if (text.find("<VTKFile") == std::string_view::npos) fail("no VTK XML file");
  if (text.substr(text.size() - std::min(text.size(), kTail)).find(kEnd) == std::string_view::npos) {
    fail("truncated: it does not end in " + std::string(kEnd));
  }
  std::string head;
  const std::size_t section = text.find("<AppendedData");
  if (section == std::string_view::npos) {
    head = text;
  } else {
    const std::size_t tag_end = text.find('>', section);
    const std::size_t underscore = text.find('_', tag_end);
    if (underscore == std::string_view::npos) fail("damaged: the appended data have no beginning");
    appended_ = underscore + 1;
    head = std::string(text.substr(0, tag_end + 1)) + "</AppendedData>" + std::string(kEnd);
  }
  const pugi::xml_parse_result result = document_.load_buffer(head.data(), head.size());
  if (!result) {
    const auto line =
        1 +
        std::count(head.begin(), head.begin() + std::min<std::ptrdiff_t>(result.offset, head.size()), '\n');
    throw Error(ErrorCode::bad_input, {file_, static_cast<int>(line)},
                std::string("XML: ") + result.description());
  }
  root_ = document_.child("VTKFile");
  const std::string found = root_.attribute("type").value();
  if (found != type_) fail("VTK file of type \"" + found + "\" where " + type_ + " is needed");
}

bool VtkXmlFile::bigEndian() const {
  return std::string_view(root_.attribute("byte_order").value()) == "BigEndian";
}

void VtkXmlFile::fail(const std::string& what) const {
  throw Error(ErrorCode::bad_input, {file_}, what);
}

std::uint64_t VtkXmlFile::headerValue(ByteReader& reader) const {
  const bool wide = std::string_view(root_.attribute("header_type").value()) == "UInt64";
  std::uint8_t digits[8] = {};
  const int count = wide ? 8 : 4;
  std::memcpy(digits, reader.take(static_cast<std::uint64_t>(count), "size of an array"),
              static_cast<std::size_t>(count));
  if (bigEndian()) std::reverse(digits, digits + count);
  std::uint64_t value;
  std::memcpy(&value, digits, sizeof(value));
  return value;
}

/// Blocks of zlib: their number, the size of each and of the last before compression (0: full as well), the
/// compressed sizes, then the blocks.
std::vector<std::uint8_t> VtkXmlFile::inflate(ByteReader& reader, std::uint64_t min_bytes,
                                              std::uint64_t max_bytes) const {
  const std::uint64_t blocks = headerValue(reader);
  const std::uint64_t block_bytes = headerValue(reader);
  const std::uint64_t last_bytes = headerValue(reader);
  if (blocks > reader.left()) reader.fail(std::to_string(blocks) + " compressed blocks");
  std::vector<std::uint64_t> stored;
  for (std::uint64_t i = 0; i < blocks; ++i) stored.push_back(headerValue(reader));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(min_bytes);
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const std::uint64_t wanted = i + 1 == blocks && last_bytes > 0 ? last_bytes : block_bytes;
    const std::uint64_t done = bytes.size();
    checkpoint();
    if (wanted > max_bytes - done) reader.fail("compressed blocks hold more than the array");
    bytes.resize(done + wanted);
    uLongf got = static_cast<uLongf>(wanted);
    const std::uint8_t* block = reader.take(stored[i], "compressed block");
    if (uncompress(bytes.data() + done, &got, block, static_cast<uLong>(stored[i])) != Z_OK ||
        got != wanted) {
      reader.fail("a compressed block cannot be decompressed");
    }
  }
  if (bytes.size() < min_bytes) reader.fail("compressed blocks hold less than the array");
  return bytes;
}

/// The bytes of an array in the file, decoded from base64.
std::string arrayName(const pugi::xml_node& array) {
  const pugi::xml_attribute name = array.attribute("Name");
  return name ? name.value() : std::string("of ") + array.parent().name();
}

std::vector<std::uint8_t> VtkXmlFile::storedBytes(const pugi::xml_node& array,
                                                  std::uint64_t max_bytes) const {
  const std::string_view format = array.attribute("format").value();
  if (format == "binary") {
    const std::string_view text = array.child_value();
    const auto* begin = reinterpret_cast<const std::uint8_t*>(text.data());
    return fromBase64(begin, begin + text.size(), max_bytes);
  }
  if (format != "appended") {
    fail("array " + arrayName(array) + " is stored as \"" + std::string(format) +
         "\"; appended, binary and ascii can be read");
  }
  if (appended_ == 0) fail("damaged: there are no appended data");
  const std::uint64_t offset = array.attribute("offset").as_ullong();
  if (offset > bytes_.size() - appended_)
    fail("truncated or damaged: an array begins at offset " + std::to_string(offset));
  const std::uint8_t* begin = bytes_.data() + appended_ + offset;
  const std::uint8_t* end = bytes_.data() + bytes_.size();
  const std::string_view encoding = root_.child("AppendedData").attribute("encoding").value();
  if (encoding == "base64") return fromBase64(begin, end, max_bytes);
  if (encoding != "raw")
    fail("appended data in encoding \"" + std::string(encoding) + "\"; raw and base64 can be read");
  return {begin, begin + std::min<std::uint64_t>(max_bytes, static_cast<std::uint64_t>(end - begin))};
}

/// `count` numbers as text, separated by blanks, as a binary array contains them.
template <class Number>
std::vector<std::uint8_t> VtkXmlFile::spelledNumbers(const pugi::xml_node& array, std::uint64_t count) const {
  using Parsed = std::conditional_t<std::is_floating_point_v<Number>, double, Number>;
  const std::string name = arrayName(array), type = array.attribute("type").value();
  const std::string_view text = array.child_value();
  std::vector<std::uint8_t> bytes;
  bytes.reserve(std::min<std::uint64_t>(count, text.size()) * sizeof(Number));
  std::uint64_t found = 0;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos; ++found) {
    if (found == count) fail("array " + name + ": more than " + std::to_string(count) + " values");
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    const char* const last = text.data() + end;
    Parsed value{};
    const auto result = std::from_chars(text.data() + at, last, value);
    bool is_number = result.ec == std::errc() && result.ptr == last;
    if constexpr (std::is_same_v<Number, float>) {
      is_number = is_number && !(std::isfinite(value) && std::abs(value) > std::numeric_limits<float>::max());
    }
    if (!is_number) {
      fail("array " + name + ": value " + std::to_string(found) + ": \"" +
           std::string(text.substr(at, std::min<std::size_t>(end - at, 40))) +
           "\": must be a number of type " + type);
    }
    const auto number = static_cast<Number>(value);
    std::uint8_t digits[sizeof(Number)];
    std::memcpy(digits, &number, sizeof(Number));
    if (bigEndian()) std::reverse(digits, digits + sizeof(Number));
    bytes.insert(bytes.end(), digits, digits + sizeof(Number));
    at = text.find_first_not_of(kBlanks, end);
  }
  if (found != count) {
    fail("array " + name + ": expected " + std::to_string(count) + " values, found " + std::to_string(found));
  }
  return bytes;
}

std::vector<std::uint8_t> VtkXmlFile::textBytes(const pugi::xml_node& array,
                                                std::uint64_t expected_bytes) const {
  const std::string_view type = array.attribute("type").value();
  if (type == "Int8") return spelledNumbers<std::int8_t>(array, expected_bytes);
  if (type == "UInt8") return spelledNumbers<std::uint8_t>(array, expected_bytes);
  if (type == "Int16") return spelledNumbers<std::int16_t>(array, expected_bytes / 2);
  if (type == "UInt16") return spelledNumbers<std::uint16_t>(array, expected_bytes / 2);
  if (type == "Int32") return spelledNumbers<std::int32_t>(array, expected_bytes / 4);
  if (type == "UInt32") return spelledNumbers<std::uint32_t>(array, expected_bytes / 4);
  if (type == "Int64") return spelledNumbers<std::int64_t>(array, expected_bytes / 8);
  if (type == "UInt64") return spelledNumbers<std::uint64_t>(array, expected_bytes / 8);
  if (type == "Float32") return spelledNumbers<float>(array, expected_bytes / 4);
  return spelledNumbers<double>(array, expected_bytes / 8);
}

std::vector<std::uint8_t> VtkXmlFile::arrayBytes(const pugi::xml_node& array,
                                                 std::uint64_t expected_bytes) const {
  if (std::string_view(array.attribute("format").value()) == "ascii") return textBytes(array, expected_bytes);
  return binaryBytes(array, expected_bytes, expected_bytes);
}

/// The bytes of an array that is not in text form.
std::vector<std::uint8_t> VtkXmlFile::binaryBytes(const pugi::xml_node& array, std::uint64_t min_bytes,
                                                  std::uint64_t max_bytes) const {
  const std::string compressor = root_.attribute("compressor").value();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    fail("compressed with " + compressor + "; vtkZLibDataCompressor can be read");
  }
  // zlib compresses by a factor of about 1000 at most, so that the file cannot contain more.
  if (min_bytes / 1100 > bytes_.size()) {
    fail("truncated: an array of " + std::to_string(min_bytes) + " bytes in a file of " +
         std::to_string(bytes_.size()));
  }
  // Compression and its tables cannot make an array much longer.
  const std::vector<std::uint8_t> stored = storedBytes(array, max_bytes + max_bytes / 8 + (1 << 16));
  ByteReader reader(file_, stored.data(), stored.size());
  if (!compressor.empty()) return inflate(reader, min_bytes, max_bytes);
  const std::uint64_t bytes = headerValue(reader);
  if (bytes < min_bytes || bytes > max_bytes) {
    fail("array " + arrayName(array) + ": expected " + (min_bytes < max_bytes ? "at most " : "") +
         std::to_string(max_bytes) + " bytes, found " + std::to_string(bytes));
  }
  const std::uint8_t* begin = reader.take(bytes, "array");
  return {begin, begin + bytes};
}

template <class To>
std::vector<To> VtkXmlFile::numbers(const pugi::xml_node& array, std::uint64_t count) const {
  const std::string type = array.attribute("type").value();
  const bool big = bigEndian();
  const auto bytes = [&](std::uint64_t size) { return arrayBytes(array, count * size); };
  if (type == "Int64") return copied<std::int64_t, To>(bytes(8), big);
  if (type == "UInt64") return copied<std::uint64_t, To>(bytes(8), big);
  if (type == "Int32") return copied<std::int32_t, To>(bytes(4), big);
  if (type == "UInt32") return copied<std::uint32_t, To>(bytes(4), big);
  if (type == "Int16") return copied<std::int16_t, To>(bytes(2), big);
  if (type == "UInt16") return copied<std::uint16_t, To>(bytes(2), big);
  if (type == "Int8") return copied<std::int8_t, To>(bytes(1), big);
  if (type == "UInt8") return copied<std::uint8_t, To>(bytes(1), big);
  if constexpr (std::is_floating_point_v<To>) {
    if (type == "Float32") return copied<float, To>(bytes(4), big);
    if (type == "Float64") return copied<double, To>(bytes(8), big);
  }
  fail("array " + arrayName(array) + " is of type \"" + type + "\", which cannot be read here");
}
template std::vector<double> VtkXmlFile::numbers(const pugi::xml_node&, std::uint64_t) const;
template std::vector<std::int64_t> VtkXmlFile::numbers(const pugi::xml_node&, std::uint64_t) const;

pugi::xml_node VtkXmlFile::fieldArray(const std::string& name) const {
  for (const pugi::xml_node& array : root_.child(type_.c_str()).child("FieldData").children()) {
    if (name == array.attribute("Name").value()) return array;
  }
  return {};
}

std::string VtkXmlFile::storedFieldText(const std::string& name) const {
  const pugi::xml_node array = fieldArray(name);
  return std::string_view(array.attribute("format").value()) == "ascii" ? array.child_value() : "";
}

std::string VtkXmlFile::fieldText(const std::string& name) const {
  const pugi::xml_node array = fieldArray(name);
  if (std::string_view(array.attribute("format").value()) == "ascii") return spelledText(array.child_value());
  const std::string_view type = array.attribute("type").value();
  if (type != "String" && type != "UInt8") return "";
  const std::vector<std::uint8_t> bytes = binaryBytes(array, 0, kMaxTextBytes);
  return {bytes.begin(), std::find(bytes.begin(), bytes.end(), 0)};
}

std::optional<double> VtkXmlFile::timeValue() const {
  const pugi::xml_node array = fieldArray("TimeValue");
  std::optional<double> time_s;
  if (std::string_view(array.attribute("format").value()) == "ascii") {
    time_s = leadingNumber(array.child_value());
  } else if (std::string_view(array.attribute("NumberOfTuples").value()) == "1") {
    time_s = numbers<double>(array, 1).front();
  }
  return time_s && std::isfinite(*time_s) ? time_s : std::nullopt;
}

std::uint64_t VtkXmlFile::headOffsetOf(const std::string& text) const {
  const std::string_view whole(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  const std::size_t offset = whole.substr(0, appended_ == 0 ? whole.size() : appended_).find(text);
  if (offset == std::string_view::npos) fail("a text of the head is written in another way");
  return offset;
}

namespace {

/// A number that is too large or too small for a double: infinite or 0, with its sign.
double beyondDoubles(const std::string& number) {
  std::istringstream text(number);
  text.imbue(std::locale::classic());
  double nearest = 0;
  text >> nearest;
  return text ? nearest : std::copysign(HUGE_VAL, nearest);
}

}  // namespace

std::optional<double> leadingNumber(std::string_view text, std::string_view* rest) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  const bool has_plus = text.substr(begin, 1) == "+" && text.substr(begin + 1, 1) != "-";
  const char* const first = text.data() + begin + (has_plus ? 1 : 0);
  double value = 0;
  const auto result = std::from_chars(first, text.data() + text.size(), value);
  if (result.ec == std::errc::invalid_argument) return std::nullopt;
  if (rest != nullptr) *rest = text.substr(static_cast<std::size_t>(result.ptr - text.data()));
  return result.ec == std::errc::result_out_of_range ? beyondDoubles({first, result.ptr}) : value;
}

std::string spelledText(const std::string& numbers_text) {
  std::istringstream text(numbers_text);
  std::string spelled;
  for (int character = 0; text >> character && character > 0 && character < 256;) {
    spelled += static_cast<char>(character);
  }
  return spelled;
}

}  // namespace emscape::volume

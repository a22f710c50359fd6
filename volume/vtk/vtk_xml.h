/// The XML files of VTK: their head as a document, their arrays as bytes. Internal to the module.
#pragma once

#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "volume/byte_reader.h"

namespace emscape::volume {

constexpr std::uint8_t kVtkTetrahedron = 10;  ///< type of a cell

class VtkXmlFile {
 public:
  /// @throws Error (bad_input) for a file that is not VTK XML of the type (such as ImageData), or is not
  /// complete
  VtkXmlFile(const std::filesystem::path& path, const char* type);

  /// The element VTKFile.
  pugi::xml_node root() const { return root_; }
  bool bigEndian() const;

  /// The bytes of a DataArray of numbers, decoded and decompressed; for numbers as text, the bytes of the
  /// equivalent binary array.
  /// @param expected_bytes  any other number is an Error, before anything is allocated for it
  std::vector<std::uint8_t> arrayBytes(const pugi::xml_node& array, std::uint64_t expected_bytes) const;

  /// The numbers of a DataArray of any type, converted. @tparam To  double or std::int64_t
  /// @throws Error (bad_input) unless there are `count` numbers, of a type that `To` can hold
  template <class To>
  std::vector<To> numbers(const pugi::xml_node& array, std::uint64_t count) const;

  /// The first text of an array of texts in the field data, in any form; empty if there is none.
  std::string fieldText(const std::string& name) const;
  /// The same as the file has it, in character codes; empty unless the array is in text form.
  std::string storedFieldText(const std::string& name) const;
  /// The number of the field data's array TimeValue; none if there is none, or it is not finite.
  std::optional<double> timeValue() const;
  /// Position of a text of the head in the file. @throws Error (bad_input) unless it is there
  std::uint64_t headOffsetOf(const std::string& text) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  pugi::xml_node fieldArray(const std::string& name) const;
  std::vector<std::uint8_t> binaryBytes(const pugi::xml_node& array, std::uint64_t min_bytes,
                                        std::uint64_t max_bytes) const;
  std::vector<std::uint8_t> storedBytes(const pugi::xml_node& array, std::uint64_t max_bytes) const;
  template <class Number>
  std::vector<std::uint8_t> spelledNumbers(const pugi::xml_node& array, std::uint64_t count) const;
  std::vector<std::uint8_t> textBytes(const pugi::xml_node& array, std::uint64_t expected_bytes) const;
  std::uint64_t headerValue(ByteReader& reader) const;
  std::vector<std::uint8_t> inflate(ByteReader& reader, std::uint64_t min_bytes,
                                    std::uint64_t max_bytes) const;

  std::string file_;
  std::string type_;
  std::vector<std::uint8_t> bytes_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::uint64_t appended_ = 0;  ///< offset of the appended data, after the underscore; 0 if there are none
};

/// Name of a DataArray in errors: its Name; if it has none, its parent, such as `of Points`.
std::string arrayName(const pugi::xml_node& array);

/// The number at the beginning of a text, after blanks; none if there is none. Beyond the doubles it is
/// infinite or 0.
/// @param rest  receives the text after the number
std::optional<double> leadingNumber(std::string_view text, std::string_view* rest = nullptr);

/// The text of an array of character codes, up to its zero.
std::string spelledText(const std::string& numbers_text);

}  // namespace emscape::volume

/// Values of an object of a document, according to the table of the format.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/schema.h"

namespace emscape::document {

/// One object of the file. A value that is not given has the table's default. Without a default, or if the
/// value is faulty (which checkObject() reports), numbers are NaN, so that later checks report nothing, whole
/// numbers are 0, and texts and lists are empty. A key that is not in the table is a programming error
/// (std::logic_error). Valid as long as the document, the table and `file`.
class Section {
 public:
  /// @param node  null for a missing object: all values have their defaults
  Section(const std::string& file, const DocumentNode* node, const ObjectSpec& spec);

  /// True if the key is given, with a value of the right type.
  bool has(const std::string& key) const;
  /// True if the object is given and checkObject() finds no fault in it.
  bool sound() const;

  double number(const std::string& key) const;
  std::optional<double> optionalNumber(const std::string& key) const;
  int integer(const std::string& key) const;
  std::optional<bool> optionalBoolean(const std::string& key) const;
  std::string text(const std::string& key) const;  ///< text, timestamp, file
  /// Index of a choice in the table's order; 0 if it is faulty.
  int choiceIndex(const std::string& key) const;
  /// The value of a choice whose order in the table is that of the enumeration.
  template <class Enum>
  Enum choice(const std::string& key) const {
    return static_cast<Enum>(choiceIndex(key));
  }

  /// The keys of an object, or those that replace a number; node() is null if a number is given.
  Section section(const std::string& key) const;
  /// List of objects; of a list of files with keys instead, also the files: their node() is a scalar.
  std::vector<Section> sections(const std::string& key) const;
  std::vector<double> numbers(const std::string& key) const;  ///< list of numbers; shorter if faulty
  std::vector<std::string> texts(const std::string& key) const;
  std::vector<std::vector<double>> numberLists(const std::string& key) const;

  /// The object itself; null if it is not given.
  const DocumentNode* node() const { return node_; }
  /// Location of the object.
  SourceLocation location() const;
  /// Location of the key's value; that of the object if the key is not given.
  SourceLocation locationOf(const std::string& key) const;
  /// Location of an item of the key's list.
  SourceLocation locationOf(const std::string& key, std::size_t item) const;

 private:
  const KeySpec& row(const std::string& key) const;
  const DocumentNode* find(const std::string& key) const;
  SourceLocation locationAt(const TextPosition& position) const {
    return {*file_, position.line, position.column};
  }

  const std::string* file_;
  const DocumentNode* node_;
  const ObjectSpec* spec_;
  std::string variant_;  ///< the discriminator's value; empty: none or faulty
};

}  // namespace emscape::document

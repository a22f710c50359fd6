/// Values of an object of a document, read by the table of the format.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/schema.h"

namespace emscape::document {

/// One object of the file. Reading a value that is not given returns the table's default. If there is none,
/// or if the value is faulty (checkObject() has reported it), numbers are NaN, so that later checks stay
/// silent, whole numbers 0, and texts and lists empty. Asking for a key that the table does not have is a
/// programming error (std::logic_error). Valid as long as the document, the table and `file` are.
class Section {
 public:
  /// @param node  null for an object that is not there: everything has its default
  Section(const std::string& file, const DocumentNode* node, const ObjectSpec& spec);

  /// True if the key is given, with a value of the right type.
  bool has(const std::string& key) const;
  /// True if the object is given and checkObject() finds nothing wrong in it.
  bool sound() const;

  double number(const std::string& key) const;
  std::optional<double> optionalNumber(const std::string& key) const;
  int integer(const std::string& key) const;
  std::optional<bool> optionalBoolean(const std::string& key) const;
  std::string text(const std::string& key) const;  ///< text, timestamp, file
  /// Index of a choice in the table's order; 0 if it is faulty.
  int choiceIndex(const std::string& key) const;
  /// The value of a choice whose order in the table is the enumeration's.
  template <class Enum>
  Enum choice(const std::string& key) const {
    return static_cast<Enum>(choiceIndex(key));
  }

  /// The keys of an object, or those in place of a number: node() is null where the number is given.
  Section section(const std::string& key) const;
  std::vector<Section> sections(const std::string& key) const;  ///< list of objects
  std::vector<double> numbers(
      const std::string& key) const;  ///< list of numbers; shorter than it should be if faulty
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

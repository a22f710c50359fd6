#include "document/number_edit.h"

#include <string_view>

#include "document/text_file.h"

namespace emscape::document {

namespace {

/// True for a plain scalar of digits, signs, points and exponents: nothing that precedes or follows it in
/// YAML or JSON gives it another meaning.
bool isPlainNumber(const DocumentNode& node) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  if (node.kind != NodeKind::scalar || node.quoted || node.anchored) return false;
  const std::size_t sign = node.text.find_first_not_of("+-") == 1 ? 1 : 0;
  return sign < node.text.size() && isDigit(node.text[sign]) &&
         node.text.find_first_not_of("0123456789+-.eE") == std::string::npos;
}

/// Copies a document with one scalar replaced by another on the same line.
class ScalarReplacement {
 public:
  ScalarReplacement(const std::string& text, const DocumentNode& old, const DocumentNode& value,
                    const Splice& splice)
      : old_(old),
        value_(value),
        bytes_(static_cast<std::ptrdiff_t>(splice.text.size()) -
               static_cast<std::ptrdiff_t>(splice.end - splice.begin)),
        columns_(static_cast<int>(characterCount(splice.text)) -
                 static_cast<int>(characterCount(
                     std::string_view(text).substr(splice.begin, splice.end - splice.begin)))) {}

  /// @return null if a value may have aliases
  DocumentNodePtr operator()(const DocumentNode& node) const {
    if (node.anchored) return nullptr;
    auto copy = std::make_shared<DocumentNode>(&node == &old_ ? value_ : node);
    copy->position = moved(node.position);
    for (DocumentNodePtr& item : copy->items) {
      if (!(item = (*this)(*item))) return nullptr;
    }
    for (MapEntry& entry : copy->entries) {
      entry.position = moved(entry.position);
      if (!(entry.value = (*this)(*entry.value))) return nullptr;
    }
    return copy;
  }

 private:
  TextPosition moved(TextPosition position) const {
    if (position.offset <= old_.position.offset) return position;
    position.offset = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(position.offset) + bytes_);
    if (position.line == old_.position.line) position.column += columns_;
    return position;
  }

  const DocumentNode &old_, &value_;
  const std::ptrdiff_t bytes_;
  const int columns_;
};

}  // namespace

DocumentNodePtr withNumberSpliced(const std::string& text, const DocumentNodePtr& root, const NodePath& path,
                                  const DocumentNodePtr& value, const Splice& splice) {
  const DocumentNodePtr old = valueAt(root, path);
  const bool is_in_place = old && old->kind == NodeKind::scalar && old->position.offset == splice.begin &&
                           splice.begin < splice.end && text.find('\n', splice.begin) >= splice.end;
  if (!is_in_place || !value || !isPlainNumber(*value) || splice.text != value->text) return nullptr;
  return ScalarReplacement(text, *old, *value, splice)(*root);
}

}  // namespace emscape::document

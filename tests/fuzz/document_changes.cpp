#include "tests/fuzz/document_changes.h"

#include <iterator>
#include <set>

namespace emscape::test {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;
using document::NodeKind;

constexpr std::size_t kMaxBytes = 1 << 16, kMaxPaths = 5000;
constexpr const char* kScalars[] = {"-1", "0", "1", "2147483648", "1e300", ".nan", "x", "true"};
/// Besides a scalar: nothing, null, empty text, [], {}, [value], {x: value}.
constexpr std::size_t kForms = 7;
/// Other values of the document that take its place.
constexpr std::size_t kOthers = 3;
constexpr std::size_t kKinds = std::size(kScalars) + kForms + kOthers;

DocumentNodePtr scalar(const std::string& text, bool quoted) {
  auto node = std::make_shared<DocumentNode>();
  node->kind = NodeKind::scalar;
  node->text = text;
  node->quoted = quoted;
  return node;
}

/// @param value  null: none
DocumentNodePtr collection(NodeKind kind, const DocumentNodePtr& value) {
  auto node = std::make_shared<DocumentNode>();
  node->kind = kind;
  if (value != nullptr && kind == NodeKind::sequence) node->items.push_back(value);
  if (value != nullptr && kind == NodeKind::map) node->entries.push_back({"x", {}, value});
  return node;
}

/// @return null: the value is left out
DocumentNodePtr formed(std::size_t form, const DocumentNodePtr& value) {
  switch (form) {
    case 0:
      return nullptr;
    case 1:
      return std::make_shared<DocumentNode>();
    case 2:
      return scalar("", true);
    case 3:
    case 4:
      return collection(form == 3 ? NodeKind::sequence : NodeKind::map, nullptr);
    default:
      return collection(form == 5 ? NodeKind::sequence : NodeKind::map, value);
  }
}

}  // namespace

DocumentChanges::DocumentChanges(const std::string& text) {
  if (text.size() > kMaxBytes) return;
  document::ProblemList problems;
  root_ = document::readDocument("", text, problems);
  if (root_ == nullptr || problems.hasErrors()) return;
  is_json_ = text.find_first_not_of(" \r\n\t") == text.find_first_of("{[");
  addPaths(*root_, {});
  if (paths_.size() > kMaxPaths) paths_.clear();
}

void DocumentChanges::addPaths(const DocumentNode& node, document::NodePath path) {
  if (!path.empty()) paths_.push_back(path);
  if (paths_.size() > kMaxPaths) return;
  path.emplace_back();
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    path.back() = i;
    addPaths(*node.items[i], path);
  }
  std::set<std::string> keys;
  for (const document::MapEntry& entry : node.entries) {
    if (!keys.insert(entry.key).second) continue;  // a path leads to the first
    path.back() = entry.key;
    addPaths(*entry.value, path);
  }
}

std::size_t DocumentChanges::count() const {
  return paths_.size() * kKinds;
}

std::string DocumentChanges::changed(std::size_t change) const {
  const std::size_t place = change / kKinds;
  std::size_t kind = change % kKinds;
  const DocumentNodePtr value = document::valueAt(root_, paths_[place]);
  DocumentNodePtr replacement;
  if (kind < kForms) {
    replacement = formed(kind, value);
  } else if ((kind -= kForms) < std::size(kScalars)) {
    replacement = scalar(kScalars[kind], false);
  } else {
    kind -= std::size(kScalars);
    constexpr std::size_t kPrime = 7919;
    replacement = document::valueAt(root_, paths_[(place + (kind + 1) * kPrime) % paths_.size()]);
  }
  return document::flowText(*document::withValueAt(root_, paths_[place], replacement), is_json_);
}

}  // namespace emscape::test

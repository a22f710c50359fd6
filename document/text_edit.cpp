#include "document/text_edit.h"

#include <algorithm>

#include "document/node_span.h"
#include "emscape/base/error.h"

namespace emscape::document {

namespace {

using std::string_view;

DocumentNodePtr childOf(const DocumentNode& node, const PathStep& step) {
  if (const std::size_t* index = std::get_if<std::size_t>(&step)) {
    return *index < node.items.size() ? node.items[*index] : nullptr;
  }
  for (const MapEntry& entry : node.entries) {
    if (entry.key == std::get<std::string>(step)) return entry.value;
  }
  return nullptr;
}

/// Nested maps and lists of one item for a chain of steps: {a: {b: [value]}}.
DocumentNodePtr wrapped(const NodePath& path, std::size_t from, DocumentNodePtr value) {
  for (std::size_t i = path.size(); i-- > from;) {
    auto outer = std::make_shared<DocumentNode>();
    if (const std::string* key = std::get_if<std::string>(&path[i])) {
      outer->kind = NodeKind::map;
      outer->entries.push_back({*key, {}, std::move(value)});
    } else {
      outer->kind = NodeKind::sequence;
      outer->items.push_back(std::move(value));
    }
    value = std::move(outer);
  }
  return value;
}

std::size_t lineBegin(string_view text, std::size_t at) {
  const std::size_t newline = at == 0 ? string_view::npos : text.rfind('\n', at - 1);
  return newline == string_view::npos ? 0 : newline + 1;
}

/// The line that contains a byte: the position of its line end, and the position after it.
Span lineEnd(string_view text, std::size_t at) {
  const std::size_t newline = std::min(text.find('\n', at), text.size());
  const bool has_return = newline > at && text[newline - 1] == '\r';
  return {has_return ? newline - 1 : newline, std::min(newline + 1, text.size())};
}

bool isOnlyBlanks(string_view text) {
  return text.find_first_not_of(" \t\r\n") == string_view::npos;
}

class Splicer {
 public:
  Splicer(const std::string& text, const DocumentNodePtr& root)
      : text_(text), root_(root), json_(text.find_first_not_of(" \t\r\n") == text.find('{')) {}

  Splice splice(const NodePath& path, const DocumentNodePtr& value) const {
    DocumentNodePtr parent, node = root_;
    std::size_t depth = 0;
    for (; depth < path.size() && node->kind != NodeKind::null; ++depth) {
      if (node->anchored) refuseAnchor();
      const DocumentNodePtr child = childOf(*node, path[depth]);
      if (!child) break;
      parent = node;
      node = child;
    }
    if (!value) return removal(*parent, path);
    if (depth == path.size() || node->kind == NodeKind::null) {
      return replacement(*parent, path[depth - 1], *wrapped(path, depth, value));
    }
    const DocumentNodePtr inner = wrapped(path, depth + 1, value);
    const std::string* key = std::get_if<std::string>(&path[depth]);
    return key != nullptr ? insertion(*node, *key, *inner) : appendedItem(*node, *inner);
  }

 private:
  [[noreturn]] static void refuse(const std::string& why) {
    throw Error(ErrorCode::bad_input, "the file cannot be edited here: " + why);
  }
  [[noreturn]] static void refuseAnchor() {
    refuse("there is an anchor (&) or an alias (*); write the value out in the file");
  }

  static const MapEntry& entryOf(const DocumentNode& map, const std::string& key) {
    return *std::find_if(map.entries.begin(), map.entries.end(),
                         [&](const MapEntry& entry) { return entry.key == key; });
  }

  Splice replacement(const DocumentNode& parent, const PathStep& step, const DocumentNode& value) const {
    const std::string written = flowText(value, json_);
    if (const std::size_t* index = std::get_if<std::size_t>(&step)) {
      const Span span = spanOf(text_, *parent.items[*index]);
      return {span.begin, span.end, written};
    }
    const MapEntry& entry = entryOf(parent, std::get<std::string>(step));
    const DocumentNode& old = *entry.value;
    const Span span = valueSpanOf(text_, entry);
    if (span.begin == span.end) return {span.begin, span.end, " " + written};
    // A block begins on a new line; a value on one line may have less indentation than a block needs.
    const bool is_block =
        (old.kind == NodeKind::map || old.kind == NodeKind::sequence) && !isFlow(text_, old);
    const std::size_t colon = afterColon(text_, entry);
    if (is_block && isOnlyBlanks(string_view(text_).substr(colon, span.begin - colon))) {
      return {colon, span.end, " " + written};
    }
    return {span.begin, span.end, written};
  }

  Splice insertion(const DocumentNode& map, const std::string& key, const DocumentNode& value) const {
    const std::string pair = keyText(key) + ": " + flowText(value, json_);
    if (map.anchored) refuseAnchor();
    if (map.entries.empty()) {
      const std::size_t inside = map.position.offset + 1;
      return {inside, inside, pair};
    }
    const std::size_t end = valueSpanOf(text_, map.entries.back()).end;
    const std::size_t first = map.entries.front().position.offset;
    const std::size_t line = lineBegin(text_, first);
    const string_view before = string_view(text_).substr(line, first - line);
    const std::string eol = lineEnding(first);
    if (isFlow(text_, map)) {
      const bool own_line = isOnlyBlanks(before) && line > map.position.offset;
      return {end, end, own_line ? "," + eol + std::string(before) + pair : ", " + pair};
    }
    const std::size_t at = lineEnd(text_, end).begin;
    return {at, at, eol + std::string(before.size(), ' ') + pair};
  }

  Splice appendedItem(const DocumentNode& list, const DocumentNode& value) const {
    if (list.anchored) refuseAnchor();
    if (list.items.empty()) {
      const std::size_t inside = list.position.offset + 1;
      return {inside, inside, flowText(value, json_)};
    }
    const std::size_t first = spanOf(text_, *list.items.front()).begin;
    const std::size_t end = spanOf(text_, *list.items.back()).end;
    const std::string eol = lineEnding(first);
    if (isFlow(text_, list)) {
      const std::size_t line = lineBegin(text_, first);
      const string_view before = string_view(text_).substr(line, first - line);
      const bool own_line = isOnlyBlanks(before) && line > list.position.offset;
      return {end, end, (own_line ? "," + eol + std::string(before) : ", ") + flowText(value, json_)};
    }
    const std::size_t dash = dashBefore(first);
    const std::string indentation(dash - lineBegin(text_, dash), ' ');
    std::string written;
    for (const MapEntry& entry : value.entries) {
      written += eol + indentation + (written.empty() ? "- " : "  ") + keyText(entry.key) + ": " +
                 flowText(*entry.value, json_);
    }
    if (written.empty()) written = eol + indentation + "- " + flowText(value, json_);
    const std::size_t at = lineEnd(text_, end).begin;
    return {at, at, written};
  }

  std::string keyText(const std::string& key) const {
    DocumentNode node;
    node.kind = NodeKind::scalar;
    node.text = key;
    return flowText(node, json_);
  }

  std::string lineEnding(std::size_t near) const {
    const Span end = lineEnd(text_, near);
    if (end.begin < end.end) return text_.substr(end.begin, end.end - end.begin);
    return text_.find("\r\n") != std::string::npos ? "\r\n" : "\n";
  }

  Splice removal(const DocumentNode& parent, const NodePath& path) const {
    if (parent.anchored) refuseAnchor();
    std::vector<Span> children;  // a key to the end of its value, or an item
    std::size_t index = 0;
    for (const MapEntry& entry : parent.entries) {
      if (std::holds_alternative<std::string>(path.back()) && entry.key == std::get<std::string>(path.back()))
        index = children.size();
      children.push_back({entry.position.offset, valueSpanOf(text_, entry).end});
    }
    for (const DocumentNodePtr& item : parent.items) children.push_back(spanOf(text_, *item));
    if (!parent.items.empty()) index = std::get<std::size_t>(path.back());

    if (children.size() == 1) return replacementByEmpty(parent, path);
    const bool is_last = index + 1 == children.size();
    if (isFlow(text_, parent)) {
      return is_last ? Splice{children[index - 1].end, children[index].end, ""}
                     : Splice{children[index].begin, children[index + 1].begin, ""};
    }
    std::size_t begin = children[index].begin;
    if (!parent.items.empty()) begin = dashBefore(begin);
    const std::size_t line = lineBegin(text_, begin);
    if (!isOnlyBlanks(string_view(text_).substr(line, begin - line))) {
      // The key is on the line of a dash; the next key is moved there.
      if (is_last) refuse("a key is on the line of another value");
      return {children[index].begin, children[index + 1].begin, ""};
    }
    const Span end = lineEnd(text_, children[index].end);
    if (end.end == end.begin && line > 0) return {lineEnd(text_, line - 1).begin, end.end, ""};
    return {line, end.end, ""};
  }

  Splice replacementByEmpty(const DocumentNode& parent, NodePath path) const {
    auto empty = std::make_shared<DocumentNode>();
    empty->kind = parent.kind;
    path.pop_back();
    return splice(path, empty);
  }

  /// The dash of an item in block style.
  std::size_t dashBefore(std::size_t item) const {
    const std::size_t dash = item == 0 ? std::string::npos : text_.find_last_not_of(" \t\r\n", item - 1);
    if (dash == std::string::npos || text_[dash] != '-') refuse("an item has no dash before it");
    return dash;
  }

  const std::string& text_;
  const DocumentNodePtr& root_;
  const bool json_;
};

}  // namespace

DocumentNodePtr valueAt(const DocumentNodePtr& root, const NodePath& path) {
  DocumentNodePtr node = root;
  for (std::size_t i = 0; i < path.size() && node; ++i) node = childOf(*node, path[i]);
  return node;
}

namespace {

DocumentNodePtr withValueFrom(const DocumentNodePtr& node, const NodePath& path, std::size_t depth,
                              const DocumentNodePtr& value) {
  if (depth == path.size()) return value;
  if (node->kind == NodeKind::null) return value ? wrapped(path, depth, value) : node;
  auto copy = std::make_shared<DocumentNode>(*node);
  if (const std::size_t* index = std::get_if<std::size_t>(&path[depth])) {
    if (*index == copy->items.size()) {
      copy->items.push_back(wrapped(path, depth + 1, value));
      return copy;
    }
    const auto item = copy->items.begin() + static_cast<std::ptrdiff_t>(*index);
    DocumentNodePtr changed = withValueFrom(*item, path, depth + 1, value);
    if (changed) {
      *item = std::move(changed);
    } else {
      copy->items.erase(item);
    }
    return copy;
  }
  const std::string& key = std::get<std::string>(path[depth]);
  const auto entry = std::find_if(copy->entries.begin(), copy->entries.end(),
                                  [&](const MapEntry& e) { return e.key == key; });
  if (entry == copy->entries.end()) {
    if (value) copy->entries.push_back({key, {}, wrapped(path, depth + 1, value)});
    return copy;
  }
  DocumentNodePtr changed = withValueFrom(entry->value, path, depth + 1, value);
  if (changed) {
    entry->value = std::move(changed);
  } else {
    copy->entries.erase(entry);
  }
  return copy;
}

}  // namespace

DocumentNodePtr withValueAt(const DocumentNodePtr& root, const NodePath& path, const DocumentNodePtr& value) {
  return withValueFrom(root, path, 0, value);
}

Splice spliceFor(const std::string& text, const DocumentNodePtr& root, const NodePath& path,
                 const DocumentNodePtr& value) {
  return Splicer(text, root).splice(path, value);
}

}  // namespace emscape::document

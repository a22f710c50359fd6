#include "document/document.h"

#include <fmt/format.h>
#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include "document/text_file.h"

namespace emscape::document {

namespace {

constexpr int kMaxNesting = 32;
constexpr long long kMaxValues = 1000000;
constexpr int kMaxTabReports = 20;

/// A fault after which reading cannot go on.
struct FatalFault {
  TextPosition position;
  std::string message;
};

/// Turns the parser's marks (line from 0, byte of the line) into positions.
class PositionFinder {
 public:
  explicit PositionFinder(std::string_view text) : text_(text), line_begins_{0} {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') line_begins_.push_back(i + 1);
    }
  }

  TextPosition operator()(const YAML::Mark& mark) {
    if (mark.is_null()) return {};
    const std::size_t line = static_cast<std::size_t>(mark.line);
    if (line >= line_begins_.size()) return {mark.line + 1, 1, text_.size()};
    const std::size_t byte =
        std::min(line_begins_[line] + static_cast<std::size_t>(mark.column), text_.size());
    if (line != line_ || byte < byte_) {
      line_ = line;
      byte_ = line_begins_[line];
      column_ = 1;
    }
    column_ += static_cast<int>(characterCount(text_.substr(byte_, byte - byte_)));
    byte_ = byte;
    return {mark.line + 1, column_, byte};
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> line_begins_;
  // The last position: the next one is usually after it, which saves time in a file with one long line.
  std::size_t line_ = 0, byte_ = 0;
  int column_ = 1;
};

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, const std::string& text, ProblemList& problems)
      : file_(file), positions_(text), problems_(problems) {}

  TextPosition positionOf(const YAML::Mark& mark) { return positions_(mark); }
  DocumentNodePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    auto node = makeNode(NodeKind::null, mark, anchor);
    if (const Frame* frame = openMap()) {
      if (frame->has_key) node->position = frame->key_position;
    }
    finish(node);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const TextPosition position = positions_(mark);
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw FatalFault{position, "alias of an unknown anchor"};
    if (open_anchors_.count(found->second.get()) != 0) {
      throw FatalFault{position, "an alias cannot be within its own anchor"};
    }
    place(found->second, position);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    auto node = makeNode(NodeKind::scalar, mark, anchor);
    node->text = value;
    node->quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    if (tag != "!" && tag != "?") refuseTag(node->position, tag);
    finish(node);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(NodeKind::sequence, mark, tag, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(NodeKind::map, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  /// A sequence or map that is still being read.
  struct Frame {
    std::shared_ptr<DocumentNode> node;
    bool has_key = false;  ///< map: the next value belongs to `key`
    bool key_is_sound = true;
    std::string key;
    TextPosition key_position;
  };

  Frame* openMap() {
    return !frames_.empty() && frames_.back().node->kind == NodeKind::map ? &frames_.back() : nullptr;
  }

  std::shared_ptr<DocumentNode> makeNode(NodeKind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    auto node = std::make_shared<DocumentNode>();
    node->kind = kind;
    node->position = positions_(mark);
    node->anchored = anchor != YAML::NullAnchor;
    if (node->anchored) anchors_[anchor] = node;
    return node;
  }

  void refuseTag(const TextPosition& position, const std::string& tag) {
    problems_.addError(locationOf(position), fmt::format("tag '{}' is not allowed", tag));
  }

  void open(NodeKind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    auto node = makeNode(kind, mark, anchor);
    if (!tag.empty() && tag != "?" && tag != "!") refuseTag(node->position, tag);
    if (frames_.size() >= kMaxNesting) {
      throw FatalFault{node->position, fmt::format("nested deeper than the allowed {} levels", kMaxNesting)};
    }
    open_anchors_.insert(node.get());
    Frame frame;
    frame.node = std::move(node);
    frames_.push_back(std::move(frame));
  }

  void close() {
    const std::shared_ptr<DocumentNode> node = frames_.back().node;
    frames_.pop_back();
    open_anchors_.erase(node.get());
    finish(node);
  }

  void finish(const std::shared_ptr<DocumentNode>& node) { place(node, node->position); }

  /// Adds a complete value to its parent. @param position  of the value or its alias
  void place(const DocumentNodePtr& node, const TextPosition& position) {
    if (frames_.empty()) {
      root_ = node;
      return;
    }
    Frame& frame = frames_.back();
    if (frame.node->kind == NodeKind::map && !frame.has_key) {
      takeKey(frame, *node, position);
      return;
    }
    frame.node->unfolded_count += node->unfolded_count;
    if (frame.node->unfolded_count > kMaxValues) {
      throw FatalFault{position, fmt::format("more than the allowed {} values", kMaxValues)};
    }
    if (frame.node->kind == NodeKind::sequence) {
      frame.node->items.push_back(node);
    } else {
      if (frame.key_is_sound) frame.node->entries.push_back({frame.key, frame.key_position, node});
      frame.has_key = false;
    }
  }

  void takeKey(Frame& frame, const DocumentNode& node, const TextPosition& position) {
    frame.has_key = true;
    frame.key = node.text;
    frame.key_position = position;
    frame.key_is_sound = node.kind == NodeKind::scalar && !(node.text == "<<" && !node.quoted);
    if (node.kind != NodeKind::scalar) {
      problems_.addError(locationOf(position), "a key must be text");
    } else if (!frame.key_is_sound) {
      problems_.addError(locationOf(position), "merge key '<<' is not allowed; write the keys out");
    }
  }

  SourceLocation locationOf(const TextPosition& position) const {
    return {file_, position.line, position.column};
  }

  const std::string& file_;
  PositionFinder positions_;
  ProblemList& problems_;
  std::vector<Frame> frames_;
  std::map<YAML::anchor_t, DocumentNodePtr> anchors_;
  std::set<const DocumentNode*> open_anchors_;
  DocumentNodePtr root_;
};

/// Tabs before the first word of a line: YAML forbids them, and parsers disagree on their meaning. JSON
/// allows them.
bool hasTabsAsIndentation(const std::string& file, const std::string& text, ProblemList& problems) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && (text[first] == '{' || text[first] == '[')) return false;
  int line = 1, reports = 0;
  for (std::size_t begin = 0; begin < text.size() && reports < kMaxTabReports; ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::size_t word = std::min(text.find_first_not_of(" \t\r", begin), end);
    const std::size_t tab = std::string_view(text).substr(begin, word - begin).find('\t');
    if (word < end && text[word] != '#' && tab != std::string_view::npos) {
      problems.addError({file, line, static_cast<int>(tab) + 1}, "tab as indentation; use spaces");
      ++reports;
    }
    begin = end + 1;
  }
  return reports > 0;
}

}  // namespace

DocumentNodePtr readDocument(const std::string& file, const std::string& text, ProblemList& problems) {
  if (hasTabsAsIndentation(file, text, problems)) return nullptr;
  TreeBuilder builder(file, text, problems);
  std::istringstream stream(text);
  const auto fail = [&](const TextPosition& position, const std::string& message) {
    problems.addError({file, position.line, position.column}, message);
    return nullptr;
  };
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder) || !builder.root() || builder.root()->kind == NodeKind::null) {
      return fail({1, 1, 0}, "the file is empty");
    }
    const DocumentNodePtr root = builder.root();
    TreeBuilder second(file, text, problems);
    if (parser.HandleNextDocument(second)) {
      return fail(second.root() ? second.root()->position : TextPosition{1, 1, 0},
                  "a second document begins here; the file must be one document");
    }
    return root;
  } catch (const FatalFault& fault) {
    return fail(fault.position, fault.message);
  } catch (const YAML::Exception& exception) {
    return fail(builder.positionOf(exception.mark), "not valid YAML: " + exception.msg);
  }
}

}  // namespace emscape::document

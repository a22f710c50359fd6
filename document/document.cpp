#include "document/document.h"

#include <fmt/format.h>
#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
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

/// JSON escapes a character beyond U+FFFF as a pair of surrogates, "\ud83c\udf89", YAML as "\U0001f389".
constexpr std::size_t kPairLength = 12, kEscapeLength = 10;

/// The code unit of an escape "\uXXXX" that begins at a position; 0: there is none.
unsigned escapedUnit(std::string_view text, std::size_t at) {
  unsigned unit = 0;
  const char* const begin = text.data() + at + 2;
  const char* const end = begin + 4;
  if (at + 6 > text.size() || text[at] != '\\' || text[at + 1] != 'u') return 0;
  return std::from_chars(begin, end, unit, 16).ptr == end ? unit : 0;
}

/// The character that a pair of surrogate escapes stands for; 0: no pair begins at this position.
unsigned escapedPair(std::string_view text, std::size_t at) {
  const unsigned high = escapedUnit(text, at);
  const unsigned low = high >= 0xD800 && high < 0xDC00 ? escapedUnit(text, at + kPairLength / 2) : 0;
  return low >= 0xDC00 && low < 0xE000 ? 0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00) : 0;
}

/// The text for the YAML parser.
struct YamlText {
  std::string text;
  std::vector<std::size_t> pair_ends;  ///< of each escape that was a pair: its end in `text`

  /// Position in the original text.
  std::size_t originalOf(std::size_t at) const {
    const auto pairs = std::upper_bound(pair_ends.begin(), pair_ends.end(), at) - pair_ends.begin();
    return at + static_cast<std::size_t>(pairs) * (kPairLength - kEscapeLength);
  }
};

/// Writes JSON's pairs of surrogate escapes as YAML needs them, in texts that begin as JSON does.
YamlText yamlTextOf(const std::string& text) {
  constexpr std::string_view kBlank = " \t\r\n", kBeforeValue = "{[,:";
  const std::size_t first = text.find_first_not_of(kBlank);
  const bool has_pairs = text.find("\\ud") != std::string::npos || text.find("\\uD") != std::string::npos;
  if (!has_pairs || (text[first] != '{' && text[first] != '[' && text[first] != '"')) return {text, {}};
  YamlText yaml;
  char quote = '\0';  // of the text in quotes that has begun
  char before = ',';  // last one that is not blank
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == '"' && c == '\\') {
      if (const unsigned character = escapedPair(text, i)) {
        yaml.text += fmt::format("\\U{:08x}", character);
        yaml.pair_ends.push_back(yaml.text.size());
        i += kPairLength - 1;
      } else {
        yaml.text += text.substr(i++, 2);
      }
      continue;
    }
    if (c == quote) {
      quote = '\0';
    } else if (quote == '\0' && (c == '"' || c == '\'') &&
               kBeforeValue.find(before) != std::string_view::npos) {
      quote = c;
    }
    if (kBlank.find(c) == std::string_view::npos) before = c;
    yaml.text += c;
  }
  return yaml;
}

/// Turns the parser's marks (line from 0, byte of the line) into positions in the original text.
class PositionFinder {
 public:
  PositionFinder(std::string_view text, const YamlText& yaml) : text_(text), yaml_(yaml), line_begins_{0} {
    for (std::size_t i = 0; i < yaml.text.size(); ++i) {
      if (yaml.text[i] == '\n') line_begins_.push_back(i + 1);
    }
  }

  TextPosition operator()(const YAML::Mark& mark) {
    if (mark.is_null()) return {};
    const std::size_t line = static_cast<std::size_t>(mark.line);
    if (line >= line_begins_.size()) return {mark.line + 1, 1, text_.size()};
    const std::size_t byte =
        std::min(yaml_.originalOf(line_begins_[line] + static_cast<std::size_t>(mark.column)), text_.size());
    if (line != line_ || byte < byte_) {
      line_ = line;
      byte_ = yaml_.originalOf(line_begins_[line]);
      column_ = 1;
    }
    column_ += static_cast<int>(characterCount(text_.substr(byte_, byte - byte_)));
    byte_ = byte;
    return {mark.line + 1, column_, byte};
  }

 private:
  std::string_view text_;
  const YamlText& yaml_;
  std::vector<std::size_t> line_begins_;  ///< in yaml_
  // The last position: the next one is usually after it, which saves time in a file with one long line.
  std::size_t line_ = 0, byte_ = 0;
  int column_ = 1;
};

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, const std::string& text, const YamlText& yaml, ProblemList& problems)
      : file_(file), positions_(text, yaml), problems_(problems) {}

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
  const YamlText yaml = yamlTextOf(text);
  TreeBuilder builder(file, text, yaml, problems);
  std::istringstream stream(yaml.text);
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
    TreeBuilder second(file, text, yaml, problems);
    if (parser.HandleNextDocument(second)) {
      return fail(second.root() ? second.root()->position : TextPosition{1, 1, 0},
                  "a second document begins here; the file must be one document");
    }
    return root;
  } catch (const FatalFault& fault) {
    return fail(fault.position, fault.message);
  } catch (const YAML::Exception& exception) {
    TextPosition position = builder.positionOf(exception.mark);
    std::string reason = exception.msg;
    if (reason.rfind(YAML::ErrorMsg::INVALID_UNICODE, 0) == 0) {
      // The mark is at the escape's end, where another escape may begin.
      const std::size_t begin =
          position.offset == 0 ? std::string::npos : text.rfind('\\', position.offset - 1);
      if (begin != std::string::npos) {
        const std::string escape = text.substr(begin, position.offset - begin);
        position.column -= static_cast<int>(escape.size());
        position.offset = begin;
        reason = escape + " is not a character";
        if (const unsigned character = escapedPair(text, begin)) {
          reason = fmt::format("{} is a pair of surrogates, which YAML writes as \\U{:08x}",
                               text.substr(begin, kPairLength), character);
        } else if (escapedUnit(text, begin) != 0) {
          reason += ", but one half of a surrogate pair";
        }
      }
    }
    if (reason == YAML::ErrorMsg::END_OF_MAP || reason == YAML::ErrorMsg::END_OF_SEQ)
      reason +=
          "; this line is indented otherwise than the ones that it belongs to, or a colon, quote or "
          "bracket is missing before it";
    const bool is_json = file.size() > 5 && file.compare(file.size() - 5, 5, ".json") == 0;
    return fail(position, fmt::format("not valid {}: {}", is_json ? "JSON" : "YAML", reason));
  }
}

}  // namespace emscape::document

#include "document/edit_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "document/schema_check.h"
#include "emscape/base/error.h"

namespace emscape::document {

namespace {

constexpr std::size_t kMaxNamesShown = 20;

[[noreturn]] void fail(const std::string& message) {
  throw Error(ErrorCode::bad_input, message);
}

/// The byte after a name in quotes that begins at `begin`; npos if it has no end.
std::size_t endOfQuotes(const std::string& text, std::size_t begin) {
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      return i + 1;
    }
  }
  return std::string::npos;
}

std::string withoutQuotes(const std::string& text) {
  std::string name;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == '\\') ++i;
    name += text[i];
  }
  return name;
}

const std::string* nameOf(const DocumentNode& item) {
  for (const MapEntry& entry : item.entries) {
    if (entry.key == "name" && entry.value->kind == NodeKind::scalar) return &entry.value->text;
  }
  return nullptr;
}

class Resolver {
 public:
  Resolver(const std::string& path, const DocumentNodePtr& root, const ObjectSpec& spec)
      : path_(path), node_(root), object_(&spec) {
    result_.exists = true;
  }

  ResolvedPath resolve() {
    if (path_.empty()) fail("the path is empty; write KEY or KEY.KEY");
    while (at_ < path_.size()) {
      if (object_ != nullptr) {
        key();
      } else if (result_.spec->type == ValueType::list) {
        item();
      } else {
        fail(fmt::format("{} has no parts; the path ends there", result_.name));
      }
    }
    if (path_.back() == '.' && !ended_) fail("the path ends with a point");
    return std::move(result_);
  }

 private:
  /// The unquoted step that begins here and ends at the next point.
  std::string word() const {
    if (path_[at_] != '"') return path_.substr(at_, path_.find('.', at_) - at_);
    const std::size_t end = endOfQuotes(path_, at_);
    if (end == std::string::npos || (end < path_.size() && path_[end] != '.')) {
      fail("a name in quotes must end before a point or the path's end");
    }
    return path_.substr(at_, end - at_);
  }

  void advance(std::size_t length) {
    at_ += length;
    ended_ = at_ == path_.size();
    if (!ended_) ++at_;
  }

  void append(const std::string& step) { result_.text += (result_.text.empty() ? "" : ".") + step; }

  void enter(const DocumentNodePtr& node, const ValueSpec& spec) {
    node_ = node;
    if (!node) result_.exists = false;
    result_.spec = &spec;
    const bool is_in_place = node && node->kind == NodeKind::map;  // of a number
    object_ = spec.type == ValueType::object || is_in_place ? spec.object : nullptr;
  }

  void key() {
    if (node_ && node_->kind != NodeKind::map && node_->kind != NodeKind::null) {
      fail(fmt::format("the {} is not a set of keys in the file", object_->name));
    }
    const std::string written = word();
    const std::string name = written.front() == '"' ? withoutQuotes(written) : written;
    std::string variant;
    if (node_ && !object_->discriminator.empty()) {
      for (const MapEntry& entry : node_->entries) {
        if (entry.key == object_->discriminator) variant = entry.value->text;
      }
    }
    const KeySpec* row = object_->find(name, variant.empty() ? nullptr : &variant);
    // A key of another variant: the edits may also select that variant.
    const bool applies = row != nullptr;
    if (!applies) row = object_->find(name, nullptr);
    if (row == nullptr) fail(unknownKeyMessage(name, *object_, nullptr));
    result_.name = "'" + name + "'";
    result_.required = applies && row->required;
    append(name);
    result_.steps.emplace_back(name);
    DocumentNodePtr child;
    if (node_) child = valueAt(node_, {name});
    enter(child, row->value);
    advance(written.size());
  }

  void item() {
    const ValueSpec& list = *result_.spec;
    const bool named =
        list.item->type == ValueType::object && list.item->object->find("name", nullptr) != nullptr;
    if (node_ && node_->kind != NodeKind::sequence && node_->kind != NodeKind::null) {
      fail(fmt::format("{} is not a list in the file", result_.name));
    }
    const std::size_t index = named ? indexByName(*list.item->object) : indexByNumber();
    result_.is_list_required = std::exchange(result_.required, false);
    result_.steps.emplace_back(index);
    enter(result_.missing.empty() ? node_->items[index] : nullptr, *list.item);
  }

  std::size_t indexByName(const ObjectSpec& spec) {
    const bool in_quotes = path_[at_] == '"';
    const std::string written = in_quotes ? withoutQuotes(word()) : path_.substr(at_);
    const std::vector<DocumentNodePtr> none;
    const std::vector<DocumentNodePtr>& items = node_ ? node_->items : none;
    std::size_t best = items.size(), best_length = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::string* name = nameOf(*items[i]);
      if (name == nullptr) continue;
      const bool begins = written.compare(0, name->size(), *name) == 0;
      const bool fits =
          begins && (written.size() == name->size() || (!in_quotes && written[name->size()] == '.'));
      if (!fits || name->empty() || (best < items.size() && name->size() <= best_length)) continue;
      best = i;
      best_length = name->size();
    }
    if (best == items.size()) {
      std::vector<std::string> names;
      for (const DocumentNodePtr& item : items) {
        if (const std::string* name = nameOf(*item)) names.push_back(*name);
      }
      return newItem(in_quotes ? written : word(), spec, names);
    }
    const std::string name = *nameOf(*items[best]);
    result_.name = fmt::format("the {} '{}'", spec.name, name);
    append(pathStep(name));
    advance(in_quotes ? word().size() : best_length);
    return best;
  }

  /// The end of the list, if the path ends with this name.
  std::size_t newItem(const std::string& name, const ObjectSpec& spec,
                      const std::vector<std::string>& names) {
    std::string known;
    for (std::size_t i = 0; i < std::min(names.size(), kMaxNamesShown); ++i) {
      known += (i == 0 ? "'" : ", '") + names[i] + "'";
    }
    if (names.size() > kMaxNamesShown) known += fmt::format(" and {} more", names.size() - kMaxNamesShown);
    result_.missing = fmt::format("there is no {} '{}'; {}{}", spec.name, name,
                                  names.empty() ? "the scenario has none" : "allowed are " + known,
                                  didYouMean(name, names));
    const std::size_t length = word().size();
    if (name.empty() || at_ + length != path_.size()) fail(result_.missing);
    result_.name = fmt::format("the {} '{}'", spec.name, name);
    result_.new_name = name;
    append(pathStep(name));
    advance(length);
    return node_ ? node_->items.size() : 0;
  }

  std::size_t indexByNumber() {
    const std::string written = word();
    const std::size_t count = node_ ? node_->items.size() : 0;
    const bool digits =
        !written.empty() && written.size() < 10 &&
        std::all_of(written.begin(), written.end(), [](char c) { return c >= '0' && c <= '9'; });
    const std::size_t index = digits ? std::stoul(written) : count;
    if (index >= count) {
      fail(fmt::format("'{}' is not an item of {}; {}", written, result_.name,
                       count == 0 ? "it has none" : fmt::format("allowed are 0 to {}", count - 1)));
    }
    result_.name = fmt::format("item {} of {}", index, result_.name);
    append(std::to_string(index));
    advance(written.size());
    return index;
  }

  const std::string& path_;
  DocumentNodePtr node_;
  const ObjectSpec* object_;  ///< of the object whose key is the next step; null in a list or a value
  std::size_t at_ = 0;
  bool ended_ = false;
  ResolvedPath result_;
};

}  // namespace

ResolvedPath resolvePath(const std::string& path, const DocumentNodePtr& root, const ObjectSpec& spec) {
  return Resolver(path, root, spec).resolve();
}

std::string quotedName(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string pathStep(const std::string& name) {
  const bool is_plain = !name.empty() && name.find_first_of(".\"=\\") == std::string::npos;
  return is_plain ? name : quotedName(name);
}

std::size_t endOfPath(const std::string& text) {
  bool step_begins = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"' && step_begins) {
      i = endOfQuotes(text, i);
      if (i == std::string::npos) return i;
      --i;
    } else if (text[i] == '=') {
      return i;
    }
    step_begins = text[i] == '.';
  }
  return std::string::npos;
}

}  // namespace emscape::document

#include "document/schema_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>

#include "base/text/quantity_text.h"
#include "base/text/utc.h"
#include "base/text/utf8.h"
#include "document/text_file.h"

namespace emscape::document {

namespace {

constexpr std::size_t kMaxQuotation = 40;

std::string withUnit(const std::string& unit) {
  return unit.empty() ? "" : " (" + unit + ")";
}

std::string quoted(const std::string& text) {
  std::size_t length = std::min(text.size(), kMaxQuotation);
  while (length < text.size() && length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80)
    --length;
  std::string shown = text.substr(0, length) + (length < text.size() ? "..." : "");
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return "'" + shown + "'";
}

std::string joined(const std::vector<std::string>& words, const std::string& between = ", ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string joinedQuoted(const std::vector<std::string>& words) {
  std::vector<std::string> all;
  for (const std::string& word : words) all.push_back(quoted(word));
  return joined(all);
}

std::string describe(const DocumentNode& node) {
  switch (node.kind) {
    case NodeKind::null:
      return "nothing";
    case NodeKind::sequence:
      return "a list";
    case NodeKind::map:
      return "a set of keys";
    case NodeKind::scalar:
      break;
  }
  return (node.quoted ? "the quoted text " : "") + quoted(node.text);
}

std::string expectation(const ValueSpec& spec) {
  switch (spec.type) {
    case ValueType::number:
    case ValueType::integer:
      return (spec.type == ValueType::integer ? "a whole number" : "a number") + withUnit(spec.unit) +
             (spec.choices.empty() ? "" : " or " + joined(spec.choices)) +
             (spec.object != nullptr ? " or the keys of a " + spec.object->name : "");
    case ValueType::boolean:
      return "true or false";
    case ValueType::text:
      return "text";
    case ValueType::file:
      return "the name of a file" +
             (spec.object != nullptr ? " or the keys of a " + spec.object->name : std::string());
    case ValueType::timestamp:
      return "a UTC time such as 2026-06-01T06:00:00Z";
    case ValueType::choice:
      return "one of " + joined(spec.choices);
    case ValueType::object:
      return "a set of keys";
    case ValueType::list:
      if (spec.min_items == spec.max_items) {
        return fmt::format("a list of {} values{}", spec.min_items, withUnit(unitOf(spec)));
      }
      return "a list";
  }
  return "";
}

/// Values that YAML does not read as text.
bool looksLikeText(const DocumentNode& node) {
  return node.quoted || (!numberOf(node.text) && !booleanOf(node.text));
}

std::string lowerCase(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

int editDistance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

bool startsWith(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

class Checker {
 public:
  Checker(const std::string& file, ProblemList& problems) : file_(file), problems_(problems) {}

  bool sound() const { return sound_; }

  void object(const std::string& name, const DocumentNode& node, const ObjectSpec& spec) {
    if (node.kind != NodeKind::map) {
      fault(node.position, fmt::format("{} must be a set of keys, not {}", name, describe(node)));
      return;
    }
    const std::string* variant = variantOf(node, spec);
    std::map<std::string, int> lines;
    std::set<std::string> seen;
    std::vector<std::string>
        meant;  // probable meanings of unknown keys; missing keys among them are not reported
    for (const MapEntry& entry : node.entries) {
      const auto [first, is_new] = lines.emplace(entry.key, entry.position.line);
      if (!is_new) {
        fault(entry.position,
              fmt::format("duplicate key {}; first at line {}", quoted(entry.key), first->second));
        continue;
      }
      seen.insert(entry.key);
      if (const KeySpec* row = spec.find(entry.key, variant)) {
        value(quoted(row->name), *entry.value, row->value);
      } else {
        fault(entry.position, unknownKeyMessage(entry.key, spec, variant, &meant));
      }
    }
    missing(node, spec, variant, seen, {meant.begin(), meant.end()});
  }

 private:
  void fault(const TextPosition& position, const std::string& message) {
    sound_ = false;
    problems_.addError({file_, position.line, position.column}, message);
  }

  /// The discriminator's value if it is valid.
  static const std::string* variantOf(const DocumentNode& node, const ObjectSpec& spec) {
    for (const MapEntry& entry : node.entries) {
      if (spec.discriminator.empty() || entry.key != spec.discriminator) continue;
      const std::vector<std::string>& choices = spec.find(entry.key, nullptr)->value.choices;
      const auto found = std::find(choices.begin(), choices.end(), entry.value->text);
      return found == choices.end() ? nullptr : &*found;
    }
    return nullptr;
  }

  void missing(const DocumentNode& node, const ObjectSpec& spec, const std::string* variant,
               const std::set<std::string>& seen, const std::set<std::string>& meant) {
    const auto given = [&](const std::string& key) { return seen.count(key) != 0; };
    for (const KeySpec& row : spec.keys) {
      const bool applies =
          row.only_for.empty() || (variant != nullptr && spec.find(row.name, variant) == &row);
      if (row.required && applies && !given(row.name) && meant.count(row.name) == 0) {
        fault(node.position,
              fmt::format("missing key '{}'{} of the {}", row.name, withUnit(unitOf(row.value)), spec.name));
      }
    }
    for (const auto& group : spec.exactly_one_of) {
      if (std::any_of(group.begin(), group.end(), [&](const auto& key) { return meant.count(key) != 0; }))
        continue;
      const auto count = std::count_if(group.begin(), group.end(), given);
      if (count == 1) continue;
      fault(node.position, fmt::format("the {} must have exactly one of {}; it has {}", spec.name,
                                       joinedQuoted(group), count == 0 ? "none" : std::to_string(count)));
    }
    for (const auto& [key, companion] : spec.goes_with) {
      if (!given(key) || given(companion)) continue;
      const auto entry = std::find_if(node.entries.begin(), node.entries.end(),
                                      [&, &name = key](const MapEntry& e) { return e.key == name; });
      fault(entry->position,
            fmt::format("'{}' needs '{}', which the {} does not have", key, companion, spec.name));
    }
  }

  void value(const std::string& name, const DocumentNode& node, const ValueSpec& spec) {
    const auto wrongType = [&] {
      fault(node.position, fmt::format("{} must be {}, not {}", name, expectation(spec), describe(node)));
    };
    const bool is_in_place = spec.object != nullptr && node.kind == NodeKind::map;  // of a number or file
    if (spec.type == ValueType::object || is_in_place) {
      object(name, node, *spec.object);
    } else if (spec.type == ValueType::list) {
      node.kind == NodeKind::sequence ? list(name, node, spec) : wrongType();
    } else if (node.kind != NodeKind::scalar) {
      wrongType();
    } else if (spec.type == ValueType::number || spec.type == ValueType::integer) {
      if (std::count(spec.choices.begin(), spec.choices.end(), node.text) > 0) return;
      const std::optional<double> number = node.quoted ? std::nullopt : numberOf(node.text);
      if (!number) {
        const std::optional<double> meant = parseQuantity(node.text, spec.unit);
        if (!meant || !rangeFault(name, node.text, *meant, spec).empty()) return wrongType();
        fault(node.position, fmt::format("{} must be {}, not {}; write {:.12g}", name, expectation(spec),
                                         describe(node), *meant));
        return;
      }
      const std::string message = rangeFault(name, node.text, *number, spec);
      if (!message.empty()) fault(node.position, message);
    } else if (spec.type == ValueType::boolean) {
      if (node.quoted || !booleanOf(node.text)) wrongType();
    } else {
      word(name, node, spec, wrongType);
    }
  }

  template <class WrongType>
  void word(const std::string& name, const DocumentNode& node, const ValueSpec& spec,
            const WrongType& wrongType) {
    if (!looksLikeText(node)) {
      if (spec.type != ValueType::text) return wrongType();
      fault(node.position, fmt::format("{} must be text, not {}; put it in quotes", name, describe(node)));
    } else if (spec.type == ValueType::choice) {
      if (std::find(spec.choices.begin(), spec.choices.end(), node.text) != spec.choices.end()) return;
      fault(node.position, fmt::format("{} must be one of {}, not {}{}", name, joined(spec.choices),
                                       describe(node), didYouMean(node.text, spec.choices)));
    } else if (spec.type == ValueType::timestamp) {
      if (parseUtc_ms(node.text)) return;
      const std::string reason = utcFault(node.text);
      fault(node.position, fmt::format("{} must be {}, not {}{}", name, expectation(spec), quoted(node.text),
                                       reason.empty() ? "" : ": " + reason));
    } else {
      const std::optional<char32_t> unprintable =
          spec.is_printable ? firstUnprintable(node.text) : std::nullopt;
      if (unprintable) {
        const auto code_point = static_cast<std::uint32_t>(*unprintable);
        fault(node.position,
              fmt::format("{} contains U+{:04X}, {}", name, code_point,
                          code_point < 0xA0 ? "a control character" : "which is no character"));
        return;
      }
      const auto length = static_cast<long long>(characterCount(node.text));
      if (length >= spec.min_items && length <= spec.max_items) return;
      fault(node.position, fmt::format("{} has {} characters, outside the allowed range {} to {}", name,
                                       length, spec.min_items, spec.max_items));
    }
  }

  void list(const std::string& name, const DocumentNode& node, const ValueSpec& spec) {
    const auto count = static_cast<long long>(node.items.size());
    if (count < spec.min_items || count > spec.max_items) {
      const std::string allowed = spec.min_items == spec.max_items
                                      ? fmt::format("it must have {}", spec.min_items)
                                      : fmt::format("allowed are {} to {}", spec.min_items, spec.max_items);
      fault(node.position, fmt::format("{} has {} items; {}", name, count, allowed));
    }
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      value(fmt::format("item {} of {}", i + 1, name), *node.items[i], *spec.item);
    }
    if (spec.items_differ) duplicates(name, node);
  }

  void duplicates(const std::string& name, const DocumentNode& node) {
    std::map<std::string, int> lines;
    for (const DocumentNodePtr& item : node.items) {
      const DocumentNode* word = item.get();
      for (const MapEntry& entry : item->entries) {
        if (entry.key == "name") word = entry.value.get();
      }
      if (word->kind != NodeKind::scalar) continue;
      const auto [first, is_new] = lines.emplace(word->text, word->position.line);
      if (is_new) continue;
      fault(word->position,
            fmt::format("{} has {} twice; first at line {}", name, quoted(word->text), first->second));
    }
  }

  const std::string& file_;
  ProblemList& problems_;
  bool sound_ = true;
};

}  // namespace

bool checkObject(const std::string& file, const DocumentNode& node, const ObjectSpec& spec,
                 ProblemList& problems) {
  Checker checker(file, problems);
  checker.object("the " + spec.name, node, spec);
  return checker.sound();
}

std::string errorsText(const std::vector<Problem>& problems) {
  constexpr std::size_t kTold = 20;
  std::string text;
  std::size_t errors = 0;
  for (const Problem& problem : problems) {
    if (problem.severity == Severity::warning || ++errors > kTold) continue;
    text += (text.empty() ? "" : "\n") + toString(problem.location) + ": " + problem.message;
  }
  if (errors > kTold) text += fmt::format("\n{} further errors are not told", errors - kTold);
  return text;
}

void requireNoProblem(const ProblemList& problems) {
  const std::vector<Problem> all = problems.inOrder();
  if (all.empty()) return;
  if (all.size() == 1) throw Error(ErrorCode::bad_input, all.front().location, all.front().message);
  throw Error(ErrorCode::bad_input, errorsText(all));
}

std::optional<bool> booleanOf(const std::string& text) {
  if (text == "true" || text == "True" || text == "TRUE") return true;
  if (text == "false" || text == "False" || text == "FALSE") return false;
  return std::nullopt;
}

std::optional<double> numberOf(const std::string& text) {
  static const std::set<std::string> kInfinities{".inf",  ".Inf",  ".INF",  "+.inf", "+.Inf",
                                                 "+.INF", "-.inf", "-.Inf", "-.INF"};
  static const std::set<std::string> kNans{".nan", ".NaN", ".NAN"};
  if (kInfinities.count(text) != 0) {
    return text[0] == '-' ? -std::numeric_limits<double>::infinity()
                          : std::numeric_limits<double>::infinity();
  }
  if (kNans.count(text) != 0) return std::numeric_limits<double>::quiet_NaN();

  const std::size_t sign = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  if (sign == text.size() || !(isDigit(text[sign]) || text[sign] == '.')) return std::nullopt;
  double value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data() + sign, end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range) {
    // Too large or too close to zero: the exponent's sign distinguishes them.
    const std::size_t exponent = text.find_first_of("eE");
    value = exponent != std::string::npos && text[exponent + 1] == '-'
                ? 0.0
                : std::numeric_limits<double>::infinity();
  }
  return text[0] == '-' ? -value : value;
}

std::string rangeFault(const std::string& name, const std::string& text, double value,
                       const ValueSpec& spec) {
  if (!std::isfinite(value))
    return fmt::format("{} is {}, not a finite number{}", name, text, withUnit(spec.unit));
  if (spec.type == ValueType::integer && value != std::floor(value)) {
    return fmt::format("{} must be a whole number, not {}", name, text);
  }
  const bool low = spec.minimum_excluded ? value <= spec.minimum : value < spec.minimum;
  if (!low && value <= spec.maximum) return "";
  if (spec.minimum == spec.maximum)  // a version
    return fmt::format("{} is {}; this program reads {}", name, text, spec.maximum);
  constexpr int kDigits = 12;  // limits are shown in full
  // A longitude from 0 to 360.
  const bool is_east =
      spec.unit == "deg" && spec.minimum == -180 && spec.maximum == 180 && value > 180 && value <= 360;
  return fmt::format("{} is {}, outside the allowed range {}{}{}", name, text,
                     spec.minimum_excluded ? "above " : "",
                     rangeText(spec.minimum, spec.maximum, spec.unit, kDigits),
                     is_east ? fmt::format("; write {:.12g}", value - 360) : "");
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& names, std::string* closest) {
  const std::string* best = nullptr;
  int best_distance = static_cast<int>(std::min<std::size_t>(word.size(), 12)) / 3 + 1;
  for (const std::string& name : names) {
    if (word.size() > 2 * name.size() + 4) continue;
    const int distance = editDistance(lowerCase(word), lowerCase(name));
    if (distance < best_distance) {
      best = &name;
      best_distance = distance;
    }
  }
  if (best == nullptr) return "";
  if (closest != nullptr) *closest = *best;
  return "; did you mean '" + *best + "'?";
}

std::string unknownKeyMessage(const std::string& key, const ObjectSpec& spec, const std::string* variant,
                              std::vector<std::string>* meant) {
  const auto propose = [&](const std::string& name) {
    if (meant != nullptr) meant->push_back(name);
  };
  if (variant != nullptr) {
    std::vector<std::string> variants;
    for (const KeySpec& row : spec.keys) {
      if (row.name == key) variants.insert(variants.end(), row.only_for.begin(), row.only_for.end());
    }
    if (!variants.empty()) {
      return fmt::format("'{}' goes with {} {}, not {}", key, spec.discriminator, joined(variants, " or "),
                         *variant);
    }
  }

  const std::string word = lowerCase(key);
  for (const auto& [name, where] : spec.elsewhere)
    if (word == name) return fmt::format("unknown key {} of the {}; {}", quoted(key), spec.name, where);
  std::vector<std::string> names, with_unit;
  bool is_other_unit = word.find('_') != std::string::npos;
  for (const KeySpec& row : spec.keys) {
    if (spec.find(row.name, variant) != &row) continue;
    names.push_back(row.name);
    // The quantity with no unit, with another one, or (a height) without its datum.
    const std::string stem = stemOf(row), key_stem = word.substr(0, word.rfind('_'));
    if (stem == row.name) continue;
    if (word == stem || startsWith(word, stem + "_") || startsWith(stem, key_stem + "_")) {
      with_unit.push_back(fmt::format("'{}' ({})", row.name, unitOf(row.value)));
      const std::string unit = row.name.substr(stem.size());
      const bool has_unit = word.size() > unit.size() && word.substr(word.size() - unit.size()) == unit;
      is_other_unit = is_other_unit && word != stem && !has_unit &&
                      word.substr(word.rfind('_')) != row.name.substr(row.name.rfind('_'));
      propose(row.name);
    }
  }
  if (!with_unit.empty()) {
    return fmt::format("unknown key {}; write {}{}", quoted(key), joined(with_unit, " or "),
                       is_other_unit ? " and convert the value" : "");
  }
  std::string closest;
  const std::string hint = didYouMean(key, names, &closest);
  if (!closest.empty()) {
    propose(closest);
    return fmt::format("unknown key {} of the {}{}", quoted(key), spec.name, hint);
  }
  return fmt::format("unknown key {} of the {}; it can have {}", quoted(key), spec.name, joined(names));
}

}  // namespace emscape::document

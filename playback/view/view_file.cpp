#include "playback/view/view_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "base/files/file_reading.h"
#include "base/files/whole_file.h"
#include "document/json_text.h"
#include "document/schema_check.h"
#include "document/text_edit.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "playback/view/view_settings.h"
#include "render/transfer/transfer_format.h"
#include "scenario/map/map_image.h"

namespace emscape::playback {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;
using document::ObjectSpec;
using document::ProblemList;
using document::Section;
using document::ValueSpec;
using document::ValueType;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;
namespace spec = document::spec;

constexpr int kVersion = 1;
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{16} << 20;

/// The format. That of the transfer function depends on its form in the file.
class ViewFormat {
 public:
  explicit ViewFormat(const DocumentNode* transfer) : transfer_(transfer) {
    const auto of = [](const char* key) { return settingOfKey(key).spec; };
    bookmark_ = {"bookmark",
                 "",
                 {spec::required("name", of("quantity"), ""), spec::required("camera", of("camera"), ""),
                  spec::optional("time_s", of("time_s"), "")}};
    range_ = {"range",
              "",
              {spec::required("min", of("iso_value"), ""), spec::required("max", of("iso_value"), "")}};
    interval_ = {"interval",
                 "",
                 {spec::required("begin_s", of("time_s"), ""), spec::required("end_s", of("time_s"), "")}};
    root_ = {
        "view",
        "",
        {spec::required("schema_version", spec::simple(ValueType::integer).from(kVersion).to(kVersion), "")}};
    const std::map<std::string, ValueSpec> objects{
        {"bookmarks", spec::listOf(spec::object(bookmark_), 0, of("edits").max_items)},
        {"play_range", spec::object(interval_)},
        {"visible_time", spec::object(interval_)},
        {"range", spec::object(range_)},
        {"transfer", spec::object(transfer_.object())}};
    for (const ViewSetting& setting : viewSettings()) {
      if (setting.key.empty()) continue;
      const auto object = objects.find(setting.key);
      root_.keys.push_back(
          spec::optional(setting.key, object == objects.end() ? setting.spec : object->second, ""));
    }
  }
  ViewFormat(const ViewFormat&) = delete;
  ViewFormat& operator=(const ViewFormat&) = delete;

  const ObjectSpec& root() const { return root_; }
  const render::TransferFormat& transfer() const { return transfer_; }

 private:
  render::TransferFormat transfer_;
  ObjectSpec bookmark_, range_, interval_, root_;
};

class Reader {
 public:
  Reader(const Section& root, const ViewFormat& format, ProblemList& problems)
      : root_(root), format_(format), problems_(problems) {}

  ViewState read() {
    for (const ViewSetting& setting : viewSettings()) {
      if (!setting.key.empty() && root_.has(setting.key)) read(setting);
    }
    return std::move(view_);
  }

 private:
  void read(const ViewSetting& setting) {
    const std::string& key = setting.key;
    if (key == "bookmarks") return readBookmarks();
    if (key == "play_range") return readInterval(key, view_.play_range);
    if (key == "visible_time") return readInterval(key, view_.visible_time);
    if (key == "range") return readRange();
    if (key == "size") return readSize();
    if (key == "transfer") {
      view_.transfer =
          render::readTransferFunction(root_.section(key), format_.transfer(), nullptr, problems_);
      return;
    }
    if (setting.isSwitch()) return setting.set(view_, *root_.optionalBoolean(key));
    if (setting.isNumber()) return setting.set(view_, root_.number(key));
    if (setting.isChoice()) {
      return setting.set(view_, setting.spec.choices[static_cast<std::size_t>(root_.choiceIndex(key))]);
    }
    if (!setting.isListOfTexts()) {
      return attempt(root_.locationOf(key), [&] { setting.set(view_, root_.text(key)); });
    }
    std::vector<std::string> texts = root_.texts(key);
    for (std::size_t i = 0; i < texts.size(); ++i) {  // one by one, for the location of an error
      attempt(root_.locationOf(key, i), [&] { setting.set(view_, std::vector<std::string>{texts[i]}); });
    }
    if (!problems_.hasErrors()) setting.set(view_, std::move(texts));
  }

  void attempt(const SourceLocation& location, const std::function<void()>& set) {
    try {
      set();
    } catch (const Error& error) {
      problems_.addError(location, error.message());
    }
  }

  void readBookmarks() {
    for (const Section& item : root_.sections("bookmarks")) {
      Bookmark bookmark{item.text("name"), {}, item.optionalNumber("time_s")};
      attempt(item.locationOf("camera"), [&] { bookmark.camera = render::parseCamera(item.text("camera")); });
      view_.bookmarks.push_back(std::move(bookmark));
    }
  }

  void readRange() {
    const Section section = root_.section("range");
    const ValueRange range{static_cast<float>(section.number("min")),
                           static_cast<float>(section.number("max"))};
    if (!(range.min < range.max)) {
      problems_.addError(section.locationOf("max"),
                         fmt::format("'max' is {}, not above 'min', {}", range.max, range.min));
    }
    view_.range = range;
  }

  void readInterval(const std::string& key, std::optional<scenario::TimeInterval>& interval) {
    const Section section = root_.section(key);
    interval = {section.number("begin_s"), section.number("end_s")};
    if (!(interval->begin_s < interval->end_s)) {
      problems_.addError(section.locationOf("end_s"), fmt::format("'end_s' is {}, not above 'begin_s', {}",
                                                                  interval->end_s, interval->begin_s));
    }
  }

  void readSize() {
    const std::vector<double> size = root_.numbers("size");
    view_.size = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  }

  const Section& root_;
  const ViewFormat& format_;
  ProblemList& problems_;
  ViewState view_;
};

/// Reports a newer version with one error, instead of a list of unknown keys.
void refuseNewerVersion(const std::string& file, const DocumentNodePtr& root) {
  const DocumentNodePtr version = document::valueAt(root, {"schema_version"});
  const auto number = version && !version->quoted ? document::numberOf(version->text) : std::nullopt;
  if (!number || !(*number > kVersion)) return;
  throw Error(ErrorCode::bad_input, {file, version->position.line, version->position.column},
              fmt::format("'schema_version' is {}; this program reads {}", version->text, kVersion));
}

Json toJson(const std::vector<Bookmark>& bookmarks) {
  Json json = Json::array();
  for (const Bookmark& bookmark : bookmarks) {
    Json entry;
    entry["name"] = bookmark.name;
    entry["camera"] = toString(bookmark.camera);
    if (bookmark.time_s) entry["time_s"] = *bookmark.time_s;
    json.push_back(std::move(entry));
  }
  return json;
}

/// The setting as JSON; null: it is left out.
Json toJson(const ViewSetting& setting, const ViewState& view) {
  const auto intervalJson = [](const std::optional<scenario::TimeInterval>& interval) {
    return interval ? Json{{"begin_s", interval->begin_s}, {"end_s", interval->end_s}} : Json();
  };
  const std::string& key = setting.key;
  if (key == "bookmarks") return toJson(view.bookmarks);
  if (key == "play_range") return intervalJson(view.play_range);
  if (key == "visible_time") return intervalJson(view.visible_time);
  if (key == "size") return {view.size.width, view.size.height};
  if (key == "range") {
    if (!view.range) return {};
    return {{"min", document::shortNumber(view.range->min)}, {"max", document::shortNumber(view.range->max)}};
  }
  if (key == "transfer") {
    return view.transfer && !view.transfer->categorical ? render::toJson(*view.transfer) : Json();
  }
  const Json json = std::visit([](const auto& value) { return Json(value); }, setting.get(view));
  return json.is_number() && std::isnan(json.get<double>()) ? Json() : json;
}

bool isRelativeFile(const std::string& name) {
  return !name.empty() && name != kOriginal && name != scenario::kLandCoverDrape &&
         fs::path(name).is_relative();
}

/// Changes the names of all files that a view names.
void renameFiles(ViewState& view, const std::function<std::string(const std::string&)>& renamed) {
  view.compare = renamed(view.compare);
  view.drape = renamed(view.drape);
  for (std::string& file : view.places) file = renamed(file);
}

/// Absolute and without symbolic links, as far as they can be resolved.
fs::path resolved(const fs::path& path) {
  const fs::path absolute = fs::absolute(path);
  std::error_code failure;
  const fs::path real = fs::weakly_canonical(absolute, failure);
  return failure ? absolute.lexically_normal() : real;
}

/// A file as it is named in the view file `view`: relative to its folder, wherever symbolic links
/// to the folders are.
std::string nameInView(const std::string& named, const fs::path& view) {
  if (!isRelativeFile(named)) return named;
  const fs::path file = fs::absolute(named);
  const std::string name = (resolved(file.parent_path()) / file.filename())
                               .lexically_normal()
                               .lexically_relative(resolved(fs::absolute(view).parent_path()))
                               .generic_string();
  return name == kOriginal ? "./" + name : name;
}

/// The file that the view file `view` names. If there is none, that of the working folder, to which
/// earlier versions of the program wrote the names.
std::string fileOfView(const fs::path& view, const std::string& name) {
  if (!isRelativeFile(name)) return name;
  const fs::path written = view.parent_path() / name, normal = written.lexically_normal();
  // If ".." follows a symbolic link, they are different files.
  const fs::path beside = resolved(normal) == resolved(written) ? normal : resolved(written);
  std::error_code ignored;
  return !fs::exists(beside, ignored) && fs::exists(name, ignored) ? name : beside.string();
}

}  // namespace

ViewState parseViewState(const std::string& text, const std::string& file) {
  ProblemList problems;
  ViewState state;
  const DocumentNodePtr root =
      document::readDocument(file, document::checkedUtf8(file, text, "a view"), problems);
  if (root) {
    refuseNewerVersion(file, root);
    const DocumentNodePtr transfer = document::valueAt(root, {"transfer"});
    const ViewFormat format(transfer.get());
    if (document::checkObject(file, *root, format.root(), problems)) {
      const Section section(file, root.get(), format.root());
      state = Reader(section, format, problems).read();
    }
  }
  document::requireNoProblem(problems);
  return state;
}

ViewState readViewState(const std::string& file) {
  ViewState state = parseViewState(readWholeText(file, kMaxFileBytes), file);
  renameFiles(state, [&](const std::string& name) { return fileOfView(file, name); });
  return state;
}

std::string viewStateText(const ViewState& state) {
  Json json;
  json["schema_version"] = kVersion;
  for (const ViewSetting& setting : viewSettings()) {
    if (setting.key.empty()) continue;
    Json value = toJson(setting, state);
    if (!value.is_null()) json[setting.key] = std::move(value);
  }
  return document::jsonText(json);
}

void writeViewState(const std::string& file, const ViewState& state) {
  ViewState stored = state;
  renameFiles(stored, [&](const std::string& name) { return nameInView(name, file); });
  const std::string text = viewStateText(stored);
  parseViewState(text, file);
  writeWhole(
      file, [&text](std::ostream& out) { out << text; }, Replaces::any);
}

std::vector<std::string> missingMapFiles(const ViewState& view) {
  std::vector<std::string> files = view.places, missing;
  if (!view.drape.empty() && view.drape != scenario::kLandCoverDrape) files.push_back(view.drape);
  std::copy_if(files.begin(), files.end(), std::back_inserter(missing), [](const std::string& file) {
    std::error_code ignored;
    return !fs::exists(file, ignored);
  });
  return missing;
}

void requireMapFiles(const ViewState& view, const ViewState& before) {
  const std::vector<std::string> known = missingMapFiles(before);
  for (const std::string& file : missingMapFiles(view)) {
    if (std::find(known.begin(), known.end(), file) == known.end())
      throw Error(ErrorCode::bad_input, {file}, "no such file");
  }
}

}  // namespace emscape::playback

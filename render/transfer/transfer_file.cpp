/// Transfer functions as files.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/files/file_reading.h"
#include "base/files/whole_file.h"
#include "document/json_text.h"
#include "document/schema_check.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "emscape/render/transfer/transfer_function.h"
#include "render/transfer/transfer_format.h"

namespace emscape::render {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 20;

}  // namespace

TransferFunction parseTransferFunction(const std::string& text, const std::string& file,
                                       const volume::VolumeInfo& info, const ColorRange& range) {
  if (info.categorical) {
    throw Error(
        ErrorCode::bad_input, {file, 0, 0},
        fmt::format(
            "{} is categorical: its categories have their own colours, a transfer function does not apply",
            info.quantity));
  }
  document::ProblemList problems;
  TransferFunction function;
  const auto root =
      document::readDocument(file, document::checkedUtf8(file, text, "a transfer function"), problems);
  const TransferFormat format(root.get());
  if (root && document::checkObject(file, *root, format.object(), problems)) {
    function = readTransferFunction({file, root.get(), format.object()}, format, &info, problems, range);
  }
  document::requireNoProblem(problems);
  return function;
}

TransferFunction readTransferFunction(const std::string& file, const volume::VolumeInfo& info,
                                      const ColorRange& range) {
  return parseTransferFunction(readWholeText(file, kMaxFileBytes), file, info, range);
}

std::string transferFunctionText(const TransferFunction& function) {
  return document::jsonText(toJson(function));
}

void writeTransferFunction(const std::string& file, const TransferFunction& function) {
  writeWhole(
      file, [text = transferFunctionText(function)](std::ostream& out) { out << text; }, Replaces::any);
}

void requireUnitOf(const TransferFunction& function, const volume::VolumeInfo& info) {
  if (function.unit.empty() || function.unit == info.unit) return;
  throw Error(ErrorCode::bad_input,
              fmt::format("the transfer function's unit '{}' is not that of the volume: {} is in '{}'",
                          function.unit, info.quantity, info.unit));
}

}  // namespace emscape::render

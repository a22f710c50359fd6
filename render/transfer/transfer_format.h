/// Transfer functions as parts of documents: the table of the format, reading and writing.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "document/document.h"
#include "document/schema.h"
#include "document/section.h"
#include "emscape/render/transfer/transfer_function.h"

namespace emscape::render {

/// The table of the format. Two of its values have two forms: positions are values or parts of the volume's
/// range, and colours are the name of a map or points.
class TransferFormat {
 public:
  /// @param node  the object to be read, which determines the forms; null: points, in values
  explicit TransferFormat(const document::DocumentNode* node);
  TransferFormat(const TransferFormat&) = delete;
  TransferFormat& operator=(const TransferFormat&) = delete;

  const document::ObjectSpec& object() const { return object_; }
  bool isRelative() const { return is_relative_; }
  bool hasMap() const { return has_map_; }

 private:
  bool is_relative_ = false;
  bool has_map_ = false;
  document::ObjectSpec color_, opacity_, object_;
};

/// Reads a function from an object that checkObject() found sound.
/// @param format  of this object
/// @param info    of its volume; null: positions must be values, and the unit is not checked
/// @param problems  receives faults that the table does not cover; the result is then undefined
/// @param range   of relative positions
TransferFunction readTransferFunction(const document::Section& section, const TransferFormat& format,
                                      const volume::VolumeInfo* info, document::ProblemList& problems,
                                      const ColorRange& range = {});

/// @throws Error (bad_input) for a categorical function
nlohmann::ordered_json toJson(const TransferFunction& function);

}  // namespace emscape::render

/// Preparation for opening a file: its kind, and the view with which it is shown.
#pragma once

#include <string>
#include <vector>

#include "apps/view/files/files.h"
#include "apps/view/parts/view_options.h"

namespace emscape::view {

/// Result of a request.
struct Opening {
  ViewOptions options;                ///< of the new session
  std::string colors;                 ///< a transfer function for the present session; else empty
  bool restores = false;              ///< as of the request
  bool imports = false;               ///< a recording: what was assumed is told
  std::vector<std::string> left_out;  ///< edits that no longer apply and files that are gone, with the reason
};

/// Examines the file: kind by name and content, errors in a scenario, edits that still apply. Reads files: to
/// be called on a background thread.
/// @param present  options of the present session; new inputs are shown with its `view`
/// @throws Error (bad_input) that lists the errors
Opening prepareOpening(const OpenRequest& request, const ViewOptions& present);

}  // namespace emscape::view

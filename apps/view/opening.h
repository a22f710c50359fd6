/// What a window is asked to open: what kind of file it is, and how it is shown.
#pragma once

#include <string>

#include "apps/view/files.h"
#include "apps/view/view_options.h"

namespace emscape::view {

/// What a request comes to.
struct Opening {
  ViewOptions options;  ///< of the session that shows it
  std::string colors;   ///< a transfer function for what is shown already; else empty
  /// The edits that do not apply any more, each with the reason; empty if all do.
  std::string left_out;
};

/// Looks at the file: its kind by name and content, the faults of a scenario, the edits that still apply.
/// Reads files: to be called beside the window.
/// @param present  what is on screen; `view` is what new inputs are shown with
/// @throws Error (bad_input) that lists the faults
Opening prepareOpening(const OpenRequest& request, const ViewOptions& present);

}  // namespace emscape::view

/// A fixed script for the window that covers everything that is timed, and evaluation of its log.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/common/console.h"
#include "emscape/scenario/model/edit.h"

namespace emscape::app {

/// Parameters of the script.
struct ViewTrial {
  std::vector<double> times_s;  ///< of the steps; fewer than two: no seeking
  std::optional<scenario::Edit>
      edit;                        ///< a value of the scenario that is doubled and restored; none: no edits
  double edit_value = 0;           ///< the present value
  double idle_s = 10;              ///< duration of the idle phase
  int width = 1200, height = 900;  ///< of the window
};

/// The script for emscape-view.
std::string trialScript(const ViewTrial& trial);

/// Times in ms; empty: not measured.
struct ViewTimes {
  std::string device, gl_renderer;
  bool shares_gpu = false;    ///< pictures were passed from CUDA to OpenGL on the GPU
  int width = 0, height = 0;  ///< of the picture
  double first_picture_ms = 0, first_exact_ms = 0;
  std::vector<double> ui;                      ///< frames of the window: events, panels, drawing commands
  std::vector<double> ui_computing;            ///< `ui` while a field was computed
  std::vector<double> frame, frame_computing;  ///< `ui`, until the frame is displayed
  double interface_fps =
      0;                 ///< frames per second while the cursor moves over the panels, without a new field
  double orbit_fps = 0;  ///< pictures per second while the camera turns
  std::vector<double> input_to_picture, input_to_exact, abort;
  std::vector<double> edit_to_picture, edit_to_exact;
  std::vector<double> seek, seek_field, seek_cached;  ///< seek_field: the field's part of seek
  int seek_count = 0, seek_fields = 0;                ///< many seeks in two seconds: fields computed
  bool seek_last_shown = false;
  double play_fields_per_s = 0;  ///< different fields on screen while playing at x1; 0: not measured
  std::vector<double> play_edit_to_picture;  ///< `edit_to_picture` while playing
  double idle_cpu_percent = 0;
  double rss_mib = 0;
};

/// @param log  that emscape-view wrote while it ran the script. @throws Error (other) if it is not one
ViewTimes trialTimes(const std::string& log);

}  // namespace emscape::app

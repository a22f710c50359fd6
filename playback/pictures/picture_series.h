/// Writes the pictures of a source to files.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/pictures/painter.h"
#include "emscape/render/scene/frame.h"
#include "playback/pictures/film.h"
#include "playback/pictures/picture_sink.h"

namespace emscape::playback {

/// Draws every frame of a source. Files are written on a separate thread while the next picture is cast.
/// @param painter  with the first frame set
/// @param sinks    each gets every picture; finished at the end
/// @param film     cameras, one per picture; its speed belongs to the painter before the first frame is set
/// @param done     called after each picture with the number of pictures so far; may be empty
/// @param stop     ends the work with Stopped; may be null
/// @return casting time (ms)
/// @throws Error, Stopped; the sinks are then not finished
double drawPictures(FrameSource& source, Painter& painter, const render::FramePlan& plan,
                    const std::vector<std::unique_ptr<PictureSink>>& sinks, const Film& film,
                    const std::function<void(int pictures)>& done = {}, const StopFlag* stop = nullptr);

}  // namespace emscape::playback

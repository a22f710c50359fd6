#include "playback/pictures/picture_series.h"

#include "base/worker.h"
#include "emscape/base/work.h"

namespace emscape::playback {

double drawPictures(FrameSource& source, Painter& painter, const render::FramePlan& plan,
                    const std::vector<std::unique_ptr<PictureSink>>& sinks, const Film& film,
                    const std::function<void(int)>& done, const StopFlag* stop) {
  double cast_ms = 0;
  Worker writer(2);  // PNG and video are encoded while the next picture is cast
  for (int index = 0; index < source.count(); ++index) {
    throwIfStopped(stop);
    if (index > 0) painter.setFrame(source.frame(index));
    if (!film.cameras.empty()) painter.setCamera(film.cameras[static_cast<std::size_t>(index)]);
    cast_ms += painter.draw(plan, stop).total_ms();
    throwIfStopped(stop);
    writer.push([&sinks, index, picture = painter.picture(painter.note(plan.pattern)), work = currentWork()] {
      const WorkScope scope(work);  // a large picture is not encoded to its end
      for (const auto& sink : sinks) sink->add(index + 1, picture, 1);
    });
    if (done) done(index + 1);
  }
  writer.finish();
  finishAll(sinks);
  return cast_ms;
}

}  // namespace emscape::playback

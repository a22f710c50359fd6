// Draws a scenario, or a volume file, at one time: with its ground, emitters, legend and time.
//   picture SCENARIO|VOLUME TIME_S PICTURE.png
#include <emscape/emscape.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  using namespace emscape;
  if (argc != 4) {
    std::fprintf(stderr, "usage: picture SCENARIO|VOLUME TIME_S PICTURE.png\n");
    return 2;
  }
  try {
    const playback::ComputeTarget target;  // the CPU
    playback::FrameSelection selection;
    selection.input = argv[1];
    selection.times = argv[2];
    const auto source = playback::openFrameSource(selection, target);

    playback::ViewState view;
    view.camera = render::parseCamera("orbit:azimuth_deg=200,elevation_deg=35");
    playback::Painter painter(view, *source, target);
    painter.setFrame(source->frame(0));
    painter.draw(render::FramePlan::exact());  // other plans interpolate some pixels, which restore() casts
    render::writePng(argv[3], painter.picture("drawn by an example"));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "picture: %s\n", error.what());
    return 1;
  }
}

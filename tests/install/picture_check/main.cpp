// True if a picture shows more than its background: picture_check PICTURE.png. A field over terrain has
// tens of thousands of colours, background and labels alone have five thousand.
#include <emscape/render/picture/image.h>

#include <cstdio>
#include <set>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const emscape::render::Image8 picture = emscape::render::readPng(argv[1]);
  std::set<int> colors;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    colors.insert(picture.rgba[i] << 16 | picture.rgba[i + 1] << 8 | picture.rgba[i + 2]);
  std::printf("%zu colours\n", colors.size());
  return colors.size() > 20000 ? 0 : 1;
}

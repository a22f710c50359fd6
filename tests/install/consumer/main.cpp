// The smallest program that uses an installed Emscape.
#include <cstdio>

#include "base/geo_frame.h"

int main() {
  const emscape::GeodesicInverse degree = emscape::geodesicInverse(0, 0, 0, 1);
  std::printf("%.3f\n", degree.distance_m);
}

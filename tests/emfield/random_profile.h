/// Terrain profiles for the tests of propagation models.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/scenario/terrain/terrain.h"
#include "propagation/diffraction/diffraction.h"
#include "tests/support/files.h"

namespace emscape::emfield::testing {

using propagation::TerrainProfile;

/// Owns the data to which a TerrainProfile points.
struct ProfileData {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;

  TerrainProfile view() const { return {range_m.data(), height_msl_m.data(), int(range_m.size())}; }
};

/// The tile of the White Mountains in tests/data, all but its edges.
inline scenario::TerrainPtr whiteMountainsTile() {
  const std::string file = test::sourceFile("tests/data/dem/N44W072.tif");
  scenario::TerrainSpec spec;
  spec.files = {file};
  spec.locations = {{file}};
  return scenario::Terrain::load(spec, {44.01, 44.99, -71.99, -71.01});
}

/// A profile between two random positions in the tile, with evenly spaced posts.
inline ProfileData randomProfile(const scenario::Terrain& terrain, std::mt19937& random, int posts) {
  std::uniform_real_distribution<double> part(0, 1);
  double latitude[2], longitude[2];
  do {
    for (int i : {0, 1}) {
      latitude[i] = 44.02 + 0.96 * part(random);
      longitude[i] = -71.98 + 0.96 * part(random);
    }
  } while (std::hypot(latitude[1] - latitude[0], (longitude[1] - longitude[0]) * 0.72) < 0.05);
  const double length_m =
      111200 * std::hypot(latitude[1] - latitude[0], (longitude[1] - longitude[0]) * 0.72);
  ProfileData profile;
  for (int i = 0; i < posts; ++i) {
    const double t = double(i) / (posts - 1);
    profile.range_m.push_back(t * length_m);
    profile.height_msl_m.push_back(float(terrain.heightMsl_m(
        latitude[0] + t * (latitude[1] - latitude[0]), longitude[0] + t * (longitude[1] - longitude[0]))));
  }
  return profile;
}

/// Made-up terrain: hills of several sizes, from flat to rugged, posts unevenly spaced.
inline ProfileData madeUpProfile(std::mt19937& random, int posts, double length_m, double relief_m) {
  std::uniform_real_distribution<double> part(0, 1);
  ProfileData profile;
  double phase[6];
  for (double& p : phase) p = 2 * kPi * part(random);
  for (int i = 0; i < posts; ++i) {
    const double t = std::pow(double(i) / (posts - 1), 1.5);
    double height = 0;
    for (int k = 0; k < 6; ++k) height += std::sin(phase[k] + t * std::pow(2.3, k + 1)) / (k + 1);
    profile.range_m.push_back(t * length_m);
    profile.height_msl_m.push_back(float(relief_m * (2 + height)));
  }
  return profile;
}

}  // namespace emscape::emfield::testing

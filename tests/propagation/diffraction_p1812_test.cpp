// Intermediates of P.1812's validation set that delta-Bullington gives: paths over sea and clutter too.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "propagation/diffraction/diffraction.h"
#include "tests/support/reference_data.h"

namespace emscape::propagation {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

struct Posts {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;
  std::vector<double> clutter_m;
};

/// A profile in Fryderyk's format.
Posts readPosts(const fs::path& path) {
  std::ifstream file(path);
  Posts posts;
  bool is_profile = false;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("{Begin of Profile}", 0) == 0) {
      std::getline(file, line);  // the number of points
      is_profile = true;
    } else if (is_profile) {
      const auto cells = cellsOf(line);
      if (cells.size() < 4 || cells[0].empty() || cells[0][0] == '{') break;
      posts.range_m.push_back(1000 * std::stod(cells[0]));
      posts.height_msl_m.push_back(std::stof(cells[1]));
      posts.clutter_m.push_back(std::stod(cells[3]));
    }
  }
  return posts;
}

/// Names and values of a log; of a name given twice the first.
std::map<std::string, double> readLog(const fs::path& path) {
  std::ifstream file(path);
  std::map<std::string, double> values;
  for (std::string line; std::getline(file, line);) {
    const auto cells = cellsOf(line);
    if (cells.size() < 4 || cells[3].empty()) continue;
    char* end = nullptr;
    const double value = std::strtod(cells[3].c_str(), &end);
    if (end != cells[3].c_str())
      values.emplace(cells[0].substr(0, cells[0].find_last_not_of(' ') + 1), value);
  }
  return values;
}

TEST(DiffractionP1812, MeetsTheIntermediatesOfTheValidationSet) {
  const auto root = test::referenceFile("reference/p1812");
  if (!root) GTEST_SKIP() << test::notInRepository("reference/p1812");
  int cases = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(*root) / "results")) {
    const std::string name = entry.path().stem().string();  // PROFILE_N_log
    SCOPED_TRACE(name);
    const Posts posts = readPosts(fs::path(*root) / "profiles" / (name.substr(0, name.size() - 6) + ".csv"));
    const auto log = readLog(entry.path());
    ASSERT_GT(posts.range_m.size(), 2u);
    DiffractionParameters parameters;
    parameters.frequency_hz = log.at("f (GHz)") * 1e9;
    parameters.effective_earth_radius_m = 3 * 6371000;  // a_beta
    parameters.polarization =
        log.at("pol") == 1 ? LinearPolarization::horizontal : LinearPolarization::vertical;
    parameters.sea_fraction = log.at("w");
    const auto model = diffractionModel<double>(parameters);
    const int count = int(posts.range_m.size()), last = count - 1;
    const double distance_m = posts.range_m.back();
    const double tx = log.at("hts (m)"), rx = log.at("hrs (m)");

    // Obstacles carry their clutter; the smooth surface is fitted to the bare terrain.
    const auto withClutter = [&](int i) {
      return double(posts.height_msl_m[std::size_t(i)]) + posts.clutter_m[std::size_t(i)];
    };
    const double terrain_db =
        bullingtonLossDb(bullingtonNu(model, posts.range_m.data(), count, tx, rx, withClutter), distance_m);
    EXPECT_NEAR(terrain_db, log.at("Lbulla (dB)"), 1e-3);

    const TerrainProfile profile{posts.range_m.data(), posts.height_msl_m.data(), last + 1};
    const DeltaBullington<double> bare = deltaBullington(model, profile, tx, rx);
    EXPECT_NEAR(bare.spherical_db, log.at("Ldsph (dB)"), 1e-3);
    if (bare.spherical_db > 0) {
      EXPECT_NEAR(bare.smooth_db, log.at("Lbulls (dB)"), 1e-3);
    }
    ++cases;
  }
  EXPECT_EQ(cases, 42);
}

}  // namespace
}  // namespace emscape::propagation

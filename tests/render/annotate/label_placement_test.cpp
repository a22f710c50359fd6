#include "render/annotate/label_placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace emscape::render {
namespace {

constexpr ImageSize kSize{1200, 900};
constexpr double kGap = 5;

std::vector<LabelRequest> crowd(int count, bool moves, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(100, 1100), y(100, 800), width(40, 220);
  std::vector<LabelRequest> requests;
  for (int i = 0; i < count; ++i)
    requests.push_back({{x(random), y(random)}, 9, width(random), 22, 1, double(i), moves});
  return requests;
}

TEST(LabelPlacement, LabelsOfManyMarkersDoNotOverlapAndLeaveThePictureFree) {
  const std::vector<Rect> taken{{0, 0, 1200, 80}, {1000, 0, 200, 900}};
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::vector<LabelRequest> requests = crowd(250, false, seed);
    for (const LabelRequest& request : crowd(50, true, seed + 10)) requests.push_back(request);
    const auto places = placeLabels(requests, kSize, kGap, taken);
    double covered = 0;
    int count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!places[i]) continue;
      const Rect& rect = places[i]->rect;
      ++count;
      covered += rect.width * rect.height;
      for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(places[j] && overlap(rect, places[j]->rect));
      for (const Rect& other : taken) EXPECT_FALSE(overlap(rect, other));
      EXPECT_GE(rect.x, 0);
      EXPECT_LE(rect.y + rect.height, kSize.height);
      const double away = length(nearestIn(rect, requests[i].at) - requests[i].at);
      const bool is_nearer_to_other =
          std::any_of(requests.begin(), requests.end(), [&](const LabelRequest& other) {
            return (requests[i].moves || !other.moves) &&
                   length(nearestIn(rect, other.at) - other.at) < away - 1e-9;
          });
      EXPECT_EQ(places[i]->needs_line, away > requests[i].radius + 2 * kGap || is_nearer_to_other);
    }
    EXPECT_LE(covered, 0.1 * static_cast<double>(kSize.count()));
    EXPECT_GT(count, 20);
  }
}

/// Whether the line from a marker to its label has a point within a rectangle.
bool leadsThrough(const LabelRequest& request, const LabelPlace& place, const Rect& rect) {
  const Point2 end = nearestIn(place.rect, request.at);
  for (int n = 0; place.needs_line && n <= 400; ++n) {
    const Point2 at = request.at + (end - request.at) * (n / 400.0);
    const Point2 inside = nearestIn(rect, at);
    if (inside.x == at.x && inside.y == at.y) return true;
  }
  return false;
}

TEST(LabelPlacement, NoLeaderLineCrossesALabel) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    std::vector<LabelRequest> requests = crowd(60, false, seed);
    for (LabelRequest& request : requests)  // so that most need a line
      request.at = {500 + 0.2 * request.at.x, 350 + 0.2 * request.at.y};
    const auto places = placeLabels(requests, kSize, kGap, {});
    int lines = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!places[i]) continue;
      lines += places[i]->needs_line ? 1 : 0;
      for (std::size_t j = 0; j < places.size(); ++j) {
        if (j == i || !places[j]) continue;
        EXPECT_FALSE(leadsThrough(requests[i], *places[i], places[j]->rect)) << i << " through " << j;
      }
    }
    EXPECT_GT(lines, 3);
  }
}

TEST(LabelPlacement, MovingObjectsDoNotMoveLabelsOfFixedOnes) {
  std::vector<LabelRequest> requests = crowd(40, false, 5);
  const std::size_t fixed = requests.size();
  const auto alone = placeLabels(requests, kSize, kGap, {});
  for (const unsigned seed : {6U, 7U}) {
    requests.resize(fixed);
    for (const LabelRequest& request : crowd(30, true, seed)) requests.push_back(request);
    const auto places = placeLabels(requests, kSize, kGap, {});
    for (std::size_t i = 0; i < fixed; ++i) {
      ASSERT_EQ(places[i].has_value(), alone[i].has_value());
      if (!places[i]) continue;
      EXPECT_EQ(places[i]->rect.x, alone[i]->rect.x);
      EXPECT_EQ(places[i]->rect.y, alone[i]->rect.y);
    }
  }
}

TEST(LabelPlacement, ALabelIsNearestToItsOwnSymbolOrHasALineToIt) {
  // The right side of the first is free, but the second symbol is as near to it.
  const std::vector<LabelRequest> two{{{600, 450}, 9, 100, 22, 1, 1, false},
                                      {{630, 472}, 9, 0, 0, 1, 2, false}};
  const auto beside = placeLabels(two, kSize, kGap, {});
  ASSERT_TRUE(beside[0]);
  EXPECT_LT(beside[0]->rect.x, 600) << "the left side is its own alone";
  EXPECT_FALSE(beside[0]->needs_line);
  // Nothing is free but a place near the second.
  const std::vector<Rect> taken{{0, 0, 610, 900}, {610, 0, 590, 430}, {610, 470, 590, 430}};
  const auto between = placeLabels({two[0], {{660, 466}, 2, 0, 0, 1, 2, false}}, kSize, kGap, taken);
  ASSERT_TRUE(between[0]);
  EXPECT_TRUE(between[0]->needs_line);
}

TEST(LabelPlacement, TheFirstRankAndTheNearestComeFirst) {
  // All at one point: only some places are free.
  std::vector<LabelRequest> requests(60, {{600, 450}, 9, 300, 60, 1, 0, false});
  for (std::size_t i = 0; i < requests.size(); ++i) requests[i].depth = static_cast<double>(60 - i);
  requests[0].rank = 0;
  const auto places = placeLabels(requests, kSize, kGap, {});
  ASSERT_TRUE(places[0] && places[59]);
  EXPECT_FALSE(places[0]->needs_line);
  EXPECT_FALSE(places[1]);
}

}  // namespace
}  // namespace emscape::render

#include "study/maps/time_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace emscape::study {
namespace {

TimeFigures::Coverage coverageOf(char letter) {
  return letter == 'x'   ? TimeFigures::Coverage::yes
         : letter == '?' ? TimeFigures::Coverage::unknown
                         : TimeFigures::Coverage::no;
}

TEST(TimeFigures, EqualFiguresOfTheRow) {
  // Covered at each of the times; a time represents the interval up to the next.
  const std::vector<double> times_s{0, 1, 2, 4, 5, 8};
  const std::vector<std::string> rows{"......", "xxxxxx", "..x.x.", "x....x", ".....x"};
  TimeFigures figures(rows.size(), times_s);
  for (std::size_t t = 0; t < times_s.size(); ++t) {
    figures.add(times_s[t], [&](std::size_t row) { return coverageOf(rows[row][t]); });
  }
  const auto of = [&](Product product, std::size_t row) { return figures.figure(product, row); };
  EXPECT_TRUE(std::isnan(of(Product::first_detection, 0)));
  EXPECT_EQ(of(Product::fraction, 0), 0);
  EXPECT_EQ(of(Product::longest_gap, 0), 8);
  EXPECT_EQ(of(Product::mean_gap, 0), 8);
  EXPECT_EQ(of(Product::first_detection, 1), 0);
  EXPECT_EQ(of(Product::fraction, 1), 1);
  EXPECT_EQ(of(Product::longest_gap, 1), 0);
  EXPECT_EQ(of(Product::mean_gap, 1), 0);
  EXPECT_EQ(of(Product::first_detection, 2), 2);
  EXPECT_EQ(of(Product::fraction, 2), 5.0f / 8);
  EXPECT_EQ(of(Product::longest_gap, 2), 2);
  EXPECT_EQ(of(Product::mean_gap, 2), 1.5f);
  EXPECT_EQ(of(Product::longest_gap, 3), 7);
  EXPECT_EQ(of(Product::gaps, 0), 1);
  EXPECT_EQ(of(Product::gaps, 1), 0);
  EXPECT_EQ(of(Product::gaps, 2), 2);
  EXPECT_EQ(of(Product::gaps, 3), 1);
  EXPECT_TRUE(std::isnan(of(Product::revisit, 0)));
  EXPECT_TRUE(std::isnan(of(Product::revisit, 1)));
  EXPECT_EQ(of(Product::revisit, 2), 3) << "from 2 to 5";
  EXPECT_EQ(of(Product::revisit, 3), 8) << "from 0 to 8";
  EXPECT_EQ(of(Product::response, 0), 4) << "half the only gap";
  EXPECT_EQ(of(Product::response, 1), 0);
  EXPECT_EQ(of(Product::response, 2), (2 * 2 + 1 * 1) / 16.0f);
  EXPECT_EQ(of(Product::response, 3), 7 * 7 / 16.0f);
  EXPECT_EQ(of(Product::fraction, 4), 0) << "the last time stands for no interval";
  EXPECT_EQ(of(Product::first_detection, 4), 8);
}

TEST(TimeFigures, OfUnknownTimesAreBoundsIfThePositionIsCoveredAtAnother) {
  const std::vector<double> times_s{0, 1, 2, 3, 4};
  const std::vector<std::string> rows{".x.x.", "?x?x.", "?...."};
  TimeFigures figures(rows.size(), times_s);
  for (std::size_t t = 0; t < times_s.size(); ++t)
    figures.add(times_s[t], [&](std::size_t row) { return coverageOf(rows[row][t]); });
  for (const Product product : {Product::first_detection, Product::fraction, Product::longest_gap,
                                Product::response, Product::gaps, Product::mean_gap, Product::revisit}) {
    const bool is_bounded =
        product != Product::gaps && product != Product::mean_gap && product != Product::revisit;
    EXPECT_EQ(figures.answer(product, 0), PixelAnswer::exact);
    EXPECT_EQ(figures.answer(product, 1), is_bounded ? PixelAnswer::bound : PixelAnswer::unknown);
    EXPECT_EQ(figures.answer(product, 2), PixelAnswer::unknown);
    EXPECT_EQ(figures.figure(product, 1), figures.figure(product, 0)) << "as without coverage";
  }
}

TEST(TimeFigures, AreExactFarFromTheEpoch) {
  const std::vector<double> times_s{5e7, 5e7 + 3, 5e7 + 4, 5e7 + 8, 5e7 + 9};
  TimeFigures figures(1, times_s);
  for (std::size_t t = 0; t < times_s.size(); ++t)
    figures.add(times_s[t], [&](std::size_t) { return coverageOf(t % 2 == 1 ? 'x' : '.'); });
  EXPECT_EQ(figures.figure(Product::revisit, 0), 5) << "from 3 to 8";
  EXPECT_EQ(figures.figure(Product::first_detection, 0), static_cast<float>(5e7 + 3));
}

}  // namespace
}  // namespace emscape::study

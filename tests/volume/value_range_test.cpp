#include "emscape/volume/value_range.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emscape::volume {
namespace {

TEST(ValueRange, SpansExactlyTheAddedValues) {
  for (const ValueRange first :
       {ValueRange{-80, -26}, ValueRange{3, 7}, ValueRange{-5, 5}, ValueRange{-1, -1}}) {
    ValueRange range;
    EXPECT_TRUE(range.empty());
    range.add(first);
    EXPECT_EQ(range, first);
    range.add({first.min - 1, first.min});
    range.add({first.max, first.max + 2});
    EXPECT_EQ(range, (ValueRange{first.min - 1, first.max + 2}));
  }
}

TEST(ValueRange, IsNotChangedByEmptyAndUnknownRanges) {
  ValueRange range{-80, -26};
  range.add(ValueRange{});
  range.add({NAN, 3});
  range.add({3, NAN});
  EXPECT_EQ(range, (ValueRange{-80, -26}));
}

}  // namespace
}  // namespace emscape::volume

#include "base/memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/errors.h"

namespace emscape {
namespace {

using ::testing::HasSubstr;

TEST(Memory, RefusesMoreThanIsAvailable) {
  constexpr std::size_t kTooMuch = std::numeric_limits<std::size_t>::max() / 2;
  const auto available = availableMemory_bytes();
  if (!available) GTEST_SKIP() << "the system does not report its memory";
  EXPECT_LT(*available, kTooMuch);
  EXPECT_NO_THROW(requireMemory({"a number", sizeof(int), ""}, {}));
  const std::string error = test::errorOf([&] {
    requireMemory({"the mesh of 5 tetrahedra", kTooMuch, "fewer layers take less"}, {"s.yaml", 3, 1});
  });
  EXPECT_THAT(error,
              HasSubstr("s.yaml:3:1: the mesh of 5 tetrahedra needs up to 8796093022208 MiB of the host's "
                        "memory, of which "));
  EXPECT_THAT(error, HasSubstr(" MiB are free; fewer layers take less"));
}

TEST(Memory, ShortageNamesNeedAndRemedy) {
  EXPECT_EQ(memoryShortage({"it", std::size_t{12} << 20, "less is enough"}, "GPU's", std::size_t{3} << 20),
            "it needs up to 12 MiB of the GPU's memory, of which 3 MiB are free; less is enough");
}

}  // namespace
}  // namespace emscape

/// Tests of loops over vector registers on every instruction set that they are built for.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>

namespace emscape::test {

/// The loops use the instruction set of the parameter (HWY_AVX3 is AVX-512) until the test ends.
class OnInstructionSet : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override {
    const std::int64_t target = GetParam();
    if (target != HWY_SCALAR && (hwy::SupportedTargets() & target) == 0) {
      GTEST_SKIP() << "the processor has no " << hwy::TargetName(target);
    }
    use(target);
  }
  void TearDown() override { use(0); }

 private:
  /// @param target  0: the best
  static void use(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace emscape::test

#define EMSCAPE_ON_INSTRUCTION_SETS(fixture)                                                            \
  INSTANTIATE_TEST_SUITE_P(InstructionSets, fixture, ::testing::Values(HWY_AVX3, HWY_AVX2, HWY_SCALAR), \
                           [](const auto& test) { return hwy::TargetName(test.param); })

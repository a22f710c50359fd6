/// One test body for the CPU and for a GPU.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "emscape/base/backend.h"
#include "tests/support/gpu.h"

namespace emscape {
/// For the names of tests.
inline void PrintTo(Backend backend, std::ostream* out) {
  *out << toString(backend);
}
}  // namespace emscape

namespace emscape::test {

/// GetParam() is the backend; the tests on the GPU are skipped if there is none.
class OnBackends : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (GetParam() == Backend::cuda) EMSCAPE_NEEDS_GPU();
  }
};

/// The tests of a suite that is OnBackends, as Backends/SUITE.TEST/cpu and .../cuda.
#define EMSCAPE_ON_BACKENDS(suite)                                                               \
  INSTANTIATE_TEST_SUITE_P(Backends, suite,                                                      \
                           ::testing::Values(::emscape::Backend::cpu, ::emscape::Backend::cuda), \
                           [](const auto& backend) { return std::string(toString(backend.param)); })

}  // namespace emscape::test

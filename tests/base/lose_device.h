/// A GPU that fails in the middle of the work.
#pragma once

namespace emscape::test {

/// Starts a kernel that faults: from then on every call that waits for the GPU fails, for the life of the
/// process.
void loseDevice();

}  // namespace emscape::test

/// For tests that need a GPU: skipped, and listed by name, if there is none.
#pragma once

#include <gtest/gtest.h>

#include "emscape/base/cuda/device.h"

/// To be used at the start of a test's body.
#define EMSCAPE_NEEDS_GPU()                                             \
  do {                                                                  \
    const emscape::Device emscape_device = emscape::findDevice();       \
    if (!emscape_device.usable) GTEST_SKIP() << emscape_device.why_not; \
  } while (false)

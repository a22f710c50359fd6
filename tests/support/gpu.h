/// For tests that need a GPU: skipped by name where there is none.
#pragma once

#include <gtest/gtest.h>

#include "emscape/base/device.h"

/// At the start of a test's body.
#define EMSCAPE_NEEDS_GPU()                                             \
  do {                                                                  \
    const emscape::Device emscape_device = emscape::findDevice();       \
    if (!emscape_device.usable) GTEST_SKIP() << emscape_device.why_not; \
  } while (false)

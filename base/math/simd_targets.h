/// The instruction sets for which loops over vector registers are compiled: AVX2, AVX-512 and the baseline,
/// which uses the scalar form of each loop. Include before <hwy/foreach_target.h> and <hwy/highway.h>.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)

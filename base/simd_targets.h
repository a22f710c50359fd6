/// The instruction sets that loops over vector registers are compiled for: AVX2, AVX-512 and the baseline,
/// which takes the plain form of each loop. To be included before <hwy/foreach_target.h> and <hwy/highway.h>.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)

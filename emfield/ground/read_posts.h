/// The loops over the posts of a path on the CPU, in vector instructions.
#pragma once

#include "emfield/ground/ground_posts.h"
#include "propagation/horizon/horizon.h"

namespace emscape::emfield {

/// PostReader of the CPU.
void readPostsCpu(const Station& station, const GroundPosts& ground, const FastInverse& path, int count,
                  float* height_msl_m);
/// The same of posts first..count - 1.
void readPostsBetweenCpu(const Station& station, const GroundPosts& ground, const FastInverse& path,
                         int first, int count, float* height_msl_m);

/// propagation::GrazingSlope of samples.
/// @param terms  of the samples' ranges
float grazingSlopeCpu(const propagation::HorizonGeometry<float>& geometry, const float* height_msl_m,
                      const propagation::RangeTerms<float>* terms, int count);

}  // namespace emscape::emfield

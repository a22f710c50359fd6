/// The loops over the posts of a path on the CPU, in vector instructions.
#pragma once

#include "emfield/ground/ground_posts.h"
#include "propagation/horizon/horizon.h"

namespace emscape::emfield {

/// Heights of the regular posts first..count - 1 toward a point.
void readPostsCpu(const Station& station, const GroundPosts& ground, const FastInverse& path, int first,
                  int count, float* height_msl_m);
/// Reads the posts of a profile that are nearer than a point.
/// @param at_crossings  false: regular posts; true: see chord_crossings.h
/// @param range_m, height_msl_m  maxPosts() elements each
/// @return their number, with the emitter's
int readProfileCpu(const Station& station, const GroundPosts& ground, const FastInverse& path,
                   bool at_crossings, double* range_m, float* height_msl_m);

/// propagation::GrazingSlope of samples.
/// @param terms  of the samples' ranges
float grazingSlopeCpu(const propagation::HorizonGeometry<float>& geometry, const float* height_msl_m,
                      const propagation::RangeTerms<float>* terms, int count);

}  // namespace emscape::emfield

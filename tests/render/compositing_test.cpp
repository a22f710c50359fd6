#include "render/cast/compositing.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/render/scene/render_settings.h"

namespace emscape::render {
namespace {

struct Sample {
  float f;
  Rgba color;
};

/// A ray with rising, falling and transparent samples.
const std::vector<Sample> kRay{{0.2F, {0.02F, 0.01F, 0.0F, 0.05F}},
                               {0.5F, {0.0F, 0.1F, 0.05F, 0.2F}},
                               {0.3F, {0.0F, 0.0F, 0.0F, 0.0F}},
                               {0.9F, {0.3F, 0.3F, 0.1F, 0.4F}},
                               {0.4F, {0.05F, 0.0F, 0.1F, 0.1F}}};

template <class Compositor>
Compositor composite(float gamma) {
  Compositor compositor(kNeverOpaqueEnough, gamma, 1.0F);
  for (const Sample& sample : kRay) compositor.add(sample.f, sample.color);
  return compositor;
}

void expectNear(const Rgba& a, const Rgba& b) {
  EXPECT_NEAR(a.r, b.r, 1e-6);
  EXPECT_NEAR(a.g, b.g, 1e-6);
  EXPECT_NEAR(a.b, b.b, 1e-6);
  EXPECT_NEAR(a.a, b.a, 1e-6);
}

TEST(Compositing, OpacityCorrectionIsInvariantToTheStep) {
  for (float opacity : {0.0F, 0.01F, 0.3F, 0.99F, 1.0F}) {
    const float half = opacityOver(opacity, 0.5F);
    EXPECT_NEAR(1 - (1 - half) * (1 - half), opacity, 1e-6) << opacity;
  }
}

TEST(Compositing, DvrIsFrontToBackAbsorption) {
  Rgba expected;
  for (auto sample = kRay.rbegin(); sample != kRay.rend(); ++sample) expected = over(sample->color, expected);
  expectNear(composite<DvrCompositor>(0).result({}), expected);
}

TEST(Compositing, MidaWithGammaMinusOneIsDvr) {
  expectNear(composite<MidaCompositor>(-1).result({}), composite<DvrCompositor>(0).result({}));
}

TEST(Compositing, MidaFollowsItsRecurrence) {
  double color = 0;
  double alpha = 0;
  double highest = 0;
  for (const Sample& sample : kRay) {  // Bruckner and Groeller 2009, eq. (4), (5)
    const double delta = std::max(0.0, sample.f - highest);
    highest = std::max(highest, double{sample.f});
    const double beta = 1 - delta;
    color = beta * color + (1 - beta * alpha) * sample.color.r;
    alpha = beta * alpha + (1 - beta * alpha) * sample.color.a;
  }
  const Rgba result = composite<MidaCompositor>(0).result({});
  EXPECT_NEAR(result.r, color, 1e-6);
  EXPECT_NEAR(result.a, alpha, 1e-6);
}

TEST(Compositing, MidaWithGammaOneIsMip) {
  const std::vector<Rgba> projected{{0, 0, 0, 0}, {0.5F, 0.4F, 0.3F, 0.6F}, {1, 1, 1, 1}};
  TransferView transfer;
  transfer.projected = projected.data();
  transfer.last = 2;
  expectNear(composite<MidaCompositor>(1).result(transfer), projected[2]);  // f = 0.9
}

/// The maximum ahead, in place of OccupancyLookahead.
struct Ahead {
  float highest;
  bool exceeds(int /*next*/, float f) const { return highest > f; }
};

TEST(Compositing, MidaDoesNotEndWhileALaterSampleMayExceedTheMaximum) {
  MidaCompositor compositor(kOpaqueEnough, 0, 1.0F);
  compositor.add(0.5F, {1, 1, 1, 1});
  Ahead higher{0.6F}, same{0.5F};
  EXPECT_FALSE(compositor.done(higher, 1));
  EXPECT_TRUE(compositor.done(same, 1));
}

TEST(Compositing, MidaDoesNotEndBeforeItIsOpaqueNorIfExact) {
  MidaCompositor thin(kOpaqueEnough, 0, 1.0F);
  thin.add(0.5F, {0.98F, 0.98F, 0.98F, 0.98F});
  MidaCompositor exact(kNeverOpaqueEnough, 0, 1.0F);
  exact.add(0.5F, {1, 1, 1, 1});
  Ahead nothing{-1};
  EXPECT_FALSE(thin.done(nothing, 1));
  EXPECT_FALSE(exact.done(nothing, 1));
}

TEST(Compositing, IgnoredSamplesKeepTheResult) {
  const Rgba clear;
  const Rgba faint{0, 0, 0, 0.01F};
  EXPECT_TRUE(DvrCompositor(kNeverOpaqueEnough, 0, 1).ignores(0.9F, clear));
  EXPECT_FALSE(DvrCompositor(kNeverOpaqueEnough, 0, 1).ignores(0.0F, faint));
  MidaCompositor mida(kNeverOpaqueEnough, 0, 1);
  EXPECT_FALSE(mida.ignores(0.4F, clear));
  mida.add(0.4F, faint);
  EXPECT_TRUE(mida.ignores(0.4F, clear));
  EXPECT_FALSE(mida.ignores(0.5F, clear));
  EXPECT_FALSE(mida.ignores(0.1F, faint));
  MipCompositor mip(kNeverOpaqueEnough, 0, 1);
  mip.add(0.4F, clear);
  EXPECT_TRUE(mip.ignores(0.4F, faint));
  EXPECT_FALSE(mip.ignores(0.5F, clear));
}

TEST(Compositing, MidaDoesNotSkipTransparentSamplesThatRaiseTheMaximum) {
  MidaCompositor compositor(kNeverOpaqueEnough, 0, 1.0F);
  compositor.add(0.4F, {0.1F, 0.1F, 0.1F, 0.2F});
  EXPECT_TRUE(compositor.canSkip(0.4F));
  EXPECT_FALSE(compositor.canSkip(0.5F));
  EXPECT_FALSE(compositor.canSkip(SkipView::kNever));
}

TEST(Compositing, DvrEndsEarlyUnlessExact) {
  DvrCompositor early(kOpaqueEnough, 0, 1);
  DvrCompositor exact(kNeverOpaqueEnough, 0, 1);
  for (DvrCompositor* compositor : {&early, &exact}) compositor->add(0.5F, {0.99F, 0.99F, 0.99F, 0.995F});
  Ahead more{1};
  EXPECT_TRUE(early.done(more, 1));
  EXPECT_FALSE(exact.done(more, 1));
}

/// A ray with one sample per part, cast by several threads with equal numbers of parts.
template <class Compositor>
Compositor joined(const std::vector<Rgba>& samples, int threads) {
  const Compositor begin(kNeverOpaqueEnough, 0, 1);
  const int parts = Compositor::kParts / threads;
  JoinedParts<Compositor> ray(begin);
  for (int thread = 0; thread < threads; ++thread) {
    JoinedParts<Compositor> own = thread == 0 ? ray : JoinedParts<Compositor>(begin);
    for (int part = thread * parts; part < (thread + 1) * parts; ++part) {
      Compositor next = own.behind();
      const Rgba& sample = samples[static_cast<std::size_t>(part)];
      next.add(sample.a, sample);
      own.join(next);
    }
    if (thread == 0) {
      ray = own;
    } else {
      ray.join(own.whole(), parts);
    }
  }
  return ray.whole();
}

TEST(JoinedParts, RayIsBitIdenticalForAnyNumberOfThreads) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int ray = 0; ray < 200; ++ray) {
    std::vector<Rgba> samples;
    for (int part = 0; part < kMaxRayParts; ++part) {
      const float a = 0.5F * unit(random);
      samples.push_back({a * unit(random), a * unit(random), a * unit(random), a});
    }
    const Rgba one = joined<DvrCompositor>(samples, 1).sum;
    for (const int threads : {2, 8}) {
      const Rgba several = joined<DvrCompositor>(samples, threads).sum;
      EXPECT_EQ(several.r, one.r);
      EXPECT_EQ(several.g, one.g);
      EXPECT_EQ(several.b, one.b);
      EXPECT_EQ(several.a, one.a);
      EXPECT_EQ(joined<MipCompositor>(samples, threads).highest, joined<MipCompositor>(samples, 1).highest);
    }
  }
}

TEST(Compositing, ModesHaveNames) {
  for (CompositingMode mode :
       {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip, CompositingMode::iso}) {
    EXPECT_EQ(parseCompositingMode(toString(mode)), mode);
  }
  EXPECT_THROW(parseCompositingMode("xray"), Error);
}

}  // namespace
}  // namespace emscape::render

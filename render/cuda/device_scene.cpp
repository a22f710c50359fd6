#include "render/cuda/device_scene.h"

#include <cuda_fp16.h>

#include <cstring>

namespace emscape::render::cuda {
namespace {

std::uint32_t halfPair(float low, float high) {
  const __half2 pair = __floats2half2_rn(low, high);
  std::uint32_t bits = 0;
  static_assert(sizeof bits == sizeof pair, "two halves are 32 bits");
  std::memcpy(&bits, &pair, sizeof bits);
  return bits;
}

}  // namespace

void DeviceScene::update(const Scene& scene, const volume::DeviceStorage& storage, cudaStream_t stream) {
  const Scene::Versions& versions = scene.versions();
  if (versions.table != seen_.table) updateTable(scene, stream);
  if (versions.ground != seen_.ground || (scene.ground() && heights_.size() == 0))
    updateGround(scene, stream);
  if (versions.levels != seen_.levels) levels_current_ = false;
  if (const BrickSummary* found = found_.arrived()) {
    skippable_share_ = static_cast<double>(found->skippable) / static_cast<double>(levels_.size());
  }
  if (!levels_current_) updateLevels(scene, storage.bricks(), stream);
  seen_ = versions;
}

bool DeviceScene::isCurrent(const Scene& scene) const {
  const Scene::Versions& versions = scene.versions();
  return versions.table == seen_.table && versions.ground == seen_.ground &&
         versions.levels == seen_.levels && levels_current_ && !(scene.ground() && heights_.size() == 0);
}

void DeviceScene::updateTable(const Scene& scene, cudaStream_t stream) {
  const SkipRule rule = scene.skipRule();
  const auto entries = static_cast<std::size_t>(rule.table.last) + 1;
  samples_.upload(rule.table.samples, entries, stream);
  projected_.upload(rule.table.projected, entries, stream);
  opaque_.upload(scene.table().opaque(), stream);
  visible_before_.upload(rule.visible_before, entries + 1, stream);
  std::vector<HalfColor> halves((entries + 1) / 2 * 2);  // kernels read pairs
  for (std::size_t i = 0; i < entries; ++i) {
    const Rgba& color = rule.table.samples[i];
    halves[i] = {halfPair(color.r, color.g), halfPair(color.b, color.a)};
  }
  half_colors_.upload(halves, stream);
}

void DeviceScene::updateGround(const Scene& scene, cudaStream_t stream) {
  heights_.resize(0);
  if (!scene.ground()) return;
  const GroundView ground = scene.ground()->view();
  const auto posts = static_cast<std::size_t>(ground.columns) * static_cast<std::size_t>(ground.rows);
  heights_.upload(ground.heights, posts, stream);
  ground_colors_.upload(ground.colors, posts, stream);
  ground_levels_.resize(static_cast<std::size_t>(ground.levels));
  for (int level = 0; level < ground.levels; ++level) {
    const std::vector<float>& highest = scene.ground()->level(level);
    ground_levels_[static_cast<std::size_t>(level)].upload(highest, stream);
  }
}

void DeviceScene::updateLevels(const Scene& scene, const volume::BricksView& bricks, cudaStream_t stream) {
  const auto count = static_cast<std::size_t>(bricks.dims.count());
  highest_.resize(count);
  levels_.resize(count);
  summary_.resize(1);
  emscape::cuda::check(cudaMemsetAsync(summary_.data(), 0, sizeof(BrickSummary), stream), "cudaMemset");
  SkipRule rule = scene.skipRule();
  rule.table.samples = samples_.data();
  rule.table.projected = projected_.data();
  rule.visible_before = visible_before_.data();
  findLevels(rule, bricks, highest_.data(), levels_.data(), summary_.data(), stream);
  found_.request(summary_.data(), stream);
  levels_current_ = true;
}

CastLaunch DeviceScene::launch(const Scene& scene, const volume::DeviceStorage& storage, Sampling sampling,
                               ImageSize size) const {
  CastLaunch launch;
  RaycastTask& task = launch.task;
  task = scene.task(size);
  task.volume = {};
  task.volume.dims = scene.grid().dims;
  task.volume.first_valid_k = storage.firstValidK();
  task.volume.masked_below = storage.maskedBelow();
  task.volume.texture = isFiltered(sampling) ? storage.linearTexture() : storage.pointTexture();
  task.volume.tiles = storage.sparseTiles();
  task.transfer.samples = samples_.data();
  task.transfer.projected = projected_.data();
  task.cut.colors = opaque_.data();
  const bool skips = scene.settings().skip_empty && skippingPays(scene.settings().mode, skippable_share_);
  task.skip = {highest_.data(), skips ? levels_.data() : nullptr, storage.bricks().dims};
  if (scene.ground()) {
    task.ground.heights = heights_.data();
    task.ground.colors = ground_colors_.data();
    for (int level = 0; level < task.ground.levels; ++level) {
      task.ground.highest[level] = ground_levels_[static_cast<std::size_t>(level)].data();
    }
  }
  launch.half_colors = half_colors_.data();
  launch.volume_highest_f = &summary_.data()->highest_f;
  return launch;
}

}  // namespace emscape::render::cuda

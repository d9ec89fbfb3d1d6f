#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "core/stop.h"
#include "integrators/path_parts.h"
#include "render/session.h"

namespace frond {

/// Traces `paths` light paths of a scene in blocks on all threads, and counts them in `traced`, the number before.
/// make() returns a new Block, which has
///   kPaths            the number of its paths,
///   trace(first, n)   which traces the paths from number `first` on, and may throw SurfaceError,
///   add_organs()      which adds to sums that all blocks share: called in the order of the blocks.
/// add(block) adds its other sums, in the same order, so that the result does not depend on threads. Of a stopped batch
/// the blocks before the first incomplete one count. Throws InputError for a defect of a material.
template <class Block>
void trace_blocks(const LoadedScene& loaded, uint64_t& traced, uint64_t paths, ThreadPool& pool,
                  const RenderControl& control, const std::function<std::unique_ptr<Block>()>& make,
                  const std::function<void(const Block&)>& add, const std::function<void()>& after_batch = {}) {
  constexpr uint64_t kBlocks = 256;  // of a batch
  RenderStatistics statistics;
  const RenderTimer timer;
  const StopScope stop(control.stop);
  const DeadlineScope deadline(control.deadline);
  for (uint64_t done = 0; done < paths && !control.is_over();) {
    const uint64_t batch = std::min(paths - done, kBlocks * Block::kPaths);
    std::vector<std::unique_ptr<Block>> blocks((batch + Block::kPaths - 1) / Block::kPaths);
    size_t complete = 0;  // number of the first blocks that are complete
    std::mutex in_order;
    try {
      pool.for_each(int64_t(blocks.size()), [&](int64_t block, int) {
        const uint64_t begin = uint64_t(block) * Block::kPaths;
        auto one = make();
        one->trace(traced + begin, std::min(Block::kPaths, batch - begin));
        const std::lock_guard lock(in_order);
        blocks[size_t(block)] = std::move(one);
        for (; complete < blocks.size() && blocks[complete]; ++complete) blocks[complete]->add_organs();
      });
    } catch (const SurfaceError& error) {
      const MaterialDescription& material = loaded.description().materials[error.material_id];
      fail(material.plugin.where, "{} has a defect: {}", name_in_messages(material), error.what());
    } catch (const Stopped&) {
      if (!control.is_over()) throw;
      blocks.resize(complete);
    }
    for (const auto& block : blocks) add(*block);
    const uint64_t counted = std::min(batch, blocks.size() * Block::kPaths);
    traced += counted;
    done += counted;
    statistics.paths = done;
    timer.read(statistics);
    if (control.progress) control.progress->update(double(done) / double(paths), statistics);
    if (after_batch) after_batch();
  }
  if (control.progress) control.progress->finish();
}

}  // namespace frond

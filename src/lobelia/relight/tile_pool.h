// The tiles of a frame on all threads, each with memory of its own that the next frame takes again.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "lobelia/base/context.h"
#include "lobelia/base/parallel.h"
#include "lobelia/relight/tile_rays.h"

namespace lobelia::relight {

template <class Tile>
class TilePool {
 public:
  // render(tile, area) for every area; returns the sum of what it counts (a type with add()).
  // Throws Cancelled when the context is.
  template <class Render>
  auto renderAll(const std::vector<TileArea>& areas, Context& context, const Render& render) {
    decltype(render(std::declval<Tile&>(), areas[0])) counts{};
    std::mutex counting;
    parallelFor(areas.size(), 1, [&](size_t i) {
      if (context.cancelled()) return;
      std::unique_ptr<Tile> tile = take();
      const auto own = render(*tile, areas[i]);
      giveBack(std::move(tile));
      const std::lock_guard lock(counting);
      counts.add(own);
    });
    if (context.cancelled()) throw Cancelled{};
    return counts;
  }

 private:
  std::unique_ptr<Tile> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Tile>();
    std::unique_ptr<Tile> tile = std::move(free_.back());
    free_.pop_back();
    return tile;
  }
  void giveBack(std::unique_ptr<Tile> tile) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(tile));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Tile>> free_;
};

}  // namespace lobelia::relight

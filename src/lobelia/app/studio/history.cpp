#include "lobelia/app/studio/history.h"

#include <set>

namespace lobelia::app {

History::History(Design first) : now_(std::make_shared<const Design>(std::move(first))) {}

void History::edit(const std::string& name, const std::function<void(Design&)>& change) {
  auto next = std::make_shared<Design>(*now_);
  change(*next);
  compact(*next);
  const bool goesOn = open_ && !undo_.empty() && undo_.back().name == name;
  if (!goesOn) undo_.push_back({name, now_});
  now_ = std::move(next);
  redo_.clear();
  open_ = true;
  trim();
}

bool History::undo() {
  open_ = false;
  if (undo_.empty()) return false;
  redo_.push_back({undo_.back().name, now_});
  now_ = std::move(undo_.back().design);
  undo_.pop_back();
  return true;
}

bool History::redo() {
  open_ = false;
  if (redo_.empty()) return false;
  undo_.push_back({redo_.back().name, now_});
  now_ = std::move(redo_.back().design);
  redo_.pop_back();
  return true;
}

size_t History::bytes() const {
  size_t bytes = 0;
  std::set<const StoredImage*> counted;
  for (const auto& image : now_->images) counted.insert(image.get());
  for (const Step& step : undo_) {
    bytes += sizeOf(*step.design);
    for (const auto& image : step.design->images)
      if (counted.insert(image.get()).second) bytes += image->bytes;
  }
  return bytes;
}

void History::trim() {
  while (undo_.size() > 1 && (undo_.size() > kMostSteps || bytes() > kMostBytes)) undo_.pop_front();
}

}  // namespace lobelia::app

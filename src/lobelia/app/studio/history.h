// Undo and redo of designs: every step is the design before it. For one thread.
//
// Steps are bounded in number and bytes, images that only they have among these; the oldest go
// first.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "lobelia/app/studio/design.h"

namespace lobelia::app {

class History {
 public:
  static constexpr size_t kMostSteps = 256;
  static constexpr size_t kMostBytes = size_t{512} << 20;  // one step is kept in any case

  explicit History(Design first);

  const Design& now() const { return *now_; }
  std::shared_ptr<const Design> share() const { return now_; }

  // One step; of the same name as the step before it, and without an endEdit() between, a part of
  // that one. When `change` throws, nothing has happened.
  void edit(const std::string& name, const std::function<void(Design&)>& change);
  void endEdit() { open_ = false; }

  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  // What undo() and redo() would undo and do again; "": nothing.
  std::string undoName() const { return canUndo() ? undo_.back().name : ""; }
  std::string redoName() const { return canRedo() ? redo_.back().name : ""; }
  // False: there is no such step.
  bool undo();
  bool redo();

 private:
  struct Step {
    std::string name;
    std::shared_ptr<const Design> design;  // before it; of redo_: after it
  };
  size_t bytes() const;  // of undo_
  void trim();

  std::shared_ptr<const Design> now_;
  std::deque<Step> undo_, redo_;
  bool open_ = false;
};

}  // namespace lobelia::app

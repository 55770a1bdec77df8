// What the window's thread and the worker share: a few values behind one mutex.
//
// The window puts what is wanted and jobs here and takes pictures and messages away; the worker
// does the opposite. Nothing is done while the mutex is held but moving these.
//
// Whenever the worker has put something here, the window is woken, outside of the mutex.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lobelia/app/studio/design.h"
#include "lobelia/app/studio/picture.h"
#include "lobelia/app/studio/view_state.h"
#include "lobelia/base/context.h"

namespace lobelia::app {

class Stage;

struct StudioMessage {
  Severity severity = Severity::info;
  std::string text;
};
struct Wanted {
  std::shared_ptr<const Design> design;
  ViewState view;
};
// Something to be done between two pictures: files read and written. What it throws becomes a
// message.
using Job = std::function<void(Stage& stage, Context& context)>;
// A change that a job has prepared, to be made by the window's thread.
struct Arrival {
  std::string name;                    // of the edit
  std::shared_ptr<const Design> base;  // the only design that it goes with; null: with any
  std::function<void(Design&)> change;
  std::function<void()> again;  // when the design is another by now
};

class Desk : public Listener {
 public:
  // wake: called from any thread; empty: nobody sleeps.
  explicit Desk(std::function<void()> wake = {}) : wakeWindow_(std::move(wake)) {}

  // The window's side.
  void want(Wanted wanted);
  void give(Job job);
  void stop();
  std::shared_ptr<const Picture> picture() const;
  std::shared_ptr<const Picture> truth() const;
  std::vector<StudioMessage> takeMessages();
  std::vector<Arrival> takeArrivals();
  size_t openJobs() const;  // given and not done
  // Is something to be rendered, or being rendered, but for the truth, or a file not taken in?
  bool isBusy() const;
  // Has the worker put something here since the last call?
  bool takeNews() { return news_.exchange(false); }

  // The worker's side.
  enum class Task : uint8_t { stop, job, wanted, go };
  // What is next: a job, something new that is wanted, or, when neither is there, to go on; where
  // there is nothing to go on with, it waits. open: is the picture not done (for isBusy())?
  Task next(bool canGoOn, bool open, Job* job, Wanted* wanted);
  // While something is rendered, want() cancels its context: at once, or, of a first picture, after
  // some time only (by want() or progress(), whichever comes then), so that who drags without end
  // sees pictures. False: do not even begin, for there is something else to be done.
  bool begin(Context& context, bool first);
  void beginJob(Context& context);  // only stop() cancels it
  void end();
  void endJob();
  void publish(std::shared_ptr<const Picture> picture, bool truth);
  void arrive(Arrival arrival);
  void ring();  // there is something new that lies elsewhere
  // Of contexts that report here: warnings, and what jobs have to tell; the oldest of many go.
  void message(Severity severity, std::string_view text) override;
  void progress(std::string_view, double) override;

 private:
  const std::function<void()> wakeWindow_;
  std::atomic<bool> news_{false};
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Under the mutex:
  std::optional<Wanted> wanted_;  // that the worker has not taken
  Wanted newest_;
  std::deque<Job> jobs_;
  bool jobRuns_ = false, stop_ = false;
  Context* running_ = nullptr;
  bool runningFirst_ = false, runningJob_ = false;
  bool outdated_ = false;     // something else is wanted than what is rendered
  bool pictureOpen_ = false;  // the picture is not done
  int64_t since_ = 0;
  std::shared_ptr<const Picture> picture_, truth_;
  std::deque<StudioMessage> messages_;
  std::string lastSaid_;
  std::vector<Arrival> arrivals_;
};

}  // namespace lobelia::app

#include "lobelia/app/studio/desk.h"

#include <utility>

namespace lobelia::app {
namespace {

constexpr int64_t kPatience = 2'000'000'000;  // nanoseconds that a first picture may take
constexpr size_t kMostMessages = 256;

}  // namespace

void Desk::want(Wanted wanted) {
  {
    const std::scoped_lock lock(mutex_);
    const bool other = newest_.design != wanted.design || !samePicture(newest_.view, wanted.view) ||
                       !sameTruth(newest_.view, wanted.view);
    if (newest_.design != wanted.design) lastSaid_.clear();  // of another design it is news
    newest_ = wanted;
    wanted_ = std::move(wanted);
    const bool patient = runningFirst_ && nanosecondsNow() - since_ < kPatience;
    if (other) outdated_ = true;
    if (other && running_ && !runningJob_ && !patient) running_->cancel();
  }
  wake_.notify_one();
}

void Desk::give(Job job) {
  {
    const std::scoped_lock lock(mutex_);
    jobs_.push_back(std::move(job));
    if (running_ && !runningJob_) running_->cancel();
  }
  wake_.notify_one();
}

void Desk::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
    if (running_) running_->cancel();
  }
  wake_.notify_one();
}

std::shared_ptr<const Picture> Desk::picture() const {
  const std::scoped_lock lock(mutex_);
  return picture_;
}
std::shared_ptr<const Picture> Desk::truth() const {
  const std::scoped_lock lock(mutex_);
  return truth_;
}

std::vector<StudioMessage> Desk::takeMessages() {
  const std::scoped_lock lock(mutex_);
  std::vector<StudioMessage> out(std::make_move_iterator(messages_.begin()),
                                 std::make_move_iterator(messages_.end()));
  messages_.clear();
  return out;
}

std::vector<Arrival> Desk::takeArrivals() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(arrivals_, {});
}

size_t Desk::openJobs() const {
  const std::scoped_lock lock(mutex_);
  return jobs_.size() + (jobRuns_ ? 1 : 0) + arrivals_.size();
}

bool Desk::isBusy() const {
  const std::scoped_lock lock(mutex_);
  return pictureOpen_ || wanted_ || jobRuns_ || !jobs_.empty() || !arrivals_.empty();
}

Desk::Task Desk::next(bool canGoOn, bool open, Job* job, Wanted* wanted) {
  std::unique_lock lock(mutex_);
  if (pictureOpen_ != open) {
    pictureOpen_ = open;
    lock.unlock();
    ring();
    lock.lock();
  }
  wake_.wait(lock, [&] { return stop_ || canGoOn || wanted_ || !jobs_.empty(); });
  if (stop_) return Task::stop;
  if (!jobs_.empty()) {
    *job = std::move(jobs_.front());
    jobs_.pop_front();
    jobRuns_ = true;
    return Task::job;
  }
  if (!wanted_) return Task::go;
  *wanted = std::move(*wanted_);
  wanted_.reset();
  pictureOpen_ = true;
  return Task::wanted;
}

bool Desk::begin(Context& context, bool first) {
  const std::scoped_lock lock(mutex_);
  if (stop_ || wanted_ || !jobs_.empty()) return false;
  running_ = &context, runningFirst_ = first, runningJob_ = false;
  outdated_ = false;
  since_ = nanosecondsNow();
  return true;
}

void Desk::beginJob(Context& context) {
  const std::scoped_lock lock(mutex_);
  if (stop_) context.cancel();
  running_ = &context, runningJob_ = true;
}

void Desk::end() {
  const std::scoped_lock lock(mutex_);
  running_ = nullptr;
}

void Desk::endJob() {
  {
    const std::scoped_lock lock(mutex_);
    running_ = nullptr, jobRuns_ = false;
  }
  ring();
}

void Desk::publish(std::shared_ptr<const Picture> picture, bool truth) {
  {
    const std::scoped_lock lock(mutex_);
    (truth ? truth_ : picture_) = std::move(picture);
  }
  ring();
}

void Desk::arrive(Arrival arrival) {
  {
    const std::scoped_lock lock(mutex_);
    arrivals_.push_back(std::move(arrival));
  }
  ring();
}

void Desk::ring() {
  news_ = true;
  if (wakeWindow_) wakeWindow_();
}

void Desk::message(Severity severity, std::string_view text) {
  if (severity == Severity::debug) return;
  {
    const std::scoped_lock lock(mutex_);
    // What every pass has to say is said once, or not at all; errors end what they are of.
    const bool rendering = running_ && !runningJob_ && severity != Severity::error;
    if (rendering && (severity == Severity::info || lastSaid_ == text)) return;
    lastSaid_ = text;
    if (messages_.size() == kMostMessages) messages_.pop_front();
    messages_.push_back({severity, std::string(text)});
  }
  ring();
}

// Who has stopped dragging need not wait for the end of a slow picture of before.
void Desk::progress(std::string_view, double) {
  const std::scoped_lock lock(mutex_);
  const bool late = nanosecondsNow() - since_ >= kPatience;
  if (outdated_ && late && running_ && !runningJob_) running_->cancel();
}

}  // namespace lobelia::app

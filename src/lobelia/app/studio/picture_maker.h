// Makes the pictures of a view, step by step: a frame by cuts or transfer, after a first look at a
// quarter of the size when frames are slow; or such a look and then pass after pass, averaged; and
// the path-traced truth beside it. For one thread; synchronous: the window's worker and headless
// frames call it.
//
// A design that cuts cannot show is said to be so, once, and they go on with the last one that they
// could.
//
// Seeds of passes are functions of the seed and the number of the pass: the same steps give the
// same bits.
#pragma once

#include <memory>

#include "lobelia/app/studio/pass_mean.h"
#include "lobelia/app/studio/picture.h"
#include "lobelia/app/studio/stage.h"

namespace lobelia::app {

class PictureMaker {
 public:
  static constexpr int kMostTruth = 1 << 16;  // samples per pixel after which the truth stands

  // first: the scene as read, which cuts can show if there are any.
  PictureMaker(Stage& stage, std::shared_ptr<const Design> first, uint64_t seed)
      : stage_(stage), seed_(seed), accepted_(std::move(first)) {}

  // From now on passes of the truth have one sample per pixel each, as many as there are passes:
  // for who does not watch it grow.
  void setEvenTruth() { evenTruth_ = true; }

  // What is wanted from now on; drops what no longer belongs to it.
  void want(std::shared_ptr<const Design> design, const ViewState& view);

  // Which step would be next.
  enum class Step : uint8_t { none, frame, look, pass, truth };
  Step next() const;
  // Is it the first to show something of what is wanted now?
  bool isFirst(Step step) const { return step == Step::look || (step == Step::frame && !looked_); }
  // Is there nothing more to be done to the picture?
  bool isDone() const;
  // Does it: the picture after it, or of step truth the truth. Throws InputError (no data for
  // the method), RuntimeError, Cancelled; after a failure the picture is left as it
  // is until something else is wanted.
  std::shared_ptr<Picture> run(Step step, Context& context);
  // Would the truth so far still be that of these?
  bool truthStands(const std::shared_ptr<const Design>& design, const ViewState& view) const {
    return design == design_ && sameTruth(view, view_);
  }
  // Begins the picture anew (not the truth).
  void restart();
  // Leaves a step out that failed.
  void giveUp(Step step);

 private:
  std::shared_ptr<Picture> frame(const ViewState& view, Context& context);
  std::shared_ptr<Picture> look(Context& context);
  std::shared_ptr<Picture> pass(ViewMethod method, PassMean& mean, Context& context);
  void show(ViewMethod method, Context& context);
  void showCuts(Context& context);

  Stage& stage_;
  const uint64_t seed_;
  std::shared_ptr<const Design> design_;
  std::shared_ptr<const Design> accepted_;  // by cuts, last
  std::string refusal_;                     // of design_, said already
  ViewState view_;
  PassMean mean_, truth_;
  bool looked_ = false;   // the look is done, if there is to be one
  bool started_ = false;  // frame or look is done
  bool givenUp_ = false, truthGivenUp_ = false;
  bool evenTruth_ = false;
  double frameSeconds_ =
      0;  // that the last frame in one go took, or had taken when it was cancelled
  double pictureSeconds_ = 0, truthSeconds_ = 0;
};

}  // namespace lobelia::app

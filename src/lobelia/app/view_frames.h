// The frames of `lobelia view --headless`: a plan of them, or what a script says. By the same parts
// as the window (studio/), step by step and without a thread of their own: same input, same bits.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/app/frames.h"
#include "lobelia/app/studio/display_picture.h"
#include "lobelia/app/studio/history.h"
#include "lobelia/app/studio/picture_maker.h"
#include "lobelia/app/view.h"
#include "lobelia/app/view_script.h"

namespace lobelia::app {

class ViewFrames {
 public:
  // Loads scene, data and script. Throws InputError, UsageError, RuntimeError, Cancelled.
  ViewFrames(const ViewOptions& options, const std::string& commandLine, Context& context);
  // Throws InputError with the place in the script, too.
  void render();
  void writeStatistics() const;

 private:
  void play(const ScriptStep& step);
  void show(const Location& where);
  void load(const ScriptStep& step);
  void edit(const ScriptStep& step);
  void chooseMethod(const ScriptStep& step);
  void chooseBounce(const ScriptStep& step);
  void chooseColours(const ScriptStep& step);
  void screenshot(const ScriptStep& step) const;
  void splitAt(const ScriptStep& step);
  Frame scriptFrame(int number) const;
  void setCamera(const Camera& film);
  void renderFrame(const Frame& frame);
  std::shared_ptr<Picture> makePicture();

  const ViewOptions& options_;
  const std::string& commandLine_;
  Context& context_;
  const std::vector<ScriptStep> script_;
  Stage stage_;
  const std::vector<Frame> plan_;
  History history_;
  const std::shared_ptr<const Design> first_;
  PictureMaker maker_;
  ViewState view_;
  int passes_ = 1;                     // of a frame by a progressive method
  std::optional<Transform> seenFrom_;  // that a script gave the camera
  int number_ = 0;                     // of the next frame of a script
  DisplaySettings display_;            // of screenshots
  std::shared_ptr<Picture> picture_, truth_;
  std::optional<ToneCurve> curve_;  // of all PNG files
};

}  // namespace lobelia::app

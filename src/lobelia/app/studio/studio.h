// The interactive viewer without its window: designs, their history, and a thread that renders.
//
// One thread, the window's, calls everything here but the constructor's context; no call waits for
// rendering or files. update() is to be called once for every frame of the window.
//
// The worker takes what is newest between pictures. A change cancels what is being rendered at
// once; only the first picture after a change may take up to two seconds first, so that who drags
// a slider without end sees something. Changes that cuts cannot show (relight::requireKnownSides,
// masks) are refused by cuts with a message, which go on showing the picture before; the
// progressive methods take them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "lobelia/app/studio/desk.h"
#include "lobelia/app/studio/display_picture.h"
#include "lobelia/app/studio/history.h"

namespace lobelia::app {

struct StudioSettings {
  SceneOptions scene;
  std::vector<std::string> data;  // files of `lobelia precompute`; none: without cuts and transfer
  uint64_t seed = 0;
  double rotation = 0;  // of the light from infinity, to begin with; degrees
  // Called by any thread when update(), the newest pictures, messages or a pick have something new.
  std::function<void()> wake;
};

class PictureMaker;
struct ViewData;

// What lies under a place of the picture.
struct Picked {
  Vec2f place;       // that was asked for
  bool hit = false;  // or nothing does
  Vec3f point, normal;
  Bounds3f bounds;          // of the instance, in the world
  MaterialHandle material;  // of the design
  EmitterHandle emitter;
};

class Studio {
 public:
  // Loads scene and data, which takes as long as it takes. Throws InputError, UsageError,
  // RuntimeError, Cancelled.
  Studio(const StudioSettings& settings, Context& context);
  // Stops in the middle of whatever is done.
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  bool hasCuts() const { return hasCuts_; }
  int transferPasses() const { return transferPasses_; }  // 0: without transfer
  const ViewData& data() const;                           // which nobody changes
  const std::string& sceneName() const { return name_; }
  // Box of the scene, for cameras and handles of lights.
  Bounds3f bounds() const { return bounds_; }

  // The design as it is now, and the history. References last until the next change.
  const Design& design() const { return history_.now(); }
  const History& history() const { return history_; }
  void edit(const std::string& name, const std::function<void(Design&)>& change);
  void endEdit() { history_.endEdit(); }
  void undo();
  void redo();

  // Where from and how; in no history. Takes effect at once.
  const ViewState& view() const { return view_; }
  void setView(const ViewState& view);

  // Files, read and written by the worker in the order of these calls. What is read becomes an edit
  // by update(); what fails, a message.
  void loadEnvironment(const std::string& file);
  // word: of a field of the material or of what it wraps (fieldPlaces(), prefix and word); the
  // image is read as numbers unless it is a colour.
  void loadTexture(const std::string& file, uint32_t material, const std::string& word);
  void loadBump(const std::string& file, uint32_t material, float scale);
  void loadNormalMap(const std::string& file, uint32_t material);
  // Light from infinity stands as the file has it: the rotation becomes 0 when it has emitters. The
  // camera becomes the file's, if it has one.
  void loadDesign(const std::string& file);
  void saveDesign(const std::string& file, const Camera& camera);
  void saveDesign(const std::string& file) { saveDesign(file, view_.camera); }
  // The newest picture: .exr as it is, linear; .png as displayPicture() shows it.
  void screenshot(const std::string& file, const DisplaySettings& display);
  // How many of these are under way.
  size_t openFiles() const { return desk_.openJobs(); }

  // Looks at what lies under a place of the picture, (0,0) the top left corner, (1,1) the other;
  // the answer comes a little later.
  void pick(Vec2f place);
  std::shared_ptr<const Picked> takePicked();  // null: no answer yet

  // Has the worker come up with anything since the last call?
  bool takeNews() { return desk_.takeNews(); }

  // Takes in what the worker has read. True when the design or the camera is another.
  bool update();
  // The newest picture and truth; null: none yet. The same pointer as before: nothing new. Where
  // something else is wanted, the picture stays until there is another; the truth goes.
  std::shared_ptr<const Picture> newestPicture() const { return desk_.picture(); }
  std::shared_ptr<const Picture> newestTruth() const { return desk_.truth(); }
  // Is the picture, the truth left out, or a file not done?
  bool isBusy() const { return desk_.isBusy(); }
  // What is to be said; each once.
  std::vector<StudioMessage> takeMessages() { return desk_.takeMessages(); }

 private:
  void send();
  void work();
  void workOn(PictureMaker& maker);
  void workJob(const Job& job);

  std::unique_ptr<Stage> stage_;  // the worker's
  const uint64_t seed_;
  const bool strict_;
  const std::vector<std::string> inputs_;  // files that are not written over
  const bool hasCuts_;
  const int transferPasses_;
  const std::string name_;
  const Bounds3f bounds_;
  History history_;
  const std::shared_ptr<const Design> first_;  // the scene as read
  ViewState view_;
  Desk desk_;
  std::mutex pickedMutex_;
  std::shared_ptr<const Picked> picked_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace lobelia::app

// How many samples the passes of a picture and of its truth have.
#include "lobelia/app/studio/picture_maker.h"

#include <gtest/gtest.h>

#include "app/block_scene.h"
#include "lobelia/app/studio/stage_of_files.h"
#include "support/run_program.h"

namespace lobelia::test {
namespace {

using app::PictureMaker;

// Of so many passes of the truth.
int truthSamples(bool even, int passes) {
  const TemporaryFolder folder;
  writeText(folder / "scene.xml", kBlockScene);
  app::SceneOptions scene;
  scene.scene = folder / "scene.xml";
  Context context;
  app::Stage stage = app::stageOf(scene, {}, context);
  const auto design = std::make_shared<const app::Design>(app::designOf(stage.scene()));
  PictureMaker maker(stage, design, 0);
  if (even) maker.setEvenTruth();
  app::ViewState view;
  view.camera = stage.scene().cameras.front();
  view.width = view.camera.width, view.height = view.camera.height;
  view.method = app::ViewMethod::path, view.truth = true;
  maker.want(design, view);
  int samples = 0;
  for (int i = 0; i < passes; ++i) {
    const auto truth = maker.run(PictureMaker::Step::truth, context);
    EXPECT_EQ(truth->passes, i + 1);
    samples = truth->samples;
  }
  return samples;
}

TEST(PictureMakerTruth, GrowsForWhoWatches) { EXPECT_GT(truthSamples(false, 12), 30); }
TEST(PictureMakerTruth, HasAsManySamplesAsPassesElsewhere) {
  EXPECT_EQ(truthSamples(true, 12), 12);
}

}  // namespace
}  // namespace lobelia::test

// Undo and redo of designs, against a model that keeps everything.
#include "lobelia/app/studio/history.h"

#include <gtest/gtest.h>

#include "lobelia/app/studio/material_edits.h"
#include "lobelia/base/random.h"

namespace lobelia::app {
namespace {

Scene threeMaterials() {
  Scene scene;
  scene.materials.resize(3);
  scene.cameras.resize(1);
  return scene;
}
std::shared_ptr<StoredImage> image(float value) {
  Image pixels;
  pixels.width = pixels.height = 1, pixels.channels = 1;
  pixels.pixels = {value};
  return std::make_shared<StoredImage>(std::move(pixels));
}

// What a design says, as a number.
std::vector<float> said(const Design& design) {
  std::vector<float> out;
  for (const Material& m : design.materials)
    out.insert(out.end(), {m.diffuse.value.x, static_cast<float>(m.type)});
  for (const auto& stored : design.images) out.push_back(stored->pixels.pixels[0]);
  for (const Emitter& e : design.emitters) out.push_back(e.radiance.value.x);
  return out;
}

TEST(History, RandomEditsUndoneAndDoneAgainAreAModels) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Rng random(seed);
    History history(designOf(threeMaterials()));
    std::vector<std::vector<float>> past, future;
    std::vector<float> now = said(history.now());
    for (int i = 0; i < 200; ++i) {
      const uint32_t what = random.nextUint() % 8;
      if (what == 0) {
        EXPECT_EQ(history.undo(), !past.empty());
        if (past.empty()) continue;
        future.push_back(std::exchange(now, past.back()));
        past.pop_back();
      } else if (what == 1) {
        EXPECT_EQ(history.redo(), !future.empty());
        if (future.empty()) continue;
        past.push_back(std::exchange(now, future.back()));
        future.pop_back();
      } else {
        const float value = random.next1D();
        const uint32_t index = random.nextUint() % 3;
        history.edit("edit", [&](Design& d) {
          if (what == 2) setBump(d, index, addBitmap(d, image(value)), 1);
          if (what == 3) setBump(d, index, {}, 1);
          if (what == 4) d.emitters.emplace_back().radiance = Rgb(value);
          if (what > 4) d.materials[shownMaterial(d, index)].diffuse = Rgb(value);
        });
        history.endEdit();
        past.push_back(std::exchange(now, said(history.now())));
        future.clear();
      }
      ASSERT_EQ(said(history.now()), now) << seed << " " << i;
      ASSERT_EQ(history.canUndo(), !past.empty());
      ASSERT_EQ(history.canRedo(), !future.empty());
    }
    while (history.undo()) {
    }
    EXPECT_EQ(said(history.now()), said(designOf(threeMaterials())));
  }
}

TEST(History, ADraggedSliderIsOneStep) {
  History history(designOf(threeMaterials()));
  const auto drag = [&](const char* name, float value) {
    history.edit(name, [&](Design& d) { d.materials[0].diffuse = Rgb(value); });
  };
  for (int i = 0; i < 100; ++i) drag("colour", static_cast<float>(i) / 128);
  drag("other", 0.5f);
  drag("colour", 0.6f);
  history.endEdit();
  drag("colour", 0.7f);
  EXPECT_EQ(history.undoName(), "colour");
  for (const float before : {0.6f, 0.5f, 99.f / 128}) {
    ASSERT_TRUE(history.undo());
    EXPECT_EQ(history.now().materials[0].diffuse.value.x, before);
  }
  EXPECT_EQ(history.redoName(), "other");
  ASSERT_TRUE(history.undo());
  EXPECT_FALSE(history.canUndo());
  // What comes after an undo is a step of its own.
  drag("colour", 0.1f);
  EXPECT_TRUE(history.canUndo());
  EXPECT_FALSE(history.canRedo());
}

TEST(History, AnEditThatThrowsHasNotHappened) {
  History history(designOf(threeMaterials()));
  EXPECT_THROW(history.edit("broken",
                            [](Design& d) {
                              d.materials.clear();
                              throw InputError({}, "no");
                            }),
               InputError);
  EXPECT_EQ(history.now().materials.size(), 3u);
  EXPECT_FALSE(history.canUndo());
}

TEST(History, ForgetsTheOldestAndLetsImagesGo) {
  History history(designOf(threeMaterials()));
  std::weak_ptr<StoredImage> first;
  for (size_t i = 0; i < 3 * History::kMostSteps; ++i) {
    history.edit("edit", [&](Design& d) {
      auto pixels = image(static_cast<float>(i));
      if (i == 0) first = pixels;
      setBump(d, 0, addBitmap(d, std::move(pixels)), 1);
    });
    history.endEdit();
    EXPECT_EQ(history.now().images.size(), 1u);
    EXPECT_EQ(history.now().textures.size(), 1u);
    EXPECT_EQ(history.now().materials.size(), 4u);
  }
  EXPECT_TRUE(first.expired());
  size_t steps = 0;
  while (history.undo()) ++steps;
  EXPECT_EQ(steps, History::kMostSteps);
}

// Handles move where something in the middle goes.
TEST(Design, CompactsWhatNothingLeadsTo) {
  Design d = designOf(threeMaterials());
  for (uint32_t i = 0; i < 3; ++i) setBump(d, i, addBitmap(d, image(static_cast<float>(i))), 1);
  setBump(d, 1, {}, 1);
  compact(d);
  ASSERT_EQ(d.images.size(), 2u);
  ASSERT_EQ(d.materials.size(), 5u);
  const Material& last = d.materials[2];
  EXPECT_EQ(last.type, MaterialType::bump);
  EXPECT_EQ(d.textures.at(last.map.index).image.index, 1u);
  EXPECT_EQ(d.images[1]->pixels.pixels[0], 2.f);
  EXPECT_EQ(d.materials.at(last.a.index).type, MaterialType::diffuse);
}

}  // namespace
}  // namespace lobelia::app

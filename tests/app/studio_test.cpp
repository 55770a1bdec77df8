// The engine of the window, as its one thread uses it: nothing waits, nothing is lost, nothing
// falls.
#include "lobelia/app/studio/studio.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "app/command_line.h"
#include "lobelia/app/studio/material_edits.h"
#include "lobelia/app/studio/material_fields.h"
#include "lobelia/base/random.h"
#include "lobelia/film/color_map.h"
#include "lobelia/film/metrics.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/scene_io.h"
#include "lobelia/relight/precompute.h"

namespace lobelia::app {
namespace {

using test::readText;
using test::runProgram;
using test::writeText;

constexpr const char* kScene = R"(<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="3, 4, 6" target="0, 0.4, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/>
      <rfilter type="box"/></film>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>
  <shape type="rectangle">
    <transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf>
  </shape>
  <shape type="cube">
    <transform name="to_world"><scale value="0.5"/><translate y="0.55"/></transform>
    <bsdf type="diffuse" id="paint"/>
  </shape>
</scene>)";

class StudioTest : public testing::Test {
 protected:
  void SetUp() override { writeText(file("scene.xml"), kScene); }
  std::string file(const std::string& name) const { return folder_ / name; }

  void precompute() const {
    Context context;
    const Scene scene = io::readScene(file("scene.xml"), {}, context);
    const Tracer tracer(scene, context);
    relight::PrecomputeSettings settings;
    settings.sampleCount = 512, settings.clusterCount = 16;
    relight::save(relight::precomputeVisibility(tracer, settings, context), scene, file("data"));
  }

  std::unique_ptr<Studio> open(bool cuts) {
    StudioSettings settings;
    settings.scene.scene = file("scene.xml");
    if (cuts) {
      precompute();
      settings.data = {file("data")};
    }
    Context context;
    return std::make_unique<Studio>(settings, context);
  }

  static ViewState sized(ViewState view, int width = 16, int height = 12) {
    view.width = width, view.height = height;
    return view;
  }
  // What a window's loop does until something has come about.
  template <class F>
  static bool loopUntil(Studio& studio, const F& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done()) {
      studio.update();
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  static bool settle(Studio& studio) {
    return loopUntil(studio, [&] { return !studio.isBusy() && studio.openFiles() == 0; });
  }
  static std::string said(Studio& studio) {
    std::string all;
    for (const StudioMessage& m : studio.takeMessages()) all += m.text + "\n";
    return all;
  }
  static uint32_t paint(const Studio& studio) {
    const auto& materials = studio.design().materials;
    for (uint32_t i = 0; i < materials.size(); ++i)
      if (materials[i].name == "paint") return i;
    ADD_FAILURE();
    return 0;
  }
  static void paintIn(Studio& studio, Rgb color) {
    const uint32_t m = paint(studio);
    studio.edit("paint", [&](Design& d) { d.materials[m].diffuse = color; });
  }

  test::TemporaryFolder folder_;
};

TEST_F(StudioTest, ShowsWhatTheCommandLineRenders) {
  const auto studio = open(true);
  EXPECT_TRUE(studio->hasCuts());
  EXPECT_EQ(studio->newestPicture(), nullptr);
  studio->setView(sized(studio->view()));
  ASSERT_TRUE(settle(*studio));
  const auto first = studio->newestPicture();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->method, "cuts");
  EXPECT_GT(first->framesPerSecond(), 0);
  const test::ProgramResult r = runProgram("view " + file("scene.xml") + " --data " + file("data") +
                                           " --headless --quiet -o " + file("frame.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  EXPECT_EQ(first->film.layers.at("").values, io::readFilm(file("frame.exr")).layers.at("").values);
  EXPECT_EQ(studio->newestPicture(), first) << "nothing new";
  paintIn(*studio, Rgb(0.9f, 0.1f, 0.1f));
  ASSERT_TRUE(settle(*studio));
  const auto red = studio->newestPicture();
  EXPECT_NE(red->film.layers.at("").values, first->film.layers.at("").values);
  studio->undo();
  ASSERT_TRUE(settle(*studio));
  EXPECT_EQ(studio->newestPicture()->film.layers.at("").values, first->film.layers.at("").values);
}

// Light changes at once, materials not at all, which is said once.
TEST_F(StudioTest, TransferShowsTheLightOnItsOwnMaterials) {
  const test::ProgramResult r = runProgram(
      "precompute " + file("scene.xml") +
      " --method vmf --directions 162 --rays 4 --subdivide 0 --quiet -o " + file("transfer"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  StudioSettings settings;
  settings.scene.scene = file("scene.xml");
  settings.data = {file("transfer")};
  Context context;
  Studio studio(settings, context);
  EXPECT_FALSE(studio.hasCuts());
  EXPECT_EQ(studio.transferPasses(), 3);
  EXPECT_EQ(studio.view().method, ViewMethod::transfer);
  studio.setView(sized(studio.view()));
  const auto values = [&] {
    EXPECT_TRUE(settle(studio));
    EXPECT_EQ(studio.newestPicture()->method, "transfer");
    return studio.newestPicture()->film.layers.at("").values;
  };
  const std::vector<float> first = values();
  paintIn(studio, Rgb(0.9f, 0.1f, 0.1f));
  EXPECT_EQ(values(), first);
  const std::string said = "materials as they were";
  EXPECT_NE(this->said(studio).find(said), std::string::npos);
  studio.edit("dim", [](Design& d) { d.emitters[0].radiance.value *= 0.5f; });
  const std::vector<float> dim = values();
  ASSERT_EQ(dim.size(), first.size());
  for (size_t i = 0; i < dim.size(); ++i) EXPECT_NEAR(dim[i], 0.5f * first[i], 1e-3f * first[i]);
  EXPECT_EQ(this->said(studio).find(said), std::string::npos) << "twice";
  ViewState view = studio.view();
  view.bounce = 1;
  studio.setView(view);
  const std::vector<float> bounced = values();
  EXPECT_EQ(bounced[0], 0) << "the sky is direct light";
  EXPECT_NE(bounced, dim);
  EXPECT_EQ(app::depthOf(view), 4) << "of the truth beside it";
}

// The floor's corners see the whole of an even sky, but for a block: pi times its radiance.
TEST_F(StudioTest, IlluminanceIsThatOfTheSky) {
  const auto studio = open(true);
  ViewState view = sized(studio->view());
  view.white = true, view.spp = 256;
  double means[2];
  for (const ViewMethod method : {ViewMethod::cuts, ViewMethod::path}) {
    view.method = method;
    studio->setView(view);
    ASSERT_TRUE(settle(*studio));
    const auto picture = studio->newestPicture();
    EXPECT_EQ(whyNotShown(*picture, nullptr, Shown::illuminance), "");
    float most = 0;
    for (size_t i = 0; i < picture->film.pixelCount(); ++i)
      most = std::max(most, luminance(picture->film.rgb(i)));
    EXPECT_NEAR(most, luminance(Rgb(0.5f, 0.7f, 1)), 0.03f) << picture->method;
    means[method == ViewMethod::cuts ? 0 : 1] = meanLuminance(picture->film);
  }
  EXPECT_NEAR(means[0] / means[1], 1, 0.05);
}

TEST_F(StudioTest, CutsCountTheirCost) {
  const auto studio = open(true);
  ViewState view = sized(studio->view());
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  const auto plain = studio->newestPicture();
  EXPECT_FALSE(plain->film.layers.contains("cost"));
  view.cost = true;
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  const auto counted = studio->newestPicture();
  EXPECT_EQ(counted->film.layers.at("").values, plain->film.layers.at("").values);
  const std::vector<float>& cost = counted->film.layers.at("cost").values;
  EXPECT_EQ(cost[0], 0) << "the sky";
  EXPECT_GT(cost[16 * 6 + 8], 1) << "the block";
}

TEST_F(StudioTest, MethodsConvergeTowardsTheTruth) {
  const auto studio = open(false);
  EXPECT_FALSE(studio->hasCuts());
  ViewState view = sized(studio->view());
  view.truth = true;
  view.maxDepth = 3;
  for (const ViewMethod method :
       {ViewMethod::path, ViewMethod::sglc, ViewMethod::vsl, ViewMethod::vsgl}) {
    view.method = method;
    view.spp = method == ViewMethod::path ? 64 : 3;
    view.lightCount = method == ViewMethod::vsgl ? 100 : 2000;
    studio->setView(view);
    ASSERT_TRUE(settle(*studio)) << static_cast<int>(method);
    ASSERT_TRUE(loopUntil(*studio, [&] {
      const auto truth = studio->newestTruth();
      return truth && truth->samples >= 64;
    }));
    const auto picture = studio->newestPicture(), truth = studio->newestTruth();
    EXPECT_EQ(picture->samples, view.spp);
    EXPECT_GT(picture->passes, 1);
    EXPECT_GT(picture->relativeError, 0);
    EXPECT_LT(picture->relativeError, 0.3);
    EXPECT_NEAR(compare(picture->film, truth->film).meanRatio, 1, 0.1)
        << viewMethodNames()[static_cast<size_t>(method)];
    EXPECT_EQ(said(*studio), "");
  }
}

TEST_F(StudioTest, ATruthOfSomethingElseGoes) {
  const auto studio = open(false);
  ViewState view = sized(studio->view());
  view.truth = true, view.spp = 2;
  studio->setView(view);
  ASSERT_TRUE(loopUntil(*studio, [&] { return studio->newestTruth() != nullptr; }));
  view.truth = false;
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  EXPECT_NE(studio->newestTruth(), nullptr) << "nothing else is wanted";
  paintIn(*studio, Rgb(0.9f, 0.1f, 0.1f));
  ASSERT_TRUE(settle(*studio));
  EXPECT_EQ(studio->newestTruth(), nullptr);
}

// No crash, no leak, and in the end the picture of what there is in the end.
TEST_F(StudioTest, StandsThousandsOfRapidEdits) {
  const auto studio = open(true);
  studio->setView(sized(studio->view()));
  Rng random(5);
  const uint32_t m = paint(*studio);
  const Material original = studio->design().materials[m];
  const auto types = simpleTypes();
  for (int i = 0; i < 4000; ++i) {
    switch (random.nextUint() % 8) {
      case 0:
        studio->undo();
        break;
      case 1:
        studio->redo();
        break;
      case 2: {
        ViewState view = studio->view();
        view.method = random.nextUint() % 4 != 0 ? ViewMethod::cuts : ViewMethod::path;
        view.camera.fovX = 0.5f + 0.2f * random.next1D();
        view.width = static_cast<int>(random.nextUint() % 20);
        view.truth = random.nextUint() % 2 == 0;
        studio->setView(view);
        break;
      }
      case 3: {
        const MaterialType type = types[random.nextUint() % types.size()];
        studio->edit("type", [&](Design& d) { changeType(d, m, type); });
        break;
      }
      case 4:
        studio->edit("turn", [&](Design& d) { d.rotation = 360. * random.next1D(); });
        break;
      default: {
        const auto places = fieldPlaces(studio->design(), m);
        const FieldPlace& place = places[random.nextUint() % places.size()];
        const Rgb value(random.next1D(), random.next1D(), random.next1D());
        studio->edit(place.field->word, [&](Design& d) {
          setField(d.materials[place.material], *place.field, value);
        });
      }
    }
    if (i % 16 == 0) studio->endEdit();
    if (i % 64 == 0) {
      studio->update();
      studio->takeMessages();
      studio->newestPicture();
    }
  }
  studio->edit("as it was", [&](Design& d) { d.materials[m] = original, d.rotation = 0; });
  ViewState view = sized(studio->view());
  view.method = ViewMethod::cuts, view.truth = false;
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  ASSERT_NE(studio->newestPicture(), nullptr) << said(*studio);
  EXPECT_EQ(studio->newestPicture()->film.width, 16);
  EXPECT_EQ(countNonFinite(studio->newestPicture()->film), 0u);
}

// The first edit, before there was any picture.
TEST_F(StudioTest, CutsShowTheSceneWhereTheyHaveShownNothing) {
  const auto studio = open(true);
  const uint32_t m = paint(*studio);
  studio->edit("glass", [&](Design& d) { changeType(d, m, MaterialType::dielectric); });
  studio->setView(sized(studio->view()));
  ASSERT_TRUE(settle(*studio));
  EXPECT_NE(said(*studio).find("from behind"), std::string::npos);
  ASSERT_NE(studio->newestPicture(), nullptr);
  const auto refused = studio->newestPicture();
  studio->undo();
  ASSERT_TRUE(settle(*studio));
  EXPECT_EQ(studio->newestPicture()->film.layers.at("").values, refused->film.layers.at("").values);
}

TEST_F(StudioTest, EndsInTheMiddleOfAPass) {
  for (const ViewMethod method : {ViewMethod::path, ViewMethod::vsl}) {
    const auto studio = open(false);
    ViewState view = sized(studio->view(), 640, 480);
    view.method = method, view.spp = 1 << 14;
    studio->setView(view);
    studio->saveDesign(file("late.xml"));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }  // and not after hours
}

TEST_F(StudioTest, CutsRefuseWhatTheirDataDoNotKnowAndGoOn) {
  const auto studio = open(true);
  studio->setView(sized(studio->view()));
  ASSERT_TRUE(settle(*studio));
  const auto before = studio->newestPicture();
  const uint32_t m = paint(*studio);
  studio->edit("glass", [&](Design& d) { changeType(d, m, MaterialType::dielectric); });
  ASSERT_TRUE(settle(*studio));
  const std::string text = said(*studio);
  EXPECT_NE(text.find("from behind"), std::string::npos) << text;
  EXPECT_EQ(studio->newestPicture()->film.layers.at("").values, before->film.layers.at("").values);
  // Seen from elsewhere, too.
  ViewState view = studio->view();
  view.camera.fovX = 0.4f;
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  EXPECT_NE(studio->newestPicture()->film.layers.at("").values, before->film.layers.at("").values);
  EXPECT_EQ(said(*studio), "") << "once is enough";
  studio->undo();
  ASSERT_TRUE(settle(*studio));
  studio->redo();
  ASSERT_TRUE(settle(*studio));
  EXPECT_NE(said(*studio).find("from behind"), std::string::npos) << "but for every time";
  // Path tracing shows it, masks as well.
  view.method = ViewMethod::path, view.spp = 4;
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  const auto glass = studio->newestPicture();
  EXPECT_EQ(glass->method, "path");
  studio->edit("gone", [&](Design& d) { d.materials[m].type = MaterialType::null; });
  ASSERT_TRUE(settle(*studio));
  EXPECT_NE(studio->newestPicture()->film.layers.at("").values, glass->film.layers.at("").values);
  EXPECT_EQ(said(*studio), "");
}

TEST_F(StudioTest, MissingFilesAreMessages) {
  const auto studio = open(false);
  const auto before = studio->history().share();
  studio->loadEnvironment(file("none.exr"));
  studio->loadTexture(file("none.png"), paint(*studio), "reflectance");
  studio->loadBump(file("none.png"), paint(*studio), 1);
  studio->loadDesign(file("none.xml"));
  studio->saveDesign(file("no/folder/design.xml"));
  studio->screenshot(file("picture.exr"), {});
  studio->saveDesign(file("scene.xml"));
  writeText(file("noimage.exr"), "no image");
  studio->loadEnvironment(file("noimage.exr"));
  ASSERT_TRUE(loopUntil(*studio, [&] { return studio->openFiles() == 0; }));
  const auto messages = studio->takeMessages();
  ASSERT_EQ(messages.size(), 8u);
  studio->loadTexture(file("none.png"), paint(*studio), "alpha");
  EXPECT_NE(said(*studio).find("has no 'alpha'"), std::string::npos);
  for (const StudioMessage& m : messages) EXPECT_EQ(m.severity, Severity::error) << m.text;
  EXPECT_NE(messages[0].text.find("none.exr"), std::string::npos) << messages[0].text;
  EXPECT_NE(messages[5].text.find("no picture"), std::string::npos) << messages[5].text;
  EXPECT_NE(messages[6].text.find("over what is read"), std::string::npos) << messages[6].text;
  EXPECT_EQ(readText(file("scene.xml")), kScene);
  EXPECT_EQ(studio->history().share(), before);
}

// Open, exchange the environment, turn it, make it rougher, add a bump map, save, reopen.
TEST_F(StudioTest, WhatIsSavedIsThereAgain) {
  ViewState view;
  std::vector<float> saved;
  {
    const auto studio = open(false);
    Film sky;
    sky.fullWidth = sky.width = 8, sky.fullHeight = sky.height = 4;
    sky.addLayer("").values.assign(96, 0.3f);
    for (size_t i = 0; i < 9; ++i) sky.layers.at("").values[i] = 7;
    io::writeExr(file("sky.exr"), sky);
    studio->loadEnvironment(file("sky.exr"));
    studio->loadBump(file("sky.exr"), paint(*studio), 0.01f);
    ASSERT_TRUE(loopUntil(*studio, [&] { return studio->openFiles() == 0; }));
    EXPECT_EQ(studio->history().undoName(), "bump map sky.exr");
    studio->edit("turn", [](Design& d) { d.rotation = 70; });
    studio->edit("type",
                 [&](Design& d) { changeType(d, paint(*studio), MaterialType::roughConductor); });
    view = sized(studio->view());
    view.spp = 2;
    view.camera.toWorld = Transform(*lookAt({4, 3, 5}, {0, 0.5, 0}, {0, 1, 0}));
    studio->setView(view);
    studio->saveDesign(file("design.xml"));
    ASSERT_TRUE(settle(*studio));
    saved = studio->newestPicture()->film.layers.at("").values;
    EXPECT_NE(said(*studio).find("wrote"), std::string::npos);
  }
  const auto studio = open(false);
  studio->loadDesign(file("design.xml"));
  ASSERT_TRUE(loopUntil(*studio, [&] { return studio->openFiles() == 0; }));
  EXPECT_EQ(said(*studio), "");
  EXPECT_EQ(studio->view().camera.toWorld.to, view.camera.toWorld.to);
  ViewState again = sized(studio->view());
  again.spp = 2;
  studio->setView(again);
  ASSERT_TRUE(settle(*studio));
  EXPECT_EQ(studio->newestPicture()->film.layers.at("").values, saved);
  studio->undo();
  ASSERT_TRUE(settle(*studio));
  EXPECT_NE(studio->newestPicture()->film.layers.at("").values, saved);
}

TEST_F(StudioTest, ScreenshotsArePictures) {
  const auto studio = open(false);
  ViewState view = sized(studio->view());
  view.spp = 2, view.cost = true;
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  const auto picture = studio->newestPicture();
  EXPECT_GT(picture->film.layers.at("cost").values[100], 0);
  DisplaySettings display;
  display.curve = measureToneCurve(picture->film, {});
  studio->screenshot(file("picture.exr"), display);
  studio->screenshot(file("picture.png"), display);
  studio->screenshot(file("picture.gif"), display);
  ASSERT_TRUE(settle(*studio));
  const Film read = io::readFilm(file("picture.exr"));
  EXPECT_EQ(read.layers.at("").values, picture->film.layers.at("").values);
  EXPECT_EQ(read.metadata.at("lobelia:method"), "path");
  EXPECT_EQ(io::readImage(file("picture.png"), {.raw = true}).width, 16);
  EXPECT_NE(said(*studio).find(".exr or .png"), std::string::npos);
}

TEST_F(StudioTest, PicksWhatLiesUnderAPlace) {
  const auto studio = open(false);
  studio->setView(sized(studio->view()));
  std::shared_ptr<const Picked> picked;
  const auto pickAt = [&](Vec2f place) {
    studio->pick(place);
    return loopUntil(*studio, [&] { return (picked = studio->takePicked()) != nullptr; });
  };
  ASSERT_TRUE(pickAt({0.5f, 0.5f}));
  EXPECT_TRUE(picked->hit);
  EXPECT_EQ(studio->design().materials.at(picked->material.index).name, "paint");
  EXPECT_LT(length(picked->bounds.lo - Vec3f(-0.5f, 0.05f, -0.5f)), 1e-5f) << "the block's";
  EXPECT_LT(length(picked->bounds.hi - Vec3f(0.5f, 1.05f, 0.5f)), 1e-5f);
  ASSERT_TRUE(pickAt({0.01f, 0.01f}));
  EXPECT_FALSE(picked->hit);
}

// Whoever sleeps until then misses nothing.
TEST_F(StudioTest, WakesTheWindowForWhatIsNew) {
  StudioSettings settings;
  settings.scene.scene = file("scene.xml");
  std::atomic<int> woken{0};
  settings.wake = [&] { ++woken; };
  Context context;
  Studio studio(settings, context);
  const auto news = [&](const auto& ask) {
    woken = 0;
    ask();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while ((woken == 0 || studio.isBusy()) && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      studio.update();
    }
    return studio.takeNews() && woken > 0;
  };
  ViewState view = sized(studio.view());
  view.spp = 1;
  EXPECT_TRUE(news([&] { studio.setView(view); }));
  EXPECT_NE(studio.newestPicture(), nullptr);
  EXPECT_TRUE(news([&] { studio.loadBump(file("none.png"), 0, 1); }));
  EXPECT_NE(said(studio), "");
  EXPECT_TRUE(news([&] { studio.pick({0.5f, 0.5f}); }));
  EXPECT_NE(studio.takePicked(), nullptr);
  EXPECT_FALSE(studio.takeNews()) << "once";
}

TEST_F(StudioTest, WhatIsReadIsNotWrittenOver) {
  writeText(file("old.xml"), "<scene version=\"3.0.0\"/>");
  StudioSettings settings;
  settings.scene.scene = file("scene.xml");
  settings.scene.design = file("old.xml");
  Context context;
  Studio studio(settings, context);
  studio.saveDesign(file("old.xml"));
  ASSERT_TRUE(settle(studio));
  EXPECT_NE(said(studio).find("over what is read"), std::string::npos);
  EXPECT_EQ(readText(file("old.xml")), "<scene version=\"3.0.0\"/>");
}

TEST_F(StudioTest, SavingFromAnotherCameraLeavesThePictureAlone) {
  const auto studio = open(false);
  ViewState view = sized(studio->view());
  view.spp = 2;
  studio->setView(view);
  ASSERT_TRUE(settle(*studio));
  const auto before = studio->newestPicture();
  Camera camera = view.camera;
  camera.fovX = 0.3f;
  studio->saveDesign(file("design.xml"), camera);
  ASSERT_TRUE(settle(*studio));
  EXPECT_EQ(studio->newestPicture(), before);
  EXPECT_NE(readText(file("design.xml")).find("<sensor"), std::string::npos);
}

TEST(Desk, AFirstPictureIsGivenSomeTimeAndNoMore) {
  Desk desk;
  Context context(&desk);
  ASSERT_TRUE(desk.begin(context, true));
  desk.want({std::make_shared<const Design>(), {}});
  context.progress("trace", 0.1);
  EXPECT_FALSE(context.cancelled());
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  context.progress("trace", 0.2);
  EXPECT_TRUE(context.cancelled()) << "though nothing else was wanted since";
  desk.end();
}

TEST_F(StudioTest, FieldsThatNoTextureDrivesSaySo) {
  const auto studio = open(false);
  const uint32_t m = paint(*studio);
  studio->edit("type", [&](Design& d) { changeType(d, m, MaterialType::roughConductor); });
  const auto design = studio->history().share();
  studio->loadTexture(file("any.png"), m, "distribution");
  EXPECT_NE(said(*studio).find("cannot be a texture"), std::string::npos);
  EXPECT_EQ(studio->history().share(), design);
}

}  // namespace
}  // namespace lobelia::app

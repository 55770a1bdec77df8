// `lobelia view` as a user types it, on data of `lobelia precompute`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "lobelia/film/metrics.h"
#include "lobelia/io/image_io.h"

namespace lobelia::test {
namespace {

// A block on a floor under an even sky and a sun; material: of the block.
std::string sceneText(const std::string& material, const std::string& emitters) {
  return R"(<scene version="3.0.0">
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="3, 4, 6" target="0, 0.4, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/>
      <rfilter type="box"/></film>
  </sensor>
  )" + emitters +
         R"(
  <shape type="rectangle">
    <transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf>
  </shape>
  <shape type="cube">
    <transform name="to_world"><scale value="0.5"/><translate y="0.55"/></transform>
    )" + material +
         R"(
  </shape>
</scene>)";
}
constexpr const char* kSky =
    R"(<emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>)";
constexpr const char* kSun = R"(<emitter type="directional"><vector name="direction"
  value="-0.4, -1, -0.3"/><rgb name="irradiance" value="2, 1.8, 1.5"/></emitter>)";
constexpr const char* kDiffuse = R"(<bsdf type="diffuse"/>)";
constexpr const char* kGlossy =
    R"(<bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf>)";

class View : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_ / name; }

  void write(const std::string& material, const std::string& emitters) {
    writeText(file("scene.xml"), sceneText(material, emitters));
  }
  void precompute() {
    const ProgramResult r =
        runProgram("precompute " + file("scene.xml") +
                   " --method cuts --samples 2048 --clusters 16 --quiet -o " + file("data"));
    ASSERT_EQ(r.exitCode, 0) << r.err;
  }
  std::string command(const std::string& options, const std::string& name) const {
    return "view " + file("scene.xml") + " --data " + file("data") + " --headless --quiet " +
           options + " -o " + file(name);
  }
  Film view(const std::string& options, const std::string& name) const {
    const ProgramResult r = runProgram(command(options, name));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    return io::readFilm(file(name));
  }
  Film reference() const {
    const ProgramResult r =
        runProgram("render " + file("scene.xml") +
                   " --lights path --max-depth 2 --spp 256 --quiet -o " + file("reference.exr"));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    return io::readFilm(file("reference.exr"));
  }

  TemporaryFolder folder_;
};

// One set of data, two materials and two lights.
TEST_F(View, IsThePathTracersPictureUnderOtherLightsWithOtherMaterials) {
  write(kDiffuse, kSky);
  precompute();
  for (const char* material : {kDiffuse, kGlossy})
    for (const std::string& emitters : {std::string(kSky), std::string(kSky) + kSun}) {
      write(material, emitters);
      const Comparison c = compare(view("--spp 16", "view.exr"), reference());
      EXPECT_NEAR(c.meanRatio, 1, 0.01) << material << emitters;
      EXPECT_LT(c.l2, emitters == kSky ? 0.04 : 0.12) << material << emitters;
    }
}

TEST_F(View, SameSeedSamePixelsForAnyNumberOfThreads) {
  write(kGlossy, std::string(kSky) + kSun);
  precompute();
  const Film one = view("--spp 4 --threads 1 --seed 3", "one.exr");
  const Film four = view("--spp 4 --threads 4 --seed 3", "four.exr");
  EXPECT_EQ(one.layers.at("").values, four.layers.at("").values);
  const Film other = view("--spp 4 --threads 4 --seed 4", "other.exr");
  EXPECT_NE(one.layers.at("").values, other.layers.at("").values);
}

TEST_F(View, FramesTurnTheLightAndSayWhatTheyCost) {
  write(kDiffuse, kSun);
  precompute();
  const ProgramResult r =
      runProgram(command("--frames 3 --rotate-step 60 --stats " + file("stats.json"), "f%02d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const Film first = io::readFilm(file("f00.exr")), last = io::readFilm(file("f02.exr"));
  EXPECT_NE(first.layers.at("").values, last.layers.at("").values);
  EXPECT_EQ(last.metadata.at("lobelia:frame"), "2");
  EXPECT_EQ(last.layers.at("").values, view("--rotate 120", "turned.exr").layers.at("").values);
  const nlohmann::json stats = nlohmann::json::parse(readText(file("stats.json")));
  EXPECT_EQ(stats["counts"]["frames"], 3);
  EXPECT_GT(stats["counts"]["evaluations_per_pixel"], 0);
  EXPECT_GT(stats["counts"]["merged_nodes_per_vertex"], 0);
  EXPECT_GT(stats["frames_per_second"], 0);
  EXPECT_TRUE(stats["gather"]["threshold"].is_null() && stats["gather"]["error"].is_null());
  for (const char* stage : {"buffer", "light", "merge", "shade"})
    EXPECT_GT(stats["seconds"][stage], 0) << stage;
}

TEST_F(View, RefusesWhatItCannotDraw) {
  write(kDiffuse, kSky);
  const std::string scene = "view " + file("scene.xml") + " --data " + file("data");

  expectFailure("view " + file("scene.xml") + " --headless -o " + file("x.exr"), 2, "--data");
  expectFailure(scene + " --headless", 2, "--output");
  expectFailure(scene + " --headless --light-cut 0 -o " + file("x.exr"), 2, "--light-cut");
  expectFailure(scene + " --headless --rotate-step 3 -o " + file("x.exr"), 2, "--frames");
  expectFailure(scene + " --headless --rotate nan -o " + file("x.exr"), 2, "--rotate");
  expectFailure(scene + " --headless -o " + file("x.exr"), 3, file("data"));
  writeText(file("data"), "no data");
  expectFailure(scene + " --headless -o " + file("x.exr"), 3, file("data"));
  precompute();
  std::string moved = readText(file("scene.xml"));
  moved.replace(moved.find("0.55"), 4, "0.75");
  writeText(file("scene.xml"), moved);
  expectFailure(scene + " --headless -o " + file("x.exr"), 3, file("data"));
  EXPECT_FALSE(std::filesystem::exists(file("x.exr")));
}

TEST_F(View, SaysWhatItLeavesOut) {
  write(kDiffuse, R"(<emitter type="point"><point name="position" value="0, 3, 0"/>
    <rgb name="intensity" value="9"/></emitter>)");
  precompute();
  const ProgramResult r = runProgram("view " + file("scene.xml") + " --data " + file("data") +
                                     " --headless -o " + file("dark.exr"));
  EXPECT_EQ(r.exitCode, 0) << r.err;
  EXPECT_NE(r.err.find("no light from infinity"), std::string::npos) << r.err;

  // What comes through glass depends on the data.
  write(R"(<bsdf type="dielectric"/>)", R"(<emitter type="point">
    <point name="position" value="0, 3, 0"/><rgb name="intensity" value="9"/></emitter>)");
  const auto errors = [&](const std::string& options) {
    const ProgramResult shown = runProgram("view " + file("scene.xml") + " --headless -o " +
                                           file("glass.exr") + " " + options);
    EXPECT_EQ(shown.exitCode, 0) << shown.err;
    return shown.err;
  };
  const auto expectSaid = [](const std::string& said, const std::string& part) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  const std::string distant = " --data " + file("data"), near = " --data " + file("local");
  EXPECT_EQ(runProgram("precompute " + file("scene.xml") +
                       " --method cuts --light surfaces --samples 256 --clusters 16 --quiet -o " +
                       file("local"))
                .exitCode,
            0);
  precompute();
  expectSaid(errors(distant), "1 surfaces transmit light: only their refl");
  expectSaid(errors(near), "light of other surfaces is shown through smooth");
  expectSaid(errors(distant + near), "no light from infinity is shown through");
  const std::string only = "the data are of direct light alone";
  expectSaid(errors(distant + " --component indirect"), only);
  EXPECT_EQ(errors(near + " --component indirect").find(only), std::string::npos);
}

// A block on a floor beside a wall under a lamp: direct light and one bounce are what the path
// tracer finds up to depth 3. The same data for another lamp, elsewhere.
TEST_F(View, LocalLightsAndOneBounceAreThePathTracersPicture) {
  const std::string wall = R"(<shape type="rectangle"><transform name="to_world">
    <scale value="2"/><rotate y="1" angle="90"/><translate x="-2" y="2"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.3, 0.2"/></bsdf></shape>)";
  const auto point = [](const std::string& at) {
    return R"(<emitter type="point"><point name="position" value=")" + at +
           R"("/><rgb name="intensity" value="9, 8, 7"/></emitter>)";
  };
  write(kDiffuse, wall + point("1, 2.5, 1"));
  const ProgramResult r =
      runProgram("precompute " + file("scene.xml") +
                 " --method cuts --light surfaces --samples 4096 --sigma 0.7 --clusters 16 --quiet "
                 "-o " +
                 file("data"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const std::string lamp = R"(<shape type="rectangle"><transform name="to_world">
    <scale value="0.2"/><rotate x="1" angle="90"/><translate x="0.5" y="2.5" z="1"/></transform>
    <emitter type="area"><rgb name="radiance" value="40"/></emitter></shape>)";
  const auto show = [&](const std::string& light) {
    const ProgramResult ref = runProgram("render " + file("scene.xml") +
                                         " --lights path --max-depth 3 --spp 512 --quiet " + light +
                                         " -o " + file("reference.exr"));
    EXPECT_EQ(ref.exitCode, 0) << ref.err;
    return compare(view("--spp 16 --light-cut 4096 " + light, "view.exr"),
                   io::readFilm(file("reference.exr")));
  };
  for (const char* place : {"1, 2.5, 1", "-0.5, 2, 1.5"}) {
    write(kDiffuse, wall + point(place));
    const Comparison all = show(""), bounced = show("--component indirect");
    EXPECT_NEAR(all.meanRatio, 1, 0.01) << place;
    EXPECT_LT(all.l2, 0.03) << place;
    EXPECT_NEAR(bounced.meanRatio, 1, 0.03) << place;
    EXPECT_LT(bounced.l2, 0.08) << place;
  }
  // Data know the geometry, not what emits; a lamp that is an object needs data with it.
  write(kDiffuse, wall + lamp);
  const ProgramResult other = runProgram(command("", "x.exr"));
  EXPECT_EQ(other.exitCode, 3) << other.err;
}

// A pane before the eye: under an even sky all that is behind it is as bright as its light.
TEST_F(View, TheSkyIsSeenThroughPanes) {
  const std::string pane = R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/>
    <lookat origin="2.9, 4.2, 5.7" target="3, 5, 6" up="0, 1, 0"/></transform>
    <bsdf type="thindielectric"/></shape>)";
  const std::string point = R"(<emitter type="point"><point name="position" value="1, 2, 2"/>
    <rgb name="intensity" value="5"/></emitter>)";
  write(kDiffuse, kSky + point + pane);
  precompute();
  const ProgramResult r = runProgram("precompute " + file("scene.xml") +
                                     " --method cuts --light surfaces --samples 512 --clusters 16 "
                                     "--quiet -o " +
                                     file("local"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const Film film = view("--spp 256 --data " + file("local"), "pane.exr");
  const Film path = reference();
  const Rgb seen = film.rgb(0), right = path.rgb(0);  // above the floor's edge
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], right[c], 0.05f * right[c]) << c;
}

TEST_F(View, DataOfBothKindsAddUp) {
  const std::string point = R"(<emitter type="point"><point name="position" value="1, 2, 2"/>
    <rgb name="intensity" value="5"/></emitter>)";
  write(kGlossy, std::string(kSky) + point);
  precompute();
  const ProgramResult r = runProgram("precompute " + file("scene.xml") +
                                     " --method cuts --light surfaces --samples 1024 --clusters 16 "
                                     "--quiet -o " +
                                     file("local"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const std::vector<float> both =
      view("--data " + file("local") + " --stats " + file("stats.json"), "both.exr")
          .layers.at("")
          .values;
  const std::vector<float> sky = view("", "sky.exr").layers.at("").values;
  const ProgramResult local = runProgram("view " + file("scene.xml") + " --data " + file("local") +
                                         " --headless -o " + file("local.exr"));
  ASSERT_EQ(local.exitCode, 0) << local.err;
  EXPECT_NE(local.err.find("1 of 2 emitters are at infinity"), std::string::npos) << local.err;
  const Film near = io::readFilm(file("local.exr"));
  // Where there is a surface; the sky itself is in both.
  const size_t middle = size_t{12} * 32 + 16;
  for (size_t c = 0; c < 3; ++c) {
    const size_t i = 3 * middle + c;
    EXPECT_GT(near.layers.at("").values[i], 0);
    EXPECT_NEAR(both[i], sky[i] + near.layers.at("").values[i], 1e-5f);
  }
  const nlohmann::json stats = nlohmann::json::parse(readText(file("stats.json")));
  EXPECT_EQ(stats["lights"]["model"], "environment and surfaces");
  EXPECT_EQ(stats["counts"]["frames"], 1);
  EXPECT_GT(stats["counts"]["cut_nodes_per_pixel"], 0);
  EXPECT_GT(stats["seconds"]["direct"], 0);
  expectFailure(command("--data " + file("data"), "x.exr"), 2, "second file");
  expectFailure(command("--component some", "x.exr"), 2, "--component");
}

// Every edit is seen in the frames after it, and equals what the scene renders with that edit.
TEST_F(View, ScriptsChangeWhatFramesShow) {
  write(R"(<bsdf type="diffuse" id="paint"/>)", kSky);
  precompute();
  writeText(file("red.xml"),
            "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"paint\">"
            "<rgb name=\"reflectance\" value=\"0.8 0.1 0.1\"/></bsdf></scene>");
  writeText(file("sun.xml"), std::string("<scene version=\"3.0.0\">") + kSun + "</scene>");
  writeText(file("script.txt"),
            "# a comment\n\nframe\ndesign red.xml  # of the block\nframe 2\n"
            "camera 3,4,-6 0,0.4,0\nframe\ndesign sun.xml\nturn 30\nframe\n"
            "design red.xml\ndesign sun.xml\nrotate 1e308\nturn 1e308\nrotate 30\nframe\n");
  const ProgramResult r = runProgram(command("--script " + file("script.txt"), "s%02d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const auto values = [&](int frame) {
    return io::readFilm(file("s0" + std::to_string(frame) + ".exr")).layers.at("").values;
  };
  EXPECT_EQ(values(0), view("", "plain.exr").layers.at("").values);
  EXPECT_NE(values(1), values(0));
  EXPECT_EQ(values(1), view("--design " + file("red.xml"), "red.exr").layers.at("").values);
  EXPECT_EQ(values(2), values(1));
  EXPECT_NE(values(3), values(2));
  EXPECT_NE(values(4), values(3));
  EXPECT_EQ(values(5), values(4)) << "edits that come again";
  EXPECT_FALSE(std::filesystem::exists(file("s06.exr")));
  // The whole of what a person has made, but for the camera, in one design.
  writeText(file("all.xml"),
            std::string("<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"paint\">"
                        "<rgb name=\"reflectance\" value=\"0.8 0.1 0.1\"/></bsdf>") +
                kSun +
                "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>"
                "<transform name=\"to_world\"><lookat origin=\"3, 4, -6\" target=\"0, 0.4, 0\" "
                "up=\"0, 1, 0\"/></transform></sensor></scene>");
  EXPECT_EQ(values(4),
            view("--rotate 30 --design " + file("all.xml"), "all.exr").layers.at("").values);
}

// Images that come with a design do not move those of an environment away.
TEST_F(View, ScriptsMayBringImages) {
  write(R"(<bsdf type="diffuse" id="paint"/>)", kSky);
  precompute();
  const Film picture = view("", "sky.exr");
  writeText(file("textured.xml"),
            "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"paint\"><texture type=\"bitmap\" "
            "name=\"reflectance\"><string name=\"filename\" value=\"sky.exr\"/></texture></bsdf>"
            "</scene>");
  std::string script = "environment sky.exr\nframe\n";
  for (int i = 0; i < 20; ++i) script += "design textured.xml\nenvironment sky.exr\nturn 18\n";
  writeText(file("script.txt"), script + "design textured.xml\nframe\n");
  const ProgramResult r = runProgram(command("--script " + file("script.txt"), "i%d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  EXPECT_NE(io::readFilm(file("i0.exr")).layers.at("").values,
            io::readFilm(file("i1.exr")).layers.at("").values);
  EXPECT_EQ(io::readFilm(file("i1.exr")).layers.at("").values,
            view("--environment " + file("sky.exr") + " --design " + file("textured.xml"), "j.exr")
                .layers.at("")
                .values);
}

TEST_F(View, ScriptsMoveTheCameraThatPicturesAreSeenBy) {
  write(kDiffuse, std::string(kSky) + "<sensor type=\"perspective\"/>");
  precompute();
  writeText(file("script.txt"), "frame\ncamera 3,4,6 0,0.4,0\nframe\n");
  for (const char* camera : {"0", "1"}) {
    const ProgramResult r = runProgram(
        command(std::string("--size 32x24 --camera ") + camera + " --script " + file("script.txt"),
                "c%d.exr"));
    ASSERT_EQ(r.exitCode, 0) << r.err;
    const bool same = io::readFilm(file("c0.exr")).layers.at("").values ==
                      io::readFilm(file("c1.exr")).layers.at("").values;
    EXPECT_EQ(same, *camera == '0');  // which is there already
  }
}

TEST_F(View, ScriptsSayWhatIsWrongAndWhere) {
  write(R"(<bsdf type="diffuse" id="paint"/>)", kSky);
  precompute();
  const auto refused = [&](const std::string& script, const std::string& mentions) {
    writeText(file("bad.txt"), script);
    expectFailure(command("--script " + file("bad.txt"), "x.exr"), 3, mentions);
  };
  refused("frame\nframes 3\n", "bad.txt:2");
  refused("frames 3\n", "did you mean 'frame'");
  refused("rotate\nframe\n", "rotate DEGREES");
  refused("rotate much\nframe\n", "'much' is not a finite number");
  refused("frame 0\n", "a number from 1");
  refused("camera 1,2 0,0,0\nframe\n", "three numbers");
  refused("camera 1,2,3 1,2,3\nframe\n", "no direction");
  refused("rotate 3\n", "has no frame");
  refused("design none.xml\nframe\n", "none.xml");
  writeText(file("bad.xml"),
            "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"pain\"/></scene>");
  refused("design bad.xml\nframe\n", "did you mean 'paint'");
  writeText(file("glass.xml"),
            "<scene version=\"3.0.0\"><bsdf type=\"dielectric\" id=\"paint\"/></scene>");
  refused("design glass.xml\nframe\n", "from behind");
  writeText(file("mask.xml"),
            "<scene version=\"3.0.0\"><bsdf type=\"mask\" id=\"paint\">"
            "<float name=\"opacity\" value=\"0.5\"/>"
            "<bsdf type=\"diffuse\"/></bsdf></scene>");
  refused("frame\ndesign mask.xml\nframe\n", "bad.txt:2");
  refused("frame\ndesign mask.xml\nframe\n", "masked out");
  writeText(file("null.xml"),
            "<scene version=\"3.0.0\"><bsdf type=\"null\" id=\"paint\"/></scene>");
  refused("design null.xml\nframe\n", "bad.txt:1");
  refused("environment none.exr\nframe\n", "bad.txt:1");
  expectFailure(command("--frames 2 --script " + file("bad.txt"), "x.exr"), 2, "--script");
}

// All that a person does in the window, and the same design again by other commands.
TEST_F(View, ScriptsEditUndoAndSave) {
  write(R"(<bsdf type="roughconductor" id="my paint"><float name="alpha" value="0.2"/></bsdf>)",
        kSky);
  precompute();
  view("", "sky.exr");
  writeText(
      file("script.txt"),
      "frame\n"
      "material \"my paint\" alpha 0.4\nmaterial \"my paint\" specular_reflectance 0.9,0.5,0.1\n"
      "material \"my paint\" type principled\ntexture \"my paint\" base_color sky.exr\n"
      "bump \"my paint\" sky.exr 0.02\nmaterial material[0] reflectance 0.2\n"
      "emitter emitter[0] strength 2\nlight add directional 0,-1,-0.3 1,1,1 beam\n"
      "emitter beam color 1,0.5,0.5\nturn 40\nsave out.xml\nframe\n"
      "undo\nundo\nundo\nundo\nundo\nundo\nundo\nundo\nundo\nundo\nframe\n"
      "redo\nredo\nredo\nredo\nredo\nredo\nredo\nredo\nredo\nredo\nframe\n");
  const ProgramResult r = runProgram(command("--script " + file("script.txt"), "s%d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const auto values = [&](int frame) {
    return io::readFilm(file("s" + std::to_string(frame) + ".exr")).layers.at("").values;
  };
  EXPECT_NE(values(0), values(1));
  EXPECT_EQ(values(2), values(0)) << "undone";
  EXPECT_EQ(values(3), values(1)) << "done again";
  // The light is turned as a whole, to the last bits or nearly.
  const Film saved = view("--design " + file("out.xml"), "saved.exr");
  EXPECT_LT(compare(io::readFilm(file("s1.exr")), saved).l2, 1e-4);
  const ProgramResult rendered =
      runProgram("render " + file("scene.xml") + " --design " + file("out.xml") +
                 " --lights path --max-depth 2 --spp 64 --quiet -o " + file("path.exr"));
  ASSERT_EQ(rendered.exitCode, 0) << rendered.err;
  EXPECT_NEAR(compare(io::readFilm(file("path.exr")), saved).meanRatio, 1, 0.05);
}

TEST_F(View, ScriptsChooseMethodsAndShowErrors) {
  write(R"(<bsdf type="diffuse" id="paint"/>)", kSky);
  writeText(file("script.txt"),
            "method path 3\nframe 2\nmaterial paint type dielectric\nframe\ntruth 6\n"
            "false-colour error\nsplit 0.5\nscreenshot error.png\nsplit off\n"
            "false-colour illuminance 0 4\nframe\nscreenshot light.png\nfalse-colour cost\nmethod "
            "sglc\nframe\n"
            "screenshot cost.png\nscreenshot cost.exr\n");
  const std::string play =
      "view " + file("scene.xml") + " --headless --quiet --script " + file("script.txt") + " -o ";
  for (const char* threads : {"1", "3"}) {
    const ProgramResult r =
        runProgram(play + file(threads) + std::string("%d.exr --threads ") + threads);
    ASSERT_EQ(r.exitCode, 0) << r.err;
  }
  const auto values = [&](const std::string& name) {
    return io::readFilm(file(name)).layers.at("").values;
  };
  for (const char* frame : {"0", "1", "2", "3", "4"})
    EXPECT_EQ(values(std::string("1") + frame + ".exr"), values(std::string("3") + frame + ".exr"))
        << frame;
  EXPECT_EQ(values("10.exr"), values("11.exr")) << "frames begin anew";
  EXPECT_NE(values("11.exr"), values("12.exr"));
  EXPECT_TRUE(io::readFilm(file("cost.exr")).layers.contains("cost"));
  for (const char* name : {"error.png", "light.png", "cost.png"})
    EXPECT_EQ(io::readImage(file(name), {}).width, 32) << name;
}

TEST_F(View, ScriptsSayWhatIsWrongWithEdits) {
  write(R"(<bsdf type="roughconductor" id="paint"/>)", kSky);
  precompute();
  const auto refused = [&](const std::string& line, const std::string& mentions) {
    writeText(file("bad.txt"), "frame\n" + line + "\nframe\n");
    const std::string all = command("--script " + file("bad.txt"), "x%d.exr");
    expectFailure(all, 3, mentions);
    expectFailure(all, 3, "bad.txt:2");
  };
  refused("material pain alpha 0.1", "did you mean 'paint'");
  refused("material paint alhpa 0.1", "did you mean 'alpha'");
  refused("material paint alpha much", "not a finite number");
  refused("material paint alpha 3", "from 0.0001 to 1");
  refused("material paint distribution gx", "did you mean 'ggx'");
  refused("material paint type gold", "it may be diffuse");
  refused("material paint", "material NAME FIELD VALUE");
  refused("material \"paint alpha 1", "not closed");
  refused("material paint type dielectric", "from behind");
  refused("texture paint distribution scene.xml", "cannot be a texture");
  refused("texture paint alpha none.png", "none.png");
  refused("texture paint alpha scene.xml", "scene.xml");
  refused("bump paint none.png", "none.png");
  refused("emitter lamp strength 1", "emitter[0]");
  refused("emitter emitter[0] position 1,2,3", "no 'position'");
  refused("emitter emitter[0] strength -1", "from 0");
  refused("light add area 0,0,0 1,1,1", "it may be point");
  refused("light remove emitter[0]", "stays");
  refused("undo", "nothing to undo");
  refused("redo", "nothing to do again");
  refused("method paths", "did you mean 'path'");
  refused("false-colour red", "luminance");
  refused("light add constant 0,0,0 1,1,1 glow", "from all around already");
  refused("false-colour cost 1", "two numbers");
  refused("split 2", "from 0 to 1");
  refused("truth 0", "a number from 1");
  refused("save none/x.xml", "there is no folder");
  refused("save scene.xml", "over what is read");
  refused("screenshot x.gif", ".exr or .png");
  writeText(file("bad.txt"), "frame\nsplit 0.5\nscreenshot x.png\n");
  expectFailure(command("--script " + file("bad.txt"), "x%d.exr"), 3, "truth 16");
  writeText(file("bad.txt"), "screenshot x.png\nframe\n");
  expectFailure(command("--script " + file("bad.txt"), "x.exr"), 3, "there is no picture yet");
  writeText(file("bad.txt"), "frame\n");
  expectFailure("view " + file("scene.xml") + " --headless --script " + file("bad.txt") + " -o " +
                    file("x.exr"),
                3, "--data");
}

}  // namespace
}  // namespace lobelia::test

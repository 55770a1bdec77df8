// The program as a user types it: pictures, files and exit codes of the contract.
#include "app/command_line.h"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "lobelia/io/image_io.h"

namespace lobelia {
namespace {

using test::expectFailure;
using test::kSmall;
using test::ProgramResult;
using test::runProgram;
using test::TemporaryFolder;

TEST(CommandLine, DiskFullIsOneAndLeavesNothing) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "skipped: no /dev/full";
  const TemporaryFolder folder;
  const ProgramResult r =
      runProgram(std::string(kSmall) + "--spp 1 --num-lights 10 -o /dev/full.exr");
  // /dev is a folder that cannot hold regular files for most users; as root it can.
  EXPECT_TRUE(r.exitCode == 0 || r.exitCode == 1 || r.exitCode == 2) << r.err;
  std::filesystem::remove("/dev/full.exr");
}

TEST(CommandLine, OutputToAFullDiskIsOne) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "skipped: no /dev/full";
  EXPECT_EQ(WEXITSTATUS(std::system(LOBELIA_PROGRAM " methods > /dev/full 2> /dev/null")), 1);
  const TemporaryFolder folder;
  expectFailure(
      std::string(kSmall) + "--spp 1 --num-lights 10 --stats /dev/full -o " + (folder / "a.exr"), 1,
      "/dev/full");
}

TEST(CommandLine, PicturesLargerThanMemoryAreRefused) {
  const double bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (bytes > 120.0 * 16384 * 16384) GTEST_SKIP() << "skipped: the largest picture fits";
  const TemporaryFolder folder;
  expectFailure(
      "render cornell --detail 0.1 --size 16384x16384 --aov "
      "albedo,normal,depth,direct,indirect,specular,variance -o " +
          (folder / "a.exr"),
      1, "--crop");
}

// As when the disk is full: nothing is left behind, and the program says why.
TEST(CommandLine, FileSizeLimitsLeaveNothing) {
  const TemporaryFolder folder;
  test::writeText(folder / "old.exr", "old");
  const std::string command = "ulimit -f 8; " LOBELIA_PROGRAM
                              " render cornell --detail 0.1 --size 64x64 --spp 1 --num-lights 8 "
                              "--quiet -o " +
                              (folder / "old.exr") + " -o " + (folder / "a.exr") + " 2> /dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  EXPECT_EQ(test::readText(folder / "old.exr"), "old");
  std::filesystem::remove(folder / "old.exr");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Every second is booked once: stages do not add up to more than the whole.
TEST(CommandLine, SecondsOfStagesFitIntoTheTotal) {
  const TemporaryFolder folder;
  for (const char* method :
       {"path", "light", "vpl", "glossy", "vsl", "vsl --gather mrcs", "vsl --gather sglc",
        "vpl --gather sglc --sglc-mode paper", "glossy --gather lightslice",
        "glossy --gather lightcuts", "glossy --gather mdlc", "glossy --gather stochastic",
        "vsl --gather illumcut", "richvpl", "vpl --compensate", "photon"}) {
    ASSERT_EQ(runProgram("render study-phong --detail 0.1 --size 24x24 --quiet --spp 2 "
                         "--num-lights 500 --lights " +
                         std::string(method) + " --stats " + (folder / "s.json") + " -o " +
                         (folder / "a.exr"))
                  .exitCode,
              0);
    const auto seconds = nlohmann::json::parse(test::readText(folder / "s.json"))["seconds"];
    double sum = 0;
    for (const auto& [stage, value] : seconds.items()) {
      if (stage != "total") sum += value.get<double>();
    }
    EXPECT_LE(sum, seconds["total"].get<double>() * 1.001) << method << seconds;
    const bool traces = std::string(method) == "path" || std::string(method) == "light";
    EXPECT_GT(seconds[traces ? "trace" : "lights"].get<double>(), 0) << method;
  }
}

TEST(CommandLine, RenderWritesPicturesAovsStatisticsAndMetadata) {
  const TemporaryFolder folder;
  const ProgramResult r =
      runProgram(std::string(kSmall) +
                 "--spp 2 --num-lights 100 --aov "
                 "albedo,normal,depth,direct,indirect,specular,variance --stats " +
                 (folder / "s.json") + " -o " + (folder / "a.exr") + " -o " + (folder / "a.png"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  EXPECT_EQ(r.err, "");
  const Film film = io::readFilm(folder / "a.exr");
  EXPECT_EQ(film.width, 24);
  for (const char* layer :
       {"", "albedo", "normal", "depth", "direct", "indirect", "specular", "variance"}) {
    EXPECT_TRUE(film.layers.contains(layer)) << layer;
  }
  EXPECT_EQ(countNonFinite(film), 0u);
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(film.rgb(i)[c], film.rgb(i, "direct")[c] + film.rgb(i, "indirect")[c],
                  1e-5f + 1e-5f * film.rgb(i)[c]);
    }
  }
  EXPECT_TRUE(film.metadata.contains("lobelia:command"));
  EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
  const auto stats = nlohmann::json::parse(test::readText(folder / "s.json"));
  for (const char* key :
       {"version", "scene", "lights", "gather", "receivers", "seconds", "counts", "memory"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  EXPECT_GT(stats["counts"]["shadow_rays"], 0);
  EXPECT_LE(stats["memory"]["bytes_per_light"], 52.0);
  EXPECT_GT(stats["receivers"]["diffuse"], 0);
  EXPECT_GT(stats["receivers"]["glossy"], 0);
  // Tone-mapped light beside linear light is compared, with a warning.
  const std::string exr = folder / "a.exr", png = folder / "a.png";
  for (const std::string& files : {exr + " " + png, png + " " + exr}) {
    const ProgramResult mixed = runProgram("compare " + files);
    EXPECT_EQ(mixed.exitCode, 0) << mixed.err;
    EXPECT_NE(mixed.err.find(png + " is a picture for display"), std::string::npos) << mixed.err;
    EXPECT_EQ(runProgram("compare --quiet " + files).err, "");
  }
  EXPECT_EQ(runProgram("compare " + png + " " + png).err, "");
  EXPECT_EQ(runProgram("compare " + exr + " " + exr).err, "");
}

TEST(CommandLine, SameSeedSamePixelsForAnyThreads) {
  const TemporaryFolder folder;
  for (const char* method :
       {"path", "light", "glossy", "vpl", "vsl", "vsl --gather mrcs",
        "vsl --gather sglc --cut-size 20", "vpl --gather sglc --cut-size 20",
        "glossy --gather sglc --sglc-mode paper",
        "glossy --gather lightslice --columns 20 --slices 10",
        "vsl --gather lightcuts --cut-size 20", "vsl --gather mdlc --cut-size 20",
        "glossy --gather illumcut", "glossy --gather stochastic --cut-size 20",
        "richvpl --richvpl-lights 20", "glossy --compensate",
        "glossy --gather sglc --near-lights 20", "photon"}) {
    const auto render = [&](int threads, const char* seed) {
      const std::string file = folder / (std::to_string(threads) + seed + ".exr");
      const ProgramResult r =
          runProgram(std::string(kSmall) + "--spp 2 --num-lights 200 --lights " + method +
                     " --threads " + std::to_string(threads) + " --seed " + seed + " -o " + file);
      EXPECT_EQ(r.exitCode, 0) << r.err;
      return io::readFilm(file).layers.at("").values;
    };
    const auto one = render(1, "7");
    EXPECT_EQ(one, render(5, "7")) << method;
    EXPECT_NE(one, render(2, "8")) << method;
  }
}

TEST(CommandLine, SavedLightsGiveTheSamePictureAndRefuseAnotherScene) {
  const TemporaryFolder folder;
  const std::string small = std::string(kSmall) + "--spp 1 --num-lights 100 ";
  ASSERT_EQ(
      runProgram(small + "--save-lights " + (folder / "l") + " -o " + (folder / "a.exr")).exitCode,
      0);
  ASSERT_EQ(
      runProgram(small + "--load-lights " + (folder / "l") + " -o " + (folder / "b.exr")).exitCode,
      0);
  EXPECT_EQ(io::readFilm(folder / "a.exr").layers.at("").values,
            io::readFilm(folder / "b.exr").layers.at("").values);
  expectFailure("render cornell --detail 0.2 --size 8x8 --quiet --load-lights " + (folder / "l") +
                    " -o " + (folder / "c.exr"),
                3, "scene");
  expectFailure(
      small + "--lights vpl --load-lights " + (folder / "l") + " -o " + (folder / "c.exr"), 3,
      "glossy");
  EXPECT_FALSE(std::filesystem::exists(folder / "c.exr"));
}

// The file has the particles; merging them is part of gathering.
TEST(CommandLine, SavedLightsOfRichVplsAreMergedAnew) {
  const TemporaryFolder folder;
  const std::string base = std::string(kSmall) + "--spp 1 --num-lights 100 ",
                    rich = base + "--lights richvpl --richvpl-lights ", file = folder / "l";
  ASSERT_EQ(runProgram(rich + "20 --save-lights " + file + " -o " + (folder / "a.exr")).exitCode,
            0);
  const auto loaded = [&](const std::string& places) {
    const std::string picture = folder / "b.exr";
    EXPECT_EQ(runProgram(rich + places + " --load-lights " + file + " -o " + picture).exitCode, 0);
    return io::readFilm(picture).layers.at("").values;
  };
  const auto saved = io::readFilm(folder / "a.exr").layers.at("").values;
  EXPECT_EQ(loaded("20"), saved);
  EXPECT_NE(loaded("40"), saved);
  expectFailure(base + "--load-lights " + file + " -o " + (folder / "c.exr"), 3, "richvpl");
}

TEST(CommandLine, PixelsAndCropAgreeWithTheWholePicture) {
  const TemporaryFolder folder;
  for (const std::string method : {"path", "glossy", "vpl --compensate", "photon"}) {
    const std::string small =
        std::string(kSmall) + "--spp 2 --num-lights 50 --lights " + method + " ";
    ASSERT_EQ(runProgram(small + "-o " + (folder / "all.exr")).exitCode, 0);
    ASSERT_EQ(runProgram(small + "--pixels 40 -o " + (folder / "some.exr")).exitCode, 0);
    const Film all = io::readFilm(folder / "all.exr"), some = io::readFilm(folder / "some.exr");
    ASSERT_EQ(some.alpha.size(), all.pixelCount());
    size_t present = 0;
    for (size_t i = 0; i < all.pixelCount(); ++i) {
      if (some.alpha[i] == 0) continue;
      ++present;
      EXPECT_EQ(some.rgb(i), all.rgb(i)) << method << " pixel " << i;
    }
    EXPECT_EQ(present, 40u);
    const ProgramResult r =
        runProgram("compare " + (folder / "some.exr") + " " + (folder / "all.exr") + " --json");
    EXPECT_EQ(nlohmann::json::parse(r.out)["rmse"], 0.0);
    EXPECT_TRUE(nlohmann::json::parse(r.out)["flip"].is_null());
    ASSERT_EQ(runProgram(small + "--crop 4,6,14,12 -o " + (folder / "crop.exr")).exitCode, 0);
    const Film crop = io::readFilm(folder / "crop.exr");
    EXPECT_EQ(crop.fullWidth, 24);
    EXPECT_EQ(crop.x0, 4);
    EXPECT_EQ(crop.width, 10);
    EXPECT_EQ(crop.height, 6);
    // Compared where both are. A ray's answer may rarely depend on its packet: not bit for bit.
    const ProgramResult window =
        runProgram("compare " + (folder / "crop.exr") + " " + (folder / "all.exr") + " --json");
    ASSERT_EQ(window.exitCode, 0) << window.err;
    EXPECT_EQ(nlohmann::json::parse(window.out)["pixels"], 60);
    EXPECT_LT(nlohmann::json::parse(window.out)["l2"], 1e-3);
  }
}

// timeout --foreground: without it, the signal comes twice, which means at once.
TEST(CommandLine, InterruptWritesWhatThereIs) {
  const TemporaryFolder folder;
  for (const auto& [signal, code] : {std::pair{"INT", 130}, std::pair{"TERM", 143}}) {
    const std::string file = folder / (std::string(signal) + ".exr");
    const std::string command = "timeout --foreground -s " + std::string(signal) +
                                " --preserve-status 3 " + LOBELIA_PROGRAM +
                                " render cornell --detail 0.1 --size 64x64 --lights path --spp "
                                "10000000 --threads 1 --quiet "
                                "-o " +
                                file;
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), code);
    const Film film = io::readFilm(file);
    EXPECT_EQ(countNonFinite(film), 0u);
    double sum = 0;
    for (size_t i = 0; i < film.pixelCount(); ++i) sum += luminance(film.rgb(i));
    EXPECT_GT(sum, 0);
  }
}

// At whatever moment a signal comes: the contract's code, and pictures that are whole if there.
TEST(CommandLine, InterruptAtAnyTime) {
  const TemporaryFolder folder;
  ASSERT_EQ(runProgram("scene cornell --detail 3 --quiet -o " + (folder / "s")).exitCode, 0);
  for (const char* seconds : {"0.3", "0.45", "0.6", "0.75", "0.9", "1.2"}) {
    const std::string file = folder / (std::string(seconds) + ".exr");
    const std::string command = "timeout --foreground -s TERM --preserve-status " +
                                std::string(seconds) + " " + LOBELIA_PROGRAM + " render " +
                                (folder / "s/scene.xml") +
                                " --size 32x32 --num-lights 100000000 --quiet -o " + file;
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 143) << seconds;
    if (std::filesystem::exists(file)) {
      EXPECT_EQ(countNonFinite(io::readFilm(file)), 0u);
    }
  }
}

// Virtual lights and path tracing agree on the light of suns and photometric emitters.
TEST(CommandLine, SunsAndPhotometricLampsAgreeAmongMethods) {
  const TemporaryFolder folder;
  std::ofstream(folder / "lamp.ies")
      << "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 3 1 2 0 0 0 1 1 10\n0 30 60 90\n0 90 180\n"
         "9 8 4 0\n9 5 1 0\n9 3 2 1\n";
  const std::string stage =
      "<scene version=\"3.0.0\"><integrator type=\"path\"><integer name=\"max_depth\" value=\"4\"/>"
      "</integrator><sensor type=\"perspective\"><float name=\"fov\" value=\"50\"/><transform "
      "name=\"to_world\"><lookat origin=\"0 3 8\" target=\"0 1 0\" up=\"0 1 0\"/></transform>"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"20\"/><integer name=\"height\" "
      "value=\"16\"/></film></sensor><shape type=\"rectangle\"><transform name=\"to_world\">"
      "<rotate x=\"1\" angle=\"-90\"/><scale value=\"4\"/></transform><bsdf "
      "type=\"roughconductor\">"
      "<float name=\"alpha\" value=\"0.4\"/></bsdf></shape><shape type=\"sphere\"><point "
      "name=\"center\" y=\"1\"/></shape><shape type=\"rectangle\"><transform name=\"to_world\">"
      "<scale value=\"4\"/><translate z=\"-3\"/></transform></shape>";
  const std::string sun =
      "<emitter type=\"sun\"><rgb name=\"irradiance\" value=\"3 2 1\"/><vector name=\"direction\" "
      "value=\"0.4 -1 -0.8\"/><float name=\"angular_radius\" value=\"4\"/></emitter>";
  const std::string lamp =
      "<emitter type=\"ies\"><string name=\"filename\" value=\"lamp.ies\"/><transform "
      "name=\"to_world\"><rotate x=\"1\" angle=\"90\"/><translate x=\"1\" y=\"3.5\" z=\"1\"/>"
      "</transform></emitter>";
  for (const std::string& emitters : {sun, lamp}) {
    std::ofstream(folder / "scene.xml") << stage << emitters << "</scene>";
    const auto mean = [&](const std::string& method) {
      const std::string out = folder / "a.exr";
      const ProgramResult r = runProgram("render " + (folder / "scene.xml") + " --strict --quiet " +
                                         method + " -o " + out);
      EXPECT_EQ(r.exitCode, 0) << r.err;
      const Film film = io::readFilm(out);
      double sum = 0;
      for (size_t i = 0; i < film.pixelCount(); ++i) sum += double{luminance(film.rgb(i))};
      return sum / static_cast<double>(film.pixelCount());
    };
    const double path = mean("--lights path --spp 256");
    EXPECT_GT(path, 0.01);
    EXPECT_NEAR(mean("--lights glossy --direct nee --spp 64"), path, 0.03 * path);
    EXPECT_NEAR(mean("--lights glossy --direct lights --spp 64"), path, 0.03 * path);
  }
}

TEST(CommandLine, DesignsChangeTheScene) {
  const TemporaryFolder folder;
  const std::string design = folder / "design.xml", out = folder / "a.exr";
  const auto green = [&](const std::string& options) {
    const ProgramResult r = runProgram(kSmall + (options + " -o " + out));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    const Film film = io::readFilm(out);
    double sum = 0, all = 0;
    const std::vector<float>& values = film.layers.at("").values;
    for (size_t i = 0; i < values.size(); ++i)
      (i % 3 == 1 ? sum : all) += static_cast<double>(values[i]);
    return sum / (sum + all);
  };
  test::writeText(design,
                  "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"white_wall\">"
                  "<rgb name=\"reflectance\" value=\"0.1 0.9 0.1\"/></bsdf></scene>");
  const double before = green("--spp 4 --lights path");
  EXPECT_GT(green("--spp 4 --lights path --design " + design), before + 0.05);
  test::writeText(design,
                  "<scene version=\"3.0.0\">\n<bsdf type=\"diffuse\" id=\"white_wal\"/></scene>");
  expectFailure("info cornell --design " + design, 3, "design.xml:2");
  expectFailure("info cornell --design " + design, 3, "did you mean 'white wall'");
  expectFailure("info cornell --design " + (folder / "none.xml"), 3, "none.xml");
}

TEST(CommandLine, SkyLightsBuiltInScenes) {
  const TemporaryFolder folder;
  const std::string out = folder / "a.exr";
  EXPECT_EQ(runProgram(kSmall + ("--sky 3,0.3,1,0.4 --spp 4 -o " + out)).exitCode, 0);
  EXPECT_GT(io::readFilm(out).pixelCount(), 0u);
  expectFailure(kSmall + ("--sky 3,1 -o " + out), 2, "TURBIDITY");
  const ProgramResult night = runProgram(
      "render cornell --detail 0.1 --size 8x8 --spp 1 --num-lights 16 --sky 3,0,-1,0 -o " + out);
  EXPECT_EQ(night.exitCode, 0) << night.err;
  EXPECT_NE(night.err.find("the sun has set"), std::string::npos) << night.err;
  expectFailure(kSmall + ("--sky 30,0,1,0 -o " + out), 2, "turbidity");
  expectFailure(kSmall + ("--sky 3,0,1,0 --environment x.exr -o " + out), 2, "--environment");
}

TEST(CommandLine, SceneRoundTripRendersTheSame) {
  const TemporaryFolder folder;
  ASSERT_EQ(runProgram("scene cornell --detail 0.1 --quiet -o " + (folder / "scene")).exitCode, 0);
  const std::string options = " --size 16x16 --spp 2 --lights path --quiet -o ";
  ASSERT_EQ(runProgram("render cornell --detail 0.1" + options + (folder / "a.exr")).exitCode, 0);
  const ProgramResult r =
      runProgram("render " + (folder / "scene/scene.xml") + options + (folder / "b.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const ProgramResult c =
      runProgram("compare " + (folder / "a.exr") + " " + (folder / "b.exr") + " --json");
  EXPECT_LT(nlohmann::json::parse(c.out)["l2"], 1e-3);
}

}  // namespace
}  // namespace lobelia

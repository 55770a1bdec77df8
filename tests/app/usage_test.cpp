// What the program says of wrong command lines and bad input; what info prints.
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/command_line.h"

namespace lobelia {
namespace {

using test::expectFailure;
using test::kSmall;
using test::ProgramResult;
using test::runProgram;
using test::runProgramInShell;
using test::TemporaryFolder;

TEST(Usage, HelpVersionAndMethods) {
  EXPECT_EQ(runProgramInShell("--help").exitCode, 0);
  EXPECT_NE(runProgramInShell("--version").out.find("lobelia 0."), std::string::npos);
  const ProgramResult methods = runProgram("methods");
  EXPECT_EQ(methods.exitCode, 0);
  EXPECT_NE(methods.out.find("glossy"), std::string::npos);
}

TEST(Usage, ArgumentsMayBeLong) {
  const ProgramResult r = runProgram("info " + std::string(100'000, 'n') + " --nonsense");
  EXPECT_EQ(r.exitCode, 2);
  EXPECT_NE(r.err.find("--nonsense"), std::string::npos) << r.err;
}

TEST(Usage, WrongUsageIsTwo) {
  expectFailure("", 2, "subcommand");
  expectFailure("rendr x", 2, "");
  expectFailure("render cornell", 2, "--output");
  const TemporaryFolder folder;
  const std::string out = " -o " + (folder / "a.exr");
  expectFailure("render cornell --lights glosy" + out, 2, "did you mean 'glossy'");
  expectFailure("render cornell --gather sglcc" + out, 2, "--gather");
  expectFailure("render cornell --spp 0" + out, 2, "--spp");
  expectFailure("render cornell --spp -3" + out, 2, "--spp");
  expectFailure("render cornell --spp 1e99" + out, 2, "--spp");
  expectFailure("render cornell --size 0x10" + out, 2, "--size");
  expectFailure("render cornell --size 10" + out, 2, "--size");
  expectFailure("render cornell --size 99999999x10" + out, 2, "--size");
  expectFailure("render cornell --crop 5,5,2,9" + out, 2, "--crop");
  expectFailure("render cornell --camera nobody" + out, 2, "--camera");
  expectFailure("render cornell --aov albeda" + out, 2, "albedo");
  expectFailure("render cornell --clamp -1" + out, 2, "--clamp");
  expectFailure("render cornell --nonsense" + out, 2, "--nonsense");
  expectFailure("render cornell -o " + (folder / "no/such/folder.exr"), 2, "folder");
  expectFailure("render cornell -o " + (folder / "a.bmp"), 2, ".exr");
  expectFailure("scene nowhere -o " + (folder / "x"), 2, "cornell");
  expectFailure("rendr cornell" + out, 2, "did you mean 'render'");
  expectFailure("render cornell --spp 4 --spp 8" + out, 2, "--spp is given 2 times");
  expectFailure("render cornell --spp 1.5" + out, 2, "'1.5' is not an integer from 1");
  expectFailure("render cornell --max-depth 0x10" + out, 2, "'0x10' is not an integer");
  expectFailure("render cornell --direct ne" + out, 2, "did you mean 'nee'");
  expectFailure("render cornell --vsl-indicator cosin" + out, 2, "did you mean 'cosine'");
  expectFailure("render cornell --time 1" + out, 2, "--time");
  expectFailure("render cornell --aov albedo -o " + (folder / "a.png"), 2, ".exr");
  for (const char* option : {"--crop", "--stats", "-D"})
    expectFailure("render cornell " + std::string(option) + " ''" + out, 2, "empty");
  for (const char* option : {"--specular-limit nan", "--time-limit nan", "--exposure inf"})
    expectFailure("render cornell " + std::string(option) + out, 2, "finite");
  expectFailure("render cornell --seed -1" + out, 2, "--seed");
  expectFailure("render cornell --seed 18446744073709551616" + out, 2, "--seed");
  expectFailure("render cornell --lights path --save-lights " + (folder / "l") + out, 2,
                "virtual lights");
  expectFailure("render cornell --lights path --load-lights " + (folder / "l") + out, 2,
                "virtual lights");
  expectFailure("render cornell" + out + out, 2, "twice");
  expectFailure("render cornell --stats " + (folder / "a.exr") + out, 2, "twice");
  expectFailure("compare a.exr a.exr --diff " + (folder / "d.exr"), 2, ".png");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// The scene that is not there would be said otherwise.
TEST(Usage, BadPicturesAreRefusedBeforeTheSceneIsRead) {
  const TemporaryFolder folder;
  const std::string render = "render " + (folder / "none.xml") + " -o " + (folder / "a.exr ");
  expectFailure(render + "--aov albedo,norml", 2, "did you mean 'normal'");
  expectFailure(render + "--lights path --aov cst", 2, "did you mean 'cost'");
  expectFailure(render + "--size 64*48", 2, "as in 640x480");
  expectFailure(render + "--size 64x0", 2, "from 1 to 65536");
  expectFailure(render + "--crop 5,5,2,9", 2, "--crop");
  expectFailure("bench clamp --scene " + (folder / "none.xml") + " --size 10", 2, "--size");
  expectFailure(render + "--size 64x48 --aov cost", 3, "none.xml");
}

// Nor is anything made or lost.
TEST(Usage, OutputsThatCannotBeWrittenAreRefusedBeforeTheSceneIsRead) {
  const TemporaryFolder folder;
  const std::string scene = folder / "none.xml";
  std::filesystem::create_directory(folder / "made.exr");
  const std::string longName = folder / (std::string(249, 'a') + ".exr");  // but not its temporary
  const std::pair<std::string, const char*> places[] = {{folder / "no/a.exr", "there is no folder"},
                                                        {folder / "made.exr", "it is a folder"},
                                                        {"/proc/a.exr", "cannot write"},
                                                        {longName, "cannot write"}};
  for (const auto& [place, mentions] : places) {
    expectFailure("render " + scene + " -o " + place, 2, mentions);
    for (const std::string option : {"--stats ", "--save-lights ", "--checkpoint ", "--resume "})
      expectFailure("render " + scene + " -o " + (folder / "b.exr") + " " + option + place, 2,
                    mentions);
    expectFailure("fit " + scene + " -o " + place, 2, "");
    expectFailure("bench clamp --scene " + scene + " --json " + place, 2, mentions);
    expectFailure("relight " + scene + " -o " + place, 2, mentions);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "made.exr"));
  std::filesystem::remove(folder / "made.exr");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  test::writeText(folder / "old.exr", "old");
  expectFailure("render " + scene + " -o " + (folder / "old.exr"), 3, "none.xml");
  EXPECT_EQ(test::readText(folder / "old.exr"), "old");
}

TEST(Usage, BadInputIsThree) {
  const TemporaryFolder folder;
  const std::string out = " -o " + (folder / "a.exr");
  expectFailure("render " + (folder / "missing.xml") + out, 3, "missing.xml");
  expectFailure("info " + (folder / "missing.xml"), 3, "missing.xml");
  expectFailure("info cornel", 3, "did you mean 'cornell'");
  test::writeText(folder / "empty.xml",
                  "<scene version=\"3.0.0\"><sensor type=\"perspective\"/></scene>");
  const ProgramResult empty = runProgram("info --json " + (folder / "empty.xml"));
  ASSERT_EQ(empty.exitCode, 0) << empty.err;
  EXPECT_TRUE(nlohmann::json::parse(empty.out)["bounds"].is_null()) << empty.out;
  EXPECT_NE(runProgram("info " + (folder / "empty.xml")).out.find("bounds       empty\n"),
            std::string::npos);
  test::writeText(folder / "scene.blend", "x");
  expectFailure("render " + (folder / "scene.blend") + out, 3, "scene.blend");
  test::writeText(folder / "cut.xml", "<scene version='3.0.0'>\n<shape type='sphere'>\n");
  expectFailure("render " + (folder / "cut.xml") + out, 3, "cut.xml:");
  test::writeText(
      folder / "unknown.xml",
      "<scene version='3.0.0'>\n  <sensor type='perspective'/>\n  <shape type='spere'/>\n</scene>");
  expectFailure("render " + (folder / "unknown.xml") + out, 3, "unknown.xml:3");
  expectFailure("render " + (folder / "unknown.xml") + out, 3, "'sphere'");
  expectFailure("compare " + (folder / "a.exr") + " " + (folder / "b.exr"), 3, "a.exr");
  test::writeText(folder / "broken.exr", "not an image");
  expectFailure("compare " + (folder / "broken.exr") + " " + (folder / "broken.exr"), 3,
                "broken.exr");
  test::writeText(folder / "lights.bin", "not lights");
  expectFailure(std::string(kSmall) + out + " --load-lights " + (folder / "lights.bin"), 3,
                "lights.bin");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

// What cannot apply is said, and the picture made all the same.
TEST(Usage, OptionsWithoutEffectAreSaid) {
  const TemporaryFolder folder;
  const std::string tiny = "render study-phong --detail 0.1 --size 8x8 --spp 2 ";
  const auto warnings = [&](const std::string& options) {
    const ProgramResult r = runProgram(tiny + options + " -o " + (folder / "a.exr"));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    std::vector<std::string> names;
    std::istringstream lines(r.err);
    for (std::string line; std::getline(lines, line);) {
      std::string level, name;
      std::istringstream(line) >> level >> name;
      if (level == "warning:") names.push_back(name);
    }
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(warnings("--num-lights 16"), Names{});
  EXPECT_EQ(warnings("--num-lights 16 --gather sglc --memory 1G"), Names{"--memory"});
  EXPECT_EQ(warnings("--lights path --num-lights 512 --clamp off --direct nee --env-lights 9 "
                     "--passes 2 --gather all"),
            (Names{"--gather", "--num-lights", "--passes", "--env-lights", "--direct", "--clamp"}));
  EXPECT_EQ(warnings("--num-lights 16 --env-lights 9"), Names{"--env-lights"});
  EXPECT_EQ(warnings("--num-lights 16 --env-lights 9 --direct lights"), Names{});
  EXPECT_EQ(warnings("--num-lights 16 --passes 3"), (Names{"--passes"}));
  EXPECT_EQ(warnings("--num-lights 16 --gather-rays 3 --radius 2"),
            (Names{"--radius", "--gather-rays"}));
  EXPECT_EQ(
      warnings("--num-lights 16 --richvpl-lights 9 --richvpl-radiance cube --richvpl-texels 7 "
               "--richvpl-lobes 4"),
      (Names{"--richvpl-lights", "--richvpl-radiance", "--richvpl-texels", "--richvpl-lobes"}));
  EXPECT_EQ(warnings("--lights richvpl --num-lights 16 --richvpl-lights 9 --richvpl-lobes 4 "
                     "--gather all --memory 1G"),
            Names{});
  EXPECT_EQ(warnings("--lights photon --num-lights 99 --gather all --gather-rays 2"),
            Names{"--gather"});
  EXPECT_EQ(warnings("--num-lights 16 --exposure 1 --checkpoint-interval 3"),
            (Names{"--checkpoint-interval", "--exposure"}));
  EXPECT_EQ(warnings("--num-lights 16 --exposure 1 -o " + (folder / "a.png")), Names{});
}

TEST(Usage, MoreNearLightsThanThereAreIsSaid) {
  const TemporaryFolder folder;
  const std::string tiny =
      "render study-phong --detail 0.1 --size 8x8 --spp 1 --num-lights 16 -o " +
      (folder / "a.exr") + " --stats " + (folder / "s.json");
  const ProgramResult more = runProgram(tiny + " --near-lights 5000");
  EXPECT_EQ(more.exitCode, 0) << more.err;
  EXPECT_NE(more.err.find("--near-lights 5000: there are"), std::string::npos) << more.err;
  const ProgramResult few = runProgram(tiny + " --near-lights 4");
  EXPECT_EQ(few.err.find("--near-lights"), std::string::npos) << few.err;
  const auto gather = nlohmann::json::parse(test::readText(folder / "s.json"))["gather"];
  EXPECT_TRUE(gather["threshold"].is_null()) << gather;
  EXPECT_TRUE(gather["error"].is_null()) << gather;
  EXPECT_EQ(gather["bound"], "");
}

TEST(Usage, FilesThatScenesNameAreToldWithItsLine) {
  const TemporaryFolder folder;
  test::writeText(folder / "empty.ply", "");
  test::writeText(folder / "empty.exr", "");
  test::writeText(folder / "mesh.xml",
                  "<scene version=\"3.0.0\">\n\n<shape type=\"ply\"><string name=\"filename\" "
                  "value=\"empty.ply\"/></shape></scene>");
  test::writeText(folder / "light.xml",
                  "<scene version=\"3.0.0\">\n<emitter type=\"envmap\"><string name=\"filename\" "
                  "value=\"empty.exr\"/></emitter></scene>");
  expectFailure("info " + (folder / "mesh.xml"), 3, "mesh.xml:3:");
  expectFailure("info " + (folder / "mesh.xml"), 3, "empty.ply: not a PLY file");
  expectFailure("info " + (folder / "light.xml"), 3, "light.xml:2:");
  expectFailure("info " + (folder / "light.xml"), 3, "empty.exr: the file is empty");
  // Where a relative name was looked for.
  expectFailure("info cornell --design no/such.xml", 3,
                "'no/such.xml' does not exist in " + std::filesystem::current_path().string());
}

TEST(Usage, FoldersAreMadeWithTheirParents) {
  const TemporaryFolder folder;
  test::writeText(folder / "file", "");
  expectFailure("scene cornell --detail 0.1 -o " + (folder / "file/under"), 2, "not a folder");
  expectFailure("convert cornell --detail 0.1 -o " + (folder / "file"), 2, "not a folder");
  for (const char* name : {"one", "two/", "one", "new/and/deep"})
    EXPECT_EQ(runProgram("convert cornell --detail 0.1 --quiet -o " + (folder / name)).exitCode, 0);
}

TEST(Usage, InfoReadsWell) {
  const TemporaryFolder folder;
  const std::string shape =
      "<shape type='sphere'><bsdf type='diffuse'><float name='nonsense' value='1'/></bsdf></shape>";
  test::writeText(folder / "s.xml",
                  "<scene version='3.0.0'><sensor type='perspective'><film type='hdrfilm'><integer "
                  "name='width' value='64'/><integer name='height' value='48'/></film></sensor>" +
                      shape + shape + "<emitter type='point'/><emitter type='point'/></scene>");
  const ProgramResult r = runProgram("info " + (folder / "s.xml"));
  EXPECT_EQ(r.exitCode, 0) << r.err;
  for (const char* line :
       {"emitters     2 point\n", "cameras      64x48\n",
        "bounds       (-1, -1, -1) to (1, 1, 1)\n", "max_depth    unlimited\n",
        "variants     none\n", "names        materials none; emitters none\n", " (2 times)\n"})
    EXPECT_NE(r.out.find(line), std::string::npos) << line << "\n" << r.out;
  EXPECT_EQ(r.out.find_first_of("{}\"["), std::string::npos) << r.out;
}

// What a file holds may be anything; a message that quotes it stays short and moves no cursor.
TEST(Usage, MessagesQuoteFilesSafely) {
  const TemporaryFolder folder;
  test::writeText(folder / "m.obj", "v " + std::string(1 << 20, 'x') + "\n");
  test::writeText(folder / "s.xml",
                  "<scene version='3.0.0'><shape type='obj'><string name='filename' "
                  "value='m.obj'/></shape></scene>");
  EXPECT_LT(runProgram("info " + (folder / "s.xml")).err.size(), 4096u);
  test::writeText(folder / "m.obj", "v \033[2J 0 0\n");
  expectFailure("info " + (folder / "s.xml"), 3, "m.obj:1");
}

}  // namespace
}  // namespace lobelia

// The documents that the program writes about itself: what the repository holds is what the program
// says, man pages format without a warning, completion completes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "lobelia/builtin/builtin_scenes.h"
#include "support/run_program.h"

namespace lobelia {
namespace {

using test::ProgramResult;
using test::readText;
using test::runProgram;
using test::TemporaryFolder;
using test::writeText;

const std::string kSource = LOBELIA_SOURCE_DIR;

std::string printed(const std::string& arguments) {
  const ProgramResult r = runProgram(arguments);
  EXPECT_EQ(r.exitCode, 0) << arguments << "\n" << r.err;
  EXPECT_FALSE(r.out.empty()) << arguments;
  return r.out;
}

bool present(const std::string& command) {
  return std::system(("command -v " + command + " > /dev/null 2>&1").c_str()) == 0;
}

// What a command prints, on both streams.
std::string said(const std::string& command) {
  const TemporaryFolder folder;
  const int status = std::system((command + " > " + (folder / "out") + " 2>&1").c_str());
  EXPECT_EQ(status, 0) << command << "\n" << readText(folder / "out");
  return readText(folder / "out");
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Commands are the titles of the option reference.
std::vector<std::string> commands() {
  std::vector<std::string> out;
  for (const std::string& line : lines(printed("docs markdown")))
    if (line.starts_with("## ") && line != "## Exit codes") out.push_back(line.substr(3));
  return out;
}

TEST(Docs, RepositoryHoldsTheReferenceThatTheProgramPrints) {
  EXPECT_EQ(readText(kSource + "/docs/options.md"), printed("docs markdown"))
      << "run: lobelia docs markdown > docs/options.md";
}

TEST(Docs, RepositoryHoldsTheGalleryThatTheProgramPrints) {
  const std::string text = readText(kSource + "/docs/gallery.md");
  EXPECT_EQ(text, printed("docs gallery")) << "run: scripts/gallery";
  for (const std::string& name : builtin::builtinSceneNames())
    EXPECT_TRUE(text.find("\n## " + name + "\n") != std::string::npos ||
                text.find("`" + name + "`") != std::string::npos)
        << name;
}

// Every picture that the gallery shows is there, and every picture that is there is shown.
TEST(Docs, GalleryPicturesAreThere) {
  const std::string text = readText(kSource + "/docs/gallery.md");
  size_t shown = 0;
  for (size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 2)) {
    const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
    if (!target.starts_with("gallery/")) continue;
    ++shown;
    EXPECT_TRUE(std::filesystem::is_regular_file(kSource + "/docs/" + target)) << target;
  }
  EXPECT_GT(shown, 0u);
  for (const auto& file : std::filesystem::directory_iterator(kSource + "/docs/gallery")) {
    const std::string name = file.path().filename().string();
    EXPECT_NE(text.find("(gallery/" + name + ")"), std::string::npos) << name << " is not shown";
  }
}

TEST(Docs, GalleryPicturesAreSmall) {
  for (const auto& file : std::filesystem::directory_iterator(kSource + "/docs/gallery"))
    EXPECT_LE(file.file_size(), 40u * 1024) << file.path();
}

// Every option says what it is for and what its value is: CLI11's own names of types say neither.
TEST(Docs, EveryOptionIsDescribed) {
  const std::vector<std::string> all = lines(printed("docs markdown"));
  size_t options = 0;
  for (const std::string& line : all) {
    if (!line.starts_with("| `")) continue;
    ++options;
    const size_t begin = line.find("` | ");
    ASSERT_NE(begin, std::string::npos) << line;
    EXPECT_GT(line.find(" | ", begin + 4), begin + 8) << line;
    for (const char* type : {" TEXT`", " INT`", " UINT`", " FLOAT`", " in ["})
      EXPECT_EQ(line.find(type), std::string::npos) << "give the option a type_name(): " << line;
  }
  EXPECT_GT(options, 80u);
}

TEST(Docs, ManPagesFormatWithoutWarnings) {
  if (!present("groff")) GTEST_SKIP() << "no groff";
  const TemporaryFolder folder;
  EXPECT_EQ(runProgram("docs files " + folder.path()).exitCode, 0);
  std::vector<std::string> pages = {"lobelia"};
  for (const std::string& command : commands()) pages.push_back("lobelia-" + command);
  ASSERT_GT(pages.size(), 8u);
  for (const std::string& page : pages) {
    const std::string file = folder / "man/man1/" + page + ".1", text = readText(file);
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS"})
      EXPECT_NE(text.find(std::string("\n.SH ") + section + "\n"), std::string::npos)
          << page << " lacks " << section;
    EXPECT_EQ(said("groff -man -Tutf8 -ww -z " + file), "") << page;
  }
  EXPECT_EQ(runProgram("docs man rendr").exitCode, 2);
}

TEST(Docs, FilesForInstallation) {
  const TemporaryFolder folder;
  EXPECT_EQ(runProgram("docs files " + (folder / "share")).exitCode, 0);
  for (const char* file :
       {"man/man1/lobelia.1", "man/man1/lobelia-render.1", "bash-completion/completions/lobelia",
        "zsh/site-functions/_lobelia", "fish/vendor_completions.d/lobelia.fish"})
    EXPECT_FALSE(readText(folder / "share/" + file).empty()) << file;
}

// What bash offers for a line that ends where the cursor is. The words as bash splits them.
std::vector<std::string> offeredByBash(const std::string& words) {
  static const std::string script = printed("completion bash");
  const TemporaryFolder folder;
  writeText(folder / "completion", script);
  writeText(folder / "try", "source " + (folder / "completion") + "\nCOMP_WORDS=(" + words +
                                ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_lobelia\n"
                                "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
  return lines(said("bash --norc " + (folder / "try")));
}

TEST(Completion, BashCompletes) {
  if (!present("bash")) GTEST_SKIP() << "no bash";
  using Words = std::vector<std::string>;
  EXPECT_EQ(offeredByBash("lobelia ren"), Words{"render"});
  EXPECT_TRUE(contains(offeredByBash("lobelia render --li"), "--lights"));
  EXPECT_EQ(offeredByBash("lobelia render --lights ''"),
            (Words{"path", "light", "photon", "vpl", "glossy", "vsl", "vsgl", "richvpl"}));
  EXPECT_EQ(offeredByBash("lobelia render --lights = gl"), Words{"glossy"});
  EXPECT_EQ(offeredByBash("lobelia render --aov albedo,dep"), Words{"albedo,depth"});
  EXPECT_TRUE(contains(offeredByBash("lobelia render kitch"), "kitchen"));
  EXPECT_EQ(offeredByBash("lobelia render " + kSource + "/READM"), Words{kSource + "/README.md"});
  EXPECT_EQ(offeredByBash("lobelia render kitchen -o " + kSource + "/READM"),
            Words{kSource + "/README.md"});
  EXPECT_EQ(offeredByBash("lobelia bench rat"), Words{"rates"});
  EXPECT_EQ(offeredByBash("lobelia completion f"), Words{"fish"});
  EXPECT_EQ(offeredByBash("lobelia render --spp ''"), Words{""}) << "a number is not a file";
}

TEST(Completion, FishCompletes) {
  if (!present("fish")) GTEST_SKIP() << "no fish";
  const TemporaryFolder folder;
  writeText(folder / "completion", printed("completion fish"));
  const auto offered = [&](const std::string& line) {
    writeText(folder / "try",
              "source " + (folder / "completion") + "\ncomplete -C '" + line + "'\n");
    return said("HOME=" + folder.path() + " fish --no-config " + (folder / "try"));
  };
  EXPECT_TRUE(offered("lobelia ren").starts_with("render\t"));
  EXPECT_NE(offered("lobelia render --li").find("--lights"), std::string::npos);
  EXPECT_NE(offered("lobelia render --lights gl").find("glossy"), std::string::npos);
  EXPECT_NE(offered("lobelia render kitch").find("kitchen"), std::string::npos);
}

TEST(Completion, ZshTakesTheScript) {
  if (!present("zsh")) GTEST_SKIP() << "no zsh";
  const TemporaryFolder folder;
  writeText(folder / "_lobelia", printed("completion zsh"));
  EXPECT_EQ(said("zsh -f -n " + (folder / "_lobelia")), "");
  writeText(folder / "try", "autoload -U compinit; compinit -D -u; source " +
                                (folder / "_lobelia") + "; print ${_comps[lobelia]}\n");
  EXPECT_EQ(said("zsh -f " + (folder / "try")), "_lobelia\n");
}

TEST(Completion, UnknownShellIsWrongUsage) {
  const ProgramResult r = runProgram("completion tcsh");
  EXPECT_EQ(r.exitCode, 2);
  EXPECT_NE(r.err.find("fish"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace lobelia

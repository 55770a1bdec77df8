// The document layer: includes, parameters, ids, places, malformed files.
#include "io/mitsuba_scene.h"
#include "lobelia/base/random.h"
#include "lobelia/io/mitsuba/xml.h"

namespace lobelia {
namespace {

using io::mitsuba::snakeCase;
using test::modern;
using test::onlyFinding;
using test::readModern;
using test::readText;
using test::refusal;

std::string refusedText(const std::string& text) {
  const TemporaryFolder folder;
  return messageOf<InputError>([&] { readText(folder, text); });
}

TEST(MitsubaXml, NamesInOneSpelling) {
  EXPECT_EQ(snakeCase("maxDepth"), "max_depth");
  EXPECT_EQ(snakeCase("intIOR"), "int_ior");
  EXPECT_EQ(snakeCase("toWorld"), "to_world");
  EXPECT_EQ(snakeCase("wrapModeU"), "wrap_mode_u");
  EXPECT_EQ(snakeCase("int_ior"), "int_ior");
  EXPECT_EQ(snakeCase("p0"), "p0");
  EXPECT_EQ(snakeCase(""), "");
}

TEST(MitsubaXml, WarningsHaveLineAndColumn) {
  const Scene scene =
      readModern("<bsdf type=\"diffuse\">\n  <float name=\"foo\" value=\"1\"/></bsdf>");
  ASSERT_EQ(scene.findings.size(), 1u);
  EXPECT_EQ(scene.findings[0].where.line, 3);
  EXPECT_EQ(scene.findings[0].where.column, 4);
  EXPECT_TRUE(contains(scene.findings[0].where.file, "scene.xml"));
  EXPECT_TRUE(contains(scene.findings[0].message, "'foo'"));
}

TEST(MitsubaXml, UnknownPropertyNamesTheNearest) {
  const Scene scene =
      readModern("<bsdf type=\"roughplastic\"><float name=\"alhpa\" value=\"0.2\"/></bsdf>");
  EXPECT_TRUE(contains(onlyFinding(scene), "did you mean 'alpha'?"));
}

TEST(MitsubaXml, StrictMakesWarningsErrors) {
  io::ReadSettings strict;
  strict.strict = true;
  EXPECT_NO_THROW(readModern("<bsdf type=\"diffuse\"/>", strict));
  const std::string message = messageOf<InputError>([&] {
    readModern("<bsdf type=\"diffuse\">\n<float name=\"foo\" value=\"1\"/></bsdf>", strict);
  });
  EXPECT_TRUE(contains(message, "scene.xml:3"));
  EXPECT_TRUE(contains(message, "foo"));
}

TEST(MitsubaXml, ParametersAreSubstituted) {
  const std::string body =
      "<default name=\"a\" value=\"0.25\"/><default name=\"ab\" value=\"0.5\"/>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"$a $ab 1\"/></bsdf>";
  EXPECT_EQ(readModern(body).materials[0].diffuse.value, Rgb(0.25f, 0.5f, 1.f));
  io::ReadSettings settings;
  settings.definitions["ab"] = "0.75";
  EXPECT_EQ(readModern(body, settings).materials[0].diffuse.value, Rgb(0.25f, 0.75f, 1.f));
}

TEST(MitsubaXml, DefinitionsThatNothingUsesAreReported) {
  io::ReadSettings settings;
  settings.definitions["ssp"] = "4";
  const std::string message = onlyFinding(readModern("", settings));
  EXPECT_TRUE(contains(message, "'ssp'"));
  EXPECT_FALSE(contains(message, "did you mean")) << "nothing else is there to be meant";
  const std::string body = "<default name=\"spp\" value=\"1\"/>";
  EXPECT_TRUE(contains(onlyFinding(readModern(body, settings)), "did you mean 'spp'"));
}

TEST(MitsubaXml, UndefinedParametersMatterWhereTheyAreUsed) {
  EXPECT_TRUE(contains(refusal("<bsdf type=\"diffuse\">\n<float name=\"reflectance\" "
                               "value=\"$rho\"/></bsdf>"),
                       "scene.xml:3"));
  EXPECT_TRUE(contains(refusal("<shape type=\"$kind\"/>"), "$kind"));
  EXPECT_TRUE(
      contains(onlyFinding(readModern("<integrator type=\"$integrator\"/>")), "$integrator"));
}

TEST(MitsubaXml, IncludesAreRelativeToTheirFile) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("parts"));
  folder.write("parts/outer.xml",
               "<scene version=\"0.6.0\"><include filename=\"inner.xml\"/></scene>");
  folder.write("parts/inner.xml",
               "<scene version=\"0.6.0\"><bsdf type=\"plastic\" id=\"p\"/>"
               "<bsdf type=\"conductor\"/></scene>");
  const Scene scene = readText(folder, modern("<include filename=\"parts/outer.xml\"/>"
                                              "<shape type=\"rectangle\"><ref id=\"p\"/></shape>"));
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].type, MaterialType::plastic);
  // The included file keeps its dialect: a conductor of 0.6 is copper.
  EXPECT_NEAR(scene.materials[1].k.value.x, 3.912f, 0.01f);
  EXPECT_TRUE(scene.findings.empty());
}

TEST(MitsubaXml, CircularIncludesShowTheChain) {
  const TemporaryFolder folder;
  folder.write("a.xml", "<scene version=\"3.0.0\"><include filename=\"b.xml\"/></scene>");
  folder.write("b.xml", "<scene version=\"3.0.0\">\n<include filename=\"a.xml\"/></scene>");
  const std::string message =
      messageOf<InputError>([&] { readText(folder, modern("<include filename=\"a.xml\"/>")); });
  EXPECT_TRUE(contains(message, "b.xml:2"));
  EXPECT_TRUE(contains(message, "a.xml -> "));
}

TEST(MitsubaXml, TheSameFileMayBeIncludedTwice) {
  const TemporaryFolder folder;
  folder.write("a.xml", "<scene version=\"3.0.0\"><shape type=\"cube\"/></scene>");
  const Scene scene =
      readText(folder, modern("<include filename=\"a.xml\"/><include filename=\"a.xml\"/>"));
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u);
}

TEST(MitsubaXml, DeepIncludesAreRefused) {
  const TemporaryFolder folder;
  const auto name = [](int i) { return std::to_string(i) + ".xml"; };
  for (int i = 0; i < 40; ++i) {
    std::string text = "<scene version=\"3.0.0\"><include filename=\"";
    text += name(i + 1);
    text += "\"/></scene>";
    folder.write(name(i), text);
  }
  EXPECT_TRUE(contains(
      messageOf<InputError>([&] { readText(folder, modern("<include filename=\"0.xml\"/>")); }),
      "levels deep"));
}

TEST(MitsubaXml, PathsAndAliases) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("meshes"));
  folder.write("meshes/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = readText(
      folder, modern("<path value=\"meshes\"/><bsdf type=\"plastic\" id=\"a\"/>"
                     "<alias id=\"a\" as=\"b\"/><shape type=\"obj\"><string name=\"filename\" "
                     "value=\"t.obj\"/><ref id=\"b\"/></shape>"));
  EXPECT_EQ(scene[scene.instances[0].material].type, MaterialType::plastic);
  EXPECT_TRUE(contains(refusal("<alias id=\"x\" as=\"y\"/>"), "'x'"));
  EXPECT_TRUE(contains(refusal("<path value=\"nowhere\"/>"), "nowhere"));
}

TEST(MitsubaXml, IdsAreUnique) {
  const std::string message =
      refusal("<bsdf type=\"diffuse\" id=\"m\"/>\n<bsdf type=\"diffuse\" id=\"m\"/>");
  EXPECT_TRUE(contains(message, "scene.xml:3"));
  EXPECT_TRUE(contains(message, "scene.xml:2"));
  EXPECT_TRUE(contains(refusal("<bsdf type=\"diffuse\" id=\"wood\"/>"
                               "<shape type=\"cube\"><ref id=\"wod\"/></shape>"),
                       "did you mean 'wood'?"));
}

TEST(MitsubaXml, ReferencesInACircleAreRefused) {
  EXPECT_TRUE(contains(refusal("<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>"
                               "<bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>"),
                       "refers to itself"));
}

TEST(MitsubaXml, MalformedFiles) {
  EXPECT_TRUE(contains(refusedText("<scene version=\"3.0.0\">\n<shape type="), "scene.xml:2"));
  EXPECT_TRUE(contains(refusedText("<scene version=\"3.0.0\">\n<shape type=\"cube\">\n</scene>"),
                       "scene.xml:3"));
  EXPECT_TRUE(contains(refusedText(""), "not well-formed"));
  EXPECT_TRUE(contains(refusedText(std::string("\0\0\0", 3)), "not well-formed"));
  EXPECT_TRUE(contains(refusedText("<bsdf type=\"diffuse\"/>"), "the root element is <bsdf>"));
  EXPECT_TRUE(contains(refusedText("<scene version=\"x\"/>"), "'x'"));
  const Scene scene = [] {
    const TemporaryFolder folder;
    return readText(folder, "<scene><sensor type=\"perspective\"/></scene>");
  }();
  EXPECT_TRUE(contains(onlyFinding(scene), "no version"));
}

TEST(MitsubaXml, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = modern(
      "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><bsdf "
      "type=\"diffuse\"/></shape>");
  for (size_t n = 0; n < whole.size(); ++n) {
    EXPECT_THROW(readText(folder, whole.substr(0, n)), InputError) << n;
  }
}

// Damaged files are read or refused; nothing else happens (this runs under sanitizers too).
TEST(MitsubaXml, DamagedFilesAreReadOrRefused) {
  const TemporaryFolder folder;
  const std::string whole = test::legacy(
      "<default name=\"r\" value=\"2\"/><bsdf type=\"mixturebsdf\" id=\"m\"><string "
      "name=\"weights\" value=\"0.5, 0.3\"/><bsdf type=\"roughconductor\"/><bsdf "
      "type=\"principled\"><spectrum name=\"baseColor\" value=\"400:0.2, 700:0.4\"/></bsdf></bsdf>"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/><ref id=\"m\"/><transform "
      "name=\"toWorld\"><rotate y=\"1\" angle=\"30\"/><matrix value=\"1 0 0 0 1 0 0 0 1\"/>"
      "</transform></shape>");
  const std::vector<std::string> values{"-1", "0", "1e38", "nan", "", "99999999999", "1 2 3", "$x"};
  Rng random(1, 0);
  const auto below = [&](size_t n) {
    return std::min(static_cast<size_t>(random.next1D() * static_cast<float>(n)), n - 1);
  };
  int read = 0, refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = whole;
    const size_t at = below(text.size());
    if (const size_t kind = below(4); kind == 0) {
      text[at] = static_cast<char>(below(256));
    } else if (kind == 1) {
      text.erase(at, 1 + below(12));
    } else if (kind == 2) {
      text.insert(at, text.substr(below(text.size()), below(40)));
    } else if (const size_t value = text.find("value=\"", at); value != text.npos) {
      text.replace(value + 7, text.find('"', value + 7) - value - 7, values[below(values.size())]);
    }
    try {
      readText(folder, text);
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
}

TEST(MitsubaXml, MissingFilesAreNamed) {
  Context context;
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { io::readMitsuba("/nowhere/scene.xml", {}, context); }),
               "/nowhere/scene.xml"));
  EXPECT_TRUE(contains(refusal("<include filename=\"gone.xml\"/>"), "gone.xml"));
  EXPECT_TRUE(contains(
      refusal("\n<shape type=\"ply\"><string name=\"filename\" value=\"gone.ply\"/></shape>"),
      "scene.xml:3"));
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(
      messageOf<InputError>([&] { io::readMitsuba(folder.path(""), {}, context); }), "folder"));
}

TEST(MitsubaXml, DeepNestingIsRefused) {
  std::string body;
  for (int i = 0; i < 100000; ++i) body += "<bsdf type=\"twosided\">";
  body += "<bsdf type=\"diffuse\"/>";
  for (int i = 0; i < 100000; ++i) body += "</bsdf>";
  EXPECT_TRUE(contains(refusal(body), "levels deep"));
}

TEST(MitsubaXml, LeftoversOfOtherProgramsAreWarnings) {
  const Scene scene = readModern(
      "<mode type=\"final\"/>\n<shape type=\"cube\" colour=\"red\">"
      "<hide name=\"x\"/></shape>text");
  ASSERT_EQ(scene.findings.size(), 4u);
  EXPECT_EQ(scene.instances.size(), 1u);
}

TEST(MitsubaXml, UnknownExtensionsSayWhatCanBeRead) {
  Context context;
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { io::readScene("a.blend", {}, context); }), ".xml"));
}

}  // namespace
}  // namespace lobelia

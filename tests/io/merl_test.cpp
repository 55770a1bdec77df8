// Tables of MERL: files there and back, broken files, materials read from them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "bsdf/captured_tables.h"
#include "io/mitsuba_scene.h"
#include "io/temporary_folder.h"
#include "lobelia/bsdf/captured.h"
#include "lobelia/io/merl_reader.h"

namespace lobelia::io {
namespace {

TabulatedBrdf example() {
  Bsdf bsdf;
  bsdf.add(capturedDiffuse({0.3f, 0.2f, 0.1f}, 1));
  bsdf.add(capturedLobe(Rgb(0.4f / projectedIntegral(40)), 40, 1));
  return test::tabulate(bsdf);
}

void expectRefused(const std::string& file, const std::string& part) {
  try {
    readMerl(file);
    ADD_FAILURE() << "no error; expected " << part;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(file), std::string::npos) << e.what();
  }
}

TEST(Merl, ComesBack) {
  const TemporaryFolder folder;
  TabulatedBrdf table = example();
  const size_t measured = TabulatedBrdf::index(3, 4, 5), hidden = TabulatedBrdf::index(4, 4, 5);
  ASSERT_TRUE(isMeasured(table.values[hidden]));
  table.values[hidden].y = -1;
  table.values[measured] = {1, 1, 1};
  writeMerl(folder.path("a.binary"), table);
  // The units of the format: 1500 per red unit, 1500 / 1.66 per blue.
  std::ifstream in(folder.path("a.binary"), std::ios::binary);
  double red = 0, blue = 0;
  in.seekg(static_cast<std::streamoff>(12 + 8 * measured));
  in.read(reinterpret_cast<char*>(&red), 8);
  in.seekg(static_cast<std::streamoff>(12 + 8 * (2 * TabulatedBrdf::kSize + measured)));
  in.read(reinterpret_cast<char*>(&blue), 8);
  EXPECT_DOUBLE_EQ(red, 1500);
  EXPECT_NEAR(blue, 1500 / 1.66, 1e-9);
  const TabulatedBrdf copy = readMerl(folder.path("a.binary"));
  EXPECT_EQ(copy.values[measured], Rgb(1.f));
  EXPECT_EQ(copy.invalidCount, table.invalidCount + 1);
  EXPECT_EQ(copy.aboveCount, table.aboveCount);
  size_t different = 0;
  for (size_t i = 0; i < TabulatedBrdf::kSize; ++i) {
    const Rgb error = copy.values[i] - table.values[i];
    if (!(maxComponent(max(error, -error)) <= 1e-6f * (1 + maxComponent(table.values[i]))))
      ++different;
  }
  EXPECT_EQ(different, 0u);
}

TEST(Merl, BrokenFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string file = folder.path("b.binary");
  EXPECT_THROW(readMerl(folder.path("none.binary")), InputError);
  EXPECT_THROW(readMerl(folder.path("")), InputError);  // a folder
  writeMerl(file, example());
  std::filesystem::resize_file(file, 1000000);
  expectRefused(file, "1000000 bytes");
  std::filesystem::resize_file(file, 4);
  expectRefused(file, "4 bytes");
  TabulatedBrdf empty;
  writeMerl(file, empty);
  expectRefused(file, "no measured value");
  // Other dimensions of the same size; values that are not numbers.
  std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
  const int32_t dimensions[3] = {180, 90, 90};
  out.write(reinterpret_cast<const char*>(dimensions), 12);
  out.close();
  expectRefused(file, "180 x 90 x 90");
  TabulatedBrdf table = example();
  const size_t at = TabulatedBrdf::index(0, 0, 0);
  table.values[at].x = std::numeric_limits<float>::quiet_NaN();
  writeMerl(file, table);
  EXPECT_FALSE(isMeasured(readMerl(file).values[at]));
}

TEST(Merl, MaterialsAreFittedWhenLoadedAndFitsAreIncluded) {
  const TemporaryFolder folder;
  const TabulatedBrdf table = example();
  writeMerl(folder.path("c.binary"), table);
  const CapturedFit fit = fitCaptured(table, 1);
  writeFit(folder.path("c.xml"), fit, "cloth");
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path(name)) << text;
    Context context;
    return readMitsuba(folder.path(name), {}, context);
  };
  const Scene scene =
      write("scene.xml",
            "<scene version=\"3.0.0\"><include filename=\"c.xml\"/>"
            "<shape type=\"sphere\"><bsdf type=\"merl\"><string name=\"filename\" "
            "value=\"c.binary\"/><integer name=\"lobes\" value=\"1\"/></bsdf></shape>"
            "<shape type=\"sphere\"><ref id=\"cloth\"/></shape></scene>");
  std::vector<const Material*> captured;
  for (const Material& m : scene.materials)
    if (m.type == MaterialType::sphericalGaussians) captured.push_back(&m);
  ASSERT_EQ(captured.size(), 2u);
  for (const Material* m : captured) {
    EXPECT_EQ(m->diffuse.value, fit.diffuse);
    EXPECT_EQ(m->ior, fit.ior);
    ASSERT_EQ(m->capturedLobes.size(), fit.lobes.size());
    EXPECT_EQ(m->capturedLobes[0].amplitude.value, fit.lobes[0].amplitude);
    EXPECT_EQ(m->capturedLobes[0].sharpness.value, fit.lobes[0].sharpness);
  }
  const std::string head = "<scene version=\"3.0.0\"><shape type=\"sphere\"><bsdf type=\"";
  EXPECT_THROW(write("d.xml", head + "measured\"><string name=\"filename\" "
                                     "value=\"x.bsdf\"/></bsdf></shape></scene>"),
               InputError);
  EXPECT_THROW(write("e.xml", head + "sphericalgaussians\"><rgb name=\"amplitude0\" "
                                     "value=\"1\"/></bsdf></shape></scene>"),
               InputError);
  EXPECT_THROW(write("f.xml", head + "sphericalgaussians\"><float name=\"int_ior\" "
                                     "value=\"0.9\"/></bsdf></shape></scene>"),
               InputError);
}

// The model's lobes lie about the mirror direction: they cannot follow a retroreflector.
TEST(Merl, PoorFitsAreSaid) {
  const TabulatedBrdf good = example();
  EXPECT_EQ(doubtsAbout(good, fitCaptured(good, 1)), "");

  TabulatedBrdf backward = good;
  for (int h = 0; h < TabulatedBrdf::kThetaH; ++h) {
    for (int d = 0; d < TabulatedBrdf::kThetaD; ++d) {
      for (int p = 0; p < TabulatedBrdf::kPhiD; ++p) {
        const DirectionPair pair = toDirections(TabulatedBrdf::centre(h, d, p));
        Rgb& value = backward.values[TabulatedBrdf::index(h, d, p)];
        if (isMeasured(value)) value = Rgb(0.05f + std::exp(20 * (dot(pair.wo, pair.wi) - 1)));
      }
    }
  }
  const CapturedFit fit = fitCaptured(backward, 1);
  EXPECT_NE(doubtsAbout(backward, fit).find(fmt::format("off by {:.1f} %", 100 * fit.error)),
            std::string::npos)
      << describeFit(backward, fit);

  TabulatedBrdf sparse = good;  // a quarter was measured
  for (size_t i = 0; i < sparse.values.size(); ++i)
    if (i % 4 != 0) sparse.values[i] = Rgb(-1.f);
  countInvalid(sparse);
  EXPECT_NE(doubtsAbout(sparse, fitCaptured(sparse, 1)).find("not measured"), std::string::npos);
}

}  // namespace
}  // namespace lobelia::io

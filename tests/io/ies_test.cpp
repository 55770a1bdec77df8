#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "io/temporary_folder.h"
#include "lobelia/io/ies_reader.h"

namespace lobelia {
namespace {

std::string file(const std::string& version, const std::string& tilt, const std::string& numbers) {
  return version + "[TEST] made up\r\n[MANUFAC] nobody\r\n" + tilt + "\r\n" + numbers;
}
// 1 lamp of 1000 lm, multiplier 2, `v` x `h` angles, type C, metres, no size; ballast 0.5, 1, 10 W.
std::string counts(int v, int h, int type = 1) {
  return "1 1000 2 " + std::to_string(v) + ' ' + std::to_string(h) + ' ' + std::to_string(type) +
         " 2 0 0 0\n0.5 1 10\n";
}

io::IesPhotometry read(const std::string& text, std::vector<Finding>* findings = nullptr) {
  const TemporaryFolder folder;
  std::vector<Finding> found;
  const auto p = io::readIes(folder.write("a.ies", text), {}, findings ? *findings : found);
  EXPECT_TRUE(found.empty()) << found[0].message;
  return p;
}
std::string refused(const std::string& text) {
  return messageOf<InputError>([&] { read(text); });
}

TEST(Ies, EveryEditionIsRead) {
  for (const char* version :
       {"", "IESNA91\r\n", "IESNA:LM-63-1995\n", "IESNA:LM-63-2002\r\n", "IESNA:LM-63-2019\r"}) {
    const io::IesPhotometry p =
        read(file(version, "TILT=NONE", counts(3, 1) + "0 90\n180\n0\n100 50,\n0\n"));
    EXPECT_EQ(p.lumens, 1000);
    EXPECT_DOUBLE_EQ(p.multiplier, 1);
    EXPECT_DOUBLE_EQ(p.at(0, 0), 100);
    EXPECT_DOUBLE_EQ(p.at(45, 77), 75);  // the same all round
    EXPECT_DOUBLE_EQ(p.at(180, 0), 0);
  }
}

TEST(Ies, FactorsMultiply) {
  const io::IesPhotometry p =
      read(file("IESNA91\n", "TILT=NONE", "2 1000 3 2 1 1 1 0 0 0 0.9 0.8 10\n0 90\n0\n100 100\n"));
  EXPECT_DOUBLE_EQ(p.at(10, 0), 100 * 3 * 0.9 * 0.8);
}

TEST(Ies, MirrorsWhatWasMeasuredOnce) {
  // One vertical range, candela = the number of the plane.
  const auto planes = [](const std::string& angles, int n) {
    std::string text = counts(2, n) + "0 180\n" + angles + "\n";
    for (int i = 0; i < n; ++i)
      text += std::to_string(10 * i) + ' ' + std::to_string(10 * i) + '\n';
    return read(file("IESNA:LM-63-2002\n", "TILT=NONE", text));
  };
  const auto quarter = planes("0 45 90", 3);
  for (const double phi : {30., 150., 210., 330., -30., 390.})
    EXPECT_NEAR(quarter.at(50, phi), 10 * 30 / 45., 1e-9) << phi;
  const auto half = planes("0 90 180", 3);
  EXPECT_NEAR(half.at(50, 135), 15, 1e-9);
  EXPECT_NEAR(half.at(50, 225), 15, 1e-9);
  const auto full = planes("0 90 180 270 360", 5);
  EXPECT_NEAR(full.at(50, 225), 25, 1e-9);
  const auto open = planes("0 90 180 270", 4);  // 360 left out: closes with 0
  EXPECT_NEAR(open.at(50, 315), 15, 1e-9);
  const auto sideways = planes("90 180 270", 3);
  EXPECT_NEAR(sideways.at(50, 135), 5, 1e-9);
  EXPECT_NEAR(sideways.at(50, 45), 5, 1e-9);
  EXPECT_NEAR(sideways.at(50, 315), 15, 1e-9);
}

TEST(Ies, NothingIsSentWhereNothingWasMeasured) {
  const auto p = read(file("IESNA91\n", "TILT=NONE", counts(2, 1) + "0 90\n0\n100 100\n"));
  EXPECT_EQ(p.at(89, 0), 100);
  EXPECT_EQ(p.at(91, 0), 0);
}

TEST(Ies, TypesAAndBTurnAroundTheirAxes) {
  const std::string angles = "-90 0 90\n-90 0 90\n";
  // Candela 100 straight ahead, 30 at the horizontal ends, 7 at the vertical ones.
  const std::string values = "30 30 30\n7 100 7\n30 30 30\n";
  for (const int type : {2, 3}) {
    const auto p = read(file("IESNA91\n", "TILT=NONE", counts(3, 3, type) + angles + values));
    EXPECT_NEAR(p.at(0, 0), 100, 1e-9);
    EXPECT_NEAR(p.at(90, 0), 30, 1e-9);    // to the right
    EXPECT_NEAR(p.at(90, 180), 30, 1e-9);  // and left
    EXPECT_NEAR(p.at(89.9, 90), 7, 0.2);   // above
    EXPECT_NEAR(p.at(45, 0), 65, 1e-9);
    EXPECT_NEAR(p.at(45, 90), 53.5, 1e-9);
  }
  // Off the axes the two differ: A's horizontal angle is larger there, B's vertical one.
  const auto a = read(file("IESNA91\n", "TILT=NONE", counts(3, 3, 3) + angles + values));
  const auto b = read(file("IESNA91\n", "TILT=NONE", counts(3, 3, 2) + angles + values));
  EXPECT_GT(std::abs(a.at(60, 45) - b.at(60, 45)), 1);
}

TEST(Ies, TiltIsReported) {
  std::vector<Finding> findings;
  const std::string numbers = counts(2, 1) + "0 90\n0\n100 100\n";
  read(file("IESNA91\n", "TILT=INCLUDE", "1\n3\n0 90 180\n1 0.9 0.8\n" + numbers), &findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_TRUE(contains(findings[0].message, "tilt table"));
  read(file("IESNA91\n", "TILT=lamp.tlt", numbers), &findings);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_TRUE(contains(findings[1].message, "lamp.tlt"));
  read(file("IESNA91\n", "TILT=NONE", numbers + "17\n"), &findings);
  ASSERT_EQ(findings.size(), 3u);
}

TEST(Ies, DamagedFilesAreRefusedWithTheLine) {
  const auto wrong = [](const std::string& numbers) {
    return refused(file("IESNA91\n", "TILT=NONE", numbers));
  };
  EXPECT_TRUE(contains(refused(""), "empty"));
  EXPECT_TRUE(contains(refused("IESNA91\n[TEST] x\n"), "TILT"));
  EXPECT_TRUE(contains(refused("\x7f"
                               "ELF binary"),
                       "TILT"));
  EXPECT_TRUE(contains(wrong("1 1000"), "cut short"));
  EXPECT_TRUE(contains(wrong(counts(2, 1) + "0 90\n0\n100\n"), "cut short"));
  const std::string words = wrong(counts(2, 1) + "0 90\n0\n100 many\n");
  EXPECT_TRUE(contains(words, "'many'") && contains(words, ":9")) << words;
  EXPECT_TRUE(contains(wrong(counts(2, 1) + "90 0\n0\n1 1\n"), "do not increase"));
  EXPECT_TRUE(contains(wrong(counts(2, 1) + "0 190\n0\n1 1\n"), "vertical angles"));
  EXPECT_TRUE(contains(wrong(counts(2, 2) + "0 90\n0 45\n1 1 1 1\n"), "horizontal angles"));
  EXPECT_TRUE(contains(wrong(counts(2, 1) + "0 90\n0\n1 -1\n"), "-1"));
  EXPECT_TRUE(contains(wrong("1 1000 1 999999999 1 1 1 0 0 0 1 1 1\n"), "1 to"));
  EXPECT_TRUE(contains(wrong("1 1000 1 20000 20000 1 1 0 0 0 1 1 1\n0 1"), "cannot fit"));
  EXPECT_TRUE(contains(wrong("1 1000 1 2.5 1 1 1 0 0 0 1 1 1\n"), "integer"));
  EXPECT_TRUE(contains(wrong("1 1000 1 2 1 4 1 0 0 0 1 1 1\n"), "photometric type"));
  EXPECT_TRUE(contains(wrong("1 1000 0 2 1 1 1 0 0 0 1 1 1\n"), "multiplier"));
  EXPECT_TRUE(contains(wrong("1 1000 inf 2 1 1 1 0 0 0 1 1 1\n"), "number"));
}

TEST(Ies, ImageHoldsTheMeasurements) {
  const auto p =
      read(file("IESNA91\n", "TILT=NONE",
                counts(3, 3) + "0 45 90\n0 90 180\n" + "100 50 20\n100 60 30\n100 70 40\n"));
  const Image image = io::iesImage(p, "x");
  EXPECT_EQ(image.channels, 1);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double down = 180.0 * y / (image.height - 1), around = 360.0 * x / image.width;
      EXPECT_NEAR(image.at(x, y, 0), p.at(down, around), 1e-4);
    }
  }
  EXPECT_EQ(image.at(0, 0, 0), 100);
  EXPECT_EQ(image.at(0, image.height - 1, 0), 0);
  // Rotational symmetry needs one column.
  EXPECT_EQ(io::iesImage(read(file("", "TILT=NONE", counts(2, 1) + "0 90\n0\n9 9\n")), "x").width,
            1);
}

// Candela of a lamp with one bright plane and, in it, one bright angle.
TEST(Ies, ImageKeepsNarrowPeaks) {
  struct Case {
    std::string planes;
    int count;
    double peak;
  };
  for (const Case& c : {Case{"0 15 30 45 60 75 90", 7, 45}, Case{"0 22.5 45 67.5 90", 5, 22.5},
                        Case{"0 10 25 90", 4, 25}, Case{"0 7.25 90 180 359.5", 5, 7.25}}) {
    std::string candela;
    std::istringstream planes(c.planes);
    for (double plane; planes >> plane;) candela += plane == c.peak ? "0 0 1000 0\n" : "0 0 0 0\n";
    const auto p = read(file("IESNA91\n", "TILT=NONE",
                             counts(4, c.count) + "0 12 37.5 90\n" + c.planes + "\n" + candela));
    const Image image = io::iesImage(p, "x");
    // The brightest texel is the peak, in the direction where the emitter has it.
    const auto brightest = std::max_element(image.pixels.begin(), image.pixels.end());
    EXPECT_NEAR(*brightest, 1000, 10) << c.planes;
    const auto index = static_cast<int>(brightest - image.pixels.begin());
    EXPECT_NEAR(180. * (index / image.width) / (image.height - 1), 37.5, 0.01) << c.planes;
    const double around = 360 * (index % image.width + 0.5) / image.width + io::iesTurn(image);
    EXPECT_NEAR(around, c.peak, 0.01) << c.planes;
  }
}

}  // namespace
}  // namespace lobelia

#include "lobelia/io/spectrum.h"

#include "io/temporary_folder.h"
#include "lobelia/io/optical_constants.h"

namespace lobelia::io {
namespace {

Spectrum constant(double value) { return {{300, 900}, {value, value}}; }

// sRGB back to XYZ, by inverting the matrix numerically (Cramer).
Vec3d toXyz(Rgb c) {
  const Vec3d a = xyzToRgb({1, 0, 0}), b = xyzToRgb({0, 1, 0}), d = xyzToRgb({0, 0, 1});
  const Vec3d v{double{c.x}, double{c.y}, double{c.z}};
  const double det = dot(a, cross(b, d));
  return {dot(v, cross(b, d)) / det, dot(a, cross(v, d)) / det, dot(a, cross(b, v)) / det};
}

TEST(Spectrum, MatchingFunctionsHitTheirTable) {
  EXPECT_DOUBLE_EQ(cie1931(555).y, 1.0);
  EXPECT_DOUBLE_EQ(cie1931(445).z, 1.7826);
  EXPECT_DOUBLE_EQ(cie1931(600).x, 1.0622);
  EXPECT_DOUBLE_EQ(cie1931(557.5).y, 0.9975);  // between 1 and 0.995
  EXPECT_EQ(cie1931(359.9), Vec3d());
  EXPECT_EQ(cie1931(830.1), Vec3d());
  EXPECT_GT(cie1931(830).x, 0);
}

TEST(Spectrum, MatchingFunctionsHaveEqualAreas) {
  // The observer is normalised so that the equal-energy spectrum has equal X, Y and Z.
  Vec3d sum;
  for (int w = 360; w <= 830; ++w) sum += cie1931(w);
  EXPECT_NEAR(sum.x / sum.y, 1, 1e-3);
  EXPECT_NEAR(sum.z / sum.y, 1, 1e-3);
}

TEST(Spectrum, EqualEnergyHasLuminanceOneAndIsReddish) {
  const Rgb rgb = spectrumToRgb(constant(1), SpectrumUse::emission);
  EXPECT_NEAR(toXyz(rgb).y, 1, 2e-3);
  EXPECT_NEAR(rgb.x, 1.2048f, 3e-3f);
  EXPECT_NEAR(rgb.y, 0.9483f, 3e-3f);
  EXPECT_NEAR(rgb.z, 0.9089f, 3e-3f);
}

TEST(Spectrum, ReflectancesAreClampedAndThatIsSaid) {
  bool clamped = false;
  const Rgb rgb = spectrumToRgb(constant(1), SpectrumUse::reflectance, &clamped);
  EXPECT_TRUE(clamped);
  EXPECT_EQ(rgb.x, 1);
  spectrumToRgb(constant(0.5), SpectrumUse::reflectance, &clamped);
  EXPECT_FALSE(clamped);
}

TEST(Spectrum, NothingOutsideOfTheSamples) {
  // A red line: no blue, and green out of gamut.
  bool clamped = false;
  const Rgb rgb = spectrumToRgb({{640, 660}, {1, 1}}, SpectrumUse::emission, &clamped);
  EXPECT_GT(rgb.x, 0);
  EXPECT_EQ(rgb.y, 0);
  EXPECT_TRUE(clamped);
}

TEST(Spectrum, InterpolationAgreesWithDenseSamples) {
  Spectrum coarse{{400, 500, 600, 700}, {0, 8, 15.6, 18.4}}, dense;
  for (int w = 400; w <= 700; ++w) {
    const auto i = std::min<size_t>(static_cast<size_t>(w - 400) / 100, 2);
    const double t = (w - coarse.wavelengths[i]) / 100;
    dense.wavelengths.push_back(w);
    dense.values.push_back(coarse.values[i] * (1 - t) + coarse.values[i + 1] * t);
  }
  const Rgb a = spectrumToRgb(coarse, SpectrumUse::emission);
  const Rgb b = spectrumToRgb(dense, SpectrumUse::emission);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-4f * b.x);
}

TEST(Spectrum, BlackbodyHasItsChromaticityAndRadiance) {
  // Chromaticity of the Planckian locus at 5000 K (Wyszecki and Stiles): x 0.3451, y 0.3516.
  const Vec3d xyz = toXyz(blackbodyToRgb(5000));
  const double sum = xyz.x + xyz.y + xyz.z;
  EXPECT_NEAR(xyz.x / sum, 0.3451, 1e-3);
  EXPECT_NEAR(xyz.y / sum, 0.3516, 1e-3);
  // Planck at 555 nm and 5000 K is about 12.8 kW/(m^2 sr nm), close to the weighted mean.
  EXPECT_NEAR(xyz.y, 12.8e3, 0.3e3);
}

TEST(Spectrum, FilesAreReadAndTheirMistakesLocated) {
  const TemporaryFolder folder;
  const Spectrum s = readSpectrum(folder.write("a.spd", "# comment\n400 1\n\n 500\t2.5 \n"), {});
  ASSERT_EQ(s.values.size(), 2u);
  EXPECT_EQ(s.wavelengths[1], 500);
  EXPECT_EQ(s.values[1], 2.5);
  EXPECT_TRUE(contains(
      messageOf<InputError>([&] { readSpectrum(folder.write("b.spd", "400 1\n500 x\n"), {}); }),
      "b.spd:2"));
  EXPECT_TRUE(contains(
      messageOf<InputError>([&] { readSpectrum(folder.write("c.spd", "500 1\n400 1\n"), {}); }),
      "increase"));
  EXPECT_TRUE(contains(messageOf<InputError>([&] {
                         readSpectrum(folder.path("none.spd"), {"s.xml", 7, 1});
                       }),
                       "s.xml:7"));
}

TEST(OpticalConstants, NamesOfDielectrics) {
  EXPECT_FLOAT_EQ(*namedIor("bk7"), 1.5046f);
  EXPECT_FLOAT_EQ(*namedIor("Water Ice"), 1.31f);
  EXPECT_FALSE(namedIor("glas"));
  for (const std::string& name : namedIors()) {
    ASSERT_TRUE(namedIor(name)) << name;
    EXPECT_GE(*namedIor(name), 1) << name;
  }
}

TEST(OpticalConstants, EveryConductorIsPlausible) {
  EXPECT_EQ(namedConductor("none")->eta, Rgb(0.f));
  EXPECT_EQ(namedConductor("none")->k, Rgb(1.f));
  EXPECT_FALSE(namedConductor("Unobtainium"));
  EXPECT_EQ(namedConductor("Be_palik")->k, namedConductor("Be")->k);
  EXPECT_EQ(namedConductor("Ni")->k, namedConductor("Ni_palik")->k);
  EXPECT_FALSE(namedConductor("Cu")->k == namedConductor("Cu_palik")->k);
  for (const std::string& name : namedConductors()) {
    const auto c = namedConductor(name);
    ASSERT_TRUE(c) << name;
    EXPECT_GE(minComponent(c->eta), 0) << name;
    EXPECT_GE(minComponent(c->k), 0) << name;
    EXPECT_LT(maxComponent(max(c->eta, c->k)), 10) << name;
  }
}

// Gold reflects red best, silver reflects all well: guards against exchanged rows or columns.
TEST(OpticalConstants, MetalsHaveTheirColours) {
  const auto reflectance = [](const char* name, int c) {
    const auto m = *namedConductor(name);
    const float n = m.eta[c], k = m.k[c];
    return (sqr(n - 1) + k * k) / (sqr(n + 1) + k * k);
  };
  EXPECT_GT(reflectance("Au", 0), 0.95f);
  EXPECT_LT(reflectance("Au", 2), 0.5f);
  EXPECT_GT(reflectance("Ag", 2), 0.9f);
  EXPECT_GT(reflectance("Cu", 0), reflectance("Cu", 2) + 0.2f);
  EXPECT_NEAR(reflectance("Cr", 1), 0.66f, 0.1f);
}

// The index of copper from its measured spectrum (luxpop.com, 400 to 800 nm).
TEST(OpticalConstants, CopperFollowsFromItsSpectrum) {
  const Spectrum eta{
      {359.374420, 364.659332, 370.102020, 375.709625, 381.489777, 387.450562, 393.600555,
       399.948975, 406.505493, 413.280579, 420.285339, 427.531647, 435.032196, 442.800629,
       450.851562, 459.200653, 467.864838, 476.862213, 486.212463, 495.936707, 506.057861,
       516.600769, 527.592224, 539.061646, 551.040771, 563.564453, 576.670593, 590.400818,
       604.800842, 619.920898, 635.816284, 652.548279, 670.184753, 688.800964, 708.481018,
       729.318665, 751.419250, 774.901123, 799.897949, 826.561157, 855.063293},
      {1.281563, 1.270000, 1.249062, 1.225000, 1.200000, 1.180000, 1.174375, 1.175000, 1.177500,
       1.180000, 1.178125, 1.175000, 1.172812, 1.170000, 1.165312, 1.160000, 1.155312, 1.150000,
       1.142812, 1.135000, 1.131562, 1.120000, 1.092437, 1.040000, 0.950375, 0.826000, 0.645875,
       0.468000, 0.351250, 0.272000, 0.230813, 0.214000, 0.209250, 0.213000, 0.216250, 0.223000,
       0.236500, 0.250000, 0.254188, 0.260000, 0.280000}};
  const Rgb rgb = spectrumToRgb(eta, SpectrumUse::unbounded);
  const Rgb known = namedConductor("Cu")->eta;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], known[c], 3e-3f) << c;
}

}  // namespace
}  // namespace lobelia::io

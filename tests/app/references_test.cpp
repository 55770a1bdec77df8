// Against images that another renderer (Mitsuba 3) made of its own test scenes: a statistical test,
// not a tolerance by eye. For a scene NAME_I.xml, I is the integrator; NAME_ref_rgb.exr is the
// reference and NAME_ref_rgb_var.exr the variance of ONE sample. With N samples a channel value
// passes when its two-sided p-value exceeds the Sidak-corrected level 0.01, or when it is within
// 1e-3; the image passes when 99.75 % of the values do.
//
// The variance images hold second moments that were accumulated in XYZ and turned into RGB like a
// colour, less the square of the RGB mean. The matrix has negative entries, so up to 41 % of an
// image's "variances" are negative, and a noisy pixel of the reference itself
// would fail with them. Undone exactly, they are proper variances of X, Y and Z: the test is made
// there. The figure for the RGB values as they stand is printed beside it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "lobelia/io/image_io.h"
#include "lobelia/io/scene_io.h"
#include "lobelia/path/path_tracer.h"
#include "support/data.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

constexpr int kSamples = 1024;

std::vector<std::string> referenceScenes() {
  std::vector<std::string> out;
  const fs::path folder = fs::path(test::sharedFolder()) / "references/mitsuba/tests/scenes";
  if (!fs::is_directory(folder)) return out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".xml" && name.starts_with("test_"))
      out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

Film render(const Scene& scene, const std::string& integrator, Context& context) {
  const Tracer tracer(scene, context);
  const EmitterSampler emitters(scene, tracer.bounds());
  Camera camera = scene.cameras.front();
  if (camera.cropX1 == 0) camera.cropX1 = camera.width, camera.cropY1 = camera.height;
  Film film;
  film.fullWidth = film.width = camera.width;
  film.fullHeight = film.height = camera.height;
  film.addLayer("");
  film.addLayer("direct");
  film.addLayer("indirect");
  PathSettings settings;
  settings.spp = kSamples;
  settings.maxDepth = integrator == "direct" ? 2 : scene.maxDepth;
  settings.specularLimit = 0;
  settings.hideEmitters = scene.hideEmitters;
  (integrator == "ptracer" ? renderLight : renderPath)(tracer, emitters, camera, settings, film,
                                                       context);
  return film;
}

// Linear sRGB (D65) to XYZ, as the reference renderer has it.
Vec3d toXyz(Vec3d c) {
  return {0.412453 * c.x + 0.357580 * c.y + 0.180423 * c.z,
          0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z,
          0.019334 * c.x + 0.119193 * c.y + 0.950227 * c.z};
}

Vec3d widen(Rgb c) { return {double(c.x), double(c.y), double(c.z)}; }

struct Score {
  double passedXyz = 0, passedRgb = 0, suspectVariances = 0, meanRatio = 0;
};

Score score(const Film& image, const Film& reference, const Film& variance) {
  const size_t pixels = image.pixelCount();
  const double level = 1 - std::pow(1 - 0.01, 1.0 / static_cast<double>(pixels));
  const auto passes = [&](double a, double b, double v) {
    const double z = std::abs(a - b) * std::sqrt(kSamples / std::max(v, 1e-4));
    return std::erfc(z / std::sqrt(2.0)) > level || std::abs(a - b) < 1e-3;
  };
  Score s;
  double sum = 0, sumReference = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const Vec3d a = widen(image.rgb(i)), b = widen(reference.rgb(i)), v = widen(variance.rgb(i));
    const Vec3d aXyz = toXyz(a), bXyz = toXyz(b), vXyz = toXyz(v + b * b) - bXyz * bXyz;
    for (int c = 0; c < 3; ++c) {
      s.passedRgb += passes(a[c], b[c], v[c]) ? 1 : 0;
      s.passedXyz += passes(aXyz[c], bXyz[c], vXyz[c]) ? 1 : 0;
      s.suspectVariances += v[c] < 0 ? 1 : 0;
      sum += a[c];
      sumReference += b[c];
    }
  }
  const double n = static_cast<double>(pixels) * 3;
  return {s.passedXyz / n, s.passedRgb / n, s.suspectVariances / n, sum / sumReference};
}

class References : public testing::TestWithParam<std::string> {};

TEST_P(References, ImagePassesTheZTest) {
  const fs::path file = GetParam();
  const std::string stem = file.stem().string();
  const size_t underscore = stem.rfind('_');
  const std::string name = stem.substr(0, underscore), integrator = stem.substr(underscore + 1);
  const std::string base = (file.parent_path() / "refs" / name).string();
  Context context;
  const Scene scene = io::readScene(file.string(), {}, context);
  const Film image = render(scene, integrator, context);
  const Score s =
      score(image, io::readFilm(base + "_ref_rgb.exr"), io::readFilm(base + "_ref_rgb_var.exr"));
  fmt::print(
      "{:<34} XYZ {:.3f} %, RGB {:.3f} % of values pass ({:.1f} % of RGB variances negative), "
      "mean ratio {:.5f}\n",
      stem, 100 * s.passedXyz, 100 * s.passedRgb, 100 * s.suspectVariances, s.meanRatio);
  if (const char* folder = std::getenv("LOBELIA_TEST_OUTPUT"))
    io::writeExr(fmt::format("{}/{}.exr", folder, stem), image);
  EXPECT_GE(std::max(s.passedXyz, s.passedRgb), 0.9975);
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(References);
INSTANTIATE_TEST_SUITE_P(Slow, References, testing::ValuesIn(referenceScenes()),
                         [](const auto& i) { return fs::path(i.param).stem().string(); });

TEST(ReferenceScenes, ArePresent) {
  if (referenceScenes().empty()) GTEST_SKIP() << "skipped: no ../shared/references";
}

}  // namespace
}  // namespace lobelia

// Against images that another renderer (Mitsuba 3) made of its own test scenes: a statistical test,
// not a tolerance by eye. For a scene NAME_I.xml, I is the integrator; NAME_ref_rgb.exr is the
// reference and NAME_ref_rgb_var.exr the variance of ONE sample. With N samples a channel value
// passes when its two-sided p-value exceeds the Sidak-corrected level 0.01, or when it is within
// 1e-3; the image passes when 99.75 % of the values do.
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

struct Score {
  double passed = 0, meanRatio = 0;
};

Score score(const Film& image, const Film& reference, const Film& variance) {
  const double level = 1 - std::pow(1 - 0.01, 1.0 / static_cast<double>(image.pixelCount()));
  size_t passed = 0;
  double sum = 0, sumReference = 0;
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(double(image.rgb(i)[c]) - double(reference.rgb(i)[c]));
      const double v = std::max(double(variance.rgb(i)[c]), 1e-4);
      const double p =
          std::erfc(difference * std::sqrt(kSamples / v) / std::sqrt(2.0));  // 2(1-Phi(z))
      passed += p > level || difference < 1e-3 ? 1 : 0;
      sum += image.rgb(i)[c];
      sumReference += reference.rgb(i)[c];
    }
  }
  return {static_cast<double>(passed) / static_cast<double>(image.pixelCount() * 3),
          sum / sumReference};
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
  fmt::print("{:<32} {:.3f} % of values pass, mean ratio {:.5f}\n", stem, 100 * s.passed,
             s.meanRatio);
  if (const char* folder = std::getenv("LOBELIA_TEST_OUTPUT"))
    io::writeExr(fmt::format("{}/{}.exr", folder, stem), image);
  EXPECT_GE(s.passed, 0.9975);
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(References);
INSTANTIATE_TEST_SUITE_P(Slow, References, testing::ValuesIn(referenceScenes()),
                         [](const auto& i) { return fs::path(i.param).stem().string(); });

TEST(ReferenceScenes, ArePresent) {
  if (referenceScenes().empty()) GTEST_SKIP() << "skipped: no ../shared/references";
}

}  // namespace
}  // namespace lobelia

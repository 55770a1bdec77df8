// `render --gather mrcs` as a user types it.
#include <cstring>
#include <map>

#include "app/render_test.h"
#include "lobelia/film/metrics.h"

namespace lobelia {
namespace {

class MrcsRender : public test::RenderTest {
 protected:
  static double sum(const Film& film) {
    double total = 0;
    for (size_t i = 0; i < film.pixelCount(); ++i)
      total += double{film.rgb(i).x} + double{film.rgb(i).y} + double{film.rgb(i).z};
    return total;
  }
  // |a - b| / |b|
  static double distance(const Film& a, const Film& b) {
    double difference = 0, norm = 0;
    for (size_t i = 0; i < a.pixelCount(); ++i)
      for (int c = 0; c < 3; ++c) {
        difference += std::pow(double{a.rgb(i)[c]} - double{b.rgb(i)[c]}, 2);
        norm += std::pow(double{b.rgb(i)[c]}, 2);
      }
    return std::sqrt(difference / norm);
  }
};

// Errors of one draw have a heavy tail: means over a few.
TEST_F(MrcsRender, ComesNearerToAllLightsWithMoreColumns) {
  constexpr int kDraws = 3;
  const std::string base = "--size 40x32 --spp 1 --num-lights 4000 --clamp 1 --component indirect ";
  std::map<int, double> errors, predicted;  // by columns
  for (int seed = 0; seed < kDraws; ++seed) {
    const std::string draw = base + "--seed " + std::to_string(seed);
    const Film all = render(draw + " --gather all", "all");
    for (const int columns : {100, 400, 1600}) {
      const std::string name = "c" + std::to_string(columns);
      const Film few = render(draw + " --gather mrcs --columns " + std::to_string(columns), name);
      errors[columns] += distance(few, all) / kDraws;
      const nlohmann::json gather = statistics(name)["gather"];
      EXPECT_EQ(gather["strategy"], "mrcs");
      EXPECT_EQ(gather["columns"], columns);
      EXPECT_EQ(gather["rows"], 1024);
      predicted[columns] += gather["predicted_error"].get<double>() / kDraws;
      EXPECT_GT(statistics(name)["counts"]["shadow_rays"], 40 * 32 * columns / 10);
    }
    EXPECT_EQ(statistics("c1600")["lights"]["diffuse"], statistics("all")["lights"]["diffuse"]);
  }
  EXPECT_LT(errors[400], 0.7 * errors[100]);
  EXPECT_LT(errors[1600], 0.7 * errors[400]);
  EXPECT_LT(errors[1600], 0.06);
  for (const auto& [columns, error] : errors) {  // predicted from some pixels
    EXPECT_GT(predicted[columns], error / 4) << columns;
    EXPECT_LT(predicted[columns], error * 4) << columns;
  }
}

TEST_F(MrcsRender, ErrorDecidesTheColumns) {
  const std::string base =
      "--size 48x40 --spp 1 --num-lights 4000 --clamp 1 --component indirect --gather mrcs ";
  render(base + "--error 0.1", "a");
  render(base + "--error 0.03", "b");
  render(base + "--error 0.001 --columns 70", "c");
  EXPECT_LT(statistics("a")["gather"]["predicted_error"], 0.1);
  EXPECT_LT(statistics("b")["gather"]["predicted_error"], 0.03);
  EXPECT_GT(statistics("b")["gather"]["columns"], statistics("a")["gather"]["columns"]);
  EXPECT_EQ(statistics("c")["gather"]["columns"], 70);
}

TEST_F(MrcsRender, PartsOfThePictureAndPassesHaveTheLightOfAll) {
  const std::string base = "--size 48x40 --spp 8 --num-lights 1000 --clamp 1 ";
  for (const char* part : {"--crop 10,8,40,32 --max-depth 4", "--pixels 700 --passes 2",
                           "--passes 8 --direct lights"}) {
    SCOPED_TRACE(part);
    const Film all = render(base + part + " --gather all", "all");
    const Film few = render(base + part + " --gather mrcs --columns 150 --rows 300", "few");
    EXPECT_EQ(few.alpha, all.alpha);
    EXPECT_NEAR(sum(few) / sum(all), 1, 0.02);
    EXPECT_LT(distance(few, all), 0.15);
    EXPECT_GT(distance(few, all), 0);
  }
}

TEST_F(MrcsRender, NearFieldOfSphericalLightsTakesTheFlares) {
  scene_ = kMicrofacets;
  const std::string base = "--lights vsl --size 48x40 --spp 1 --num-lights 4000 --seed 3 ";
  const Film all = render(base + "--gather all", "all");
  const std::string few = base + "--gather mrcs --columns 200 --rows 300 ";
  const Film without = render(few + "--near-field 0", "without");
  const Film with = render(few, "with"), narrow = render(few + "--near-field 2", "narrow");
  EXPECT_LT(distance(with, all), 0.6 * distance(without, all));
  EXPECT_LT(distance(narrow, all), 0.9 * distance(without, all));
  EXPECT_NEAR(sum(with) / sum(all), 1, 0.05);
  const Film again = render(few + "--threads 1", "again");
  for (size_t i = 0; i < with.pixelCount(); ++i) EXPECT_EQ(with.rgb(i), again.rgb(i));
}

TEST_F(MrcsRender, AllColumnsGiveTheSameBits) {
  const std::string base = "--size 32x24 --spp 2 --num-lights 300 ";
  const Film all = render(base + "--gather all", "all");
  const Film few = render(base + "--gather mrcs --columns 100000", "few");
  for (size_t i = 0; i < all.pixelCount(); ++i) EXPECT_EQ(few.rgb(i), all.rgb(i));
}

TEST_F(MrcsRender, ThreadsDoNotMatter) {
  const std::string base =
      "--size 48x40 --spp 2 --num-lights 3000 --gather mrcs --columns 200 --sketch 32 ";
  const Film one = render(base + "--threads 1", "one"), two = render(base + "--threads 2", "two");
  for (size_t i = 0; i < one.pixelCount(); ++i) EXPECT_EQ(one.rgb(i), two.rgb(i));
  EXPECT_EQ(statistics("one")["gather"]["sketch"], 32);
}

TEST_F(MrcsRender, WrongUseSaysWhatWouldBeRight) {
  expectError("--columns 10", "--gather mrcs");
  expectError("--gather all --error 0.1", "--gather mrcs");
  expectError("--gather mrcs --sketch 17", "multiple of 16");
  expectError("--gather mrcs --sketch many", "'off'");
  expectError("--gather mrcs --columns 0", "--columns");
  expectError("--gather mrcs --rows -3", "--rows");
  expectError("--gather mrcs --error 0", "--error");
  expectError("--gather mrcs --memory lots", "800M or 2G");
  expectError("--gather all --near-field 2", "--gather mrcs");
  expectError("--gather mrcs --near-field -1", "--near-field");
  expectError("--gather mrcs --column-scale grey", "--column-scale");
  expectError("--gather mrcs --columns 50 --num-lights 2000 --memory 10K", "--memory");
  expectError("--lights path --gather mrcs --columns 10", "--lights path");
}

}  // namespace
}  // namespace lobelia

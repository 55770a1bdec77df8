// The file of transfer: what it gives back, and what it refuses.
#include <gtest/gtest.h>

#include <limits>

#include "lobelia/base/random.h"
#include "lobelia/relight/visibility_data.h"
#include "lobelia/store/store.h"
#include "lobelia/transfer/transfer_summary.h"
#include "support/run_program.h"
#include "transfer/small_transfer.h"

namespace lobelia::transfer {
namespace {

class TransferFile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new Scene(test::glossyScene());
    Context context;
    data_ = new TransferData(test::transferOf(*scene_, test::coarseTransfer(), context));
  }
  static void TearDownTestSuite() { delete data_, delete scene_; }
  void SetUp() override { save(*data_, *scene_, file_); }

  void expectRefused(const Scene& scene, const std::string& mentions) const {
    try {
      load(file_, scene);
      ADD_FAILURE() << "was read; should have been refused: " << mentions;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(mentions), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("data.vmf"), std::string::npos) << e.what();
    }
  }
  void expectRefused(const TransferData& data, const std::string& mentions) const {
    save(data, *scene_, file_);
    expectRefused(*scene_, mentions);
  }

  const test::TemporaryFolder folder_;
  const std::string file_ = folder_ / "data.vmf";
  static inline Scene* scene_ = nullptr;
  static inline TransferData* data_ = nullptr;
};

TEST_F(TransferFile, GivesBackWhatWasSaved) {
  ASSERT_GT(data_->mesh.mesh.triangles().size(), data_->mesh.mesh.firstTriangle().back());
  ASSERT_GT(data_->passes[0].glossy[0].recordCount(), 0u);
  ASSERT_GT(data_->passes[1].glossy[0].recordCount(), 0u);
  ASSERT_FALSE(data_->passes[0].diffuse.empty());
  ASSERT_GT(data_->reflection.recordCount(), 0u) << "the ball is textured";
  const TransferData back = load(file_, *scene_);
  test::expectSame(back, *data_);
  EXPECT_EQ(back.byteCount(), data_->byteCount());
  EXPECT_EQ(store::kindOf(file_), kTransferKind);
}

TEST_F(TransferFile, CountsWhatIsLookedUp) {
  size_t records = 0, bytes = data_->reflection.byteCount();
  for (const TransferPass& pass : data_->passes) {
    bytes += pass.diffuse.size() * 64;
    for (const SliceRows& rows : pass.glossy)
      records += rows.recordCount(), bytes += rows.byteCount();
  }
  EXPECT_EQ(data_->recordCount(), records);
  EXPECT_EQ(data_->byteCount(), bytes);
}

TEST_F(TransferFile, IsDescribedWithoutItsScene) {
  const TransferSummary s = summaryOf(file_);
  EXPECT_EQ(s.sceneHash, transferHash(*scene_));
  EXPECT_EQ(s.directions, GeodesicGrid(data_->directionLevel).count());
  EXPECT_EQ(s.passes, data_->passes.size());
  EXPECT_EQ(s.classes, 1u);
  EXPECT_EQ(s.vertices, data_->mesh.vertices.size());
  EXPECT_EQ(s.records, data_->recordCount());
  EXPECT_EQ(s.bytes, data_->byteCount());
}

TEST_F(TransferFile, KeepsClasses) {
  Context context;
  TransferSettings settings = test::coarseTransfer();
  settings.classCount = 2;
  const TransferData data = test::transferOf(*scene_, settings, context);
  ASSERT_EQ(data.passes[1].glossy.size(), 3u);
  save(data, *scene_, file_);
  test::expectSame(load(file_, *scene_), data);
}

TEST_F(TransferFile, DoesNotMindLightsAndCameras) {
  Scene changed = *scene_;
  changed.cameras.emplace_back();
  // An environment whose image comes first, so that the ball's has another number.
  changed.images.insert(changed.images.begin(), {"sky", 1, 1, 3, {1, 2, 3}});
  changed.textures[0].image = {1};
  Emitter sky;
  sky.type = EmitterType::environment;
  sky.image = {0};
  changed.emitters.push_back(sky);
  test::expectSame(load(file_, changed), *data_);
  changed.images[0].pixels[1] = 7;
  test::expectSame(load(file_, changed), *data_);
  changed.emitters[0] = {};
  test::expectSame(load(file_, changed), *data_);
}

TEST_F(TransferFile, IsOfOneScene) {
  const std::string other = "of another scene";
  Scene changed = *scene_;
  changed.meshes[0].positions[3].z = 0.25f;
  expectRefused(changed, other);
  changed = *scene_;
  changed.instances[1].toWorld = Transform(translation({0, 0, 1}));
  expectRefused(changed, other);
  changed = *scene_;
  changed.instances[1].flipNormals = true;
  expectRefused(changed, other);
  changed = *scene_;
  changed.instances.pop_back();
  expectRefused(changed, other);
}

TEST_F(TransferFile, IsOfOneChoiceOfMaterials) {
  const std::string other = "materials or textures were changed";
  Scene changed = *scene_;
  changed.materials[0].alphaU = 31.f;
  expectRefused(changed, other);
  changed = *scene_;
  changed.materials[0].specular = Rgb(0.4f, 0.3f, 0.21f);
  expectRefused(changed, other);
  changed = *scene_;
  std::swap(changed.instances[0].material, changed.instances[1].material);
  expectRefused(changed, other);
  changed = *scene_;
  changed.images[0].pixels[4] = 0.75f;
  expectRefused(changed, other);
  changed = *scene_;
  changed.textures[0].uvMatrix[0][0] = 2;
  expectRefused(changed, other);
}

TEST_F(TransferFile, IsRefusedWhenDamaged) {
  const std::string good = test::readText(file_);
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    std::string bad = good;
    bad[rng.nextUint() % bad.size()] ^= static_cast<char>(1 << (i % 8));
    test::writeText(file_, bad);
    EXPECT_THROW(load(file_, *scene_), InputError) << i;
    EXPECT_THROW(summaryOf(file_), InputError) << i;
  }
  test::writeText(file_, good.substr(0, good.size() / 2));
  expectRefused(*scene_, "truncated");
  test::writeText(file_, "");
  expectRefused(*scene_, "empty");
  test::writeText(file_, "nothing of ours");
  expectRefused(*scene_, "not a Lobelia data file");
}

TEST_F(TransferFile, OfAnotherKindIsRefusedByName) {
  EXPECT_THROW(
      {
        try {
          relight::load(file_, *scene_);
        } catch (const InputError& e) {
          EXPECT_NE(std::string(e.what()).find("holds 'vmf-transfer'"), std::string::npos)
              << e.what();
          throw;
        }
      },
      InputError);
  store::Writer("visibility-cuts", 1, transferHash(*scene_)).save(file_);
  expectRefused(*scene_, "holds 'visibility-cuts'");
  store::Writer(kTransferKind, 1, transferHash(*scene_)).save(file_);
  expectRefused(*scene_, "version 1");
  store::Writer(kTransferKind, 99, transferHash(*scene_)).save(file_);
  expectRefused(*scene_, "version 99");
}

// With a right checksum, too, as somebody would write it who means harm.
TEST_F(TransferFile, IsCheckedForSense) {
  for (const auto& [level, classes] :
       {std::pair{-1, 1}, {6, 1}, {2, 0}, {2, kMostClasses + 1}, {2, -5}}) {
    TransferData bad = *data_;
    bad.directionLevel = level, bad.classCount = classes;
    expectRefused(bad, "out of range");
  }
  TransferData bad = *data_;
  bad.passes.clear();
  expectRefused(bad, "out of range");
  bad = *data_;
  bad.passes.resize(66);
  expectRefused(bad, "out of range");
  bad = *data_;
  bad.directionLevel = 1;  // of which rows have fewer words
  expectRefused(bad, "slices");
  bad = *data_;
  bad.classCount = 2;
  expectRefused(bad, "has no chunk 'p1g2-");
  bad = *data_;
  bad.passes[1].glossy[0] = SliceRows(162);
  expectRefused(bad, "0 rows for");
  bad = *data_;
  bad.passes[0].diffuse.pop_back();
  expectRefused(bad, "diffuse lobes for");
  bad = *data_;
  bad.diffuseSides = DiffuseSides(data_->mesh.vertices.size(), std::vector<uint32_t>{0, 3});
  expectRefused(bad, "diffuse lobes for");
  // A back of a vertex that is not there.
  const auto last = static_cast<uint32_t>(data_->mesh.vertices.size());
  bad.diffuseSides = DiffuseSides(last + 1, std::vector<uint32_t>{0, last});
  expectRefused(bad, "do not ascend");
  bad = *data_;
  bad.reflection = SliceRows(162);
  bad.reflection.addRow({}, {});
  expectRefused(bad, "'own' has 1 rows");
}

TEST_F(TransferFile, TheMeshIsCheckedForSense) {
  const relight::SampleMesh& mesh = data_->mesh.mesh;
  const std::vector<Vec3f> positions(mesh.positions().begin(), mesh.positions().end());
  const auto meshOf = [&](std::vector<Vec3f> places) {
    return relight::SampleMesh(std::move(places),
                               {mesh.triangles().begin(), mesh.triangles().end()},
                               {mesh.firstTriangle().begin(), mesh.firstTriangle().end()});
  };
  TransferData bad = *data_;
  std::vector<Vec3f> places = positions;
  places[7].y = std::numeric_limits<float>::quiet_NaN();
  bad.mesh.mesh = meshOf(places);
  expectRefused(bad, "not finite");
  places = positions;
  places.emplace_back(1.f);
  bad.mesh.mesh = meshOf(places);
  expectRefused(bad, "rows for");
}

// Taken out of the file, what materials with textures reflect is nothing, not out of bounds.
TEST_F(TransferFile, HasARowOfReflectionForEveryVertex) {
  TransferData without = *data_;
  without.reflection = {};
  save(without, *scene_, file_);
  const TransferData back = load(file_, *scene_);
  ASSERT_EQ(back.reflection.rowCount(), back.mesh.vertices.size());
  for (size_t v = 0; v < back.mesh.vertices.size(); ++v)
    for (const size_t k : {0u, 100u, 161u}) ASSERT_EQ(back.reflection.find(v, k), nullptr);
}

// Without surfaces, or with such as have no area, there is a file, and it is read.
TEST(TransferOfNothing, IsSavedAndRead) {
  const test::TemporaryFolder folder;
  for (const bool line : {false, true}) {
    Scene scene;
    if (line) {
      Mesh mesh;
      mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
      mesh.triangles = {{0, 1, 2}};
      test::place(scene, mesh);
      scene.instances[0].material =
          test::addMaterial(scene, test::phongMaterial(Rgb(0.2f), Rgb(0.5f), 20));
    }
    TransferSettings settings = test::coarseTransfer();
    settings.classCount = 2;
    Context context;
    const TransferData made = test::transferOf(scene, settings, context);
    save(made, scene, folder / "nothing");
    test::expectSame(load(folder / "nothing", scene), made);
  }
}

}  // namespace
}  // namespace lobelia::transfer

// Figure 3 of [P002]: gathering against scattering [Green06] with as many rays, and with more.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/bench_vmf_views.h"
#include "lobelia/base/error.h"
#include "lobelia/transfer/scatter.h"

namespace lobelia::app {
namespace {

// Rays of scattering to those of gathering.
constexpr int kRayRatios[] = {1, 4, 16};
// Of each of the two halves of converged transfer: compared with both, a picture's error is free of
// their noise.
constexpr int kConvergedRatio = 16;
constexpr int kCoarseRayLevel = 4;

// What bounces are judged by as well as all light: direct light hides them.
struct Pictures {
  std::vector<Film> all, bounces;  // one from each side
};
struct ConvergedPictures {
  std::vector<Reference> all, bounces;
};

class ScatterStudy {
 public:
  ScatterStudy(const std::string& name, const VmfStudy& study)
      : name_(name), study_(study), views_(name, study) {}

  void run() {
    study_.progress(name_, "gathering");
    const VmfData gathered = makeTransfer(views_.tracer(), {}, study_);
    const transfer::TransferMesh& mesh = gathered.data.mesh;
    chooseSlices(gathered.data);
    const uint64_t whole = raysOfWhole(mesh);
    if (whole == 0) throw UsageError(fmt::format("{}: nothing in the scene reflects", name_));
    const auto raysOf = [&](int ratio) {
      return std::max(
          1, static_cast<int>(std::lround(ratio * gathered.rays / static_cast<double>(whole))));
    };
    converge(mesh, raysOf(kConvergedRatio));
    add("gathered", "gathered", gathered.rays, gathered.data);
    addCoarse();
    for (const int ratio : kRayRatios) {
      const int rays = raysOf(ratio);
      study_.progress(name_, fmt::format("scattering, {} rays for a slice", rays));
      add(fmt::format("scattered, {} rays for a slice", rays), fmt::format("{}", rays),
          static_cast<double>(whole) * rays, scattered(mesh, rays, &seen_));
    }
    study_.report.show("figure3", name_, pictures_);
  }

 private:
  void chooseSlices(const transfer::TransferData& data) {
    const transfer::ReflectionTables tables(views_.scene());
    const transfer::SliceLookup lookup(views_.scene(), data, tables);
    seen_ = transfer::seenSlices(lookup, data, views_.cameras());
  }

  // Each call with random numbers of its own.
  transfer::TransferData scattered(const transfer::TransferMesh& mesh, int rays,
                                   const transfer::SliceMask* only) {
    study_.context.seed = hashCombine(study_.options.seed, ++runs_);
    return transfer::scatterTransfer(views_.tracer(), mesh,
                                     settingsOf(VmfKind{}, views_.scene(), study_), rays,
                                     study_.context, only);
  }

  // Rays of scattering all slices, one path for each.
  uint64_t raysOfWhole(const transfer::TransferMesh& mesh) {
    const Statistics& s = study_.context.statistics;
    const uint64_t before = s.count("transfer_rays");
    scattered(mesh, 1, nullptr);
    return s.count("transfer_rays") - before;
  }

  // Through the same points of pixels for all data.
  Pictures pictures(const transfer::TransferData& data) {
    study_.context.seed = study_.options.seed;
    return {views_.frames(data), views_.frames(data, 1)};
  }

  void converge(const transfer::TransferMesh& mesh, int rays) {
    Pictures halves[2];
    for (Pictures& half : halves) {
      study_.progress(name_, "converged transfer");
      half = pictures(scattered(mesh, rays, &seen_));
    }
    for (size_t v = 0; v < VmfViews::kViews; ++v) {
      converged_.all.push_back({std::move(halves[0].all[v]), std::move(halves[1].all[v]), {}});
      converged_.bounces.push_back(
          {std::move(halves[0].bounces[v]), std::move(halves[1].bounces[v]), {}});
    }
  }

  // How much of gathering's error comes from its rays.
  void addCoarse() {
    study_.progress(name_, "gathering along fewer rays");
    VmfKind kind;
    kind.rayLevel = kCoarseRayLevel;
    const VmfData gathered = makeTransfer(views_.tracer(), kind, study_);
    add(fmt::format("gathered, --rays {}", kCoarseRayLevel), "gathered-coarse", gathered.rays,
        gathered.data);
  }

  BenchTable& table() {
    return study_.report.table(
        {"figure3",
         "Figure 3: scattering and gathering",
         {{"scene", "scene"},
          {"method", "method"},
          {"mrays", "million rays", "{:.1f}"},
          {"l2", "l2", "{:.4f}"},
          {"mean_ratio", "mean ratio", "{:.4f}"},
          {"l2_converged", "l2 to converged transfer", "{:.4f}"},
          {"mean_converged", "mean ratio to it", "{:.4f}"},
          {"l2_bounces", "of bounces, l2 to it", "{:.4f}"},
          {"mean_bounces", "mean ratio to it", "{:.4f}"}},
         {},
         {views_.note() +
          fmt::format(" Converged transfer: the same vertices and directions, scattered in two "
                      "halves with {} times the rays of gathering each. Scattering makes the "
                      "slices that these pictures look up; rays are those of all slices.",
                      kConvergedRatio)}});
  }

  void add(const std::string& method, const std::string& file, double rays,
           const transfer::TransferData& data) {
    const Pictures shown = pictures(data);
    const VmfError error = views_.error(shown.all, views_.paths());
    const VmfError all = views_.error(shown.all, converged_.all);
    const VmfError bounces = views_.error(shown.bounces, converged_.bounces);
    table().rows.push_back({name_, method, 1e-6 * rays, error.l2, error.meanRatio, all.l2,
                            all.meanRatio, bounces.l2, bounces.meanRatio});
    if (!curve_) curve_ = measureToneCurve(views_.path(0, VmfViews::kBounces).first, {});
    pictures_.push_back({method, study_.report.picture(fmt::format("figure3-{}-{}", name_, file),
                                                       shown.all.front(), *curve_)});
  }

  const std::string name_;
  const VmfStudy& study_;
  VmfViews views_;
  transfer::SliceMask seen_;
  ConvergedPictures converged_;
  uint64_t runs_ = 0;  // of scattering
  std::optional<ToneCurve> curve_;
  std::vector<FigurePicture> pictures_;
};

}  // namespace

void vmfScatter(const std::string& name, const VmfStudy& study) { ScatterStudy(name, study).run(); }

}  // namespace lobelia::app

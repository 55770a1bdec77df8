// Figure 3 of [P002]: gathering against scattering [Green06] with as many rays, and with more.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/bench_vmf_views.h"
#include "lobelia/transfer/scatter.h"

namespace lobelia::app {
namespace {

// Rays of scattering to those of gathering.
constexpr int kRayRatios[] = {1, 4, 16};
// Segments of a path, about, for the first guess.
constexpr double kSegments = 1.3;
constexpr double kOctantPaths = 8;  // of a vertex' diffuse lobes, in paths of a slice

class ScatterStudy {
 public:
  ScatterStudy(const std::string& name, const VmfStudy& study)
      : name_(name), study_(study), views_(name, study) {}

  void run() {
    study_.progress(name_, "gathering");
    VmfData gathered = makeTransfer(views_.tracer(), {}, study_);
    add("gathered", gathered.rays, 0, gathered.rest, gathered.data);
    const auto vertices = static_cast<double>(gathered.data.mesh.vertices.size());
    double perPath = kSegments;  // segments of a path; known after the first run
    const double paths = gathered.slices + kOctantPaths * vertices;
    for (const int more : kRayRatios) {
      if (study_.cancelled()) return;
      study_.progress(name_, fmt::format("scattering, {} times the rays", more));
      const int rays =
          std::max(1, static_cast<int>(std::lround(more * gathered.rays / (paths * perPath))));
      const Statistics& s = study_.context.statistics;
      const uint64_t before = s.count("transfer_rays");
      const int64_t start = nanosecondsNow();
      study_.context.seed = study_.options.seed;
      const transfer::TransferData data = transfer::scatterTransfer(
          views_.tracer(), gathered.data.mesh, settingsOf(VmfKind{}, views_.scene(), study_), rays,
          study_.context);
      const double seconds = 1e-9 * static_cast<double>(nanosecondsNow() - start);
      const auto traced = static_cast<double>(s.count("transfer_rays") - before);
      if (traced > 0) perPath = traced / (paths * rays);
      add(fmt::format("scattered, {} rays for a slice", rays), traced, rays, seconds, data);
    }
    study_.report.show("figure3", name_, pictures_);
  }

 private:
  void add(const std::string& method, double rays, int perSlice, double seconds,
           const transfer::TransferData& data) {
    BenchTable& table = study_.report.table(
        {"figure3",
         "Figure 3: scattering and gathering",
         {{"scene", "scene"},
          {"method", "method"},
          {"mrays", "million rays", "{:.1f}"},
          {"seconds", "seconds", "{:.1f}"},
          {"l2", "l2", "{:.4f}"},
          {"mean_ratio", "mean ratio", "{:.4f}"}},
         {},
         {views_.note() + " Seconds are without masks and subdivision; scattering follows single "
                          "rays and is not made to be fast."}});
    const VmfError error = views_.error(data);
    table.rows.push_back({name_, method, 1e-6 * rays, seconds, error.l2, error.meanRatio});
    if (!curve_) curve_ = measureToneCurve(views_.path(0, VmfViews::kBounces).first, {});
    transfer::TransferRenderer renderer(views_.tracer(), data);
    views_.light(&renderer);
    const std::string file = fmt::format("figure3-{}-{}", name_, perSlice);
    pictures_.push_back(
        {method, study_.report.picture(file, views_.frame(renderer, 0, 0, VmfViews::kBounces + 1),
                                       *curve_)});
  }

  const std::string name_;
  const VmfStudy& study_;
  VmfViews views_;
  std::optional<ToneCurve> curve_;
  std::vector<FigurePicture> pictures_;
};

}  // namespace

void vmfScatter(const std::string& name, const VmfStudy& study) { ScatterStudy(name, study).run(); }

}  // namespace lobelia::app

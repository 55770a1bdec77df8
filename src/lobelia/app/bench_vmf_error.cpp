// Figures 1, 2 and 4 of [P002]: frames from transfer beside path-traced pictures, bounce by bounce
// and all light together, with errors where the paper has pictures alone.
#include <fmt/format.h>

#include "lobelia/app/bench_vmf_views.h"

namespace lobelia::app {
namespace {

constexpr const char* kBounceNames[] = {"direct light", "first bounce", "second bounce"};

class ErrorStudy {
 public:
  ErrorStudy(const std::string& name, const VmfStudy& study)
      : name_(name), study_(study), views_(name, study) {}

  void run(bool figure1, bool figure2, bool figure4) {
    study_.progress(name_, "precomputation");
    const VmfData made = makeTransfer(views_.tracer(), {}, study_);
    if (figure1) addBounces(made.data);
    if (figure2) addPictures(made.data);
    if (!figure4) return;
    addError({}, made.data);
    for (const VmfKind& kind : {VmfKind{4, false}, VmfKind{3, true}}) {
      if (kind.materials && views_.scene().materials.size() < 3) continue;
      study_.progress(name_, kind.name());
      addError(kind, makeTransfer(views_.tracer(), kind, study_).data);
    }
  }

 private:
  std::string picture(const std::string& name, const Film& film) {
    if (!curve_) curve_ = measureToneCurve(views_.path(0, VmfViews::kBounces).first, {});
    return study_.report.picture(name, film, *curve_);
  }

  void addBounces(const transfer::TransferData& data) {
    BenchTable& table = study_.report.table({"figure1",
                                             "Figure 1: light bounce by bounce",
                                             {{"scene", "scene"},
                                              {"bounce", "light"},
                                              {"l2", "l2", "{:.4f}"},
                                              {"mean_ratio", "mean ratio", "{:.4f}"}},
                                             {},
                                             {views_.note() + " The first of the sides."}});
    transfer::TransferRenderer renderer(views_.tracer(), data);
    views_.light(&renderer);
    std::vector<FigurePicture> ours, paths;
    for (int j = 0; j <= VmfViews::kBounces; ++j) {
      const Film film = views_.frame(renderer, 0, j, j + 1);
      const Reference path = views_.path(0, j, j);
      const Comparison error = views_.compared(film, 0, path);
      const char* const light = kBounceNames[j];
      table.rows.push_back({name_, std::string(light), error.l2, error.meanRatio});
      ours.push_back({light, picture(fmt::format("figure1-{}-{}", name_, j), film)});
      paths.push_back({fmt::format("{}, path tracer", light),
                       picture(fmt::format("figure1-{}-{}-path", name_, j), path.first)});
    }
    study_.report.show("figure1", name_, ours);
    study_.report.show("figure1", name_ + " by the path tracer", paths);
  }

  void addPictures(const transfer::TransferData& data) {
    study_.report
        .table({"figure2",
                "Figure 2: two bounces of glossy reflections",
                {{"scene", "scene"}, {"vertices", "vertices", "{:.0f}"}},
                {},
                {}})
        .rows.push_back({name_, static_cast<double>(data.mesh.vertices.size())});
    transfer::TransferRenderer renderer(views_.tracer(), data);
    views_.light(&renderer);
    std::vector<FigurePicture> line;
    for (size_t v = 0; v < VmfViews::kViews; ++v)
      line.push_back({fmt::format("view {}", v + 1),
                      picture(fmt::format("figure2-{}-{}", name_, v + 1),
                              views_.frame(renderer, v, 0, VmfViews::kBounces + 1))});
    study_.report.show("figure2", name_, line);
  }

  void addError(const VmfKind& kind, const transfer::TransferData& data) {
    BenchTable& table = study_.report.table({"figure4",
                                             "Figure 4: error against the path tracer",
                                             {{"scene", "scene"},
                                              {"data", "data"},
                                              {"vertices", "vertices", "{:.0f}"},
                                              {"l2", "l2", "{:.4f}"},
                                              {"mean_ratio", "mean ratio", "{:.4f}"},
                                              {"l2_bounces", "l2 of bounces", "{:.4f}"},
                                              {"mean_bounces", "mean ratio", "{:.4f}"}},
                                             {},
                                             {views_.note()}});
    const std::vector<Film> frames = views_.frames(data);
    const VmfError all = views_.error(frames, views_.paths());
    const VmfError bounces = views_.error(views_.frames(data, 1), views_.paths(1));
    table.rows.push_back({name_, kind.name(), static_cast<double>(data.mesh.vertices.size()),
                          all.l2, all.meanRatio, bounces.l2, bounces.meanRatio});
    const std::string file = fmt::format("figure4-{}-{}{}", name_, kind.directions(),
                                         kind.materials ? "-materials" : "");
    study_.report.show("figure4", fmt::format("{}, {}", name_, kind.name()),
                       {{"transfer", picture(file, frames.front())},
                        {"path tracer", picture(fmt::format("figure4-{}-path", name_),
                                                views_.path(0, VmfViews::kBounces).first)}});
  }

  const std::string name_;
  const VmfStudy& study_;
  VmfViews views_;
  std::optional<ToneCurve> curve_;  // of the path tracer's picture, for all
};

}  // namespace

void vmfError(const std::string& name, bool figure1, bool figure2, bool figure4,
              const VmfStudy& study) {
  ErrorStudy(name, study).run(figure1, figure2, figure4);
}

}  // namespace lobelia::app

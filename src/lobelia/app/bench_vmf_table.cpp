// Table 1 of [P002]: size and time of transfer, and frames per second while the light turns, beside
// the paper's figures; and how dense the paper's table of displaced rows is by Phong exponent.
#include <fmt/format.h>

#include <limits>

#include "lobelia/app/bench_cuts.h"
#include "lobelia/app/bench_vmf.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/temporary_file.h"
#include "lobelia/transfer/frame.h"
#include "lobelia/transfer/row_displacement.h"

namespace lobelia::app {
namespace {

constexpr int kFrames = 12;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// On a Quadro FX 5800, MB of 24 bytes for each lobe.
struct PaperRow {
  std::string_view scene;
  VmfKind kind;
  double vertices, density, mb, seconds, fps;
};
constexpr PaperRow kPaper[] = {{"bird", {3, false}, 25403, .12, 275.1, 1120, 6.21},
                               {"dragon", {3, false}, 41097, .17, 652.2, 2101, 6.02},
                               {"glasses", {3, false}, 23491, .18, 385.5, 789, 6.19},
                               {"glasses", {4, false}, 23491, .17, 1510.0, 1836, 5.85},
                               {"glasses", {3, true}, 23491, .09, 578.9, 862, 2.79},
                               {"teapot-32", {3, false}, 24269, .18, 413.3, 819, 6.26},
                               {"teapot-64", {3, false}, 24269, .16, 352.0, 844, 6.33},
                               {"teapot-128", {3, false}, 24269, .14, 303.0, 867, 6.36},
                               {"teapot-256", {3, false}, 24269, .12, 264.5, 881, 6.11}};

std::vector<PaperRow> rowsOf(const std::string& scene) {
  std::vector<PaperRow> rows;
  for (const PaperRow& row : kPaper)
    if (row.scene == scene) rows.push_back(row);
  if (rows.empty()) rows.push_back({scene, {}, kNone, kNone, kNone, kNone, kNone});
  return rows;
}

double secondsSince(int64_t start) { return 1e-9 * static_cast<double>(nanosecondsNow() - start); }

class TableStudy {
 public:
  TableStudy(const std::string& name, const VmfStudy& study)
      : name_(name),
        study_(study),
        scene_(loadScene(optionsOf(name, study).scene, study.context)),
        camera_(timedCamera(scene_, optionsOf(name, study))),
        tracer_(scene_, study.context),
        emitters_(scene_, tracer_.bounds()) {}

  void run(bool table1, bool hash) {
    for (const PaperRow& row : rowsOf(name_)) {
      if (study_.cancelled()) return;
      const bool first = row.kind.directionLevel == 3 && !row.kind.materials;
      if (!table1 && !first) continue;
      study_.progress(name_, row.kind.name());
      const VmfData made = makeTransfer(tracer_, row.kind, study_);
      if (table1) addRow(row, made);
      if (hash && first) addHash(row, made.data);
    }
  }

 private:
  static BenchOptions optionsOf(const std::string& name, const VmfStudy& study) {
    BenchOptions options = study.options;
    options.scene.scene = name;
    if (options.size.empty()) options.size = "1024x768";
    return options;
  }

  static size_t lobesOf(const transfer::TransferData& data) {
    size_t lobes = 0;
    for (const transfer::TransferPass& pass : data.passes) lobes += pass.glossy.size();
    return lobes;
  }
  // Records over lobes of slices that there could be.
  static double density(const transfer::TransferData& data, const VmfKind& kind) {
    return static_cast<double>(data.recordCount()) /
           static_cast<double>(data.mesh.vertices.size() * kind.directions() * lobesOf(data));
  }

  void addRow(const PaperRow& paper, const VmfData& made) {
    const TemporaryFile file;
    transfer::save(made.data, scene_, file.path());
    const auto bytes = static_cast<double>(std::filesystem::file_size(file.path()));
    const double fps = framesPerSecond(made.data);
    table1().rows.push_back({name_, paper.kind.name(),
                             static_cast<double>(made.data.mesh.vertices.size()), paper.vertices,
                             100 * density(made.data, paper.kind), 100 * paper.density,
                             1e-6 * static_cast<double>(made.data.byteCount()), 1e-6 * bytes,
                             paper.mb, made.masks, made.rest, paper.seconds, fps, paper.fps});
  }

  double framesPerSecond(const transfer::TransferData& data) {
    transfer::TransferRenderer renderer(tracer_, data);
    renderer.relight(emitters_, study_.context);
    const auto frame = [&](int i) {
      Film film = emptyFrame(camera_);
      renderer.render({.rotation = 5.0 * i, .hideEmitters = scene_.hideEmitters}, camera_, film,
                      study_.context);
    };
    frame(0);
    const int64_t start = nanosecondsNow();
    for (int i = 1; i <= kFrames; ++i) frame(i);  // throws when cancelled
    return kFrames / secondsSince(start);
  }

  // All lobes of slices as rows of one table, as the paper has them.
  void addHash(const PaperRow& paper, const transfer::TransferData& data) {
    transfer::SliceRows all(paper.kind.directions());
    for (const transfer::TransferPass& pass : data.passes)
      for (const transfer::SliceRows& rows : pass.glossy) all.append(rows);
    const int64_t start = nanosecondsNow();
    const transfer::RowDisplacement displaced(all);
    const double seconds = secondsSince(start);
    const auto records = static_cast<double>(all.recordCount());
    const double slots = static_cast<double>(displaced.slots());
    hash().rows.push_back({name_, 1e-6 * records, 100 * density(data, paper.kind),
                           100 * paper.density, records > 0 ? slots / records : kNone,
                           1e-6 * static_cast<double>(displaced.byteCount()),
                           1e-6 * static_cast<double>(all.byteCount()), seconds});
  }

  BenchTable& table1() {
    return study_.report.table(
        {"table1",
         "Table 1: transfer, its size and time, and frames per second",
         {{"scene", "scene"},
          {"data", "data"},
          {"vertices", "vertices", "{:.0f}"},
          {"paper_vertices", "paper", "{:.0f}"},
          {"density", "density %", "{:.1f}"},
          {"paper_density", "paper", "{:.0f}"},
          {"mb", "MB", "{:.1f}"},
          {"file_mb", "MB of file", "{:.1f}"},
          {"paper_mb", "paper", "{:.1f}"},
          {"masks", "masks, s", "{:.1f}"},
          {"seconds", "the rest, s", "{:.1f}"},
          {"paper_seconds", "paper, s", "{:.0f}"},
          {"fps", "frames/s", "{:.1f}"},
          {"paper_fps", "paper", "{:.1f}"}},
         {},
         {fmt::format(
             "Two bounces. Density: records over lobes of slices that there could be. MB: "
             "what frames look up. Frames: {}x{}, the mean of {}, the light turned between "
             "them. The paper's figures: a Quadro FX 5800.",
             camera_.width, camera_.height, kFrames)}});
  }

  BenchTable& hash() {
    return study_.report.table(
        {"hash",
         "Displaced rows against rows of bits",
         {{"scene", "scene"},
          {"mrecords", "million records", "{:.2f}"},
          {"density", "density %", "{:.1f}"},
          {"paper_density", "paper", "{:.0f}"},
          {"slots", "slots per record", "{:.3f}"},
          {"displaced_mb", "displaced, MB", "{:.1f}"},
          {"rows_mb", "rows of bits, MB", "{:.1f}"},
          {"seconds", "built in s", "{:.2f}"}},
         {},
         {"All lobes of all slices as rows of one table [P002 section 6.2]. Displaced rows have "
          "the "
          "number of the row in each slot, by which empty entries are known."}});
  }

  const std::string name_;
  const VmfStudy& study_;
  const Scene scene_;
  const Camera camera_;
  const Tracer tracer_;
  const EmitterSampler emitters_;
};

}  // namespace

void vmfTable(const std::string& name, bool table1, bool hash, const VmfStudy& study) {
  TableStudy(name, study).run(table1, hash);
}

}  // namespace lobelia::app

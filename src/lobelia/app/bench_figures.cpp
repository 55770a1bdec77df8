#include "lobelia/app/bench_figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "lobelia/app/frame_setup.h"
#include "lobelia/base/error.h"
#include "lobelia/base/file.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {
namespace {

std::string gallery(const std::vector<FigurePicture>& line) {
  std::string captions, rule, pictures;
  for (const FigurePicture& picture : line) {
    captions += fmt::format("| {} ", picture.caption);
    rule += "|---";
    pictures += fmt::format("| ![{}]({}) ", picture.caption, picture.file);
  }
  return fmt::format("{}|\n{}|\n{}|\n", captions, rule, pictures);
}

// Scenes may be named by paths.
std::string fileName(std::string name) {
  std::replace(name.begin(), name.end(), '/', '-');
  return name;
}

}  // namespace

std::set<std::string> chosenOf(const std::string& option, const std::string& list,
                               std::span<const std::string> known) {
  if (list.empty()) return {known.begin(), known.end()};
  std::set<std::string> chosen;
  std::istringstream in(list + ",");
  for (std::string name; std::getline(in, name, ',');) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw UsageError(fmt::format("{} '{}': there is no '{}'; there are {} (a list has commas){}",
                                   option, list, name, fmt::join(known, ", "),
                                   suggestion(name, {known.begin(), known.end()})));
    }
    chosen.insert(name);
  }
  return chosen;
}

FigureReport::FigureReport(std::string folder, std::string page, std::string title)
    : folder_(std::move(folder)), page_(std::move(page)), title_(std::move(title)) {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw UsageError(fmt::format("-o {}: cannot make that folder: {}", folder_, error.message()));
  }
  requireWritable(fmt::format("{}/{}.md", folder_, page_));
}

BenchTable& FigureReport::table(const BenchTable& empty) {
  const auto found = std::find_if(tables_.begin(), tables_.end(),
                                  [&](const BenchTable& table) { return table.key == empty.key; });
  if (found != tables_.end()) return *found;
  tables_.push_back(empty);
  return tables_.back();
}

std::string FigureReport::picture(const std::string& name, const Film& film,
                                  const ToneCurve& curve) const {
  if (folder_.empty()) return "";
  io::writeExr(fmt::format("{}/{}.exr", folder_, fileName(name)), film);
  return picture(name, toneMap(film, curve), film);
}

std::string FigureReport::picture(const std::string& name, const std::vector<uint8_t>& pixels,
                                  const Film& shape) const {
  if (folder_.empty()) return "";
  const std::string file = fileName(name) + ".png";
  io::writePng(fmt::format("{}/{}", folder_, file), pixels, shape.width, shape.height);
  return file;
}

std::string FigureReport::drawing(const std::string& name, const std::string& svg) const {
  if (folder_.empty()) return "";
  const std::string file = fileName(name) + ".svg";
  writeFileAtomically(fmt::format("{}/{}", folder_, file),
                      std::as_bytes(std::span<const char>(svg)));
  return file;
}

void FigureReport::show(const std::string& tableKey, const std::string& title,
                        std::vector<FigurePicture> line) {
  std::erase_if(line, [](const FigurePicture& picture) { return picture.file.empty(); });
  if (!line.empty()) lines_.push_back({tableKey, title, std::move(line)});
}

void FigureReport::writePage(const std::string& command) const {
  if (folder_.empty()) return;
  std::string text = fmt::format("# {}\n\n    {}\n", title_, command);
  for (const BenchTable& table : tables_) {
    text += fmt::format("\n{}", markdown(table));
    for (const Line& line : lines_)
      if (line.tableKey == table.key)
        text += fmt::format("\n**{}**\n\n{}", line.title, gallery(line.pictures));
  }
  writeFileAtomically(fmt::format("{}/{}.md", folder_, page_),
                      std::as_bytes(std::span<const char>(text)));
}

}  // namespace lobelia::app

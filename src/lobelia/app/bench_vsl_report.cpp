#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "lobelia/app/bench_vsl.h"
#include "lobelia/base/file.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {
namespace {

std::string gallery(const std::vector<VslPicture>& line) {
  std::string captions, rule, pictures;
  for (const VslPicture& picture : line) {
    captions += fmt::format("| {} ", picture.caption);
    rule += "|---";
    pictures += fmt::format("| ![{}]({}) ", picture.caption, picture.file);
  }
  return fmt::format("{}|\n{}|\n{}|\n", captions, rule, pictures);
}

}  // namespace

VslReport::VslReport(std::string folder) : folder_(std::move(folder)) {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw UsageError(fmt::format("-o {}: cannot make that folder: {}", folder_, error.message()));
  }
  requireWritable(folder_ + "/vsl.md");
}

BenchTable& VslReport::table(const BenchTable& empty) {
  const auto found = std::find_if(tables_.begin(), tables_.end(),
                                  [&](const BenchTable& table) { return table.key == empty.key; });
  if (found != tables_.end()) return *found;
  tables_.push_back(empty);
  return tables_.back();
}

std::string VslReport::picture(const std::string& name, const Film& film,
                               const ToneCurve& curve) const {
  if (folder_.empty()) return "";
  io::writeExr(fmt::format("{}/{}.exr", folder_, name), film);
  return picture(name, toneMap(film, curve), film);
}

std::string VslReport::picture(const std::string& name, const std::vector<uint8_t>& pixels,
                               const Film& shape) const {
  if (folder_.empty()) return "";
  io::writePng(fmt::format("{}/{}.png", folder_, name), pixels, shape.width, shape.height);
  return fmt::format("{}.png", name);
}

void VslReport::show(const std::string& tableKey, const std::string& title,
                     std::vector<VslPicture> line) {
  std::erase_if(line, [](const VslPicture& picture) { return picture.file.empty(); });
  if (!line.empty()) lines_.push_back({tableKey, title, std::move(line)});
}

void VslReport::writePage(const std::string& command) const {
  if (folder_.empty()) return;
  std::string text =
      fmt::format("# Virtual spherical lights: figures of [Hasan09]\n\n    {}\n", command);
  for (const BenchTable& table : tables_) {
    text += fmt::format("\n{}", markdown(table));
    for (const Line& line : lines_)
      if (line.tableKey == table.key)
        text += fmt::format("\n**{}**\n\n{}", line.title, gallery(line.pictures));
  }
  writeFileAtomically(folder_ + "/vsl.md", std::as_bytes(std::span<const char>(text)));
}

}  // namespace lobelia::app

// Figures of a paper as a study makes them again: which of them, their tables and pictures, and the
// page that shows these.
#pragma once

#include <deque>
#include <iterator>
#include <set>
#include <span>

#include "lobelia/app/bench_report.h"
#include "lobelia/film/film.h"

namespace lobelia::app {

// Of a list with commas, as `option` ("--figures") has it; "": all. Throws UsageError for what is
// not known.
std::set<std::string> chosenOf(const std::string& option, const std::string& list,
                               std::span<const std::string> known);

struct FigurePicture {
  std::string caption, file;  // the file within the folder
};

// Tables by key, in the order in which they were begun, and pictures below each.
class FigureReport {
 public:
  // Makes the folder; "" where no pictures are wanted. page: the name of its page (PAGE.md).
  FigureReport(std::string folder, std::string page, std::string title);
  bool hasPictures() const { return !folder_.empty(); }

  // The table of that key, begun with what `empty` holds when there is none yet.
  BenchTable& table(const BenchTable& empty);
  // Writes NAME.exr and NAME.png, tone-mapped; "" where no pictures are wanted.
  std::string picture(const std::string& name, const Film& film, const ToneCurve& curve) const;
  std::string picture(const std::string& name, const std::vector<uint8_t>& pixels,
                      const Film& shape) const;
  // Writes NAME.svg.
  std::string drawing(const std::string& name, const std::string& svg) const;
  // A line of pictures below a table; those without a file are left out.
  void show(const std::string& tableKey, const std::string& title, std::vector<FigurePicture> line);
  void writePage(const std::string& command) const;  // as far as the study is
  std::vector<BenchTable> takeTables() {
    return {std::make_move_iterator(tables_.begin()), std::make_move_iterator(tables_.end())};
  }

 private:
  struct Line {
    std::string tableKey, title;
    std::vector<FigurePicture> pictures;
  };
  std::string folder_, page_, title_;
  std::deque<BenchTable> tables_;  // references to them are given out
  std::vector<Line> lines_;
};

}  // namespace lobelia::app

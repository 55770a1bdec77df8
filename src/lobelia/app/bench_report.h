// What a study found, as tables: Markdown for the eye, JSON for programs.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace lobelia::app {

struct BenchColumn {
  std::string key, heading;
  std::string format = "{:.4g}";  // of numbers; keys name them in JSON
};
using BenchCell = std::variant<std::string, double>;  // not finite: "-", null in JSON

struct BenchTable {
  std::string key, title;
  std::vector<BenchColumn> columns;
  std::vector<std::vector<BenchCell>> rows;
  std::vector<std::string> notes;
};

struct BenchRun {  // what was asked for, and the answer
  std::string name, command;
  uint64_t seed = 0;
  std::vector<BenchTable> tables;
};

std::string markdown(const BenchTable& table);
std::string json(const BenchRun& run);

}  // namespace lobelia::app

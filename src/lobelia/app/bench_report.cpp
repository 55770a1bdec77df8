#include "lobelia/app/bench_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lobelia/base/parallel.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;

std::string text(const BenchColumn& column, const BenchCell& cell) {
  if (const auto* words = std::get_if<std::string>(&cell)) return *words;
  const double number = std::get<double>(cell);
  return std::isfinite(number) ? fmt::format(fmt::runtime(column.format), number) : "-";
}

Json value(const BenchCell& cell) {
  if (const auto* words = std::get_if<std::string>(&cell)) return *words;
  const double number = std::get<double>(cell);
  return std::isfinite(number) ? Json(number) : Json();
}

// The processor's name where the system tells it.
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

std::string markdown(const BenchTable& table) {
  std::string out = fmt::format("### {}\n\n", table.title);
  for (const BenchColumn& column : table.columns) out += "| " + column.heading + " ";
  out += "|\n";
  for (size_t i = 0; i < table.columns.size(); ++i) out += i == 0 ? "|---" : "|---:";
  out += "|\n";
  for (const auto& row : table.rows) {
    for (size_t i = 0; i < row.size(); ++i) out += "| " + text(table.columns[i], row[i]) + " ";
    out += "|\n";
  }
  if (!table.notes.empty()) out += "\n";
  for (const std::string& note : table.notes) out += note + "\n";
  return out;
}

std::string json(const BenchRun& run) {
  Json out{{"bench", run.name}, {"version", kVersion},      {"command", run.command},
           {"seed", run.seed},  {"processor", processor()}, {"threads", threadCount()}};
  for (const BenchTable& table : run.tables) {
    Json rows = Json::array();
    for (const auto& row : table.rows) {
      Json object = Json::object();
      for (size_t i = 0; i < row.size(); ++i) object[table.columns[i].key] = value(row[i]);
      rows.push_back(std::move(object));
    }
    out[table.key] = std::move(rows);
  }
  return out.dump(2) + "\n";
}

}  // namespace lobelia::app

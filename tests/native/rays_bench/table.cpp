#include "rays_bench/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace panoptes::test {

namespace {

// Three digits that mean something; counts in full.
std::string number(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return fmt::format("{:.0f}", value);
  return std::abs(value) >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string text(const Cell& cell) {
  if (const auto* words = std::get_if<std::string>(&cell)) return *words;
  if (const auto* value = std::get_if<double>(&cell)) return number(*value);
  return "-";
}

std::string quoted(const std::string& words) {
  std::string out = "\"";
  for (char c : words) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
    else
      out += fmt::format("\\u{:04x}", int(c));
  }
  return out + '"';
}

std::string json(const Cell& cell) {
  if (const auto* words = std::get_if<std::string>(&cell)) return quoted(*words);
  const auto* value = std::get_if<double>(&cell);
  return value && std::isfinite(*value) ? fmt::format("{:.9g}", *value) : "null";
}

}  // namespace

std::string as_text(const Table& table) {
  std::vector<size_t> widths;
  for (size_t c = 0; c < table.columns.size(); ++c) {
    size_t width = table.columns[c].size();
    for (const auto& row : table.rows) width = std::max(width, text(row.at(c)).size());
    widths.push_back(width);
  }
  std::string out = table.title + "\n";
  const auto line = [&](const auto& cell_text) {
    for (size_t c = 0; c < widths.size(); ++c)
      out += c == 0 ? fmt::format("  {:<{}}", cell_text(c), widths[c])
                    : fmt::format("  {:>{}}", cell_text(c), widths[c]);
    out += '\n';
  };
  line([&](size_t c) { return table.columns[c]; });
  for (const auto& row : table.rows) line([&](size_t c) { return text(row[c]); });
  return out;
}

std::string as_json(const std::string& device, const std::vector<Table>& tables) {
  std::vector<std::string> parts;
  for (const Table& table : tables) {
    std::vector<std::string> rows;
    for (const auto& row : table.rows) {
      std::vector<std::string> cells;
      for (size_t c = 0; c < table.columns.size(); ++c)
        cells.push_back(quoted(table.columns[c]) + ": " + json(row.at(c)));
      rows.push_back(fmt::format("{{{}}}", fmt::join(cells, ", ")));
    }
    parts.push_back(fmt::format("{{\"title\": {}, \"rows\": [\n    {}]}}", quoted(table.title),
                                fmt::join(rows, ",\n    ")));
  }
  return fmt::format("{{\"device\": {}, \"tables\": [\n  {}]}}\n", quoted(device),
                     fmt::join(parts, ",\n  "));
}

}  // namespace panoptes::test

// What the benchmark prints: tables, as text for people or as JSON.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace panoptes::test {

// Text, a number, or nothing (not measured).
using Cell = std::variant<std::monostate, std::string, double>;

struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;

  void add(std::vector<Cell> row) { rows.push_back(std::move(row)); }
};

std::string as_text(const Table& table);
// {"device": ..., "tables": [{"title": ..., "rows": [{column: cell}]}]}; nothing becomes null.
std::string as_json(const std::string& device, const std::vector<Table>& tables);

}  // namespace panoptes::test

// SPDX-License-Identifier: Apache-2.0
#include "carus/results/curves.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

#include "carus/core/error.hpp"
#include "carus/results/files.hpp"

namespace carus::results {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t comma; (comma = line.find(',', begin)) != std::string::npos; begin = comma + 1) {
    cells.push_back(line.substr(begin, comma - begin));
  }
  cells.push_back(line.substr(begin));
  return cells;
}

}  // namespace

observe::Table read_curves(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  observe::Table table;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const auto cells = split(text.substr(begin, end - begin));
    if (begin == 0) {
      table.names = cells;
      continue;
    }
    if (cells.size() != table.names.size()) {
      throw InputError(fmt::format("{}: line {} has {} values, the header {} names", file.string(),
                                   table.rows.size() + 2, cells.size(), table.names.size()));
    }
    observe::Values row;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      char* rest = nullptr;
      row.push_back(std::strtod(cells[k].c_str(), &rest));
      if (cells[k].empty() || *rest != '\0') {
        throw InputError(fmt::format("{}: line {}: {}: \"{}\"; allowed a number", file.string(), table.rows.size() + 2,
                                     table.names[k], cells[k].substr(0, 40)));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Curves::Curves(const std::filesystem::path& file, std::vector<std::string> names) {
  table_.names = std::move(names);
  out_.open(file, std::ios::trunc);
  out_ << fmt::format("{}\n", fmt::join(table_.names, ",")) << std::flush;
  if (!out_) throw InputError(fmt::format("{}: cannot be written", file.string()));
}

Curves::Curves(const std::filesystem::path& file, std::vector<std::string> names, std::size_t keep) {
  keep_lines(file, keep + 1);
  table_ = read_curves(file);
  if (table_.names != names) {
    throw InputError(
        fmt::format("{}: columns are not those of this version of carus; run again without --resume", file.string()));
  }
  out_.open(file, std::ios::app);
}

void Curves::append(const observe::Values& row) {
  CARUS_ASSERT(row.size() == table_.names.size());
  // {} is the shortest text that reads back to the same double: a resumed run goes on from the very same numbers.
  out_ << fmt::format("{}\n", fmt::join(row, ",")) << std::flush;
  table_.rows.push_back(row);
}

}  // namespace carus::results

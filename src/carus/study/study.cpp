// SPDX-License-Identifier: Apache-2.0
#include "carus/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "carus/core/error.hpp"
#include "carus/results/files.hpp"

namespace carus::study {
namespace {

namespace fs = std::filesystem;

class Runner {
 public:
  Runner(const std::vector<Row>& rows, const Options& options) : rows_(rows), o_(options) {
    table_.scenario = o_.scenario, table_.variants = o_.variants;
    table_.version = o_.version, table_.commit = o_.commit;
  }

  Table run() {
    fs::create_directories(o_.out);
    for (const Row& row : rows_) {
      Entry entry{
          .name = row.name, .set = row.set, .same_as = row.same_as, .kept = false, .measures = {}, .difference = {}};
      if (!(row.same_as.empty() ? compute(row, entry) : copy(entry))) {
        table_.interrupted = true;
        say(row, "interrupted; the same command goes on");
        break;
      }
      if (!table_.entries.empty())
        entry.difference = largest_difference_percent(table_.entries.front().measures.peaks, entry.measures.peaks);
      table_.entries.push_back(entry);
      write();
      say(row, line(entry));
    }
    write();
    return table_;
  }

 private:
  /// False if interrupted.
  bool compute(const Row& row, Entry& entry) {
    const fs::path folder = o_.out / row.name;
    entry.kept = is_complete(folder, row.scenario);
    try {
      if (!entry.kept) {
        const bool resume = is_resumable(folder, row.scenario, results::build_line(o_.version, o_.commit));
        if (o_.run(row.scenario, folder, resume) == results::Outcome::interrupted) return false;
      }
      entry.measures = read_measures(folder, row.scenario);
    } catch (const InputError& error) {
      entry.measures = {};
      entry.measures.outcome = "refused", entry.measures.reason = error.what();
      entry.measures.version = o_.version, entry.measures.commit = o_.commit;
    }
    return true;
  }

  bool copy(Entry& entry) const {
    const auto first = std::find_if(table_.entries.begin(), table_.entries.end(),
                                    [&](const Entry& e) { return e.name == entry.same_as; });
    CARUS_ASSERT(first != table_.entries.end());
    entry.measures = first->measures;
    return true;
  }

  void write() const {
    results::write_atomically(o_.out / "study.md", markdown(table_));
    results::write_atomically(o_.out / "study.json", json(table_));
  }

  static std::string line(const Entry& e) {
    const Measures& m = e.measures;
    std::string text = m.outcome;
    if (m.birth_time) text += fmt::format(" in contraction {} at {:.1f} min", m.contractions, *m.birth_time / 60);
    if (!m.birth_time && !m.peaks.empty()) text += fmt::format(", head {:.0f} mm down", m.peaks.back());
    if (!m.reason.empty()) text += ": " + m.reason.substr(0, m.reason.find('\n'));
    if (e.difference) text += fmt::format("; {:.1f} % from {}", *e.difference, base_row);
    if (!e.same_as.empty()) return text + "; the same scenario as " + e.same_as;
    if (e.kept) return text + "; kept";
    return m.outcome == "refused" ? text : text + fmt::format("; {:.0f} s", m.wall);
  }

  void say(const Row& row, const std::string& text) const {
    if (o_.tell) o_.tell(fmt::format("[{}/{}] {}: {}", &row - rows_.data() + 1, rows_.size(), row.name, text));
  }

  const std::vector<Row>& rows_;
  const Options& o_;
  Table table_;
};

}  // namespace

Table run(const std::vector<Row>& rows, const Options& options) { return Runner(rows, options).run(); }

}  // namespace carus::study

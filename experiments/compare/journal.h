// journal.jsonl: all that a comparison has measured, a line of JSON for each render, written when
// the render is done. Everything else that a comparison writes can be made from it again, so one
// that was stopped at any moment goes on from its last line.
#pragma once

#include "experiments/compare/compare.h"
#include "experiments/output/output_file.h"

#include <nlohmann/json.hpp>

#include <string>
#include <variant>
#include <vector>

namespace lockstep {

struct MeasuredRun {
  Measurement run;
  ErrorSpectrum spectrum;  // of its error
};

// What one line says. `sampler` in the measurements has no meaning here: the name counts.
struct JournalEntry {
  std::string scene;
  int depth = 0;
  std::string sampler;
  std::string conditions;  // all else that the result depends on, in words
  std::variant<MeasuredRun, TimingRepeat> what;
  int line = 0;
};

class Journal {
 public:
  // Opens the journal of `directory`. With `resume` its entries are read, and a last line that was
  // cut short is removed; otherwise an earlier journal is set aside. Throws Error where a line is
  // not a comparison's, and where another process writes to it.
  Journal(const std::string& directory, bool resume);

  const std::string& path() const { return path_; }
  const std::vector<JournalEntry>& earlier() const { return earlier_; }

  // Throw Error where the line cannot be written; the journal is then as it was.
  void add(const JournalEntry& entry);
  // Counts entries that were added as earlier ones.
  void take_over(const std::vector<JournalEntry>& entries);
  void add_note(const nlohmann::ordered_json& note);  // for `lockstep runs`

 private:
  std::string path_;
  AppendFile file_;
  std::vector<JournalEntry> earlier_;
};

constexpr std::string_view kJournalFile = "journal.jsonl";

// An entry as a line of its own, and back; `line` is 0. Throws Error where it is none.
std::string journal_line(const JournalEntry& entry);
JournalEntry parse_journal_line(const std::string& text);

// The lines of a journal, as far as they are whole; those that are not JSON are null.
std::vector<nlohmann::ordered_json> read_journal_lines(const std::string& path);

}  // namespace lockstep

// The battery's results as text and as CSV.
#include "experiments/stress/stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lockstep {
namespace {

std::string csv_quoted(std::string_view text) {
  if (text.find_first_of(",\"\n") == text.npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    out += c;
    if (c == '"') out += c;
  }
  return out + '"';
}

std::string bad_samples(const StressRow& row) {
  std::string text;
  for (const StressBadSample& b : row.bad) {
    text += fmt::format("{}pixel {} {} sample {} seed {}", text.empty() ? "" : "; ", b.at.x, b.at.y,
                        b.at.sample, b.seed);
  }
  return text;
}

std::uint64_t nonfinite(const StressResult& result) {
  std::uint64_t sum = 0;
  for (const StressRow& row : result.rows) sum += row.nonfinite;
  return sum;
}

// Nothing where a row was only compared with that of another width.
std::string if_judged(const StressRow& row, double value) {
  return row.judged ? fmt::format("{}", value) : "";
}

std::string width_text(int width) { return width > 0 ? std::to_string(width) : "any"; }

void append_line(const StressResult& result, std::string& text) {
  const StressRow& row = worst_row(result);
  fmt::format_to(std::back_inserter(text),
                 "{:<8} {:<30} {:>12.6g} {:>12.6g} {:>9.2g}  {:<11} {:>6} {:>6.1f}\n",
                 result.tested.family, result.tested.name, row.expected, row.got,
                 row.standard_error, name(row.verdict), nonfinite(result), result.seconds);
}

void append_complaints(const StressResult& result, std::string& text) {
  for (const StressRow& row : result.rows) {
    if (row.verdict == StressVerdict::Right) continue;
    fmt::format_to(std::back_inserter(text), "{}: {}, width {}{}{}: {} instead of {}: {}\n",
                   name(row.verdict), result.tested.name, width_text(row.width),
                   row.sampler.empty() ? "" : ", ", row.sampler, row.got, row.expected,
                   row.message);
    if (row.verdict == StressVerdict::Unsupported) return;  // once says it
  }
}

}  // namespace

std::string stress_table(const std::vector<StressResult>& results) {
  std::string text = fmt::format("{:<8} {:<30} {:>12} {:>12} {:>9}  {:<11} {:>6} {:>6}\n", "family",
                                 "case", "expected", "got", "std.err.", "verdict", "nonfin", "s");
  int counts[4] = {};
  for (const StressResult& result : results) {
    append_line(result, text);
    ++counts[int(verdict(result))];
  }
  text += '\n';
  for (const StressResult& result : results) append_complaints(result, text);
  return text + fmt::format("{} cases: {} right, {} unsupported, {} vague, {} wrong\n",
                            results.size(), counts[0], counts[1], counts[2], counts[3]);
}

std::string stress_csv_header() {
  return "case,family,extreme,width,sampler,expected,got,standard_error,tolerance,verdict,"
         "nonfinite,nonfinite_samples,fireflies,seconds,message\n";
}

std::string stress_csv_rows(const StressResult& result) {
  std::string text;
  for (const StressRow& row : result.rows) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{:.4f},{}\n",
                   result.tested.name, result.tested.family, csv_quoted(result.tested.extreme),
                   width_text(row.width), csv_quoted(row.sampler.empty() ? "any" : row.sampler),
                   row.expected, row.got, if_judged(row, row.standard_error),
                   if_judged(row, row.tolerance), name(row.verdict), row.nonfinite,
                   csv_quoted(bad_samples(row)), row.fireflies, row.seconds,
                   csv_quoted(row.message));
  }
  return text;
}

}  // namespace lockstep

#include "experiments/report/figures.h"

#include "experiments/output/output_file.h"
#include "experiments/report/series_style.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// A string of gnuplot.
std::string gnuplot_string(std::string text) {
  std::string result = "'";
  for (char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

// Colour and dashes of a sampler's line.
std::string line_look(std::size_t sampler) {
  constexpr int kDashes[] = {1, 2, 4};
  return fmt::format("lc rgb '{}' dt {} lw 1.5", kSeriesColours[sampler % kSeriesColours.size()],
                     kDashes[sampler / kSeriesPerDash % std::size(kDashes)]);
}

// Its marker: the page's, as gnuplot numbers them.
int point_type(std::size_t sampler) {
  constexpr int kPoints[] = {7, 5, 9, 13, 11, 2};
  return kPoints[sampler % std::size(kPoints)];
}

std::string number_or_missing(const Json& value) {
  return value.is_number() ? fmt::format("{:.9g}", value.get<double>()) : "?";
}

// A block for each sampler, a row for each sample count: samples, CPU time, and three columns for
// each metric of the table.
std::string errors_data(const Json& summary, const Json& scene) {
  std::string text = "# spp cpu_seconds";
  for (const Json& column : summary["table"]) {
    const std::string metric = column["name"];
    text += fmt::format(" {0} {0}_p5 {0}_p95", metric);
  }
  text += "\n# median over seeds, and 5 % and 95 % quantiles\n";
  for (const Json& sampler : scene["samplers"]) {
    text += "# " + gnuplot_string(sampler["sampler"]) + "\n";
    for (const Json& rung : sampler["rungs"]) {
      text += fmt::format("{} {}", rung["spp"].get<int>(),
                          number_or_missing(rung["cpu_seconds"]["median"]));
      for (const Json& column : summary["table"]) {
        const Json& spread = rung[column["name"].get<std::string>()];
        for (const char* part : {"median", "p5", "p95"}) {
          text += fmt::format(" {}", number_or_missing(spread[part]));
        }
      }
      text += "\n";
    }
    if (sampler["rungs"].empty()) text += "? ?\n";
    text += "\n\n";
  }
  return text;
}

// What all scripts begin with.
std::string preamble(const std::string& what, const std::string& stem) {
  return fmt::format(
      "# {0}. Run `gnuplot {1}.gp` here to make {1}*.pdf,\n"
      "# or `gnuplot -e \"format='svg'\" {1}.gp` for SVG.\n"
      "if (!exists('format')) format = 'pdf'\n"
      "if (format eq 'svg') {{ set terminal svg size 480,360 noenhanced font 'Helvetica,13' }} \\\n"
      "else {{ set terminal pdfcairo size 8.5cm,6.4cm noenhanced font 'Helvetica,8' }}\n"
      "set datafile missing '?'\n"
      "set logscale xy\n"
      "set autoscale noextend\n"
      "set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n"
      "set grid lc rgb '#dddddd' lw 0.5\n"
      "set key outside below horizontal samplen 2.5\n"
      "set tics nomirror\n"
      "set style fill transparent solid 0.15 noborder\n",
      what, stem);
}

// Tick marks for the positive ones of the values: 1, 2 and 5 times powers of ten, or powers of ten
// alone where they span more than three. Empty where no value is positive.
std::string log_ticks(const std::vector<double>& values) {
  double low = HUGE_VAL, high = 0.0;
  for (double value : values) {
    if (!(value > 0.0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (high == 0.0) return "";
  std::vector<double> ticks;
  for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= 10.0 * high;
       power *= 10.0) {
    ticks.push_back(power);
    if (high < 1000.0 * low) ticks.insert(ticks.end(), {2.0 * power, 5.0 * power});
  }
  return fmt::format("({:.6g})", fmt::join(ticks, ", "));
}

// The values that get() finds in the scene's rungs.
template <class Get>
std::vector<double> rung_values(const Json& scene, Get get) {
  std::vector<double> values;
  for (const Json& sampler : scene["samplers"]) {
    for (const Json& rung : sampler["rungs"]) {
      const Json value = get(rung);
      if (value.is_number()) values.push_back(value.template get<double>());
    }
  }
  return values;
}

// What a figure of errors has across: a column of the data.
struct HorizontalAxis {
  std::string name, label;
  int column;
  std::string ticks;
};

// One plot for each metric of the table.
std::string errors_script(const Json& summary, const Json& scene, const std::string& label,
                          const HorizontalAxis& across) {
  const std::string stem = fmt::format("{}-error-{}", label, across.name);
  std::string text =
      preamble(fmt::format("{}: error against {}", label, across.label), stem) +
      fmt::format("data = {}\nset xtics {}\nset xlabel {}\n", gnuplot_string(label + "-errors.dat"),
                  across.ticks, gnuplot_string(across.label));
  int column = 3;
  for (const Json& metric : summary["table"]) {
    const std::string name = metric["name"];
    const int median = std::exchange(column, column + 3);
    const std::string ticks =
        log_ticks(rung_values(scene, [&](const Json& rung) { return rung[name]["median"]; }));
    if (ticks.empty()) continue;  // nothing to show on a logarithmic axis
    text += fmt::format("\nset output {}.format\nset ytics {}\nset ylabel {}\nplot",
                        gnuplot_string(stem + "-" + name + "."), ticks,
                        gnuplot_string(metric["heading"]));
    std::string lines;
    for (std::size_t s = 0; s < scene["samplers"].size(); ++s) {
      text += fmt::format(
          " \\\n  data index {} using {}:{}:{} with filledcurves notitle lc rgb '{}',", s,
          across.column, median + 1, median + 2, kSeriesColours[s % kSeriesColours.size()]);
      lines +=
          fmt::format(" \\\n  data index {} using {}:{} with linespoints title {} {} pt {} ps 0.5,",
                      s, across.column, median, gnuplot_string(scene["samplers"][s]["sampler"]),
                      line_look(s), point_type(s));
    }
    lines.back() = '\n';
    text += lines;
  }
  return text;
}

// The largest sample count that has spectra.
std::optional<int> spectrum_spp(const Json& scene) {
  std::optional<int> largest;
  for (const Json& sampler : scene["samplers"]) {
    for (const Json& rung : sampler["rungs"]) {
      if (rung.contains("spectrum")) {
        largest = std::max(largest.value_or(0), rung["spp"].get<int>());
      }
    }
  }
  return largest;
}

// A row for each frequency: it, and each sampler's power.
std::string spectrum_data(const Json& scene, int spp) {
  std::string text = fmt::format("# frequency, then the power of each sampler at {} spp:\n#", spp);
  for (const Json& sampler : scene["samplers"])
    text += fmt::format(" {}", gnuplot_string(sampler["sampler"]));
  text += "\n";
  for (std::size_t k = 0; k < scene["frequencies"].size(); ++k) {
    text += number_or_missing(scene["frequencies"][k]);
    for (const Json& sampler : scene["samplers"]) {
      std::string value = "?";
      for (const Json& rung : sampler["rungs"]) {
        if (rung["spp"] == spp && rung.contains("spectrum")) {
          value = number_or_missing(rung["spectrum"]["power"][k]);
        }
      }
      text += fmt::format(" {}", value);
    }
    text += "\n";
  }
  return text;
}

std::string spectrum_script(const Json& scene, const std::string& label, int spp) {
  const std::string stem = label + "-spectrum";
  std::string text =
      preamble(fmt::format("{}: spectrum of the error at {} samples per pixel", label, spp), stem) +
      fmt::format(
          "data = {}\n"
          "set xlabel 'spatial frequency (cycles per pixel)'\n"
          "set ylabel 'power of the error (radiance squared)'\n"
          "set output {}.format\nplot",
          gnuplot_string(stem + ".dat"), gnuplot_string(stem + "."));
  for (std::size_t s = 0; s < scene["samplers"].size(); ++s) {
    text += fmt::format(" \\\n  data using 1:{} with lines title {} {},", s + 2,
                        gnuplot_string(scene["samplers"][s]["sampler"]), line_look(s));
  }
  text.back() = '\n';
  return text;
}

enum class Drawn { Yes, No, NoGnuplot };

Drawn run_gnuplot(const fs::path& folder, std::string script) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  for (int stream : {0, 1, 2}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", stream ? O_WRONLY : O_RDONLY,
                                     0);
  }
  std::string program = "gnuplot";
  char* arguments[] = {program.data(), script.data(), nullptr};
  pid_t process = 0;
  const int failure =
      posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return Drawn::NoGnuplot;
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return Drawn::No;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? Drawn::Yes : Drawn::No;
}

}  // namespace

std::string write_figures(const Json& summary, const std::string& directory) {
  const fs::path folder = fs::path(directory) / "figures";
  make_output_directory(folder.string());
  std::vector<std::string> scripts;
  const auto write = [&](const std::string& name, const std::string& text) {
    write_text_file((folder / name).string(), text);
    if (name.ends_with(".gp")) scripts.push_back(name);
  };
  for (const Json& scene : summary["scenes"]) {
    const std::string label = file_name_safe(scene["label"].get<std::string>());
    write(label + "-errors.dat", errors_data(summary, scene));
    const std::string counts =
        fmt::format("({})", fmt::join(summary["spp"].get<std::vector<int>>(), ", "));
    const std::string times = log_ticks(
        rung_values(scene, [](const Json& rung) { return rung["cpu_seconds"]["median"]; }));
    for (const HorizontalAxis& across : {HorizontalAxis{"time", "CPU time (s)", 2, times},
                                         HorizontalAxis{"spp", "samples per pixel", 1, counts}}) {
      write(fmt::format("{}-error-{}.gp", label, across.name),
            errors_script(summary, scene, label, across));
    }
    if (const std::optional<int> spp = spectrum_spp(scene)) {
      write(label + "-spectrum.dat", spectrum_data(scene, *spp));
      write(label + "-spectrum.gp", spectrum_script(scene, label, *spp));
    }
  }
  std::string failed;
  for (const std::string& script : scripts) {
    const Drawn drawn = run_gnuplot(folder, script);
    if (drawn == Drawn::NoGnuplot) {
      return (folder / "*.gp").string() + " (without PDF: gnuplot is not installed)";
    }
    if (drawn == Drawn::No) failed += fmt::format(" {}", script);
  }
  if (!failed.empty()) return folder.string() + " (gnuplot failed on:" + failed + ")";
  return (folder / "*.pdf").string() + " and the scripts and data that make them";
}

}  // namespace lockstep

// errors.csv: one row for each render of a comparison, written and flushed as it is measured.
// spectra.csv: how the power of the errors spreads over spatial frequencies.
#pragma once

#include "experiments/compare/compare.h"
#include "experiments/output/output_file.h"

#include <string>
#include <string_view>

namespace lockstep {

// A field as RFC 4180 wants it: quoted where it holds a comma, a quote or a line break.
std::string csv_field(std::string_view text);

// scene,sampler,seed,spp,cpu_seconds,wall_seconds, then the metrics in the order of metrics(), then
// depth,pilot_spp,mean_weight,lanes,lanes_active,nonfinite,width,threads,cpu. Numbers have all
// their digits.
std::string errors_csv_header();
std::string errors_csv_row(std::string_view scene, int depth, std::string_view sampler,
                           const Measurement& run);

// The whole of spectra.csv: scene,depth,sampler,spp,frequency,power. A row for each ring of
// frequencies (cycles per pixel) with the power in it, averaged over seeds; see error_spectrum().
std::string spectra_csv(const Comparison& comparison);

// The file as it grows.
class ErrorsCsv {
 public:
  // Writes the file anew with these rows, which end in line breaks. Throws Error.
  ErrorsCsv(const std::string& directory, std::string_view rows);
  void append(std::string_view scene, int depth, std::string_view sampler,
              const Measurement& run);  // throws Error

 private:
  AppendFile file_;
};

}  // namespace lockstep

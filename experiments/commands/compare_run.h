// Runs a comparison for a person: progress on the terminal, all files, and the table at the end.
#pragma once

#include "experiments/compare/compare.h"

namespace lockstep {

// Writes errors.csv, spectra.csv, summary.json, report.html and images to the settings' directory,
// prints the table. Throws Cancelled after writing what there is when it was interrupted.
void run_comparison(const CompareSettings& settings, bool quiet);

}  // namespace lockstep

// Runs a comparison for a person: progress on the terminal, all files, and the table at the end.
#pragma once

#include "experiments/compare/compare.h"

namespace lockstep {

class Desk;

// Writes errors.csv, spectra.csv, summary.json, report.html and images to the settings' directory,
// prints the table. Ranks of the desk help. Throws Cancelled after writing what there is when it
// was interrupted.
void run_comparison(const CompareSettings& settings, bool quiet, Desk* desk = nullptr);

}  // namespace lockstep

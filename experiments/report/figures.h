// Figures for a paper: gnuplot scripts with their data, and the PDF files that gnuplot makes of
// them.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace lockstep {

// Writes to directory/figures, for every scene of what summarize() made: LABEL-errors.dat and
// LABEL-spectrum.dat, and the scripts LABEL-error-time.gp, LABEL-error-spp.gp and
// LABEL-spectrum.gp, which gnuplot then turns into one PDF for each metric of the report's table.
// Scripts and data are written where there is no gnuplot, too. Returns where the figures are, or
// what is missing, in one line for people. Throws Error where nothing can be written.
std::string write_figures(const nlohmann::ordered_json& summary, const std::string& directory);

}  // namespace lockstep

// How a sampler's line looks in every chart, by its place in the list of samplers: colour, dashes
// and marker together tell thirty apart.
#pragma once

#include <array>
#include <string_view>

namespace lockstep {

// Ten colours that stay apart with every common colour blindness (Petroff 2021, "Accessible Color
// Sequences for Data Visualization").
inline constexpr std::array<std::string_view, 10> kSeriesColours = {
    "#3f90da", "#ffa90e", "#bd1f01", "#94a4a2", "#832db6",
    "#a96b59", "#e76300", "#b9ac70", "#717581", "#92dadd"};

// Each this many lines the dashes change: solid, dashed, dash-dotted.
inline constexpr int kSeriesPerDash = 5;

}  // namespace lockstep

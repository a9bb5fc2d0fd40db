// Reference images for comparisons, kept in the output directory so that a second run finds them.
#pragma once

#include "core/scene.h"
#include "experiments/compare.h"

#include <string>

namespace lockstep {

// Samples per pixel of the reference that `settings` asks for.
int reference_spp(const CompareSettings& settings);

// The file named by the settings, the one in the directory if it was made with the same settings,
// or else a new render: two independent Owen-scrambled halves, averaged; their difference gives
// the error estimate. `render_settings` has the comparison's depth and machine settings.
Reference make_reference(const CompareSettings& settings, const SceneComparison& comparison,
                         const Scene& scene, RenderSettings render_settings,
                         const Progress& progress);

// True where make_reference will find a finished image.
bool has_reference(const CompareSettings& settings, const SceneComparison& comparison,
                   const Scene& scene);

}  // namespace lockstep

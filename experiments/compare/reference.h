// Reference images for comparisons, kept in files that are named by what they were made from, so
// that a second run finds them.
#pragma once

#include "core/scene.h"
#include "experiments/compare/compare.h"

#include <cstdint>
#include <string>

namespace lockstep {

// Samples per pixel of the reference that `settings` asks for.
int reference_spp(const CompareSettings& settings);

// The file named by the settings, one in the folder of references that was made with the same
// settings, or else a new render: two independent Owen-scrambled halves, averaged; what they differ
// by gives the error estimates. `render_settings` has the comparison's depth and machine settings.
// A render that is stopped keeps its state beside the file and continues the next time.
Reference make_reference(const CompareSettings& settings, const SceneComparison& comparison,
                         const Scene& scene, RenderSettings render_settings,
                         const Progress& progress);

// True where make_reference will find a finished image.
bool has_reference(const CompareSettings& settings, const SceneComparison& comparison,
                   const Scene& scene);

// A number that tells images apart.
std::uint64_t content_fingerprint(const Image& image);

}  // namespace lockstep

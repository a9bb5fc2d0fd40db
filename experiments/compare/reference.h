// Reference images for comparisons, kept in files that are named by what they were made from, so
// that a second run finds them.
#pragma once

#include "core/scene.h"
#include "experiments/compare/compare.h"

#include <cstdint>
#include <string>

#include <functional>

namespace lockstep {

// Renders one of the two halves that a reference is the mean of.
using RenderHalf =
    std::function<RenderResult(const Scene& scene, const SamplerSpec& sampler,
                               const RenderSettings& settings, int half, const Progress& progress)>;

// The sampler of references, and what is rendered with it: `settings` have the comparison's depth.
SamplerSpec reference_sampler();
RenderSettings half_settings(const CompareSettings& settings, RenderSettings render_settings,
                             int half);

// Samples per pixel of the reference that `settings` asks for.
int reference_spp(const CompareSettings& settings);

// The file named by the settings, one in the folder of references that was made with the same
// settings, or else a new render: two independent Owen-scrambled halves, averaged; what they differ
// by gives the error estimates. `render_settings` has the comparison's depth and machine settings.
// A render that is stopped keeps its state beside the file and continues the next time.
// `render_half` is used in place of render() where given.
Reference make_reference(const CompareSettings& settings, const SceneComparison& comparison,
                         const Scene& scene, RenderSettings render_settings,
                         const Progress& progress, const RenderHalf& render_half = {});

// True where make_reference will find a finished image.
bool has_reference(const CompareSettings& settings, const SceneComparison& comparison,
                   const Scene& scene);

// A number that tells images apart.
std::uint64_t content_fingerprint(const Image& image);

}  // namespace lockstep

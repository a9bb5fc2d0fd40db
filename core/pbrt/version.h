// Which pbrt wrote a scene file. Files do not state it; defaults differ.
#pragma once

namespace lockstep::pbrt {

// The film's type tells v4 apart: before it there was only "image". Without a film, a WorldEnd
// tells v3, since v4 dropped that directive. Renderer, SurfaceIntegrator and the like are v2's.
enum class Version { v2, v3, v4 };

}  // namespace lockstep::pbrt

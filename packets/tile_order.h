// The order in which a pass begins its tiles.
#pragma once

namespace lockstep {

// Any order gives the same image: tests see to that.
enum class TileOrder { Forward, Backward, Scattered };

}  // namespace lockstep

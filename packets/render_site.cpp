#include "packets/render_site.h"

namespace lockstep {

RenderSite& render_site() noexcept {
  static constinit thread_local RenderSite site;
  return site;
}

}  // namespace lockstep

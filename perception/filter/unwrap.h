// Accepts pixels that may be ghosts where their neighbours tell that they are none. A range camera measures range modulo
// the unambiguous range U; a surface at range R reads r = R - kU. One pixel alone cannot tell an oblique or dark surface
// at r from a bright one at r + U (IsGhost in perception/filter/depth_filter.h). Where U is short, that takes nearly all
// of a corridor's walls. But surfaces are continuous: the order k spreads from pixels where it is known, those bright
// enough for their range, to neighbours that continue the same surface, also across the wrap. This is phase unwrapping
// by region growing (D. Ghiglia and M. Pritt, "Two-dimensional phase unwrapping", Wiley, 1998).
//
// A pixel continues a surface where enough neighbours of known order agree: ranges within the agreement tolerance,
// amplitudes within a factor of two, and no albedo above that of the brightest surface. A ghost beside a near object of
// the same reading is much darker than that, so the order does not spread across.
#pragma once

#include <vector>

#include "perception/filter/depth_filter.h"

namespace merlin {

// Accepts each pixel with Rejection::kGhost whose order the surface tells: its reason becomes kNone, and kU is added to
// its range. Works only on frames in which less than a quarter of the pixels are accepted already. Dark pixels are more
// biased, by light that came over other paths, so that frames with enough bright ones do better without them.
void UnwrapGhosts(DepthFrame& frame, std::vector<Rejection>& reasons, double lamp_amplitude_e_m2,
                  const DepthFilterConfig& config);

}  // namespace merlin

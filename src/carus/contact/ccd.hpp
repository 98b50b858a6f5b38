// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/contact/distance.hpp"

namespace carus::contact {

/// Share of the way p, at most `most`, that two features x may go together before what separates them has shrunk to a
/// tenth: additive continuous collision detection (Li et al. 2021). It never overshoots: each advance is what the
/// distance allows at the greatest speed of approach. `edges`: two edges, else point and triangle. Distances > 0 at the
/// start.
double conservative_step(Corners x, Corners p, bool edges, double most);

}  // namespace carus::contact

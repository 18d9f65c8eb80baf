#pragma once
// Which lights a row's points see: the map's visibility says what may be seen from somewhere in a cluster, a few rays
// say how much of it is.

#include "renderer_rt/light_probe.hpp"

namespace q3rt {

/// Has the lights of each cluster's rows chosen also in proportion to how much of them arrives, by rays from the rows'
/// points. A light that gives g and arrives with chance v adds g^2 v to the second moment of the choice: the least
/// variance is had in proportion to g sqrt(v), so that the root is what is `seen`. Movers don't stand in the way: doors
/// open. `rows`: those of the probe's tables. Deterministic.
void lookFromRows(const LightProbe& probe, LightRows& rows);

} // namespace q3rt

#pragma once
// The BSP tree over a box map: split planes are box sides; leafs are boxes, of air (with their faces) or solid (with a
// brush that fills them).

#include "baseq3-test/box_map.hpp"

namespace q3rt {

/// Fills planes, nodes, leafs, leaf surfaces, leaf brushes, brushes and brush sides of `bsp`. Face i is surface i.
/// `solidShader` is the brushes' shader number.
void buildBoxTree(const BoxMap& map, const std::vector<BoxFace>& faces, int solidShader, Bsp& bsp);

} // namespace q3rt

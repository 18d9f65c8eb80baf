#pragma once
// Deforms that rebuild quads: each takes a batch apart and puts it together again.

#include "scene/deform.hpp"

namespace q3rt {

/// Every 4 vertices become a square that faces the view.
void deformAutoSprite(const DeformContext& context, std::vector<Vertex>& vertices, std::vector<uint32_t>& indices);
/// Every 4 vertices turn about their long axis toward the view.
void deformAutoSprite2(const DeformContext& context, std::vector<Vertex>& vertices,
                       const std::vector<uint32_t>& indices);
/// The first quad becomes a line of text of the view.
void deformText(const DeformContext& context, int textNumber, std::vector<Vertex>& vertices,
                std::vector<uint32_t>& indices);

} // namespace q3rt

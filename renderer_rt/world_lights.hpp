#pragma once
// The lights, the light table, the tree that finds a point's row in it, and the light grid: built at load, read by the
// direct-illumination stage.

#include <unordered_map>
#include <vector>

#include "gpu/uploader.hpp"
#include "scene/entity_geometry.hpp"
#include "scene/light_animation.hpp"
#include "scene/light_rows.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {

/// Irradiance = ambient + directed x max(0, cosine of normal and direction), luxel units.
struct GridShare {
    vec3 ambient, directed;
    bool valid; ///< false: no light is known here, such as inside a wall
};

/// What the traced lights leave of a point of the map's light grid.
struct GridCell {
    GridShare surfaces; ///< of what has a lightmap, or baked colours
    GridShare models;   ///< of what the engine lights by the grid
    vec3 direction;     ///< unit, toward the light
    float sunSeen;      ///< share of the suns that shine here, [0, 1]: a guide for choosing lights
    bool isFitted;      ///< what surfaces take is what their luxels lack (grid_fit.hpp)
};

/// What is uploaded, as plain tables: pure, testable.
struct LightTables {
    std::vector<RtTriangleLight> triangles; ///< of emitters, then of skies
    std::vector<RtLight> points;            ///< numbered on after the triangles
    std::vector<RtLight> others;            ///< suns, in no row; a frame's dynamic lights follow them
    LightRows rows;
    std::vector<RtNode> nodes;
    LightGrid gridShape; ///< where the cells of `grid` stand; has none itself
    std::vector<GridCell> grid;
};
/// The shape of the map's light grid. Of a map without one that can be used: one over all that is drawn, for what
/// luxels lack.
LightGrid gridShapeOf(const World& world);

/// Of the light grid on models: r_ambientScale, r_directedScale.
struct ModelLightScale {
    float ambient = 0.6f, directed = 1;
    bool operator==(const ModelLightScale&) const = default;
};

/// Animated emitters are entered into `animation`. The grid is as baked: explainGrid() comes next.
LightTables buildLightTables(const World& world, const MaterialLibrary& materials, const LightSet& lights,
                             const ModelLightScale& scale, LightAnimation& animation);

/// Clusters from which any part of a sky surface may be seen; all of them if a sky surface is in no cluster.
std::vector<bool> findSkyClusters(const World& world, const MaterialLibrary& materials);

/// A dynamic light of the game as a sphere (units: shaders/shared/constants.h).
RtLight makeDynamicLight(const vec3& origin, float radiusQu, const vec3& color);

/// A light of a mover where the mover is. Movers are rigid.
TriangleLight moveLight(const TriangleLight& light, const mat4& worldFromModel);

/// A light on its surface as the view has it, deformed: what glows is what is seen, and what stops rays to others.
TriangleLight deformLight(const TriangleLight& light, const ViewGeometry& geometry, const EntitySurface& surface);

/// All that is made of a map's lights before it is uploaded (prepared_lights.hpp).
struct PreparedLights {
    LightSet lights;
    LightAnimation animation;
    LightTables tables;
};

class WorldLights {
  public:
    WorldLights(Device& device, Uploader& uploader, const World& world, const PreparedLights& prepared);
    /// Fills the frame's light addresses and counts, all but those of `lights` (see others()).
    void describe(RtFrame& frame) const;
    /// All triangle lights, those of movers and deformed surfaces where the view has them; empty if all are where
    /// describe() says.
    std::vector<RtTriangleLight> moveTriangles(const ViewGeometry& geometry) const;
    const std::vector<RtLight>& others() const { return m_others; }
    /// What animated lights are multiplied by at a time.
    std::vector<vec3> colorsAt(double shaderTimeSeconds) const { return m_animation.evaluate(shaderTimeSeconds); }
    size_t triangleCount() const { return m_triangleCount; }
    size_t pointCount() const { return m_pointCount; }
    size_t rowEntryCount() const { return m_rowEntryCount; }
    uint32_t clusterCount() const { return m_clusterCount; }

  private:
    struct MovingLight {
        size_t index; ///< in the table
        TriangleLight light;
    };
    void moveDeformed(const ViewGeometry& geometry, std::vector<RtTriangleLight>& moved) const;

    LightAnimation m_animation;
    std::vector<RtLight> m_others;
    std::vector<RtTriangleLight> m_resting; ///< all triangle lights; kept if some move
    std::vector<MovingLight> m_ofMovers;
    std::unordered_map<int, std::vector<MovingLight>> m_deformed; ///< by world surface
    Buffer m_triangles, m_points, m_rows, m_entries, m_nodes, m_nodeStarts, m_grid;
    size_t m_triangleCount = 0, m_pointCount = 0, m_rowEntryCount = 0;
    uint32_t m_clusterCount = 0;
    vec3 m_nodeStartOrigin{0};
    float m_nodeStartCellQu = 1;
    ivec3 m_nodeStartCounts{0};
    vec3 m_gridOrigin{0}, m_gridCellSize{1};
    ivec3 m_gridCounts{0};
};

} // namespace q3rt

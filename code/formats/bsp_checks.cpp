#include "formats/bsp_checks.hpp"

#include <string>

#include "base/error.hpp"

namespace q3rt {
namespace {

/// Axial sides that every brush starts with; a fog's bounds are taken from them.
constexpr int kAxialSides = 6;

class ReferenceCheck {
  public:
    ReferenceCheck(const Bsp& bsp, std::string_view name)
        : m_bsp(bsp)
        , m_name(name) {}

    void run() {
        checkNodes();
        checkTree();
        checkLeafs();
        checkModels();
        checkBrushes();
        checkFogs();
        checkSurfaces();
    }

  private:
    [[noreturn]] void fail(const char* lump, size_t record, const char* what) const {
        throw ContentError(formatText("%s: %s lump, record %zu: %s; the map is damaged, get it again", m_name.c_str(),
                                      lump, record, what));
    }

    static bool inArray(int index, size_t size) { return index >= 0 && static_cast<size_t>(index) < size; }
    static bool inArray(int first, int count, size_t size) {
        return first >= 0 && count >= 0 && static_cast<size_t>(first) + static_cast<size_t>(count) <= size;
    }

    void checkNodes() const {
        if (m_bsp.nodes.empty() || m_bsp.leafs.empty())
            throw ContentError(m_name + ": NODES or LEAFS lump is empty; the map is damaged, get it again");
        for (size_t i = 0; i < m_bsp.nodes.size(); ++i) {
            const BspNode& node = m_bsp.nodes[i];
            if (!inArray(node.plane, m_bsp.planes.size())) fail("NODES", i, "there is no such plane");
            for (const int child : node.children) {
                const bool known =
                    child >= 0 ? inArray(child, m_bsp.nodes.size()) : inArray(-1 - child, m_bsp.leafs.size());
                if (!known) fail("NODES", i, "there is no such child");
            }
        }
    }

    /// A node with two parents, or its own ancestor, would make a walk of the tree endless or exponential.
    void checkTree() const {
        std::vector<bool> reached(m_bsp.nodes.size());
        std::vector<int> open{0};
        reached[0] = true;
        while (!open.empty()) {
            const int node = open.back();
            open.pop_back();
            for (const int child : m_bsp.nodes[static_cast<size_t>(node)].children) {
                if (child < 0) continue;
                if (reached[static_cast<size_t>(child)])
                    fail("NODES", static_cast<size_t>(node), "a child that another node has already");
                reached[static_cast<size_t>(child)] = true;
                open.push_back(child);
            }
        }
    }

    void checkLeafs() const {
        for (size_t i = 0; i < m_bsp.leafs.size(); ++i) {
            const BspLeaf& leaf = m_bsp.leafs[i];
            if (leaf.cluster < -1 || (m_bsp.clusterCount > 0 && leaf.cluster >= m_bsp.clusterCount))
                fail("LEAFS", i, "there is no such cluster");
            if (!inArray(leaf.firstLeafSurface, leaf.leafSurfaceCount, m_bsp.leafSurfaces.size()))
                fail("LEAFS", i, "its surfaces are not in LEAFSURFACES");
            if (!inArray(leaf.firstLeafBrush, leaf.leafBrushCount, m_bsp.leafBrushes.size()))
                fail("LEAFS", i, "its brushes are not in LEAFBRUSHES");
        }
        for (size_t i = 0; i < m_bsp.leafSurfaces.size(); ++i) {
            if (!inArray(m_bsp.leafSurfaces[i], m_bsp.surfaces.size()))
                fail("LEAFSURFACES", i, "there is no such surface");
        }
        for (size_t i = 0; i < m_bsp.leafBrushes.size(); ++i) {
            if (!inArray(m_bsp.leafBrushes[i], m_bsp.brushes.size())) fail("LEAFBRUSHES", i, "there is no such brush");
        }
    }

    void checkModels() const {
        if (m_bsp.models.empty())
            throw ContentError(m_name + ": MODELS lump is empty; the map is damaged, get it again");
        for (size_t i = 0; i < m_bsp.models.size(); ++i) {
            const BspModel& model = m_bsp.models[i];
            if (!inArray(model.firstSurface, model.surfaceCount, m_bsp.surfaces.size()))
                fail("MODELS", i, "its surfaces are not in SURFACES");
            if (!inArray(model.firstBrush, model.brushCount, m_bsp.brushes.size()))
                fail("MODELS", i, "its brushes are not in BRUSHES");
        }
    }

    void checkBrushes() const {
        for (size_t i = 0; i < m_bsp.brushes.size(); ++i) {
            const BspBrush& brush = m_bsp.brushes[i];
            if (!inArray(brush.firstSide, brush.sideCount, m_bsp.brushSides.size()))
                fail("BRUSHES", i, "its sides are not in BRUSHSIDES");
            if (!inArray(brush.shader, m_bsp.shaders.size())) fail("BRUSHES", i, "there is no such shader");
        }
        for (size_t i = 0; i < m_bsp.brushSides.size(); ++i) {
            if (!inArray(m_bsp.brushSides[i].plane, m_bsp.planes.size()))
                fail("BRUSHSIDES", i, "there is no such plane");
            if (!inArray(m_bsp.brushSides[i].shader, m_bsp.shaders.size()))
                fail("BRUSHSIDES", i, "there is no such shader");
        }
    }

    void checkFogs() const {
        for (size_t i = 0; i < m_bsp.fogs.size(); ++i) {
            const BspFog& fog = m_bsp.fogs[i];
            if (fog.brush == -1 && fog.visibleSide == -1) continue;
            if (!inArray(fog.brush, m_bsp.brushes.size())) fail("FOGS", i, "there is no such brush");
            const int sides = m_bsp.brushes[static_cast<size_t>(fog.brush)].sideCount;
            if (sides < kAxialSides) fail("FOGS", i, "its brush has fewer than 6 sides");
            if (fog.visibleSide < -1 || fog.visibleSide >= sides) fail("FOGS", i, "its brush has no such side");
        }
    }

    void checkSurfaces() const {
        for (size_t i = 0; i < m_bsp.surfaces.size(); ++i) {
            const BspSurface& surface = m_bsp.surfaces[i];
            if (!inArray(surface.shader, m_bsp.shaders.size())) fail("SURFACES", i, "there is no such shader");
            if (surface.fog != -1 && !inArray(surface.fog, m_bsp.fogs.size()))
                fail("SURFACES", i, "there is no such fog");
            if (!inArray(surface.firstVertex, surface.vertexCount, m_bsp.vertices.size()))
                fail("SURFACES", i, "its vertices are not in DRAWVERTS");
            if (!inArray(surface.firstIndex, surface.indexCount, m_bsp.indices.size()))
                fail("SURFACES", i, "its indexes are not in DRAWINDEXES");
            if (surface.type == BspSurfaceType::Patch) checkPatch(i, surface);
            if (surface.type == BspSurfaceType::Planar || surface.type == BspSurfaceType::TriangleSoup)
                checkTriangles(i, surface);
        }
    }

    void checkPatch(size_t record, const BspSurface& surface) const {
        const int64_t width = surface.patchWidth, height = surface.patchHeight;
        const bool oddSides = width >= 3 && height >= 3 && width % 2 == 1 && height % 2 == 1;
        if (!oddSides) fail("SURFACES", record, "the sides of a patch must be odd and at least 3");
        if (width * height > surface.vertexCount)
            fail("SURFACES", record, "the patch has fewer vertices than its grid");
    }

    void checkTriangles(size_t record, const BspSurface& surface) const {
        if (surface.indexCount % 3 != 0) fail("SURFACES", record, "its index count is no multiple of 3");
        for (int i = 0; i < surface.indexCount; ++i) {
            const int index = m_bsp.indices[static_cast<size_t>(surface.firstIndex + i)];
            if (!inArray(index, static_cast<size_t>(surface.vertexCount)))
                fail("DRAWINDEXES", static_cast<size_t>(surface.firstIndex + i), "its surface has no such vertex");
        }
    }

    const Bsp& m_bsp;
    std::string m_name;
};

} // namespace

void checkBspReferences(const Bsp& bsp, std::string_view name) { ReferenceCheck(bsp, name).run(); }

} // namespace q3rt

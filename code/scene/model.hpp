#pragma once
// Models and skins by handle, their tags, bounds and animated vertices.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "scene/animated_mesh.hpp"
#include "scene/material.hpp"
#include "scene/world.hpp"

namespace q3rt {

struct ModelSurface {
    std::string name;
    std::vector<MaterialId> materials; ///< by skin number modulo; at least one
    size_t surface = 0;                ///< of the mesh
};

struct ModelLod {
    std::unique_ptr<AnimatedMesh> mesh;
    std::vector<ModelSurface> surfaces;
};

struct Model {
    enum class Kind { Bad, Inline, Mesh } kind = Kind::Bad;
    std::string name;
    int inlineModel = 0;        ///< BSP model number
    std::vector<ModelLod> lods; ///< [0] finest
};

struct Skin {
    std::string name;
    std::vector<std::pair<std::string, MaterialId>> surfaces; ///< lower-case surface name
};

class ModelLibrary {
  public:
    ModelLibrary(FileSource& files, MaterialLibrary& materials);
    int registerModel(std::string_view name); ///< 0: missing or bad
    int registerSkin(std::string_view name);
    /// One handle a BSP submodel, "*0", "*1", ...
    void addInlineModels(const World& world);
    const Model& get(int handle) const; ///< out of range: the bad model
    const Skin* skin(int handle) const; ///< nullptr: 0 or out of range
    size_t count() const { return m_models.size(); }
    const MaterialLibrary& materials() const { return m_materials; }
    /// False (identity, origin 0) if there is no such tag. `fraction` weights endFrame.
    bool lerpTag(int handle, int startFrame, int endFrame, float fraction, std::string_view tag,
                 Orientation& out) const;
    Bounds modelBounds(int handle, const World* world) const; ///< zeros if unknown

  private:
    FileSource& m_files;
    MaterialLibrary& m_materials;
    std::vector<Model> m_models;
    std::vector<Skin> m_skins;
    std::unordered_map<std::string, int> m_modelByName, m_skinByName;
};

/// Material of one model surface for an entity: customShader, else customSkin, else the model's own (spec of
/// models 2.7).
MaterialId surfaceMaterial(const ModelLibrary& models, const ModelSurface& surface, int customShader, int customSkin,
                           int skinNumber);

/// Frame numbers as the original uses them (wrap flag; bad ones become 0).
void resolveFrames(size_t frameCount, bool wrap, int& frame, int& oldFrame);

/// Level of detail for an entity (spec of models 2.4), of `count`; 0 is the finest. `box`: of its frame.
int chooseLod(int count, const Bounds& box, const vec3& entityOrigin, const Orientation& view, float fovYRadians,
              float lodScale, int lodBias);

/// Lighting of an entity (spec of models 2.9).
struct EntityLight {
    vec3 ambient{0}; ///< 0..255
    vec3 directed{0};
    vec3 direction{0}; ///< in the entity's axes
};

} // namespace q3rt

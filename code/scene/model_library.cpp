// Registration of models and skins, tags and bounds (spec of models 1 and 3).

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/skin.hpp"
#include "scene/model.hpp"
#include "scene/triangle_order.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr size_t kMaxNameLength = 64; // longer names are refused, as the game code expects

std::string toLower(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; });
    return lower;
}

/// Text after the last dot of the file name, lower case; empty if there is none.
std::string extensionOf(std::string_view name) {
    const size_t dot = name.rfind('.'), slash = name.rfind('/');
    if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash)) return {};
    return toLower(name.substr(dot + 1));
}

/// Triangles in the leaf order of a tree over frame 0: software acceleration structures follow primitive order.
void orderTriangles(Md3Surface& surface) {
    std::vector<vec3> corners;
    corners.reserve(surface.indices.size());
    for (const uint32_t index : surface.indices) {
        corners.push_back(surface.positions[index]);
    }
    std::vector<uint32_t> ordered;
    ordered.reserve(surface.indices.size());
    for (const uint32_t triangle : sahLeafOrder(corners)) {
        const auto first = surface.indices.begin() + static_cast<std::ptrdiff_t>(triangle) * 3;
        ordered.insert(ordered.end(), first, first + 3);
    }
    surface.indices = std::move(ordered);
}

ModelLod makeLod(Md3 md3, MaterialLibrary& materials) {
    ModelLod lod;
    for (size_t i = 0; i < md3.surfaces.size(); ++i) {
        ModelSurface surface;
        surface.name = md3.surfaces[i].name;
        surface.surface = i;
        for (const std::string& shader : md3.surfaces[i].shaders) {
            const MaterialId id = materials.find(shader, lightmapContext::kNone);
            surface.materials.push_back(materials.get(id).isDefault ? 0 : id);
        }
        if (surface.materials.empty()) surface.materials.push_back(0);
        orderTriangles(md3.surfaces[i]);
        lod.surfaces.push_back(std::move(surface));
    }
    lod.md3 = std::move(md3);
    return lod;
}

/// Levels of detail stand in base_2.md3, base_1.md3, base.md3, the suffix before the first dot of the whole name.
std::vector<std::string> lodFileNames(std::string_view name) {
    const size_t dot = name.find('.');
    const std::string stem(name.substr(0, dot)), rest(dot == std::string_view::npos ? "" : name.substr(dot));
    return {stem + rest, stem + "_1" + rest, stem + "_2" + rest};
}

std::vector<ModelLod> loadMd3(FileSource& files, MaterialLibrary& materials, const std::string& name) {
    std::vector<ModelLod> lods;
    const std::vector<std::string> names = lodFileNames(name);
    for (auto file = names.rbegin(); file != names.rend(); ++file) { // coarsest first: shaders are made in this order
        const auto bytes = files.read(*file);
        if (!bytes) continue;
        lods.insert(lods.begin(), makeLod(parseMd3(*bytes, *file), materials));
    }
    return lods;
}

/// Tries one extension; true if `model` was filled. A kind that is not supported is reported by name.
bool loadAs(FileSource& files, MaterialLibrary& materials, const std::string& file, std::string_view extension,
            Model& model) {
    try {
        if (extension == "md3") {
            model.lods = loadMd3(files, materials, file);
        } else if (files.read(file)) {
            logLineOnce(LogLevel::Warning, "%s: models of this kind are not supported yet; convert it to MD3",
                        file.c_str());
        }
    } catch (const ContentError& error) {
        logLineOnce(LogLevel::Warning, "%s", error.what());
        model.lods.clear();
    }
    return !model.lods.empty();
}

constexpr std::string_view kExtensions[] = {"iqm", "mdr", "md3"};

bool loadModelFile(FileSource& files, MaterialLibrary& materials, Model& model) {
    const std::string extension = extensionOf(model.name);
    const bool known = std::find(std::begin(kExtensions), std::end(kExtensions), extension) != std::end(kExtensions);
    if (known && loadAs(files, materials, model.name, extension, model)) return true;
    const std::string stem = known ? model.name.substr(0, model.name.rfind('.')) : model.name;
    for (const std::string_view other : kExtensions) {
        if (known && other == extension) continue;
        if (loadAs(files, materials, stem + "." + std::string(other), other, model)) return true;
    }
    return false;
}

const Md3Tag* findTag(const Md3& md3, int frame, std::string_view name) {
    if (md3.frames.empty()) return nullptr;
    const size_t row = static_cast<size_t>(std::clamp(frame, 0, static_cast<int>(md3.frames.size()) - 1));
    for (size_t i = 0; i < md3.tagCount; ++i) {
        const Md3Tag& tag = md3.tags[row * md3.tagCount + i];
        if (tag.name == name) return &tag;
    }
    return nullptr;
}

} // namespace

ModelLibrary::ModelLibrary(FileSource& files, MaterialLibrary& materials)
    : m_files(files)
    , m_materials(materials) {
    m_models.emplace_back(); // handle 0: the bad model
    m_skins.emplace_back();  // handle 0: no skin
}

int ModelLibrary::registerModel(std::string_view name) {
    if (name.empty() || name.size() >= kMaxNameLength) {
        logLine(LogLevel::Warning, "model name \"%.*s\" is %s", static_cast<int>(name.size()), name.data(),
                name.empty() ? "empty" : "longer than 63 characters");
        return 0;
    }
    const std::string key(name);
    if (const auto known = m_modelByName.find(key); known != m_modelByName.end()) return known->second;
    Model model;
    model.name = key;
    int handle = 0;
    if (loadModelFile(m_files, m_materials, model)) {
        model.kind = Model::Kind::Md3;
        handle = static_cast<int>(m_models.size());
        m_models.push_back(std::move(model));
    } else {
        logLine(LogLevel::Developer, "model %s: no such file", key.c_str());
    }
    m_modelByName[key] = handle;
    return handle;
}

void ModelLibrary::addInlineModels(const World& world) {
    for (size_t i = 0; i < world.bsp.models.size(); ++i) {
        Model model;
        model.kind = Model::Kind::Inline;
        model.name = formatText("*%zu", i);
        model.inlineModel = static_cast<int>(i);
        m_modelByName[model.name] = static_cast<int>(m_models.size());
        m_models.push_back(std::move(model));
    }
}

int ModelLibrary::registerSkin(std::string_view name) {
    if (name.empty() || name.size() >= kMaxNameLength) return 0;
    const std::string key = toLower(name);
    if (const auto known = m_skinByName.find(key); known != m_skinByName.end()) return known->second;
    // Unlike models, skins don't look whether the material failed: what was understood of it is drawn.
    const auto materialOf = [&](std::string_view shader) { return m_materials.find(shader, lightmapContext::kNone); };
    Skin skin;
    skin.name = std::string(name);
    const bool isFile = name.size() > 5 && name.substr(name.size() - 5) == ".skin";
    if (!isFile) {
        skin.surfaces.emplace_back("", materialOf(name)); // matches no surface of a name: all get the default look
    } else if (const auto bytes = m_files.read(name)) {
        const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        for (const SkinSurface& surface : parseSkin(text)) {
            skin.surfaces.emplace_back(toLower(surface.surface), materialOf(surface.shader));
        }
    }
    int handle = 0;
    if (!skin.surfaces.empty()) {
        handle = static_cast<int>(m_skins.size());
        m_skins.push_back(std::move(skin));
    }
    m_skinByName[key] = handle;
    return handle;
}

const Model& ModelLibrary::get(int handle) const {
    const bool valid = handle > 0 && handle < static_cast<int>(m_models.size());
    return m_models[valid ? static_cast<size_t>(handle) : 0];
}

const Skin* ModelLibrary::skin(int handle) const {
    const bool valid = handle > 0 && handle < static_cast<int>(m_skins.size());
    return valid ? &m_skins[static_cast<size_t>(handle)] : nullptr;
}

bool ModelLibrary::lerpTag(int handle, int startFrame, int endFrame, float fraction, std::string_view tag,
                           Orientation& out) const {
    out = Orientation{};
    const Model& model = get(handle);
    if (model.kind != Model::Kind::Md3) return false;
    const Md3Tag* start = findTag(model.lods[0].md3, startFrame, tag);
    const Md3Tag* end = findTag(model.lods[0].md3, endFrame, tag);
    if (!start || !end) return false;
    const float startWeight = 1.0f - fraction;
    out.origin = start->orientation.origin * startWeight + end->orientation.origin * fraction;
    for (int i = 0; i < 3; ++i) {
        const vec3 axis = start->orientation.axis[i] * startWeight + end->orientation.axis[i] * fraction;
        out.axis[i] = normalizeOrZero(axis);
    }
    return true;
}

Bounds ModelLibrary::modelBounds(int handle, const World* world) const {
    const Model& model = get(handle);
    Bounds bounds{vec3(0.0f), vec3(0.0f)};
    if (model.kind == Model::Kind::Inline && world && model.inlineModel < static_cast<int>(world->bsp.models.size())) {
        const BspModel& box = world->bsp.models[static_cast<size_t>(model.inlineModel)];
        bounds = {box.mins, box.maxs};
    } else if (model.kind == Model::Kind::Md3 && !model.lods[0].md3.frames.empty()) {
        const Md3Frame& frame = model.lods[0].md3.frames[0];
        bounds = {frame.mins, frame.maxs};
    }
    return bounds;
}

} // namespace q3rt

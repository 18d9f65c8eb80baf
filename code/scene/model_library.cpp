// Registration of models and skins, tags and bounds (spec of models 1 and 3).

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/skin.hpp"
#include "scene/model.hpp"

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

ModelLod makeLod(std::unique_ptr<AnimatedMesh> mesh, MaterialLibrary& materials) {
    ModelLod lod;
    for (size_t i = 0; i < mesh->surfaceCount(); ++i) {
        const MeshSurface from = mesh->surface(i);
        ModelSurface surface;
        surface.name = from.name;
        surface.surface = i;
        for (const std::string& shader : from.shaders) {
            const MaterialId id = materials.find(shader, lightmapContext::kNone);
            surface.materials.push_back(materials.get(id).isDefault ? 0 : id);
        }
        if (surface.materials.empty()) surface.materials.push_back(0);
        lod.surfaces.push_back(std::move(surface));
    }
    lod.mesh = std::move(mesh);
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
        lods.insert(lods.begin(), makeLod(makeMd3Mesh(parseMd3(*bytes, *file)), materials));
    }
    return lods;
}

/// All levels of detail are in the one file.
std::vector<ModelLod> loadMdr(FileSource& files, MaterialLibrary& materials, const std::string& name) {
    std::vector<ModelLod> lods;
    const auto bytes = files.read(name);
    if (!bytes) return lods;
    const auto model = std::make_shared<const Mdr>(parseMdr(*bytes, name));
    for (size_t level = 0; level < model->lods.size(); ++level)
        lods.push_back(makeLod(makeMdrMesh(model, level), materials));
    return lods;
}

std::vector<ModelLod> loadIqm(FileSource& files, MaterialLibrary& materials, const std::string& name) {
    std::vector<ModelLod> lods;
    if (const auto bytes = files.read(name)) lods.push_back(makeLod(makeIqmMesh(parseIqm(*bytes, name)), materials));
    return lods;
}

/// Tries one extension; true if `model` was filled.
bool loadAs(FileSource& files, MaterialLibrary& materials, const std::string& file, std::string_view extension,
            Model& model) {
    try {
        if (extension == "md3")
            model.lods = loadMd3(files, materials, file);
        else if (extension == "mdr")
            model.lods = loadMdr(files, materials, file);
        else
            model.lods = loadIqm(files, materials, file);
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
        model.kind = Model::Kind::Mesh;
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
    return model.kind == Model::Kind::Mesh && model.lods[0].mesh->lerpTag(tag, startFrame, endFrame, fraction, out);
}

Bounds ModelLibrary::modelBounds(int handle, const World* world) const {
    const Model& model = get(handle);
    Bounds bounds{vec3(0.0f), vec3(0.0f)};
    if (model.kind == Model::Kind::Inline && world && model.inlineModel < static_cast<int>(world->bsp.models.size())) {
        const BspModel& box = world->bsp.models[static_cast<size_t>(model.inlineModel)];
        bounds = {box.mins, box.maxs};
    } else if (model.kind == Model::Kind::Mesh) {
        const Bounds box = model.lods[0].mesh->frameBox(0).box;
        if (!box.empty()) bounds = box;
    }
    return bounds;
}

} // namespace q3rt

// The material library: look-up, remapping, draw order.
#include "scene/material.hpp"

#include <algorithm>

#include "base/log.hpp"
#include "formats/text_case.hpp"
#include "scene/material_compile.hpp"

namespace q3rt {
namespace {

constexpr size_t kMaxName = 63; ///< of the engine

std::string_view withoutExtension(std::string_view name) {
    const size_t dot = name.rfind('.'), slash = name.rfind('/');
    const bool has = dot != std::string_view::npos && (slash == std::string_view::npos || dot > slash);
    return has ? name.substr(0, dot) : name;
}

Material makeDefaultMaterial() {
    Material material;
    material.name = "<default>";
    material.isDefault = true;
    Stage stage;
    stage.unit[0].frames = {builtinTexture::kDefault};
    stage.rgbGen = RgbGen::IdentityLighting;
    material.stages.push_back(std::move(stage));
    return material;
}

} // namespace

MaterialLibrary::MaterialLibrary(FileSource& files, TextureLibrary& textures, const MaterialSettings& settings)
    : m_files(files)
    , m_textures(textures)
    , m_settings(settings) {
    const ScriptReport report = [](std::string_view file, int line, std::string_view what) {
        logLineOnce(LogLevel::Warning, "%.*s:%d: %.*s", static_cast<int>(file.size()), file.data(), line,
                    static_cast<int>(what.size()), what.data());
    };
    for (const std::string& name : m_files.list("scripts", ".shader")) {
        const std::string path = "scripts/" + name;
        const auto bytes = m_files.read(path);
        if (!bytes) continue;
        m_scripts.addFile({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path, report);
    }
    add(makeDefaultMaterial(), "<default>");
}

MaterialId MaterialLibrary::add(Material material, const std::string& key) {
    const auto id = static_cast<MaterialId>(m_materials.size());
    // Draw order: by sort, later registered ones behind earlier ones of the same sort.
    const auto place =
        std::upper_bound(m_sorted.begin(), m_sorted.end(), material.sort,
                         [this](float sort, MaterialId other) { return sort < m_materials[other]->sort; });
    const auto rank = static_cast<size_t>(place - m_sorted.begin());
    m_sorted.insert(place, id);
    m_materials.push_back(std::make_unique<Material>(std::move(material)));
    for (size_t i = rank; i < m_sorted.size(); ++i)
        m_materials[m_sorted[i]]->sortRank = static_cast<uint32_t>(i);
    m_byName[key].push_back(id);
    return id;
}

MaterialId MaterialLibrary::find(std::string_view name, int lightmap, bool mipRaw) {
    if (name.empty()) return 0;
    if (name.size() > kMaxName) {
        logLineOnce(LogLevel::Warning, "shader name longer than %zu characters, default drawn: %.*s", kMaxName,
                    static_cast<int>(name.size()), name.data());
        return 0;
    }
    const std::string key = toLowerAscii(withoutExtension(name));
    if (const auto known = m_byName.find(key); known != m_byName.end())
        for (const MaterialId id : known->second)
            if (m_materials[id]->lightmap == lightmap || m_materials[id]->isDefault) return id;
    const auto unused = m_unusedPage.find(key);
    if (lightmap >= 0 && unused != m_unusedPage.end()) {
        // The original compiles such a shader anew for every surface, which only shows in the order of blended ones.
        const Material& first = *m_materials[unused->second];
        constexpr float kLastOpaqueSort = 3;
        if (first.sort <= kLastOpaqueSort) return unused->second;
        Material copy = first;
        copy.sharedStages = unused->second;
        return add(std::move(copy), key);
    }
    Material material = create(name, key, lightmap, mipRaw);
    const bool ignoresPage = lightmap >= 0 && material.lightmap != lightmap;
    const MaterialId id = add(std::move(material), key);
    m_materials[id]->sharedStages = id;
    if (ignoresPage) m_unusedPage[key] = id;
    return id;
}

Material MaterialLibrary::create(std::string_view name, const std::string& key, int lightmap, bool mipRaw) {
    const CompileContext context{m_textures, m_settings, m_lightmaps, startVideo, lightmap};
    if (const ScriptDefinition* definition = m_scripts.find(key)) {
        MaterialDraft draft = compileScript(*definition, context);
        if (draft.sunDirection) sunDirection = *draft.sunDirection;
        if (draft.sunLight) sunLight = *draft.sunLight;
        if (draft.cloudHeight) lastCloudHeight = *draft.cloudHeight;
        return std::move(draft.material);
    }
    const TextureFlags flags{mipRaw, mipRaw, !mipRaw};
    if (const auto image = m_textures.load(name, flags)) return compileImage(withoutExtension(name), *image, context);
    // Games ask for pictures that no archive holds, OpenArena's for 89 crosshairs: their answer is the handle 0.
    const LogLevel level = lightmap == lightmapContext::k2D ? LogLevel::Developer : LogLevel::Warning;
    logLineOnce(level, "no shader and no image, default drawn: %.*s", static_cast<int>(name.size()), name.data());
    Material missing;
    missing.name = withoutExtension(name);
    missing.lightmap = lightmap;
    missing.isDefault = true;
    return missing;
}

int MaterialLibrary::registerHandle(std::string_view name, int lightmap, bool mipRaw) {
    const MaterialId id = find(name, lightmap, mipRaw);
    return m_materials[id]->isDefault ? 0 : static_cast<int>(id);
}

MaterialId MaterialLibrary::drawnId(MaterialId id) const {
    const MaterialId other = m_materials[id]->remappedTo;
    return other != 0 ? other : id;
}

const Material& MaterialLibrary::drawn(MaterialId id) const { return *m_materials[drawnId(id)]; }

/// The most recently created variant of a name, whatever its lightmap; created if there is none.
MaterialId MaterialLibrary::findAny(std::string_view name) {
    const auto known = m_byName.find(toLowerAscii(withoutExtension(name)));
    return known != m_byName.end() ? known->second.back() : find(name, 0);
}

void MaterialLibrary::remap(std::string_view from, std::string_view to, const char* timeOffset) {
    const MaterialId source = findAny(from), target = findAny(to);
    for (const auto& [id, name] : {std::pair{source, from}, std::pair{target, to}})
        if (m_materials[id]->isDefault) {
            logLineOnce(LogLevel::Warning, "can't remap shader %.*s to %.*s: %.*s is not found or failed",
                        static_cast<int>(from.size()), from.data(), static_cast<int>(to.size()), to.data(),
                        static_cast<int>(name.size()), name.data());
            return;
        }
    for (const MaterialId id : m_byName[toLowerAscii(withoutExtension(from))])
        m_materials[id]->remappedTo = id == target ? 0 : target;
    if (timeOffset) m_materials[target]->timeOffsetSeconds = parseScriptNumber(timeOffset);
}

} // namespace q3rt

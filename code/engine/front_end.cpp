#include "engine/front_end.hpp"

#include <algorithm>
#include <cmath>
#include <malloc.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "scene/texture_upload.hpp"

namespace q3rt {

namespace {

// Bits of a videoMap's cinematic: loop, silent, drawn by a shader.
constexpr int kVideoMapBits = 2 | 8 | 16;
constexpr int kDefaultFontPoints = 12;

/// Truncated and taken modulo 256, as content was authored against: 1.5 gives 126.
uint8_t colorByte(float value) {
    if (!std::isfinite(value)) return 0;
    return static_cast<uint8_t>(static_cast<int64_t>(value * 255.0f));
}

bool isFinite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace

void bindFrontEndSettings(SettingsBinding& binding, FrontEndSettings& values){
#define SETTING Q3RT_SETTING_BIND
#include "engine/front_end_settings.def.h"
#undef SETTING
}

FrontEnd::FrontEnd(EngineServices& engine)
    : m_engine(engine) {
    bindFrontEndSettings(m_binding, m_settings);
}

FrontEnd::~FrontEnd() { removeCommands(); }

DisplayInfo FrontEnd::beginRegistration() {
    shutdownRegistration();
    m_binding.registerAll(m_engine);
    m_display = openDisplay();
    m_display.supportsGamma = m_settings.r_ignorehwgamma == 0;
    const bool headroom = m_display.supportsGamma && m_display.fullscreen && isRasterizer();
    m_overbrightBits = headroom ? m_settings.r_overBrightBits : 0;
    addCommands();

    TextureSettings texture;
    texture.picmip = m_settings.r_picmip;
    texture.roundImagesDown = m_settings.r_roundImagesDown != 0;
    texture.simpleMipMaps = m_settings.r_simpleMipMaps != 0;
    texture.colorMipLevels = m_settings.r_colorMipLevels != 0;
    texture.overbrightBits = m_overbrightBits;
    texture.mapOverbrightBits = m_settings.r_mapOverBrightBits;
    texture.softwareGamma = !m_display.supportsGamma;
    texture.gamma = m_settings.r_gamma;
    texture.intensity = m_settings.r_intensity;
    texture.greyscale = m_settings.r_greyscale;
    texture.lightmapIntensity = m_settings.r_lightmap == 2;
    if (m_display.maxTextureSize > 0) texture.maxSize = m_display.maxTextureSize;
    m_textures = std::make_unique<TextureLibrary>(m_engine, texture);

    MaterialSettings material;
    material.detailTextures = m_settings.r_detailtextures != 0;
    material.vertexLight = m_settings.r_vertexLight != 0;
    material.fullbright = m_settings.r_fullbright != 0;
    material.multitexture = m_settings.r_ext_multitexture != 0;
    material.fastSky = m_settings.r_fastsky != 0;
    material.lightmapMode = m_settings.r_lightmap;
    m_materials = std::make_unique<MaterialLibrary>(m_engine, *m_textures, material);
    m_materials->startVideo = [this](std::string_view name) {
        const int handle = m_engine.playCinematic(name, 0, 0, 256, 256, kVideoMapBits);
        if (handle >= 0) m_videos.push_back(handle);
        return handle;
    };
    m_models = std::make_unique<ModelLibrary>(m_engine, *m_materials);
    m_frame.reserve();
    onContentCreated();
    return m_display;
}

void FrontEnd::shutdownRegistration() {
    onContentDropped();
    removeCommands();
    m_world.reset();
    m_models.reset();
    m_materials.reset();
    m_textures.reset();
    m_videos.clear();
    m_frame.clear();
    m_firstEntity = m_firstPoly = m_firstLight = 0;
    m_entityTokenAt = 0;
    m_captures.clear();
}

void FrontEnd::endRegistration() {
    if (!registered()) return;
    onEndRegistration();
    malloc_trim(0); // decoded images and files have gone: their memory back to the system
}

int FrontEnd::registerModel(std::string_view name) { return registered() ? m_models->registerModel(name) : 0; }

int FrontEnd::registerSkin(std::string_view name) { return registered() ? m_models->registerSkin(name) : 0; }

int FrontEnd::registerShader(std::string_view name, bool mipmaps) {
    return registered() ? m_materials->registerHandle(name, lightmapContext::k2D, mipmaps) : 0;
}

std::optional<RegisteredFont> FrontEnd::registerFont(std::string_view, int pointSize) {
    if (!registered()) return std::nullopt;
    // The name says nothing: the file is chosen by size alone.
    const std::string file = formatText("fonts/fontImage_%d.dat", pointSize > 0 ? pointSize : kDefaultFontPoints);
    const auto bytes = m_engine.read(file);
    if (!bytes) {
        logLineOnce(LogLevel::Warning, "%s: font not found; text in this size keeps its old look", file.c_str());
        return std::nullopt;
    }
    RegisteredFont result;
    result.font = parseFont(*bytes, file);
    result.name = file;
    for (size_t i = 0; i < result.font.glyphs.size(); ++i)
        result.glyphShader[i] = registerShader(result.font.glyphs[i].shaderName, false);
    return result;
}

void FrontEnd::loadWorld(std::string_view name) {
    if (!registered()) return;
    if (m_world) throw UsageError("a second map was loaded without a shutdown in between");
    WorldSettings world;
    world.subdivisions = m_settings.r_subdivisions;
    world.vertexLight = m_settings.r_vertexLight != 0;
    world.fullbright = m_settings.r_fullbright != 0;
    world.singleShader = m_settings.r_singleShader != 0;
    m_world = q3rt::loadWorld(m_engine, name, *m_materials, world);
    m_models->addInlineModels(*m_world);
    m_entityTokenAt = 0;
    applyWorldRemaps();
    onWorldLoaded();
}

void FrontEnd::applyWorldRemaps() {
    if (m_world->entities.empty()) return;
    for (const auto& [key, value] : m_world->entities.front().pairs) {
        const bool vertexKey = key.starts_with("vertexremapshader");
        if (!vertexKey && !key.starts_with("remapshader")) continue;
        const size_t separator = value.find(';');
        if (separator == std::string::npos) {
            logLine(LogLevel::Warning, "%s: key %s has no semicolon; the rest of worldspawn's remaps is ignored",
                    m_world->name.c_str(), key.c_str());
            return;
        }
        if (vertexKey && m_settings.r_vertexLight == 0) continue;
        m_materials->remap(value.substr(0, separator), value.substr(separator + 1), "0");
    }
}

void FrontEnd::clearScene() {
    m_firstEntity = static_cast<uint32_t>(m_frame.entities.size());
    m_firstPoly = static_cast<uint32_t>(m_frame.polys.size());
    m_firstLight = static_cast<uint32_t>(m_frame.lights.size());
}

void FrontEnd::addEntity(const SceneEntity& entity) {
    if (!registered()) return;
    if (!isFinite(entity.orientation.origin)) {
        logLineOnce(LogLevel::Warning, "an entity whose origin is not a number is not drawn");
        return;
    }
    m_frame.entities.push_back(entity);
}

void FrontEnd::addPolys(int shader, size_t vertexCount, std::span<const PolyVertex> vertices) {
    if (!registered() || vertexCount == 0) return;
    if (shader == 0) {
        logLineOnce(LogLevel::Warning, "a polygon without a shader is not drawn");
        return;
    }
    for (size_t first = 0; first + vertexCount <= vertices.size(); first += vertexCount) {
        ScenePoly poly;
        poly.shader = shader;
        poly.firstVertex = static_cast<uint32_t>(m_frame.polyVertices.size());
        poly.vertexCount = static_cast<uint32_t>(vertexCount);
        const auto part = vertices.subspan(first, vertexCount);
        m_frame.polyVertices.insert(m_frame.polyVertices.end(), part.begin(), part.end());
        m_frame.polys.push_back(poly);
    }
}

void FrontEnd::addLight(const SceneLight& light) {
    if (!registered() || light.radius <= 0) return;
    // The light's strength grows with the square of its radius.
    if (!isFinite(light.origin) || !isFinite(light.color) || !std::isfinite(light.radius * light.radius)) {
        logLineOnce(LogLevel::Warning, "a light whose place, colour or radius is not a number is left out");
        return;
    }
    m_frame.lights.push_back(light);
}

void FrontEnd::renderScene(const SceneView& view) {
    if (!registered() || m_settings.r_norefresh != 0) return;
    if (!m_world && (view.flags & viewFlag::kNoWorldModel) == 0)
        throw UsageError("a scene of the world was asked for, but no map is loaded");
    const bool lit = m_settings.r_dynamiclight != 0 && m_settings.r_vertexLight != 1;
    SceneView scene = view;
    scene.eye = m_eye;
    scene.firstEntity = m_firstEntity;
    scene.entityCount = static_cast<uint32_t>(m_frame.entities.size()) - m_firstEntity;
    scene.firstPoly = m_firstPoly;
    scene.polyCount = static_cast<uint32_t>(m_frame.polys.size()) - m_firstPoly;
    scene.firstLight = m_firstLight;
    scene.lightCount = lit ? static_cast<uint32_t>(m_frame.lights.size()) - m_firstLight : 0;
    clearScene();
    if (scene.width > 0 && scene.height > 0) m_frame.commands.emplace_back(std::move(scene));
}

void FrontEnd::setColor(const std::optional<vec4>& color) {
    if (!color) {
        m_color = U8vec4(255);
        return;
    }
    m_color = U8vec4(colorByte(color->r), colorByte(color->g), colorByte(color->b), colorByte(color->a));
}

void FrontEnd::drawPicture(float x, float y, float width, float height, float s1, float t1, float s2, float t2,
                           int shader) {
    if (registered()) m_frame.commands.emplace_back(Picture{x, y, width, height, s1, t1, s2, t2, shader, m_color});
}

void FrontEnd::drawCinematic(int x, int y, int width, int height, int columns, int rows, const uint8_t* rgba, int slot,
                             bool dirty) {
    if (!registered()) return;
    uploadCinematic(columns, rows, rgba, slot, dirty);
    m_frame.commands.emplace_back(CinematicPicture{x, y, width, height, columns, rows, slot});
}

void FrontEnd::uploadCinematic(int columns, int rows, const uint8_t* rgba, int slot, bool dirty) {
    if (!registered() || slot < 0 || slot >= builtinTexture::kScratchCount || columns <= 0 || rows <= 0 || !rgba)
        return;
    const MipLevel& now = m_textures->get(builtinTexture::kScratch0 + static_cast<TextureId>(slot)).levels.front();
    if (dirty || now.width != columns || now.height != rows) m_textures->setScratch(slot, columns, rows, rgba);
}

void FrontEnd::beginFrame(int stereoEye) {
    m_binding.refresh();
    m_eye = stereoEye == 1 ? Eye::Left : stereoEye == 2 ? Eye::Right : Eye::Both; // the engine's stereoFrame_t
    if (registered() && m_eye != Eye::Both) m_frame.commands.emplace_back(m_eye);
}

Renderer::FrameTimes FrontEnd::endFrame() {
    FrameTimes times;
    if (!registered()) return times;
    const int startMs = m_engine.milliseconds();
    m_frame.clockMs = startMs;
    runVideos();
    // The frame leaves the member first: an error in drawing must not leave it to be drawn again.
    FrameCommands frame;
    std::swap(frame, m_frame);
    m_firstEntity = m_firstPoly = m_firstLight = 0;
    FrameImage image;
    const bool capture = !m_captures.empty();
    onFrame(frame, capture ? &image : nullptr);
    if (capture) writeCaptures(image);
    times.backMs = m_engine.milliseconds() - startMs;
    frame.clear();
    if (m_frame.commands.empty()) std::swap(frame, m_frame); // keeps its memory
    return times;
}

void FrontEnd::runVideos() {
    for (const int handle : m_videos) {
        m_engine.runCinematic(handle);
        m_engine.uploadCinematic(handle);
    }
}

int FrontEnd::markFragments(const std::vector<vec3>& polygon, const vec3& projection, size_t maxPoints,
                            std::vector<vec3>& points, size_t maxFragments, std::vector<MarkFragment>& fragments) {
    if (!m_world || polygon.empty()) return 0;
    return m_marks.clip(*m_world, *m_materials, polygon, projection, maxPoints, points, maxFragments, fragments,
                        m_settings.r_marksOnTriangleMeshes != 0);
}

bool FrontEnd::lightForPoint(const vec3& point, GridLight& light) {
    if (!m_world || m_world->grid.empty()) return false;
    light = m_world->grid.sample(point);
    light.ambient *= m_settings.r_ambientScale;
    light.directed *= m_settings.r_directedScale;
    return true;
}

bool FrontEnd::lerpTag(int model, int startFrame, int endFrame, float fraction, std::string_view tag,
                       Orientation& out) {
    if (registered()) return m_models->lerpTag(model, startFrame, endFrame, fraction, tag, out);
    out = Orientation{};
    return false;
}

Bounds FrontEnd::modelBounds(int model) {
    if (registered()) return m_models->modelBounds(model, m_world.get());
    return Bounds{vec3(0.0f), vec3(0.0f)};
}

void FrontEnd::remapShader(std::string_view from, std::string_view to, const char* timeOffset) {
    if (registered()) m_materials->remap(from, to, timeOffset);
}

std::optional<std::string> FrontEnd::entityToken() {
    if (!m_world) return std::nullopt;
    std::string_view rest = std::string_view(m_world->bsp.entities).substr(m_entityTokenAt);
    int line = 1;
    auto token = nextScriptToken(rest, line, false);
    m_entityTokenAt = token ? m_world->bsp.entities.size() - rest.size() : 0;
    return token;
}

bool FrontEnd::inPvs(const vec3& from, const vec3& to) { return m_world && m_world->inPvs(from, to); }

std::array<uint8_t, 256> FrontEnd::displayRamp() const {
    return m_display.supportsGamma ? buildGammaTable(m_settings.r_gamma, m_overbrightBits) : buildGammaTable(1.0f, 0);
}

ViewGeometrySettings FrontEnd::viewGeometrySettings() const {
    ViewGeometrySettings result;
    result.identityLight = identityLight();
    result.ambientScale = m_settings.r_ambientScale;
    result.directedScale = m_settings.r_directedScale;
    result.lodScale = m_settings.r_lodscale;
    result.lodBias = m_settings.r_lodbias;
    result.railWidth = m_settings.r_railWidth;
    result.railCoreWidth = m_settings.r_railCoreWidth;
    result.railSegmentLength = m_settings.r_railSegmentLength;
    result.drawEntities = m_settings.r_drawentities != 0;
    return result;
}

} // namespace q3rt

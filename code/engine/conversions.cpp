#include "engine/conversions.hpp"

#include <cmath>
#include <cstring>

#include "base/error.hpp"

namespace q3rt {
namespace {

/// Copies as much as fits, always terminated.
template <size_t Size>
void storeText(std::string_view from, char (&to)[Size]) {
    const size_t length = std::min(from.size(), Size - 1);
    std::memcpy(to, from.data(), length);
    std::memset(to + length, 0, Size - length);
}

Orientation orientationFrom(const float* origin, const vec3_t* axis) {
    return {vectorFrom(origin), {vectorFrom(axis[0]), vectorFrom(axis[1]), vectorFrom(axis[2])}};
}

} // namespace

vec3 vectorFrom(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }

void storeVector(const vec3& from, float* xyz) {
    for (int i = 0; i < 3; ++i)
        xyz[i] = from[i];
}

std::optional<SceneEntity> entityFrom(const refEntity_t& entity) {
    if (entity.reType < 0 || entity.reType >= RT_MAX_REF_ENTITY_TYPE)
        throw UsageError(formatText("the game added an entity of unknown kind %d", entity.reType));
    if (std::isnan(entity.origin[0]) || std::isnan(entity.origin[1]) || std::isnan(entity.origin[2]))
        return std::nullopt;
    SceneEntity result;
    result.kind = static_cast<EntityKind>(entity.reType);
    result.flags = static_cast<uint32_t>(entity.renderfx);
    result.model = entity.hModel;
    result.lightingOrigin = vectorFrom(entity.lightingOrigin);
    result.shadowPlane = entity.shadowPlane;
    result.orientation = orientationFrom(entity.origin, entity.axis);
    result.nonNormalizedAxes = entity.nonNormalizedAxes != 0;
    result.frame = entity.frame;
    result.oldFrame = entity.oldframe;
    result.oldOrigin = vectorFrom(entity.oldorigin);
    result.backLerp = entity.backlerp;
    result.skinNumber = entity.skinNum;
    result.customSkin = entity.customSkin;
    result.customShader = entity.customShader;
    result.color = {entity.shaderRGBA[0], entity.shaderRGBA[1], entity.shaderRGBA[2], entity.shaderRGBA[3]};
    result.texCoord = {entity.shaderTexCoord[0], entity.shaderTexCoord[1]};
    result.shaderTimeSeconds = entity.shaderTime;
    result.radius = entity.radius;
    result.rotationDegrees = entity.rotation;
    return result;
}

void storePolyVertices(std::span<const polyVert_t> from, std::vector<PolyVertex>& to) {
    to.clear();
    for (const polyVert_t& vertex : from)
        to.push_back({vectorFrom(vertex.xyz),
                      {vertex.st[0], vertex.st[1]},
                      {vertex.modulate[0], vertex.modulate[1], vertex.modulate[2], vertex.modulate[3]}});
}

SceneView viewFrom(const refdef_t& view) {
    SceneView result;
    result.x = view.x;
    result.y = view.y;
    result.width = view.width;
    result.height = view.height;
    result.fovXDegrees = view.fov_x;
    result.fovYDegrees = view.fov_y;
    result.view = orientationFrom(view.vieworg, view.viewaxis);
    result.timeMs = view.time;
    result.flags = static_cast<uint32_t>(view.rdflags);
    std::memcpy(result.areaMask.data(), view.areamask, sizeof view.areamask);
    for (size_t i = 0; i < result.text.size(); ++i)
        result.text[i].assign(view.text[i], strnlen(view.text[i], sizeof view.text[i]));
    return result;
}

void storeDisplay(const DisplayInfo& display, glconfig_t& config) {
    std::memset(&config, 0, sizeof config);
    storeText(display.rendererText, config.renderer_string);
    storeText(display.vendorText, config.vendor_string);
    storeText(display.versionText, config.version_string);
    storeText(display.extensionsText, config.extensions_string);
    config.maxTextureSize = display.maxTextureSize;
    config.numTextureUnits = display.textureUnits;
    config.colorBits = display.colorBits;
    config.depthBits = display.depthBits;
    config.stencilBits = display.stencilBits;
    config.deviceSupportsGamma = display.supportsGamma;
    config.textureEnvAddAvailable = 1;
    config.vidWidth = display.width;
    config.vidHeight = display.height;
    config.windowAspect = display.aspect;
    config.displayFrequency = display.frequency;
    config.isFullscreen = display.fullscreen;
    config.stereoEnabled = display.stereo;
}

void storeOrientation(const Orientation& from, orientation_t& to) {
    storeVector(from.origin, to.origin);
    for (int i = 0; i < 3; ++i)
        storeVector(from.axis[i], to.axis[i]);
}

void storeFont(const RegisteredFont& font, fontInfo_t& out) {
    std::memset(&out, 0, sizeof out);
    for (size_t i = 0; i < font.font.glyphs.size(); ++i) {
        const FontGlyph& from = font.font.glyphs[i];
        glyphInfo_t& to = out.glyphs[i];
        to.height = from.height;
        to.top = from.top;
        to.bottom = from.bottom;
        to.pitch = from.pitch;
        to.xSkip = from.xSkip;
        to.imageWidth = from.imageWidth;
        to.imageHeight = from.imageHeight;
        to.s = from.s;
        to.t = from.t;
        to.s2 = from.s2;
        to.t2 = from.t2;
        to.glyph = font.glyphShader[i];
        storeText(from.shaderName, to.shaderName);
    }
    out.glyphScale = font.font.glyphScale;
    storeText(font.name, out.name);
}

} // namespace q3rt

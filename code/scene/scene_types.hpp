#pragma once
// What the engine asks for in one frame, in our own types. Handles are those that registration returned; 0 is the
// default.

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

enum class EntityKind { Model, Poly, Sprite, Beam, RailCore, RailRings, Lightning, PortalSurface };

/// renderfx bits.
namespace entityFlag {
inline constexpr uint32_t kMinLight = 0x1, kThirdPerson = 0x2, kFirstPerson = 0x4, kDepthHack = 0x8, kCrosshair = 0x10,
                          kNoShadow = 0x40, kLightingOrigin = 0x80, kShadowPlane = 0x100, kWrapFrames = 0x200;
/// Drawn with the view's nearer projection: what the player holds.
inline bool isHeld(uint32_t flags) { return (flags & (kDepthHack | kCrosshair)) == kDepthHack; }
} // namespace entityFlag
/// rdflags bits.
namespace viewFlag {
inline constexpr uint32_t kNoWorldModel = 0x1, kHyperspace = 0x4;
}

struct SceneEntity {
    EntityKind kind = EntityKind::Model;
    uint32_t flags = 0;
    int model = 0;
    vec3 lightingOrigin{0};
    float shadowPlane = 0;
    Orientation orientation; ///< axes as given, scale allowed
    bool nonNormalizedAxes = false;
    int frame = 0, oldFrame = 0;
    vec3 oldOrigin{0};
    float backLerp = 0; ///< weight of oldFrame
    int skinNumber = 0, customSkin = 0, customShader = 0;
    U8vec4 color{255};
    vec2 texCoord{0};
    float shaderTimeSeconds = 0;
    float radius = 0;
    float rotationDegrees = 0;
};

struct PolyVertex {
    vec3 position{0};
    vec2 st{0};
    U8vec4 color{255};
};

struct ScenePoly {
    int shader = 0;
    uint32_t firstVertex = 0, vertexCount = 0; ///< in FrameCommands::polyVertices
};

struct SceneLight {
    vec3 origin{0};
    float radius = 0; ///< qu; the engine's "intensity"
    vec3 color{0};
    bool additive = false;
};

/// What is drawn for, in a stereo frame one after the other.
enum class Eye : uint8_t { Both, Left, Right };

/// One RenderScene call with the entities, polys and lights added for it.
struct SceneView {
    int x = 0, y = 0, width = 0, height = 0; ///< pixels, top-left origin
    float fovXDegrees = 90, fovYDegrees = 90;
    Orientation view; ///< origin = eye; axis = forward, left, up
    Eye eye = Eye::Both;
    int timeMs = 0;
    uint32_t flags = 0;
    std::array<uint8_t, 32> areaMask{}; ///< set bit: that area is hidden
    std::array<std::string, 8> text;
    uint32_t firstEntity = 0, entityCount = 0; ///< ranges in FrameCommands
    uint32_t firstPoly = 0, polyCount = 0;
    uint32_t firstLight = 0, lightCount = 0;
};

/// One StretchPic. Pixels, top-left origin; sizes may be negative.
struct Picture {
    float x = 0, y = 0, width = 0, height = 0, s1 = 0, t1 = 0, s2 = 1, t2 = 1;
    int shader = 0;
    U8vec4 color{255};
};

/// One StretchRaw: the pixels went to scratch texture `slot` already.
struct CinematicPicture {
    int x = 0, y = 0, width = 0, height = 0;
    int columns = 0, rows = 0;
    int slot = 0;
};

/// An Eye alone: what follows is for it.
using FrameCommand = std::variant<Picture, CinematicPicture, SceneView, Eye>;

/// Everything of one frame in call order.
struct FrameCommands {
    int clockMs = 0; ///< the engine's clock when the frame began: the time of 2D shaders
    std::vector<FrameCommand> commands;
    std::vector<SceneEntity> entities;
    std::vector<ScenePoly> polys;
    std::vector<PolyVertex> polyVertices;
    std::vector<SceneLight> lights;
    void reserve(); ///< room for a busy frame
    void clear();
};

} // namespace q3rt

#pragma once
// A renderer module without its C boundary: what the engine calls, in our types. engine/export_table.cpp wraps one of
// these into the engine's table; the headless host may drive one directly. Any call may throw; the guard reports it.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/services.hpp"
#include "formats/font.hpp"
#include "scene/scene_types.hpp"
#include "scene/world.hpp"

namespace q3rt {

/// What the engine is told about the device and window (glconfig).
struct DisplayInfo {
    std::string rendererText, vendorText, versionText, extensionsText;
    int maxTextureSize = 0, textureUnits = 2;
    int colorBits = 24, depthBits = 24, stencilBits = 8;
    bool supportsGamma = false, fullscreen = false, stereo = false;
    int width = 0, height = 0; ///< pixels
    float aspect = 4.0f / 3.0f;
    int frequency = 0;
};

/// The engine's RegisterFont: the file's glyphs with shader handles filled in.
struct RegisteredFont {
    Font font;
    std::array<int, 256> glyphShader{};
    std::string name;
};

class Renderer {
  public:
    virtual ~Renderer() = default; ///< Shutdown(1): window and device go
    /// (Re)initialises after construction or shutdownRegistration(); all handles are new.
    virtual DisplayInfo beginRegistration() = 0;
    /// Shutdown(0): drops all registered data, keeps window and device. Legal at any moment, repeatedly.
    virtual void shutdownRegistration() = 0;
    virtual void endRegistration() = 0;
    virtual int registerModel(std::string_view name) = 0;
    virtual int registerSkin(std::string_view name) = 0;
    virtual int registerShader(std::string_view name, bool mipmaps) = 0;
    virtual std::optional<RegisteredFont> registerFont(std::string_view name, int pointSize) = 0;
    virtual void loadWorld(std::string_view name) = 0;

    virtual void clearScene() = 0;
    virtual void addEntity(const SceneEntity& entity) = 0;
    /// `vertices` holds polyCount polygons of vertexCount vertices each.
    virtual void addPolys(int shader, size_t vertexCount, std::span<const PolyVertex> vertices) = 0;
    virtual void addLight(const SceneLight& light) = 0;
    /// The range fields of `view` are ignored: the lists since clearScene or the last renderScene are taken.
    virtual void renderScene(const SceneView& view) = 0;
    virtual void setColor(const std::optional<vec4>& color) = 0;
    virtual void drawPicture(float x, float y, float width, float height, float s1, float t1, float s2, float t2,
                             int shader) = 0;
    virtual void drawCinematic(int x, int y, int width, int height, int columns, int rows, const uint8_t* rgba,
                               int slot, bool dirty) = 0;
    virtual void uploadCinematic(int columns, int rows, const uint8_t* rgba, int slot, bool dirty) = 0;
    virtual void beginFrame(int stereoEye) = 0;
    struct FrameTimes {
        int frontMs = 0, backMs = 0;
    };
    virtual FrameTimes endFrame() = 0;

    virtual int markFragments(const std::vector<vec3>& polygon, const vec3& projection, size_t maxPoints,
                              std::vector<vec3>& points, size_t maxFragments, std::vector<MarkFragment>& fragments) = 0;
    virtual bool lightForPoint(const vec3& point, GridLight& light) = 0;
    virtual bool lerpTag(int model, int startFrame, int endFrame, float fraction, std::string_view tag,
                         Orientation& out) = 0;
    virtual Bounds modelBounds(int model) = 0;
    virtual void remapShader(std::string_view from, std::string_view to, const char* timeOffset) = 0;
    virtual std::optional<std::string> entityToken() = 0;
    virtual bool inPvs(const vec3& from, const vec3& to) = 0;
    /// The last presented frame for the engine's AVI writer (through EngineServices::writeVideoFrame).
    virtual void takeVideoFrame(int width, int height, uint8_t* capture, uint8_t* encode, bool motionJpeg) = 0;
};

/// Each module defines this one: its export table is made around it.
std::unique_ptr<Renderer> createRenderer(EngineServices& engine);

} // namespace q3rt

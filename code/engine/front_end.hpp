#pragma once
// The half of a renderer that needs no graphics device: registration, scene lists, queries. It owns the content
// (textures, materials, models, world) and turns the engine's calls into FrameCommands, which the derived class draws.
// Lists grow; nothing is dropped for being one too many.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "engine/renderer.hpp"
#include "engine/settings.hpp"
#include "scene/entity_geometry.hpp"
#include "scene/material.hpp"
#include "scene/model.hpp"
#include "scene/texture.hpp"

namespace q3rt {

struct FrontEndSettings {
#define SETTING Q3RT_SETTING_MEMBER
#include "engine/front_end_settings.def.h"
#undef SETTING
};
void bindFrontEndSettings(SettingsBinding& binding, FrontEndSettings& values);

/// A finished frame on the CPU, 8-bit RGB, top row first.
struct FrameImage {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

class FrontEnd : public Renderer {
  public:
    explicit FrontEnd(EngineServices& engine);
    ~FrontEnd() override;
    FrontEnd(const FrontEnd&) = delete;
    FrontEnd& operator=(const FrontEnd&) = delete;

    DisplayInfo beginRegistration() override;
    void shutdownRegistration() override;
    void endRegistration() override;
    int registerModel(std::string_view name) override;
    int registerSkin(std::string_view name) override;
    int registerShader(std::string_view name, bool mipmaps) override;
    std::optional<RegisteredFont> registerFont(std::string_view name, int pointSize) override;
    void loadWorld(std::string_view name) override;
    void clearScene() override;
    void addEntity(const SceneEntity& entity) override;
    void addPolys(int shader, size_t vertexCount, std::span<const PolyVertex> vertices) override;
    void addLight(const SceneLight& light) override;
    void renderScene(const SceneView& view) override;
    void setColor(const std::optional<vec4>& color) override;
    void drawPicture(float x, float y, float width, float height, float s1, float t1, float s2, float t2,
                     int shader) override;
    void drawCinematic(int x, int y, int width, int height, int columns, int rows, const uint8_t* rgba, int slot,
                       bool dirty) override;
    void uploadCinematic(int columns, int rows, const uint8_t* rgba, int slot, bool dirty) override;
    void beginFrame(int stereoEye) override;
    FrameTimes endFrame() override;
    int markFragments(const std::vector<vec3>& polygon, const vec3& projection, size_t maxPoints,
                      std::vector<vec3>& points, size_t maxFragments, std::vector<MarkFragment>& fragments) override;
    bool lightForPoint(const vec3& point, GridLight& light) override;
    bool lerpTag(int model, int startFrame, int endFrame, float fraction, std::string_view tag,
                 Orientation& out) override;
    Bounds modelBounds(int model) override;
    void remapShader(std::string_view from, std::string_view to, const char* timeOffset) override;
    std::optional<std::string> entityToken() override;
    bool inPvs(const vec3& from, const vec3& to) override;
    void takeVideoFrame(int width, int height, uint8_t* capture, uint8_t* encode, bool motionJpeg) override;

  protected:
    // --- what a derived renderer adds, in calling order ---
    /// Opens window and device the first time, then only reports them. Settings are read already.
    virtual DisplayInfo openDisplay() = 0;
    /// New, empty libraries exist.
    virtual void onContentCreated() {}
    virtual void onWorldLoaded() {}
    virtual void onEndRegistration() {}
    /// Draws and presents. Fills `capture` (final picture) if it is not null.
    virtual void onFrame(const FrameCommands& frame, FrameImage* capture) = 0;
    /// The console command of that name.
    virtual void onMinimize() {}
    /// Lines of the console command modelist: what each r_mode is.
    virtual std::vector<std::string> modeLines() const { return {}; }
    /// More lines of the console command gfxinfo.
    virtual std::vector<std::string> displayLines() const { return {}; }
    /// Everything registered is about to be destroyed; legal at any moment, also before the first registration.
    virtual void onContentDropped() {}

    EngineServices& engine() { return m_engine; }
    const FrontEndSettings& settings() const { return m_settings; }
    /// Derived classes bind their own settings here, in their constructor.
    SettingsBinding& settingsBinding() { return m_binding; }
    TextureLibrary& textures() { return *m_textures; }
    MaterialLibrary& materials() { return *m_materials; }
    ModelLibrary& models() { return *m_models; }
    const World* world() const { return m_world.get(); }
    bool registered() const { return m_materials != nullptr; }
    /// Is the world rasterised? Headroom above white, several samples a pixel and a scale are for it.
    virtual bool isRasterizer() const { return true; }
    /// Effective overbright of this registration. White is drawn as 1 / 2^bits, and the ramp makes it white again.
    int overbrightBits() const { return m_overbrightBits; }
    float identityLight() const { return 1.0f / static_cast<float>(1 << m_overbrightBits); }
    /// From the finished picture's bytes to those that are shown, in place of a display's gamma ramp.
    std::array<uint8_t, 256> displayRamp() const;
    ViewGeometrySettings viewGeometrySettings() const;

  private:
    enum class CaptureKind { Tga, Jpeg, Levelshot, VideoRaw, VideoJpeg };
    struct CaptureRequest {
        CaptureKind kind;
        std::string file; ///< empty: the next free numbered name
        bool silent = false;
        int width = 0, height = 0; ///< video frames
    };
    friend struct FrontEndCommands;

    void addCommands();
    void removeCommands();
    void requestScreenshot(CaptureKind kind);
    void printShaderList();
    void printDisplayInfo();
    void printImageList();
    void printModelList();
    void printSkinList();
    void runVideos();
    void applyWorldRemaps();
    void writeCaptures(const FrameImage& image);
    void writeScreenshot(const CaptureRequest& request, const FrameImage& image);
    void writeVideo(const CaptureRequest& request, const FrameImage& image);
    std::string nextScreenshotName(const char* extension);

    EngineServices& m_engine;
    FrontEndSettings m_settings;
    SettingsBinding m_binding;
    DisplayInfo m_display;
    int m_overbrightBits = 0;
    bool m_commandsAdded = false;
    std::unique_ptr<TextureLibrary> m_textures;
    std::unique_ptr<MaterialLibrary> m_materials;
    std::unique_ptr<ModelLibrary> m_models;
    std::unique_ptr<World> m_world;
    MarkClipper m_marks;
    std::vector<int> m_videos; ///< cinematic handles of videoMaps
    FrameCommands m_frame;
    uint32_t m_firstEntity = 0, m_firstPoly = 0, m_firstLight = 0;
    Eye m_eye = Eye::Both;
    U8vec4 m_color{0}; ///< the original starts with transparent black, and keeps the colour over frames
    size_t m_entityTokenAt = 0;
    std::vector<CaptureRequest> m_captures;
    int m_nextScreenshot = 0;
};

} // namespace q3rt

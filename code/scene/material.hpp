#pragma once
// Materials: shader scripts and plain images compiled to stages. The script is the material; nothing is recognised by
// name. Behaviour: spec of materials, sections 1 to 3.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "formats/shader_script.hpp"
#include "math/vector.hpp"
#include "scene/texture.hpp"
#include "scene/wave.hpp"

namespace q3rt {

using MaterialId = uint32_t; ///< index in MaterialLibrary; 0 is the default material

/// Lightmap contexts below 0: who asks decides what $lightmap binds and how a plain image is lit.
namespace lightmapContext {
inline constexpr int kNone = -1, kWhite = -2, kByVertex = -3, k2D = -4;
}

enum class BlendFactor : uint8_t {
    Zero,
    One,
    SrcColor,
    OneMinusSrcColor,
    DstColor,
    OneMinusDstColor,
    SrcAlpha,
    OneMinusSrcAlpha,
    DstAlpha,
    OneMinusDstAlpha,
    SrcAlphaSaturate
};
enum class AlphaTest : uint8_t { None, Greater0, Less128, GreaterEqual128 };
enum class DepthFunc : uint8_t { LessEqual, Equal, Always };
enum class CullMode : uint8_t { Front, Back, None }; ///< Front: front-sided, clockwise triangles show
enum class RgbGen : uint8_t {
    Identity,
    IdentityLighting,
    Constant,
    Vertex,
    ExactVertex,
    OneMinusVertex,
    Entity,
    OneMinusEntity,
    Wave,
    LightingDiffuse
};
enum class AlphaGen : uint8_t {
    Identity,
    Constant,
    Vertex,
    OneMinusVertex,
    Entity,
    OneMinusEntity,
    Wave,
    LightingSpecular,
    Portal,
    KeepFromRgb ///< alpha as the rgbGen left it
};
enum class TexCoordGen : uint8_t { Texture, Lightmap, Environment, Vector };
enum class TexModKind : uint8_t { None, Scale, Scroll, EntityTranslate, Turb, Stretch, Transform, Rotate };
enum class DeformKind : uint8_t { None, Wave, Normal, Move, Bulge, ProjectionShadow, AutoSprite, AutoSprite2, Text };

struct TexMod {
    TexModKind kind = TexModKind::None;
    std::array<float, 6>
        value{}; ///< scale/scroll: 2; transform: m00 m01 m10 m11 t0 t1; rotate: degrees/s; turb: see wave
    Wave wave;   ///< turb, stretch
};

struct Deform {
    DeformKind kind = DeformKind::None;
    Wave wave;
    float spread = 0; ///< wave: 1 / div
    vec3 move{0};
    float bulgeWidth = 0, bulgeHeight = 0, bulgeSpeed = 0;
    int text = 0;
};

/// One texture unit of a stage.
struct TextureUnit {
    std::vector<TextureId> frames; ///< 1, or the animMap's
    float framesPerSecond = 0;
    int videoSlot = -1; ///< cinematic handle of videoMap, -1 none
    std::string videoName;
    bool isLightmap = false;
    bool isWhite = false;
    TexCoordGen texCoordGen = TexCoordGen::Texture;
    vec3 texCoordVectors[2] = {};
    std::vector<TexMod> mods; ///< at most 4
};

/// How baked light enters a stage: what the ray tracer replaces by the traced one (out = A x L + B).
enum class BakedLight : uint8_t { None, Lightmap, VertexColor, LightGrid };
/// Two units in one pass: multiply t0 * t1 * colour, or add min(1, t0 * colour + t1).
enum class Combine : uint8_t { Single, Multiply, Add };
/// What a blended stage in fog fades (spec of world 6.5).
enum class FogFade : uint8_t { None, Rgb, Alpha, Rgba };

struct Stage {
    TextureUnit unit[2];
    Combine combine = Combine::Single;
    bool blended = false;
    BlendFactor source = BlendFactor::One, destination = BlendFactor::Zero;
    AlphaTest alphaTest = AlphaTest::None;
    DepthFunc depthFunc = DepthFunc::LessEqual;
    bool depthWrite = true;
    bool detail = false;
    RgbGen rgbGen = RgbGen::Identity;
    AlphaGen alphaGen = AlphaGen::Identity;
    Wave rgbWave, alphaWave;
    U8vec4 constantColor{255};
    BakedLight bakedLight = BakedLight::None;
    FogFade fogFade = FogFade::None;
};

/// Text keywords that only map compilers read, and that give the ray tracer its lights.
struct LightDirectives {
    float surfaceLight = 0;              ///< q3map_surfacelight
    std::optional<vec3> color;           ///< q3map_lightRGB
    std::string lightImage, editorImage; ///< q3map_lightimage, qer_editorimage
    float skyLight = 0;                  ///< q3map_skylight value
    int skyLightIterations = 0;
    float backsplashPercent = 5, backsplashDistance = 23;
    struct Sun {
        vec3 color{1}; ///< normalised
        float intensity = 0, yawDegrees = 0, pitchDegrees = 0, devianceDegrees = 0;
    };
    std::vector<Sun> suns;
    bool alphaShadow = false;
};

struct SkyParameters {
    bool hasBox = false;
    std::array<TextureId, 6> box{}; ///< rt, lf, bk, ft, up, dn
    float cloudHeight = 0;
};

struct FogParameters {
    vec3 color{0};
    float depthForOpaque = 0;
};

namespace surfaceParm {
inline constexpr uint32_t kNoDamage = 0x1, kSlick = 0x2, kSky = 0x4, kNoImpact = 0x10, kNoMarks = 0x20, kNoDraw = 0x80,
                          kNoDlight = 0x20000;
inline constexpr uint32_t kContentsLava = 0x8, kContentsSlime = 0x10, kContentsWater = 0x20, kContentsFog = 0x40,
                          kContentsTranslucent = 0x20000000;
} // namespace surfaceParm

struct Material {
    std::string name;
    int lightmap = lightmapContext::kNone;
    bool isDefault = false; ///< the script failed or nothing was found: users substitute material 0
    bool explicitScript = false;
    float sort = 3;
    CullMode cull = CullMode::Front;
    bool polygonOffset = false, entityMergable = false;
    bool isSky = false, isPortal = false, isFog = false;
    SkyParameters sky;
    FogParameters fog;
    uint32_t surfaceFlags = 0, contentFlags = 0; ///< from surfaceparm lines (surfaceParm::*)
    float clampTimeSeconds = 0;
    float portalRange = 0; ///< alphaGen portal; 0 none
    std::vector<Deform> deforms;
    std::vector<Stage> stages; ///< after collapsing; what is drawn, in order
    LightDirectives light;
    MaterialId remappedTo = 0; ///< 0: not remapped
    double timeOffsetSeconds = 0;
    uint32_t sortRank = 0; ///< position in draw order; kept current by the library
    /// First of the copies that differ in sortRank only (a page asked for, no lightmap stage): shares its stages.
    MaterialId sharedStages = 0;
    bool usesTime = false, usesEntity = false; ///< what its evaluated stages depend on
};

struct MaterialSettings {
    bool detailTextures = true, vertexLight = false, fullbright = false, multitexture = true, fastSky = false;
    int lightmapMode = 0; ///< r_lightmap
};

/// Starts a looping silent video for a videoMap, returns its cinematic handle or -1.
using VideoStarter = std::function<int(std::string_view name)>;

class MaterialLibrary {
  public:
    /// Reads all scripts/*.shader at once.
    MaterialLibrary(FileSource& files, TextureLibrary& textures, const MaterialSettings& settings);
    /// Finds or creates; `mipRaw` false: a plain image becomes un-mipmapped and clamped (RegisterShaderNoMip).
    /// A missing or failed one returns an id whose material has isDefault set.
    MaterialId find(std::string_view name, int lightmap, bool mipRaw = true);
    /// As the engine's RegisterShader: 0 if default.
    int registerHandle(std::string_view name, int lightmap, bool mipRaw = true);
    const Material& get(MaterialId id) const { return *m_materials[id]; }
    /// The one that is drawn: remapping followed, one level.
    const Material& drawn(MaterialId id) const;
    size_t count() const { return m_materials.size(); }
    void remap(std::string_view from, std::string_view to, const char* timeOffset);
    /// Lightmap pages of the loaded world: texture of $lightmap for index i.
    void setLightmaps(std::vector<TextureId> pages) { m_lightmaps = std::move(pages); }
    const ScriptLibrary& scripts() const { return m_scripts; }
    TextureLibrary& textures() const { return m_textures; }
    /// Sun of the last parsed q3map_sun; reset by a world load. Direction to the sun, colour * intensity.
    vec3 sunDirection{0}, sunLight{0};
    float lastCloudHeight = 512; ///< of the last sky parsed: applies to all
    VideoStarter startVideo;
    const MaterialSettings& settings() const { return m_settings; }
    /// As drawn(), but the id.
    MaterialId drawnId(MaterialId id) const;

  private:
    FileSource& m_files;
    TextureLibrary& m_textures;
    MaterialSettings m_settings;
    ScriptLibrary m_scripts;
    std::vector<TextureId> m_lightmaps;
    std::vector<std::unique_ptr<Material>> m_materials;
    std::unordered_map<std::string, std::vector<MaterialId>> m_byName; ///< lower case, without extension
    std::vector<MaterialId> m_sorted;
    std::unordered_map<std::string, MaterialId> m_unusedPage; ///< first entry asked with a page that it never uses
    MaterialId add(Material material, const std::string& key);
    Material create(std::string_view name, const std::string& key, int lightmap, bool mipRaw);
    MaterialId findAny(std::string_view name);
};

} // namespace q3rt

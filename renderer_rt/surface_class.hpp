#pragma once
// Which of the ray tracer's structures a surface goes to, decided from its compiled material alone.

#include <cstdint>
#include <optional>
#include <span>

#include "scene/material.hpp"
#include "shaders/shared/stage.h"

namespace q3rt {

enum class SurfaceClass : uint8_t {
    Solid,         ///< nothing behind it shows; back faces culled by the tracer
    SolidTwoSided, ///< the same, shown from both sides
    Tested,        ///< the accept function decides at each point: alpha test, back-sided
    Layer,         ///< blended or a decal: composed with what is behind it
    Sky
};
inline constexpr size_t kSurfaceClassCount = 5;

/// nullopt: it shows nothing (no stages, no fog).
std::optional<SurfaceClass> classifySurface(const Material& material);

/// Is light that falls on either side to be seen on both? Of what shows both its sides and does not stop light when a
/// map is baked; other such surfaces are baked as walls, with their front's light.
bool isThin(const Material& material);

/// kSurface* bits of a material for the surface table.
uint32_t surfaceFlags(const Material& material, SurfaceClass surfaceClass);

/// RtSurface::cover of a tested surface's stages.
uint32_t coverOf(std::span<const StageState> stages);

/// Must any-hit code run on hits of this class?
inline bool isOpaqueClass(SurfaceClass c) {
    return c == SurfaceClass::Solid || c == SurfaceClass::SolidTwoSided || c == SurfaceClass::Sky;
}

/// Who may see a surface: the eye, mirrors, light.
struct Visibility {
    bool eye = true, mirrors = true, shadow = true;
    bool near = false; ///< depth hack
};
/// Instance mask bits (kMask*).
uint8_t instanceMask(SurfaceClass surfaceClass, const Visibility& visibility);

} // namespace q3rt

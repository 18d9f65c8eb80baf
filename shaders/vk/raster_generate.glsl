// Colour and texture coordinates of a vertex as the language's generators define them. The original computes them per
// vertex in bytes, and the picture shows that; so they are truncated here and interpolated after.

// Entry of the 1024-entry sine table, whose period is 1023.
float sineTable(float turns) {
    float entry = floor(fract(turns) * 1024.0);
    return sin(entry * (6.28318530718 / 1023.0));
}

vec3 truncateBytes(vec3 bytes) { return floor(clamp(bytes, 0.0, 255.0)) / 255.0; }

vec3 generateRgb(uint kind, vec3 constant, vec4 vertexColor, vec3 normal, RasterEntity entity) {
    if (kind == kColorVertex) return truncateBytes(vertexColor.rgb * 255.0 * constant + 0.001);
    if (kind == kColorOneMinusVertex) return truncateBytes((255.0 - vertexColor.rgb * 255.0) * constant + 0.001);
    if (kind == kColorLightingDiffuse) {
        float incoming = max(dot(normal, entity.lightDirection), 0.0);
        return truncateBytes(entity.ambient + incoming * entity.directed);
    }
    return constant;
}

// The original's specular light stands at a fixed point of model space.
const vec3 kSpecularLight = vec3(-960.0, 1980.0, 96.0);

float generateAlpha(uint kind, float constant, vec4 vertexColor, vec3 position, vec3 normal, float portalRange,
                    RasterEntity entity) {
    if (kind == kAlphaVertex) return vertexColor.a;
    if (kind == kAlphaOneMinusVertex) return 1.0 - vertexColor.a;
    if (kind == kAlphaLightingSpecular) {
        vec3 toLight = normalize(kSpecularLight - position);
        vec3 reflected = 2.0 * normal * dot(normal, toLight) - toLight;
        float strength = max(dot(reflected, normalize(entity.eyeInModel - position)), 0.0);
        return floor(min(255.0, 255.0 * strength * strength * strength * strength)) / 255.0;
    }
    if (kind == kAlphaPortal) {
        // Model-space vertex against the world-space eye, as the original has it.
        float part = distance(position, entity.eyeInWorld) / max(portalRange, 1e-6);
        return floor(min(1.0, part) * 255.0) / 255.0;
    }
    return constant;
}

vec2 baseCoordinates(uint kind, vec3 vectorS, vec3 vectorT, vec3 position, vec3 normal, vec2 st, vec2 lightmapSt,
                     vec3 eye) {
    if (kind == kCoordLightmap) return lightmapSt;
    if (kind == kCoordVector) return vec2(dot(position, vectorS), dot(position, vectorT));
    if (kind == kCoordEnvironment) {
        vec3 toEye = normalize(eye - position);
        vec3 reflected = 2.0 * normal * dot(normal, toEye) - toEye;
        return vec2(0.5 + 0.5 * reflected.y, 0.5 - 0.5 * reflected.z);
    }
    return st;
}

vec2 unitCoordinates(uint stage, uint unit, vec3 position, vec3 normal, vec2 st, vec2 lightmapSt, vec3 eye) {
    vec2 result = baseCoordinates(stages[stage].unit[unit].coord, stages[stage].unit[unit].vectorS,
                                  stages[stage].unit[unit].vectorT, position, normal, st, lightmapSt, eye);
    uint count = min(stages[stage].unit[unit].modCount, kMaxTexMods);
    for (uint i = 0u; i < count; ++i) {
        vec4 m = stages[stage].unit[unit].mods[i].matrix;
        if (stages[stage].unit[unit].mods[i].kind == kModTurb) {
            result += m.x * vec2(sineTable((position.x + position.z) / 1024.0 + m.y),
                                 sineTable(position.y / 1024.0 + m.y));
        } else {
            vec2 shift = stages[stage].unit[unit].mods[i].translate;
            result = vec2(result.x * m.x + result.y * m.z, result.x * m.y + result.y * m.w) + shift;
        }
    }
    return result;
}

// Coordinates of a point in the fog picture: depth along the view, and how far below the fog's surface.
vec2 fogCoordinates(uint fog, vec3 worldPosition) {
    float s = dot(fogs[fog].forward, worldPosition - fogs[fog].eye) * fogs[fog].scale + 1.0 / 512.0;
    float eyeDepth = fogs[fog].eyeDepth;
    float depth =
        fogs[fog].hasSurface != 0u ? fogs[fog].planeDistance - dot(fogs[fog].planeNormal, worldPosition) : 0.0;
    float t;
    if (eyeDepth < 0.0)
        t = depth < 1.0 ? 1.0 / 32.0 : 1.0 / 32.0 + (30.0 / 32.0) * depth / (depth - eyeDepth);
    else
        t = depth < 0.0 ? 1.0 / 32.0 : 31.0 / 32.0;
    return vec2(s, t);
}

float fogDensity(vec2 st) {
    float s = st.x - 1.0 / 512.0;
    if (s < 0.0 || st.y < 1.0 / 32.0) return 0.0;
    if (st.y < 31.0 / 32.0) s *= (st.y - 1.0 / 32.0) / (30.0 / 32.0);
    return sqrt(floor(255.0 * min(1.0, s * 8.0)) / 255.0);
}

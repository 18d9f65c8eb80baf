// All stages of a surface as one affine function of light and of what lies behind:
//     out = lit * L + unlit + through * D, per channel.
// L replaces every form of baked light: 1.0 = irradiance 63.75 luxel units, traced. D is the colour behind the surface.
//
// The frame buffer value is kept in that form while the stages are blended over it: it starts as D (0, 0, 1). A stage's
// source is S = a L + b with a scalar alpha (baked light never enters alpha), so every legal factor pair is
//     S * factor + F * factor,   F = lit L + unlit + through D,
// with factors 0, 1, alpha, 1 - alpha (destination alpha is 1): affine again, exactly. The factors that are colours
// (DST_COLOR and 1 - DST_COLOR of the source, SRC_COLOR and 1 - SRC_COLOR of the destination) need the product
//     S F = (a unlit + b lit) L + b unlit + b through D + a lit L^2 + a through L D.
// L^2 and L D are linearised by the secant through 0 and the surface's own baked light l (the texel or vertex colour
// that L replaces): L^2 = l L, L D = l D. So: exact where the traced light equals the baked one, exact in the dark,
// never negative, and the common stacks ({lightmap} {texture filter} in either order, glows, tints) have no such term.
// What the algebra leaves out is the frame buffer's clamp at 1 between two stages: light stays unbounded until the
// output curve.
#ifndef Q3RT_LIB_MATERIAL_AFFINE_GLSL
#define Q3RT_LIB_MATERIAL_AFFINE_GLSL
#include "lib/stage.glsl"

struct AffineColor {
    vec3 lit;
    vec3 unlit;
    vec3 through;
    uint wroteDepth; // 1: a stage passed and wrote depth; stages of depthFunc equal need it
};

// S = lit * L + unlit; `baked` is the value of L that the map compiler stored.
struct StageSource {
    vec3 lit;
    vec3 unlit;
    vec3 baked;
    float alpha;
};

// The surface before its first stage: all of what is behind.
AffineColor beginAffine()
{
    AffineColor result;
    result.lit = vec3(0.0f);
    result.unlit = vec3(0.0f);
    result.through = vec3(1.0f);
    result.wroteDepth = 0u;
    return result;
}

// Texel of the unit that is baked light, and the product of all others.
StageSource splitLightmap(StageState s, vec4 color, vec4 texel0, vec4 texel1)
{
    bool first = s.unit[0].isLightmap != 0u;
    vec3 other = first ? vec3(texel1) : vec3(texel0);
    StageSource source;
    source.alpha = combineTexels(s.combine, color, texel0, texel1).a;
    source.baked = first ? vec3(texel0) : vec3(texel1);
    source.unlit = vec3(0.0f);
    source.lit = vec3(color);
    if (s.combine == kCombineMultiply) {
        source.lit = other * vec3(color);
    } else if (s.combine == kCombineAdd) {
        // texel0 * color + texel1: the colour multiplies unit 0 only.
        source.lit = first ? vec3(color) : vec3(1.0f);
        source.unlit = first ? other : other * vec3(color);
    }
    return source;
}

// Baked light that came as the stage's colour: the generator without its light is the constant part.
StageSource splitColor(StageState s, vec4 color, vec4 texel0, vec4 texel1)
{
    vec4 unlitColor = vec4(vec3(s.color), color.a);
    vec4 fragment = combineTexels(s.combine, unlitColor, texel0, texel1);
    StageSource source;
    source.alpha = fragment.a;
    source.unlit = s.combine == kCombineAdd ? vec3(texel1) : vec3(0.0f);
    source.lit = s.combine == kCombineAdd ? vec3(texel0) * vec3(s.color) : vec3(fragment);
    source.baked = vec3(color) / max(vec3(s.color), vec3(1.0f / 255.0f)); // color has the constant part as a factor
    return source;
}

// `color` is stageColor with the baked light in it. Textures as sampled.
StageSource stageSource(StageState s, vec4 color, vec4 texel0, vec4 texel1)
{
    if (s.bakedLight == kBakedLightmap)
        return splitLightmap(s, color, texel0, texel1);
    if (s.bakedLight == kBakedVertex || s.bakedLight == kBakedGrid)
        return splitColor(s, color, texel0, texel1);
    vec4 fragment = combineTexels(s.combine, color, texel0, texel1);
    StageSource source;
    source.lit = vec3(0.0f);
    source.unlit = vec3(fragment);
    source.baked = vec3(0.0f);
    source.alpha = fragment.a;
    return source;
}

AffineColor scaleAffine(AffineColor value, float factor)
{
    value.lit *= factor;
    value.unlit *= factor;
    value.through *= factor;
    return value;
}

AffineColor addAffine(AffineColor left, AffineColor right)
{
    left.lit += right.lit;
    left.unlit += right.unlit;
    left.through += right.through;
    return left;
}

AffineColor sourceAsAffine(StageSource source)
{
    AffineColor result = beginAffine();
    result.lit = source.lit;
    result.unlit = source.unlit;
    result.through = vec3(0.0f);
    return result;
}

// S F with L^2 and L D linearised (see above).
AffineColor multiplyAffine(StageSource source, AffineColor frame)
{
    AffineColor result = frame;
    result.lit = source.lit * frame.unlit + source.unlit * frame.lit + source.lit * frame.lit * source.baked;
    result.unlit = source.unlit * frame.unlit;
    result.through = (source.unlit + source.lit * source.baked) * frame.through;
    return result;
}

// Can S F have a term of L^2 or L D? Only those read the baked light.
bool multipliesLight(StageState s, AffineColor frame)
{
    return s.blended != 0u && (frame.lit != vec3(0.0f) || frame.through != vec3(0.0f));
}

// value * factor, where `product` is S F and `isSource` tells which of the two `value` is.
AffineColor applyFactor(uint factor, AffineColor value, AffineColor product, float alpha, bool isSource)
{
    uint colorFactor = isSource ? kBlendDstColor : kBlendSrcColor;
    uint oneMinusColor = isSource ? kBlendOneMinusDstColor : kBlendOneMinusSrcColor;
    if (factor == colorFactor)
        return product;
    if (factor == oneMinusColor)
        return addAffine(value, scaleAffine(product, -1.0f));
    if (factor == kBlendOne || factor == kBlendDstAlpha)
        return value;
    if (factor == kBlendSrcAlpha)
        return scaleAffine(value, alpha);
    if (factor == kBlendOneMinusSrcAlpha)
        return scaleAffine(value, 1.0f - alpha);
    return scaleAffine(value, 0.0f);
}

// The surface after one more stage. `color` from stageColor (and fadeColorInFog).
AffineColor addStage(AffineColor frame, StageState s, vec4 color, vec4 texel0, vec4 texel1)
{
    StageSource source = stageSource(s, color, texel0, texel1);
    if (!passesAlphaTest(s.alphaTest, source.alpha))
        return frame;
    if (s.depthEqual != 0u && frame.wroteDepth == 0u)
        return frame;
    AffineColor own = sourceAsAffine(source);
    AffineColor result = own;
    if (s.blended != 0u) {
        AffineColor product = multiplyAffine(source, frame);
        result = addAffine(applyFactor(s.sourceBlend, own, product, source.alpha, true),
                           applyFactor(s.destinationBlend, frame, product, source.alpha, false));
    }
    result.wroteDepth = max(frame.wroteDepth, s.depthWrite);
    return result;
}

// What the surface shows for a light and a background.
vec3 resolveAffine(AffineColor surface, vec3 light, vec3 behind)
{
    return surface.lit * light + surface.unlit + surface.through * behind;
}
#endif

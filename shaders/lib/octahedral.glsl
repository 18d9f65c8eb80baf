// Directions as points of a square: the octahedral map (Cigolle et al. 2014, "A Survey of Efficient Representations for
// Independent Unit Vectors", JCGT 3, 2).
#ifndef Q3RT_LIB_OCTAHEDRAL_GLSL
#define Q3RT_LIB_OCTAHEDRAL_GLSL

// `n`: of any length but 0. In [-1, 1].
vec2 octahedralOf(vec3 n)
{
    vec3 p = n / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 side = vec2(p.x >= 0.0f ? 1.0f : -1.0f, p.y >= 0.0f ? 1.0f : -1.0f);
    return p.z >= 0.0f ? vec2(p.x, p.y) : vec2((1.0f - abs(p.y)) * side.x, (1.0f - abs(p.x)) * side.y);
}

vec3 fromOctahedral(vec2 e)
{
    float z = 1.0f - abs(e.x) - abs(e.y);
    float fold = max(-z, 0.0f);
    return normalize(vec3(e.x + (e.x >= 0.0f ? -fold : fold), e.y + (e.y >= 0.0f ? -fold : fold), z));
}

#endif

#include "scene/effect_trim.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace q3rt {

namespace {

constexpr float kNearestW = 1.0f; // qu: what is nearer is left alone
constexpr float kManyTexels = 1e9f;
constexpr float kTexelRounding = 1.0f / 16; // of a texel: samplers reckon with 1/256 of one

// Depths of the corners may differ by this factor: texels a pixel then differ by its square, less than the two between
// what is asked for and what the part holds for.
constexpr float kMostTilt = 1.1f;

// Of the square's size: how far the fourth corner may be from where the others want it. Pixels move by less than a
// tenth of that of a square as large as the screen.
constexpr float kRoughness = 1e-4f;

/// First and last texel with something, of columns or of rows; first > last: none.
struct TexelRange {
    int first, last;
};

template <typename HasSomething>
TexelRange findRange(int count, const HasSomething& hasSomething) {
    TexelRange range{0, count - 1};
    while (range.first <= range.last && !hasSomething(range.first))
        ++range.first;
    while (range.last > range.first && !hasSomething(range.last))
        --range.last;
    return range;
}

/// Filters reach half a texel beyond its border; as much again is for the driver's rounding.
void addRange(const TexelRange& range, int count, bool clamped, float& least, float& greatest) {
    if (range.first > range.last) return;
    const auto size = static_cast<float>(count);
    float from = static_cast<float>(range.first - 1) / size, to = static_cast<float>(range.last + 2) / size;
    if (!clamped && (from < 0 || to > 1)) {
        // What touches one side of a texture that repeats comes in at the other.
        from = 0;
        to = 1;
    }
    least = std::min(least, from);
    greatest = std::max(greatest, to);
}

/// Of the levels down to the one that is read at a depth, one after the other.
class PartFinder {
  public:
    /// Bounds grow by what the level has.
    template <typename TexelHasSomething>
    void addLevel(const MipLevel& level, bool clamped, const TexelHasSomething& texelHasSomething) {
        const auto texel = [&](int x, int y) {
            return texelHasSomething(&level.rgba[(static_cast<size_t>(y) * level.width + x) * 4]);
        };
        const auto row = [&](int y) {
            for (int x = 0; x < level.width; ++x)
                if (texel(x, y)) return true;
            return false;
        };
        const auto column = [&](int x) {
            for (int y = 0; y < level.height; ++y)
                if (texel(x, y)) return true;
            return false;
        };
        addRange(findRange(level.height, row), level.height, clamped, m_least.y, m_greatest.y);
        addRange(findRange(level.width, column), level.width, clamped, m_least.x, m_greatest.x);
        if (clamped) addCircle(level, texel);
    }
    TexturePart part() const {
        if (m_least.x >= m_greatest.x || m_least.y >= m_greatest.y) return {};
        return {m_least, m_greatest, m_centre, m_radius};
    }

  private:
    template <typename Texel>
    void addCircle(const MipLevel& level, const Texel& texel) {
        if (m_radius == 0) m_centre = 0.5f * (m_least + m_greatest);
        const vec2 size(level.width, level.height);
        float greatest = -1;
        for (int y = 0; y < level.height; ++y) {
            for (int x = 0; x < level.width; ++x) {
                if (!texel(x, y)) continue;
                const vec2 away = (vec2(x, y) + 0.5f) / size - m_centre;
                greatest = std::max(greatest, glm::dot(away, away));
            }
        }
        const float reach = 1.5f * glm::length(1.0f / size); // of filters, and rounding, as for the sides
        if (greatest >= 0) m_radius = std::max(m_radius, std::sqrt(greatest) + reach);
    }
    vec2 m_least{1.0f}, m_greatest{0.0f}, m_centre{0.5f};
    float m_radius = 0;
};

template <typename TexelHasSomething>
std::array<TexturePart, TextureParts::kDepths> findParts(const Texture& texture,
                                                         const TexelHasSomething& texelHasSomething) {
    std::array<TexturePart, TextureParts::kDepths> parts;
    PartFinder finder;
    const auto add = [&](size_t level) {
        if (level < texture.levels.size())
            finder.addLevel(texture.levels[level], texture.flags.clamp, texelHasSomething);
    };
    add(0);
    for (size_t depth = 0; depth < parts.size(); ++depth) {
        add(depth + 1);
        parts[depth] = finder.part();
    }
    return parts;
}

int wrapOrClamp(int number, int count, bool clamped) {
    return clamped ? std::clamp(number, 0, count - 1) : (number % count + count) % count;
}

/// What filters may read of a level anywhere in a cell: texels whose middles are less than one away.
template <typename TexelHasSomething>
bool cellHasSomething(const MipLevel& level, size_t cellX, size_t cellY, bool clamped,
                      const TexelHasSomething& texelHasSomething) {
    const auto range = [](size_t cell, int count) {
        const float size = static_cast<float>(count) / kTextureCells, from = static_cast<float>(cell) * size;
        return TexelRange{static_cast<int>(std::ceil(from - 1.5f - kTexelRounding)),
                          static_cast<int>(std::floor(from + size + 0.5f + kTexelRounding))};
    };
    const TexelRange columns = range(cellX, level.width), rows = range(cellY, level.height);
    for (int row = rows.first; row <= rows.last; ++row) {
        const auto y = static_cast<size_t>(wrapOrClamp(row, level.height, clamped));
        for (int column = columns.first; column <= columns.last; ++column) {
            const auto x = static_cast<size_t>(wrapOrClamp(column, level.width, clamped));
            if (texelHasSomething(&level.rgba[(y * static_cast<size_t>(level.width) + x) * 4])) return true;
        }
    }
    return false;
}

template <typename TexelHasSomething>
std::vector<TextureCells> findCells(const Texture& texture, const TexelHasSomething& texelHasSomething) {
    std::vector<TextureCells> cells(TextureParts::kDepths);
    TextureCells held{};
    const auto add = [&](size_t level) {
        if (level >= texture.levels.size()) return;
        for (size_t y = 0; y < kTextureCells; ++y)
            for (size_t x = 0; x < kTextureCells; ++x)
                if ((held[y] >> x & 1) == 0 &&
                    cellHasSomething(texture.levels[level], x, y, texture.flags.clamp, texelHasSomething))
                    held[y] |= 1u << x;
    };
    for (size_t level = 0; level < TextureParts::kDepths; ++level) {
        add(level);
        cells[level] = held;
    }
    return cells;
}

/// What of a texture changes what is behind.
enum class Counting : uint8_t { All, WithAlpha, WithColor };

Counting whatCounts(const StageState& stage) {
    if (stage.blended == 0 || stage.depthWrite != 0) return Counting::All;
    const uint32_t source = stage.sourceBlend, destination = stage.destinationBlend;
    const bool keepsWhereClear = destination == kBlendOne || destination == kBlendOneMinusSrcAlpha;
    if (source == kBlendSrcAlpha && keepsWhereClear) return Counting::WithAlpha;
    const bool keepsWhereBlack = destination == kBlendOne || destination == kBlendOneMinusSrcColor;
    return source == kBlendOne && keepsWhereBlack ? Counting::WithColor : Counting::All;
}

/// How a stage moves its texture: texture coordinates are matrix * st + shift.
struct Motion {
    glm::mat2 matrix{1.0f};
    vec2 shift{0.0f};
    bool moves = false;
    /// Of lengths, at most.
    float stretch() const {
        const float squares = glm::dot(matrix[0], matrix[0]) + glm::dot(matrix[1], matrix[1]);
        const float area = glm::determinant(matrix);
        return std::sqrt(0.5f * (squares + std::sqrt(std::max(squares * squares - 4 * area * area, 0.0f))));
    }
};

std::optional<Motion> motionOf(const TextureUnitState& unit) {
    Motion motion;
    if (unit.coord != kCoordTexture || unit.modCount > 1) return std::nullopt;
    if (unit.modCount == 0) return motion;
    const TexModState& mod = unit.mods[0];
    if (mod.kind != kModAffine) return std::nullopt;
    motion.matrix = {mod.matrix.x, mod.matrix.y, mod.matrix.z, mod.matrix.w}; // by columns: of s, of t
    motion.shift = mod.translate;
    motion.moves = true;
    return motion;
}

size_t depthOf(float texelsPerPixel) {
    size_t depth = 0;
    while (depth < TextureParts::kDepths && texelsPerPixel > static_cast<float>(1u << depth))
        ++depth;
    return depth;
}

/// Cells of the texture between coordinates on one axis, a bit each.
uint32_t cellsBetween(float least, float greatest, bool clamped) {
    constexpr int kCount = kTextureCells;
    if (greatest - least >= 1 && !clamped) return ~0u;
    const float whole = clamped ? 0 : std::floor(least);
    const auto place = [&](float at) { return (clamped ? std::clamp(at, 0.0f, 1.0f) : at - whole) * kCount; };
    const int first = static_cast<int>(std::floor(place(least)));
    const int end = std::max(first + 1, static_cast<int>(std::ceil(place(greatest))));
    uint32_t cells = 0;
    for (int cell = first; cell < end; ++cell)
        cells |= 1u << wrapOrClamp(cell, kCount, clamped);
    return cells;
}

/// The part of the square that shows the part of the texture.
TexturePart moveBack(const TexturePart& part, const Motion& motion) {
    constexpr float kLeastArea = 1e-6f; // a texture so large shows no border
    if (std::abs(glm::determinant(motion.matrix)) < kLeastArea) return {};
    const glm::mat2 back = glm::inverse(motion.matrix);
    const vec2 middle = back * (part.centre - motion.shift);
    const vec2 reach(part.radius * glm::length(vec2(back[0].x, back[1].x)),
                     part.radius * glm::length(vec2(back[0].y, back[1].y)));
    TexturePart moved{vec2(kManyTexels), vec2(-kManyTexels)};
    for (const vec2& corner :
         {part.least, part.greatest, vec2(part.least.x, part.greatest.y), vec2(part.greatest.x, part.least.y)}) {
        const vec2 st = back * (corner - motion.shift);
        moved.least = glm::min(moved.least, st);
        moved.greatest = glm::max(moved.greatest, st);
    }
    moved.least = glm::max(glm::max(moved.least, middle - reach), vec2(0.0f));
    moved.greatest = glm::min(glm::min(moved.greatest, middle + reach), vec2(1.0f));
    return moved;
}

} // namespace

TextureParts findTextureParts(const Texture& texture) {
    TextureParts parts;
    const MipLevel& base = texture.levels.front();
    parts.sizeTexels = vec2(base.width, base.height);
    parts.clamped = texture.flags.clamp;
    if (base.rgba.empty()) return parts;
    const auto hasAlpha = [](const uint8_t* texel) { return texel[3] != 0; };
    const auto hasColor = [](const uint8_t* texel) { return (texel[0] | texel[1] | texel[2]) != 0; };
    parts.withAlpha = findParts(texture, hasAlpha);
    parts.withColor = findParts(texture, hasColor);
    parts.cellsWithAlpha = findCells(texture, hasAlpha);
    parts.cellsWithColor = findCells(texture, hasColor);
    return parts;
}

TexturePart findPartShown(const StageState& state, const TextureParts& parts, float texelsPerPixel) {
    const Counting counting = whatCounts(state);
    const std::optional<Motion> motion = motionOf(state.unit[0]);
    if (counting == Counting::All || !motion || state.combine != kCombineSingle) return {};
    const size_t depth = depthOf(texelsPerPixel * motion->stretch());
    if (depth == TextureParts::kDepths) return {};
    const TexturePart& part = (counting == Counting::WithAlpha ? parts.withAlpha : parts.withColor)[depth];
    // What a clamped texture has at a side it has beyond it too; another begins anew there.
    const bool ends = parts.clamped && glm::all(glm::greaterThanEqual(part.least, vec2(0.0f))) &&
                      glm::all(glm::lessThanEqual(part.greatest, vec2(1.0f)));
    if (motion->moves) return ends ? moveBack(part, *motion) : TexturePart{};
    return {glm::max(part.least, vec2(0.0f)), glm::min(part.greatest, vec2(1.0f))};
}

EffectSquare::EffectSquare(std::span<const Vertex, 4> square, const mat4& clipFromModel, const vec2& sizePx) {
    std::ranges::copy(square, m_square.begin());
    m_usable = findCorners() && place(clipFromModel, sizePx);
}

bool EffectSquare::findCorners() {
    unsigned found = 0;
    for (size_t i = 0; i < 4; ++i) {
        const vec2& st = m_square[i].st;
        if ((st.x != 0 && st.x != 1) || (st.y != 0 && st.y != 1) || m_square[i].color != m_square[0].color)
            return false;
        const auto corner = static_cast<size_t>(st.x + 2 * st.y);
        m_corners[corner] = i;
        found |= 1u << corner;
    }
    if (found != 15u) return false;
    const auto at = [&](size_t corner) { return m_square[m_corners[corner]].position; };
    const vec3 across = at(3) - at(0);
    const vec3 gap = at(1) + at(2) - at(0) - at(3);
    return glm::dot(gap, gap) <= kRoughness * kRoughness * glm::dot(across, across);
}

bool EffectSquare::place(const mat4& clipFromModel, const vec2& sizePx) {
    std::array<vec2, 4> px;
    float leastW = kManyTexels, greatestW = 0;
    for (size_t i = 0; i < 4; ++i) {
        const vec4 clip = clipFromModel * vec4(m_square[m_corners[i]].position, 1.0f);
        leastW = std::min(leastW, clip.w);
        greatestW = std::max(greatestW, clip.w);
        px[i] = vec2(clip) / std::max(clip.w, kNearestW) * 0.5f * sizePx;
    }
    m_acrossS = px[1] - px[0];
    m_acrossT = px[2] - px[0];
    m_tilt = greatestW / std::max(leastW, kNearestW);
    return leastW >= kNearestW && greatestW <= kMostTilt * leastW;
}

float EffectSquare::texelsPerPixel(const vec2& sizeTexels) const {
    const float area = std::abs(m_acrossS.x * m_acrossT.y - m_acrossS.y * m_acrossT.x);
    const float most = std::max(sizeTexels.x * glm::length(m_acrossT), sizeTexels.y * glm::length(m_acrossS));
    return area > 0 ? most / area : kManyTexels;
}

void EffectSquare::write(const TexturePart& part, std::span<Vertex, 4> out) const {
    const auto at = [&](size_t corner) { return m_square[m_corners[corner]].position; };
    for (size_t i = 0; i < 4; ++i) {
        const vec2 st(i & 1 ? part.greatest.x : part.least.x, i & 2 ? part.greatest.y : part.least.y);
        Vertex& vertex = out[m_corners[i]];
        vertex = m_square[m_corners[i]];
        vertex.st = st;
        vertex.position = glm::mix(glm::mix(at(0), at(1), st.x), glm::mix(at(2), at(3), st.x), st.y);
    }
}

float EffectSquare::mostTexelsPerPixel(const vec2& sizeTexels, const glm::mat2& turn) const {
    constexpr float kRounding = 1.01f;
    const glm::mat2 pxFromSt(m_acrossS, m_acrossT);
    if (glm::determinant(pxFromSt) == 0) return kManyTexels;
    const glm::mat2 texels = glm::mat2(sizeTexels.x, 0, 0, sizeTexels.y) * turn * glm::inverse(pxFromSt);
    // The sum of both is the most that a driver may take for the length of either.
    const auto length = [](const vec2& step) { return std::abs(step.x) + std::abs(step.y); };
    return std::max(length(texels[0]), length(texels[1])) * m_tilt * m_tilt * kRounding;
}

SquareCells findCellsShown(const StageState& state, const TextureParts& parts, const EffectSquare& square) {
    SquareCells shown;
    shown.fill(0xffff);
    const Counting counting = whatCounts(state);
    const std::optional<Motion> motion = motionOf(state.unit[0]);
    if (counting == Counting::All || !motion || state.combine != kCombineSingle) return shown;
    const glm::mat2& matrix = motion->matrix;
    if (matrix[0].y != 0 || matrix[1].x != 0) return shown;
    const auto& levels = counting == Counting::WithAlpha ? parts.cellsWithAlpha : parts.cellsWithColor;
    const size_t level = depthOf(square.mostTexelsPerPixel(parts.sizeTexels, matrix));
    if (level >= levels.size()) return shown;
    const auto cellsOf = [&](uint32_t number, float scale, float shift) {
        const float one = scale * static_cast<float>(number) / kSquareCells + shift;
        const float other = scale * static_cast<float>(number + 1) / kSquareCells + shift;
        return cellsBetween(std::min(one, other), std::max(one, other), parts.clamped);
    };
    std::array<uint32_t, kSquareCells> columns;
    for (uint32_t s = 0; s < kSquareCells; ++s)
        columns[s] = cellsOf(s, matrix[0].x, motion->shift.x);
    for (uint32_t t = 0; t < kSquareCells; ++t) {
        uint32_t row = 0;
        for (uint32_t rows = cellsOf(t, matrix[1].y, motion->shift.y); rows != 0; rows &= rows - 1)
            row |= levels[level][static_cast<size_t>(std::countr_zero(rows))];
        shown[t] = 0;
        for (uint32_t s = 0; s < kSquareCells; ++s)
            if ((row & columns[s]) != 0) shown[t] |= static_cast<uint16_t>(1u << s);
    }
    return shown;
}

} // namespace q3rt

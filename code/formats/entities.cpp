#include "formats/entities.hpp"

#include "formats/shader_script.hpp"
#include "formats/text_case.hpp"

namespace q3rt {

std::optional<std::string_view> MapEntity::value(std::string_view key) const {
    for (const auto& [name, text] : pairs) {
        if (equalsIgnoringCase(name, key)) return text;
    }
    return std::nullopt;
}

std::string_view MapEntity::className() const { return value("classname").value_or(std::string_view()); }

std::optional<vec3> MapEntity::vector(std::string_view key) const {
    const auto text = value(key);
    if (!text) return std::nullopt;
    std::string_view rest = *text;
    int line = 1;
    vec3 numbers{0.0f};
    for (int i = 0; i < 3; ++i) {
        const auto token = nextScriptToken(rest, line, false);
        if (!token) return std::nullopt;
        numbers[i] = parseScriptNumber(*token);
    }
    return numbers;
}

float MapEntity::number(std::string_view key, float fallback) const {
    const auto text = value(key);
    if (!text) return fallback;
    std::string_view rest = *text;
    int line = 1;
    const auto token = nextScriptToken(rest, line, false);
    return token ? parseScriptNumber(*token) : fallback;
}

std::vector<MapEntity> parseEntities(std::string_view text) {
    std::vector<MapEntity> entities;
    int line = 1;
    while (nextScriptToken(text, line, false) == "{") {
        MapEntity entity;
        while (true) {
            auto key = nextScriptToken(text, line, false);
            if (!key) return entities;
            if (*key == "}") break;
            auto value = nextScriptToken(text, line, false);
            if (!value || *value == "}") return entities;
            entity.pairs.emplace_back(std::move(*key), std::move(*value));
        }
        entities.push_back(std::move(entity));
    }
    return entities;
}

} // namespace q3rt

#include "trace/trace_event.hpp"

#include <type_traits>

#include "trace/field_archive.hpp"

namespace q3rt {
namespace {

template <size_t Index = 0>
TraceEvent decodeFields(size_t code, Decoder& decoder) {
    if constexpr (Index < std::variant_size_v<TraceEvent>) {
        if (code != Index) return decodeFields<Index + 1>(code, decoder);
        std::variant_alternative_t<Index, TraceEvent> event;
        event.fields(decoder);
        return event;
    } else {
        decoder.fail("unknown event");
    }
}

/// What a renderer would read or write out of bounds for.
struct Checker {
    const Decoder& decoder;
    void operator()(const event::Register& e) const {
        if (e.kind > event::HandleKind::ShaderNoMip) decoder.fail("unknown kind of handle");
    }
    void operator()(const event::AddPolys& e) const {
        if (e.vertexCount <= 0 || e.vertices.size() % static_cast<size_t>(e.vertexCount) != 0)
            decoder.fail("polygons with a broken vertex count");
    }
    void operator()(const event::Cinematic& e) const {
        const size_t pixels = e.columns > 0 && e.rows > 0 ? size_t(e.columns) * size_t(e.rows) : 0;
        if (pixels == 0 || (e.dirty && e.rgba.size() != pixels * 4)) decoder.fail("a cinematic frame of a wrong size");
    }
    void operator()(const event::MarkFragments& e) const {
        constexpr int32_t kMost = 1 << 20; // the engine asks for 384 points in 128 fragments
        if (e.maxPoints < 0 || e.maxFragments < 0 || e.maxPoints > kMost || e.maxFragments > kMost)
            decoder.fail("a mark with a broken limit");
    }
    void operator()(const event::BeginRegistration& e) const {
        constexpr int32_t kMost = 1 << 16; // pixels
        if (e.width <= 0 || e.height <= 0 || e.width > kMost || e.height > kMost) decoder.fail("a broken picture size");
    }
    template <class Other>
    void operator()(const Other&) const {}
};

} // namespace

void encodeEvent(TraceEvent& event, std::vector<std::byte>& out) {
    out.push_back(static_cast<std::byte>(event.index()));
    Encoder encoder(out);
    std::visit([&](auto& fields) { fields.fields(encoder); }, event);
}

TraceEvent decodeEvent(const std::vector<std::byte>& bytes, size_t& offset, const std::string& name) {
    Decoder decoder(bytes, offset, name);
    uint8_t code = 0;
    decoder(code);
    TraceEvent event = decodeFields(code, decoder);
    std::visit(Checker{decoder}, event);
    return event;
}

bool changesState(const TraceEvent& event) {
    return std::visit(
        [](const auto& e) {
            using Event = std::decay_t<decltype(e)>;
            return std::is_same_v<Event, event::Shutdown> || std::is_same_v<Event, event::BeginRegistration> ||
                   std::is_same_v<Event, event::Register> || std::is_same_v<Event, event::LoadWorld> ||
                   std::is_same_v<Event, event::EndRegistration> || std::is_same_v<Event, event::RegisterFont> ||
                   std::is_same_v<Event, event::RemapShader> || std::is_same_v<Event, event::CvarValue> ||
                   std::is_same_v<Event, event::CinematicPlay> || std::is_same_v<Event, event::Cinematic> ||
                   std::is_same_v<Event, event::SetColor>;
        },
        event);
}

} // namespace q3rt

#include "host/trade/session.hpp"

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "formats/text_case.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/setting_checks.hpp"

namespace q3rt {
namespace {

constexpr int kLatch = 0x20, kUserCreated = 0x80; ///< the engine's cvar flags

/// Every back end and device draws the same expected picture (the tests hold them to it), and the size is named apart.
bool decidesPicture(const std::string& lowerName) {
    for (const char* name :
         {"rt_backend", "rt_printperfstats", "r_device", "r_mode", "r_customwidth", "r_customheight"})
        if (lowerName == name) return false;
    return lowerName.starts_with("rt_") || lowerName.starts_with("r_");
}

} // namespace

/// Hands files through and remembers what was in them.
class TradeSession::HashedFiles : public FileSource {
  public:
    explicit HashedFiles(FileSource& files)
        : m_files(files) {}
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        auto bytes = m_files.read(name);
        if (bytes) m_hashes[toLowerAscii(name)] = hashBytes(*bytes);
        return bytes;
    }
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override {
        return m_files.list(directory, extension);
    }
    std::string hash() const {
        std::string text;
        for (const auto& [name, hash] : m_hashes)
            text += formatText("%s %016llx\n", name.c_str(), static_cast<unsigned long long>(hash));
        return hashText(text);
    }

  private:
    FileSource& m_files;
    std::map<std::string, uint64_t> m_hashes; ///< by lower-case name
};

TradeSession::TradeSession(TradeSource& source, std::filesystem::path module, bool verbose)
    : m_source(source)
    , m_module(std::move(module))
    , m_verbose(verbose) {
    m_moduleHash = formatText("%016llx", static_cast<unsigned long long>(hashBytes(readFileBytes(m_module))));
}

TradeSession::~TradeSession() = default;

void TradeSession::apply(const TradePoint& point) {
    if (!m_engine || startSettings(point) != m_startSettings) return start(point);
    for (const std::string& name : m_setCvars)
        if (!point.cvars.contains(name)) m_engine->cvars.preset(name, defaultOf(name));
    for (const auto& [name, value] : point.cvars)
        setCvar(name, value);
    requireSettings(m_engine->cvars, {point.cvars.begin(), point.cvars.end()});
}

void TradeSession::start(const TradePoint& point) {
    m_engine.reset(); // the interface allows one at a time
    m_files = std::make_unique<HashedFiles>(m_source.files());
    m_engine = std::make_unique<HeadlessEngine>(*m_files);
    m_engine->showsMessages = m_verbose;
    m_engine->loadModule(m_module);
    m_source.start(*m_engine, point.size, {point.cvars.begin(), point.cvars.end()});
    m_setCvars.clear();
    for (const auto& [name, value] : point.cvars)
        m_setCvars.insert(name);
    m_startSettings = startSettings(point);
    m_source.draw(*m_engine, 0, false);
    requireSettings(m_engine->cvars, {point.cvars.begin(), point.cvars.end()});
    const auto json = nlohmann::json::parse(stats(), nullptr, false);
    m_device = m_engine->config().renderer_string;
    m_backend.clear();
    if (!json.is_object()) return;
    m_device = json.value("device", m_device);
    m_backend = json.value("backend", m_backend);
}

std::string TradeSession::startSettings(const TradePoint& point) const {
    std::string text = formatText("%dx%d", point.size.width, point.size.height);
    for (const auto& [name, value] : point.cvars)
        if (isLatched(name)) text += " " + name + "=" + value;
    return text;
}

bool TradeSession::isDeclared(const std::string& name) const {
    const cvar_t* cvar = m_engine->cvars.find(name);
    return cvar && !(cvar->flags & kUserCreated);
}

bool TradeSession::isLatched(const std::string& name) const {
    const cvar_t* cvar = m_engine->cvars.find(name);
    return cvar && (cvar->flags & kLatch);
}

std::string TradeSession::defaultOf(const std::string& name) const { return m_engine->cvars.find(name)->resetString; }

void TradeSession::setCvar(const std::string& name, const std::string& value) {
    m_engine->cvars.preset(name, value);
    m_setCvars.insert(name);
}

std::string TradeSession::stats() const { return m_engine->cvars.value("q3rt_stats"); }

std::string TradeSession::describeState() const {
    std::string text = "module " + m_moduleHash + "\nfiles " + m_files->hash() + "\n";
    for (const std::string& name : m_engine->cvars.names())
        if (decidesPicture(name)) text += name + " " + m_engine->cvars.value(name) + "\n";
    return text;
}

} // namespace q3rt

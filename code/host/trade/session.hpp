#pragma once
// A module running for a sweep: started anew only for settings that take effect at a start.

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "host/trade/points.hpp"
#include "host/trade/source.hpp"

namespace q3rt {

class TradeSession {
  public:
    /// `source` outlives this object.
    TradeSession(TradeSource& source, std::filesystem::path module, bool verbose);
    ~TradeSession();

    /// Every cvar of the point is in force afterwards; those of earlier points that it lacks are at their defaults.
    /// Throws as requireSettings does.
    void apply(const TradePoint& point);
    /// After the first apply().
    bool isDeclared(const std::string& name) const;
    /// Why there is no such setting, or "".
    std::string complaint(const std::string& name) const { return m_engine->cvars.complaint(name); }
    bool isLatched(const std::string& name) const;
    std::string defaultOf(const std::string& name) const; ///< of a declared cvar
    const std::string& device() const { return m_device; }
    const std::string& backend() const { return m_backend; }
    const std::string& moduleHash() const { return m_moduleHash; } ///< of the module's file
    /// The device's name apart, everything that the module's picture depends on now: files read, rt_ and r_ cvars.
    std::string describeState() const;

    void approach(size_t view, int frames) { m_source.approach(*m_engine, view, frames); }
    DrawnFrame draw(size_t view, bool capture) { return m_source.draw(*m_engine, view, capture); }
    void setCvar(const std::string& name, const std::string& value);
    /// What the module said of its last frame: a JSON object, or empty.
    std::string stats() const;

  private:
    class HashedFiles;
    void start(const TradePoint& point);
    std::string startSettings(const TradePoint& point) const;

    TradeSource& m_source;
    std::filesystem::path m_module;
    std::string m_moduleHash;
    bool m_verbose;
    std::unique_ptr<HashedFiles> m_files;
    std::unique_ptr<HeadlessEngine> m_engine;
    std::string m_startSettings;      ///< those that only a new start changes
    std::set<std::string> m_setCvars; ///< since the start
    std::string m_device, m_backend;
};

} // namespace q3rt

// Where the fetched driver is looked for, and when it is offered to the loader.

#include "gpu/software_driver.hpp"

#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>

#include <gtest/gtest.h>

namespace q3rt {
namespace {

namespace fs = std::filesystem;

/// Sets the environment and puts it back.
class Environment {
  public:
    void set(const std::string& name, const char* value) {
        const char* before = std::getenv(name.c_str());
        m_before.try_emplace(name, before ? std::optional<std::string>(before) : std::nullopt);
        value ? setenv(name.c_str(), value, 1) : unsetenv(name.c_str());
    }
    ~Environment() {
        for (const auto& [name, value] : m_before)
            value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
    }

  private:
    std::map<std::string, std::optional<std::string>> m_before;
};

class FetchedDriver : public testing::Test {
  protected:
    void SetUp() override {
        fs::remove_all(m_folder);
        makeIcd(m_folder / "cache" / "q3rt");
        makeIcd(m_folder / "home" / ".cache" / "q3rt");
        for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"})
            m_environment.set(name, nullptr);
        m_environment.set("XDG_CACHE_HOME", (m_folder / "cache").c_str());
        m_environment.set("HOME", (m_folder / "home").c_str());
    }
    void TearDown() override { fs::remove_all(m_folder); }
    static void makeIcd(const fs::path& cache) {
        fs::create_directories(cache / "lavapipe");
        std::ofstream(cache / "lavapipe" / "lvp_icd.json") << "{}";
    }
    static std::string added() {
        const char* value = std::getenv("VK_ADD_DRIVER_FILES");
        return value ? value : "";
    }
    fs::path m_folder = fs::path(testing::TempDir()) / "q3rt fetched driver test";
    Environment m_environment;
};

TEST_F(FetchedDriver, IsInTheUsersCache) {
    EXPECT_EQ(findFetchedDriver(), m_folder / "cache/q3rt/lavapipe/lvp_icd.json");
    m_environment.set("XDG_CACHE_HOME", "");
    EXPECT_EQ(findFetchedDriver(), m_folder / "home/.cache/q3rt/lavapipe/lvp_icd.json");
    m_environment.set("HOME", "/nonexistent");
    EXPECT_EQ(findFetchedDriver(), "");
    m_environment.set("HOME", nullptr);
    EXPECT_EQ(findFetchedDriver(), "");
}

TEST_F(FetchedDriver, IsAddedWhereNoDriverIsNamed) {
    EXPECT_EQ(variableNamingDrivers(), nullptr);
    offerFetchedDriver();
    EXPECT_EQ(added(), findFetchedDriver().string());
    EXPECT_STREQ(variableNamingDrivers(), "VK_ADD_DRIVER_FILES");
}

TEST_F(FetchedDriver, IsNotForcedOnWhoNamedDrivers) {
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
        m_environment.set(name, "/some/driver.json");
        offerFetchedDriver();
        EXPECT_EQ(added(), "");
        m_environment.set(name, nullptr);
    }
    m_environment.set("VK_ADD_DRIVER_FILES", "/some/driver.json");
    offerFetchedDriver();
    EXPECT_EQ(added(), "/some/driver.json");
}

TEST_F(FetchedDriver, AbsentNothingChanges) {
    m_environment.set("XDG_CACHE_HOME", "/nonexistent");
    offerFetchedDriver();
    EXPECT_EQ(added(), "");
}

} // namespace
} // namespace q3rt

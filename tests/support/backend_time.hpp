#pragma once
// How long pictures of each back end take in the tests: ./test prints the sums.

#include <chrono>
#include <string>

namespace q3rt::test {

/// Its lifetime counts for one back end. The environment variable Q3RT_BACKEND_TIMES names the file that gets a line
/// "BACKEND SECONDS" at the end; without it nothing is written.
class BackendTime {
  public:
    explicit BackendTime(std::string backend)
        : m_backend(std::move(backend)) {}
    ~BackendTime();
    BackendTime(const BackendTime&) = delete;
    BackendTime& operator=(const BackendTime&) = delete;
    void setBackend(std::string backend) { m_backend = std::move(backend); }

  private:
    std::string m_backend;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

} // namespace q3rt::test

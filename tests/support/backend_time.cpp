#include "support/backend_time.hpp"

#include <cstdio>
#include <cstdlib>

namespace q3rt::test {

BackendTime::~BackendTime() {
    const char* path = std::getenv("Q3RT_BACKEND_TIMES");
    if (!path) return;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - m_start;
    // Tests run side by side: a line is one write to the end of the file.
    if (std::FILE* file = std::fopen(path, "a")) {
        std::fprintf(file, "%s %.3f\n", m_backend.c_str(), seconds.count());
        std::fclose(file);
    }
}

} // namespace q3rt::test

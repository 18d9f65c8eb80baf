// bench_replay RECORDING MODULE WIDTHxHEIGHT FIRST COUNT [CVAR=VALUE]...: what a frame of a recording costs a renderer
// module. One line of JSON: processor time of all threads, wall time, heap allocations of our own, memory (resident:
// heap and stacks, files, shared; what a software Vulkan driver allocates for a device is shared). The frames are read
// into memory first; 50 frames before FIRST are drawn and not counted.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/common/session.hpp"
#include "host/headless/replayer.hpp"
#include "metrics/statistics.hpp"
#include "support/allocation_count.hpp"

namespace {

using namespace q3rt;

constexpr int kWarmUpFrames = 50;

double processorMs() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) {
        return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
    };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

double peakMemoryMb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Resident memory of one kind, such as RssAnon.
double residentMb(const std::string& kind) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(kind + ":")) return std::strtod(line.c_str() + kind.size() + 1, nullptr) / 1024;
    return 0;
}

void addCvars(Replayer::Options& options, int argc, char** argv) {
    for (int i = 6; i < argc; ++i) {
        const std::string text = argv[i];
        options.cvars.emplace_back(text.substr(0, text.find('=')), text.substr(text.find('=') + 1));
    }
}

void measure(int argc, char** argv) {
    Replayer::Options options;
    if (std::sscanf(argv[3], "%dx%d", &options.width, &options.height) != 2)
        throw UsageError(std::string(argv[3]) + " is no size: write WIDTHxHEIGHT");
    addCvars(options, argc, argv);
    const int first = std::atoi(argv[4]), count = std::atoi(argv[5]);
    Recording recording{std::filesystem::path(argv[1])};
    RecordedFiles files(recording, {});
    HeadlessEngine engine(files);
    engine.showsMessages = false;
    engine.loadModule(findModule(argv[2]));
    Replayer replayer(recording, engine, options);
    std::vector<Recording::Frame> frames;
    for (size_t i = 0; i < recording.frameCount(); ++i) {
        Recording::Frame frame = recording.readFrame(i);
        if (frame.number >= first + count) break;
        if (frame.number < first - kWarmUpFrames)
            replayer.play(frame, Replayer::Draw::Nothing);
        else
            frames.push_back(std::move(frame));
    }
    std::vector<double> wallMs;
    wallMs.reserve(frames.size());
    double startMs = 0;
    uint64_t startAllocations = 0, framesAllocating = 0;
    auto start = std::chrono::steady_clock::now();
    for (const Recording::Frame& frame : frames) {
        if (frame.number == first) {
            startMs = processorMs();
            startAllocations = test::allocationCount();
            start = std::chrono::steady_clock::now();
        }
        const uint64_t before = test::allocationCount();
        const Replayer::Result result = replayer.play(frame, Replayer::Draw::Frame);
        if (frame.number >= first && test::allocationCount() != before) ++framesAllocating;
        if (frame.number >= first) wallMs.push_back(result.wallMs);
    }
    if (wallMs.empty()) throw UsageError(std::string(argv[1]) + " has no such frames: choose others");
    const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const uint64_t allocations = test::allocationCount() - startAllocations;
    const auto drawn = static_cast<double>(wallMs.size());
    const nlohmann::ordered_json line = {{"module", argv[2]},
                                         {"size", argv[3]},
                                         {"frames", wallMs.size()},
                                         {"processor_ms", (processorMs() - startMs) / drawn},
                                         {"wall_ms", wall / drawn},
                                         {"median_ms", computeQuantile(wallMs, 0.5)},
                                         {"p99_ms", computeQuantile(wallMs, 0.99)},
                                         {"allocations", allocations},
                                         {"frames_allocating", framesAllocating},
                                         {"peak_mb", peakMemoryMb()},
                                         {"heap_mb", residentMb("RssAnon")},
                                         {"file_mb", residentMb("RssFile")},
                                         {"shared_mb", residentMb("RssShmem")},
                                         {"device", engine.config().renderer_string}};
    std::printf("%s\n", line.dump().c_str());
    engine.unloadModule();
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 6) {
        std::fprintf(stderr, "bench_replay RECORDING MODULE WIDTHxHEIGHT FIRST COUNT [CVAR=VALUE]...\n");
        return 2;
    }
    try {
        measure(argc, argv);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_replay: %s\n", error.what());
        return 1;
    }
}

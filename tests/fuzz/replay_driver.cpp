// Runs a fuzz target without a fuzzer: over each seed file, then over a fixed, repeatable series of mutations of them.
// Usage: replay_NAME FOLDER [MUTATIONS]. A crash or a broken promise ends the program; the input is left as a file.

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

using Input = std::vector<uint8_t>;

constexpr size_t kDefaultMutations = 4000;

/// splitmix64: the same series everywhere.
class Random {
  public:
    uint64_t next() {
        uint64_t z = m_state += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    /// 0 .. bound - 1
    size_t below(size_t bound) { return static_cast<size_t>(next() % bound); }

  private:
    uint64_t m_state = 1;
};

constexpr uint32_t kTellingNumbers[] = {0,          1,          2,          0x7F,       0x80,       0xFF,
                                        0x7FFF,     0x8000,     0xFFFF,     0x10000,    0x7FFFFFFF, 0x80000000,
                                        0xFFFFFFFF, 0xFFFFFFFE, 0x40000000, 0x20000001, 0x7F800000, 0x7FC00000,
                                        0x0A0A0A0A, 0x7B7B7B7B, 0x7D7D7D7D};

void mutateOnce(Input& input, const Input& other, Random& random) {
    if (input.empty()) {
        input = other;
        return;
    }
    const size_t at = random.below(input.size());
    const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
    const size_t room = input.size() - at;
    switch (random.below(7)) {
    case 0:
        *place ^= static_cast<uint8_t>(1u << random.below(8));
        break;
    case 1:
        *place = static_cast<uint8_t>(random.next());
        break;
    case 2: {
        const uint32_t number = kTellingNumbers[random.below(std::size(kTellingNumbers))];
        std::memcpy(&*place, &number, std::min(room, sizeof(number)));
        break;
    }
    case 3:
        input.resize(at);
        break;
    case 4:
        input.erase(place, place + static_cast<std::ptrdiff_t>(1 + random.below(std::min<size_t>(room, 64))));
        break;
    case 5: {
        const Input copy(place, place + static_cast<std::ptrdiff_t>(1 + random.below(std::min<size_t>(room, 64))));
        input.insert(input.begin() + static_cast<std::ptrdiff_t>(random.below(input.size())), copy.begin(), copy.end());
        break;
    }
    default: { // the head of this one, the tail of the other
        if (other.empty()) break;
        input.resize(at);
        input.insert(input.end(), other.begin() + static_cast<std::ptrdiff_t>(random.below(other.size())), other.end());
        break;
    }
    }
}

std::vector<Input> readSeeds(const std::string& folder) {
    std::vector<std::filesystem::path> paths;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        paths.push_back(entry->path());
    std::sort(paths.begin(), paths.end());
    std::vector<Input> seeds;
    for (const auto& path : paths) {
        std::ifstream file(path, std::ios::binary);
        seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return seeds;
}

Input theInput;
std::string theCrashFile;

/// Leaves the input behind. Not strictly allowed in a signal handler, but the process is lost anyway.
void saveInput(int signal) {
    std::signal(signal, SIG_DFL);
    if (FILE* file = std::fopen(theCrashFile.c_str(), "wb")) {
        std::fwrite(theInput.data(), 1, theInput.size(), file);
        std::fclose(file);
        std::fprintf(stderr, "the input that did it: %s\n", theCrashFile.c_str());
    }
    std::raise(signal);
}

void runInput(Input input) {
    theInput = std::move(input);
    LLVMFuzzerTestOneInput(theInput.data(), theInput.size());
}

} // namespace

int main(int argumentCount, char** arguments) {
    if (argumentCount < 2) {
        std::fprintf(stderr, "usage: %s FOLDER [MUTATIONS]\n", arguments[0]);
        return 2;
    }
    const size_t mutations = argumentCount > 2 ? std::strtoul(arguments[2], nullptr, 10) : kDefaultMutations;
    theCrashFile = std::string(arguments[0]) + ".crash";
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL})
        std::signal(signal, saveInput);
    const std::vector<Input> seeds = readSeeds(arguments[1]);
    if (seeds.empty()) {
        std::fprintf(stderr, "%s: no seeds there; run make_corpus first\n", arguments[1]);
        return 1;
    }
    runInput({});
    for (const Input& seed : seeds)
        runInput(seed);
    Random random;
    for (size_t i = 0; i < mutations; ++i) {
        Input input = seeds[random.below(seeds.size())];
        const size_t steps = 1 + random.below(4);
        for (size_t step = 0; step < steps; ++step)
            mutateOnce(input, seeds[random.below(seeds.size())], random);
        runInput(std::move(input));
    }
    std::printf("%zu seeds and %zu mutations: no crash\n", seeds.size(), mutations);
    return 0;
}

// Functions that the driver computes, against double precision. Bounds: Vulkan 1.3, "Precision and Operation of SPIR-V
// Instructions"; acos has none that says anything, so it has one that the sky's clouds can live with.

#include <cmath>
#include <cstring>
#include <functional>

#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/gpu_test.hpp"
#include "gpu/readback.hpp"
#include "gpu/uploader.hpp"
#include "numerics/measured.hpp"
#include "spirv/shaders_functions_comp.hpp"

namespace q3rt::test {
namespace {

constexpr double kUlp = 0x1p-23; ///< of a value in [1, 2): the largest relative step

struct DeviceFunction {
    const char* name;
    double low, high;
    bool logarithmic; ///< how the arguments are spread
    std::function<double(double)> exact;
    bool relative;                       ///< else the error is absolute
    std::function<double(double)> bound; ///< by argument
};

std::vector<DeviceFunction> listFunctions() {
    const auto constant = [](double value) { return [value](double) { return value; }; };
    return {
        {"inversesqrt", 1e-30, 1e30, true, [](double x) { return 1 / std::sqrt(x); }, true, constant(2 * kUlp)},
        {"sqrt", 1e-30, 1e30, true, [](double x) { return std::sqrt(x); }, true, constant(4.5 * kUlp)},
        {"1 / x", 1e-30, 1e30, true, [](double x) { return 1 / x; }, true, constant(2.5 * kUlp)},
        {"exp", -80, 80, false, [](double x) { return std::exp(x); }, true,
         [](double x) { return (3 + 2 * std::abs(x)) * kUlp; }},
        {"acos", -1, 1, false, [](double x) { return std::acos(x); }, false, constant(1e-3)},
        {"sin", -M_PI, M_PI, false, [](double x) { return std::sin(x); }, false, constant(0x1p-11)},
        {"cos", -M_PI, M_PI, false, [](double x) { return std::cos(x); }, false, constant(0x1p-11)},
        {"length of normalize", 1e-15, 1e15, true, [](double) { return 1.0; }, true, constant(8 * kUlp)},
        {"pow(x, 2.4)", 1e-4, 1, true, [](double x) { return std::pow(x, static_cast<double>(2.4f)); }, true,
         // exp2(y log2 x): 3 ulp of log2 (2^-21 near 1), times y, then those of exp2.
         [](double x) { return (3 + 2.4 * std::abs(std::log2(x)) * 4 + 3) * kUlp + 2.4 * 0x1p-21; }},
    };
}

class DeviceFunctions : public GpuTest {
  protected:
    std::vector<float> evaluate(uint32_t function, const std::vector<float>& arguments) {
        const VkDeviceSize bytes = arguments.size() * sizeof(float);
        const Buffer in(device(), {.size = bytes, .name = "arguments"});
        const Buffer out(device(), {.size = bytes, .name = "results"});
        Uploader uploader(device());
        uploader.upload(in, std::span<const float>(arguments));
        uploader.flush();
        const DescriptorLayout layout(device(), {{0}, {1}});
        const uint32_t push[2] = {function, static_cast<uint32_t>(arguments.size())};
        const ComputePipeline pipeline(device(), {.name = "functions",
                                                  .shader = {shaders::shaders_functions_comp},
                                                  .interface = {{layout.handle()}, sizeof(push)}});
        DescriptorArena arena(device());
        const VkDescriptorSet set =
            arena.make(layout, {bindStorageBuffer(0, in.handle()), bindStorageBuffer(1, out.handle())});
        device().submitAndWait([&](VkCommandBuffer commands) {
            pipeline.bind(commands);
            pipeline.bindSets(commands, {set});
            pipeline.push(commands, push);
            pipeline.dispatch(commands, (push[1] + 63) / 64);
        });
        const std::vector<std::byte> read = readBuffer(device(), out);
        std::vector<float> results(arguments.size());
        std::memcpy(results.data(), read.data(), bytes);
        return results;
    }
};

TEST_F(DeviceFunctions, StayWithinTheirBounds) {
    constexpr int kCount = 1 << 16;
    uint32_t number = 0;
    std::printf("device: %s\n", device().capabilities().deviceName.c_str());
    for (const DeviceFunction& f : listFunctions()) {
        std::vector<float> arguments;
        for (int i = 0; i < kCount; ++i) {
            const double share = i / double(kCount - 1);
            arguments.push_back(static_cast<float>(f.logarithmic ? f.low * std::pow(f.high / f.low, share)
                                                                 : f.low + (f.high - f.low) * share));
        }
        const std::vector<float> results = evaluate(number++, arguments);
        double worst = 0, ofBound = 0;
        for (size_t i = 0; i < results.size(); ++i) {
            const double x = arguments[i], exact = f.exact(x);
            const double error = std::abs(double(results[i]) - exact) / (f.relative ? std::abs(exact) : 1);
            // NaN compares as nothing: it must not hide.
            worst = error <= worst ? worst : error;
            ofBound = error / f.bound(x) <= ofBound ? ofBound : error / f.bound(x);
        }
        std::printf("numerics | %s on the device | worst %s error %.2g\n", f.name, f.relative ? "relative" : "absolute",
                    worst);
        expectWithin(std::string(f.name) + " on the device", ofBound, 1, "of the bound");
    }
}

} // namespace
} // namespace q3rt::test

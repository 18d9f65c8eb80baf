#include "relight/relight.hpp"

#include <algorithm>
#include <limits>

#include "relight/lost_units.hpp"

namespace q3rt {
namespace {

/// Luxels that the score is taken from.
constexpr size_t kScoredLuxels = 4000;
constexpr size_t kFirstLights = 2;
/// What q3map2 keeps of a bounce (spec of baked light: 500 x 0.375 x 3 x 0.25 / 255 by form factors); the fit finds
/// what a map has.
constexpr float kCompilerBounce = 0.55f;

/// Lights there may be after each stage: doubled until the budget is used, then once more for suns.
std::vector<size_t> planStages(size_t budget) {
    std::vector<size_t> counts{0};
    for (size_t count = kFirstLights; count < budget; count *= 2)
        counts.push_back(count);
    counts.push_back(budget);
    counts.push_back(budget);
    return counts;
}

/// Steps of the work: what is computed once, then what settling a light and finding a light takes.
constexpr size_t kInputSteps = 500, kSettleSteps = 1, kSearchSteps = 3, kScoreSteps = 60;

/// Lights, their places and bounces are settled in turn until a round takes no more than this off the cost.
constexpr double kSettledShare = 0.97;
constexpr int kMostSettlings = 4;

size_t stepsOfStage(size_t stage, const std::vector<size_t>& counts) {
    const size_t before = stage > 0 ? counts[stage - 1] : 0;
    return kSettleSteps * counts[stage] + kSearchSteps * (counts[stage] - before);
}

void runStage(RelightModel& model, size_t stage, const std::vector<size_t>& counts,
              const std::function<void(size_t)>& found) {
    const bool isLast = stage + 1 == counts.size();
    if (stage == 0) model.solveFirst();
    if (stage == 0 || isLast) model.addSuns();
    if (counts[stage] > model.pointCount() && !isLast) model.addPoints(counts[stage] - model.pointCount(), found);
    double cost = model.cost();
    for (int i = 0; i < kMostSettlings; ++i) {
        model.settle();
        if (model.cost() > kSettledShare * cost) break;
        cost = model.cost();
    }
}

/// Did the compiler let surfaces that shine end (q3map2 -fast)? What explains more before any light is found.
float findSurfaceEnd(const RelightInput& input, LostLights scripted) {
    float best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (const float faintest : {0.0f, kFaintestLight}) {
        scripted.faintestSurface = faintest;
        RelightModel model(input, scripted);
        model.solveFirst();
        if (model.cost() < least) best = faintest;
        least = std::min(least, model.cost());
    }
    return best;
}

/// As a file has them: rounded, so that a run goes on from the same numbers whether it was broken off or not.
LostLights throughText(const LostLights& lights) { return parseLostLights(formatLostLights(lights, ""), "lights"); }

double shownShareOf(const RelightInput& input) {
    double shown = 0, all = 0;
    for (size_t i = 0; i < input.isShown.size(); ++i) {
        all += input.scene.luxels.patches[i].areaQu2;
        if (input.isShown[i]) shown += input.scene.luxels.patches[i].areaQu2;
    }
    return all > 0 ? shown / all : 0;
}

} // namespace

RelightResult relight(const World& world, const MaterialLibrary& materials, const RelightSettings& settings,
                      const LostLights* begun, const RelightProgress& progress) {
    const std::vector<size_t> counts = planStages(settings.budget);
    const size_t first = begun ? std::min(begun->stage, counts.size()) : 0;
    size_t done = 0, all = kInputSteps + kScoreSteps;
    for (size_t stage = first; stage < counts.size(); ++stage)
        all += stepsOfStage(stage, counts);
    const auto advance = [&](size_t steps) {
        if (progress.step) progress.step(steps, all);
    };
    advance(0);
    RelightResult result;
    const RelightInput input(world, materials, settings);
    result.patchCount = input.scene.luxels.patches.size();
    result.luxelCount = input.scene.luxels.luxels.size();
    if (result.luxelCount == 0) return result;
    result.shownShare = shownShareOf(input);
    LostLights scripted = input.scripted();
    scripted.bounce = kCompilerBounce;
    result.before = RelightModel(input, scripted).scoreHeldOut(kScoredLuxels);
    if (!begun) scripted.faintestSurface = findSurfaceEnd(input, scripted);
    result.lights = begun ? *begun : scripted;
    advance(done = kInputSteps);
    for (size_t stage = first; stage < counts.size(); ++stage) {
        RelightModel model(input, result.lights);
        runStage(model, stage, counts, [&](size_t found) { advance(done + kSearchSteps * found); });
        result.stages.push_back({model.pointCount(), model.cost(), model.score()});
        LostLights lights = model.lights();
        lights.stage = stage + 1;
        lights.budget = settings.budget;
        result.lights = throughText(lights);
        if (progress.stage) progress.stage(result.lights);
        advance(done += stepsOfStage(stage, counts));
    }
    result.after = RelightModel(input, result.lights).scoreHeldOut(kScoredLuxels);
    result.lights.stage = result.lights.budget = 0;
    advance(all);
    return result;
}

} // namespace q3rt

#include "measure/TechniqueBench.h"

namespace lucent::measure {

Result<std::vector<BenchMesh>> dragonsOf(const BenchAssets& assets) {
    auto dragons = assets.meshes({"dragon-4k", "dragon-40k", "dragon"});
    if (dragons && dragons->size() < 3) dragons->clear();
    return dragons;
}

std::vector<const BenchPart*> benchParts() {
    std::vector<const BenchPart*> parts;
    for (const TechniqueBench* bench : benches())
        for (const BenchPart& part : bench->parts)
            parts.push_back(&part);
    return parts;
}

std::vector<const BenchPart*> benchParts(std::string_view name) {
    std::vector<const BenchPart*> parts = benchParts();
    std::erase_if(parts, [&](const BenchPart* part) {
        return part->name != name && !(name == "all" && part->isUsual);
    });
    return parts;
}

Result<Plan> planOf(std::span<const BenchPart* const> parts, const BenchAssets& assets, bool quick) {
    Plan plan;
    plan.quick = quick;
    plan.repeats = quick ? Repeats{3, 15, 150} : Repeats{5, 31, 1000};
    for (const BenchPart* part : parts)
        if (part->plan)
            if (Status planned = part->plan(plan, assets); !planned) return planned.error();
    return plan;
}

} // namespace lucent::measure

#include "measure/Plan.h"

namespace lucent::measure {

std::string Setting::name() const {
    std::string text = method;
    for (const auto& [knob, value] : knobs)
        text += " " + knob + "=" + value;
    return text;
}

std::string Series::name() const { return setting.name() + (part.empty() ? "" : ", " + part); }

Timed timedLight() {
    return {[](scene::Scene&) {},
            [](scene::Scene& scene) {
                scene.lights.clear();
                scene.environment.reset();
            }};
}

const Measurement* measured(const BenchReport& report, std::string_view technique, const std::string& scene,
                            const Setting& setting) {
    for (const Measurement& m : report.measurements)
        if (m.technique == technique && m.scene == scene && m.method == setting.method &&
            m.knobs == setting.knobs && m.error && m.ms)
            return &m;
    return nullptr;
}

void append(Plan& plan, const Plan& more) {
    const auto add = [](auto& list, const auto& others) {
        list.insert(list.end(), others.begin(), others.end());
    };
    add(plan.cases, more.cases);
    add(plan.series, more.series);
    add(plan.hard, more.hard);
    add(plan.ratios, more.ratios);
}

} // namespace lucent::measure

#include "measure/Plan.h"

#include "technique/Technique.h"

#include <algorithm>

namespace lucent::measure {

namespace {

// The parameter of a technique that chooses among its methods; "" where none does.
std::string methodParam(const std::string& technique, const std::string& method) {
    for (const ParamTable* table : technique::tables()) {
        if (table->name != technique) continue;
        const auto found = std::find_if(table->params.begin(), table->params.end(), [&](const Param& param) {
            return param.id == "method" ||
                   std::find(param.choices.begin(), param.choices.end(), method) != param.choices.end();
        });
        if (found != table->params.end()) return std::string(found->id);
    }
    return "";
}

} // namespace

std::string Setting::name() const {
    std::string text = method;
    for (const auto& [knob, value] : knobs)
        text += " " + knob + "=" + value;
    return text;
}

Status Setting::putInto(scene::Scene& scene, const std::string& technique) const {
    const std::string place = "technique." + technique + ".";
    const std::string param = methodParam(technique, method);
    if (!param.empty())
        if (Status set = setParam(scene, place + param, method); !set) return set;
    for (const auto& [knob, value] : knobs)
        if (Status set = setParam(scene, (knob.find('.') == knob.npos ? place : "technique.") + knob, value);
            !set)
            return set;
    return Done{};
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

} // namespace lucent::measure

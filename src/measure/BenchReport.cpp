#include "measure/BenchReport.h"

#include "base/JsonWriter.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <tuple>

namespace lucent::measure {

namespace {

const char* nameOf(HardResult::Status status) {
    switch (status) {
    case HardResult::Status::Pass:
        return "pass";
    case HardResult::Status::Error:
        return "error";
    case HardResult::Status::Refused:
        return "refused";
    }
    return "";
}

void write(JsonWriter& json, const Machine& machine) {
    json.key("machine").beginObject();
    if (!machine.cpu.empty()) json.key("cpu").value(machine.cpu);
    if (machine.cores > 0) json.key("cores").value(machine.cores);
    if (machine.memoryMB > 0) json.key("memoryMB").value(machine.memoryMB);
    json.key("where").value(machine.where);
    json.key("driver").value(machine.driver);
    json.key("version").value(machine.version);
    if (!machine.browser.empty()) json.key("browser").value(machine.browser);
    json.end();
}

void write(JsonWriter& json, std::string_view name, const std::optional<Metrics>& metrics) {
    if (!metrics) return;
    json.key(name).beginObject();
    writeMembers(json, *metrics);
    json.end();
}

void write(JsonWriter& json, const Measurement& m) {
    json.beginObject();
    json.key("technique").value(m.technique).key("scene").value(m.scene).key("method").value(m.method);
    json.key("knobs").beginObject();
    for (const auto& [name, value] : m.knobs) {
        char* end = nullptr;
        const double number = std::strtod(value.c_str(), &end);
        json.key(name);
        *end == 0 ? json.value(number) : json.value(value);
    }
    json.end();
    json.key("width").value(m.size.x).key("height").value(m.size.y).key("lights").value(m.lights);
    if (m.ms) {
        json.key("ms").beginObject();
        json.key("median").value(m.ms->median).key("low").value(m.ms->low).key("high").value(m.ms->high);
        json.key("repeats").value(m.ms->repeats).end();
    }
    if (m.bakeMs) json.key("bakeMs").value(*m.bakeMs);
    if (m.refused.empty()) {
        json.key("passes").value(m.passes).key("draws").value(m.draws);
        json.key("bytes").value(double(m.bytes));
        json.key("truthNoise").value(m.truthNoise).key("pareto").value(m.pareto);
    }
    write(json, "error", m.error);
    write(json, "modelError", m.modelError);
    if (!m.refused.empty()) json.key("refused").value(m.refused);
    json.end();
}

void write(JsonWriter& json, const ScalingSeries& series) {
    json.beginObject();
    json.key("technique").value(series.technique).key("method").value(series.method);
    json.key("over").value(series.over);
    json.key("points").beginArray();
    for (const dvec2& point : series.points)
        json.beginObject().key("x").value(point.x).key("ms").value(point.y).end();
    json.end();
    json.key("exponent").value(series.exponent()).end();
}

void write(JsonWriter& json, const HardResult& hard) {
    json.beginObject();
    json.key("name").value(hard.name).key("method").value(hard.method);
    json.key("status").value(nameOf(hard.status));
    if (hard.status != HardResult::Status::Refused) json.key("error").value(hard.error);
    if (!hard.message.empty()) json.key("message").value(hard.message);
    json.end();
}

void write(JsonWriter& json, const Ratio& ratio) {
    json.beginObject();
    json.key("name").value(ratio.name).key("value").value(ratio.value);
    if (ratio.target) {
        json.key("target").value(*ratio.target).key("atLeast").value(ratio.atLeast);
        json.key("met").value(ratio.met());
    }
    json.end();
}

// What settings are weighed by.
double decisive(const Metrics& error) {
    return error.angles ? error.angles->all.median : error.flux ? error.flux->misplaced : error.rmse;
}

std::string errorText(const Metrics& error) {
    if (error.flux)
        return formatted("  misplaced %.2f %% (noise %.2f %%), encircled %.2f %%, flux %.4f, RMSE %.2e",
                         100 * error.flux->misplaced, 100 * error.flux->byNoise, 100 * error.flux->encircled,
                         error.fluxRatio, error.rmse);
    if (!error.angles) return formatted("  RMSE %.2e, %.2e of the mean", error.rmse, error.relRmse);
    const auto part = [](const char* where, const Angles& angles) {
        return formatted("  %s: %.3g degrees, 95 %% %.3g, 99 %% %.3g, lost %.2g %%", where, angles.median,
                         angles.p95, angles.p99, 100 * angles.lost);
    };
    return part("all", error.angles->all) + part("inside", error.angles->inside);
}

template <class Item>
void writeList(JsonWriter& json, std::string_view name, const std::vector<Item>& items) {
    json.key(name).beginArray();
    for (const Item& item : items)
        write(json, item);
    json.end();
}

} // namespace

void BenchReport::markParetoFronts() {
    using Key = std::tuple<std::string, std::string, int, int>;
    std::map<Key, std::vector<Measurement*>> groups;
    for (Measurement& m : measurements) {
        m.pareto = false;
        if (m.ms && m.error) groups[{m.technique, m.scene, m.size.x, m.size.y}].push_back(&m);
    }
    for (const auto& [key, group] : groups) {
        std::vector<dvec2> points;
        for (const Measurement* m : group)
            points.push_back({m->ms->median, decisive(*m->error)});
        const std::vector<bool> front = paretoFront(points);
        for (std::size_t i = 0; i < group.size(); ++i)
            group[i]->pareto = front[i];
    }
}

std::string BenchReport::json() const {
    JsonWriter json;
    json.beginObject();
    json.key("format").value("lucent-bench-1").key("date").value(date).key("commit").value(commit);
    json.key("quick").value(quick);
    write(json, machine);
    json.key("timing").value(timing);
    if (contextMB > 0)
        json.key("memory").beginObject().key("contextMB").value(contextMB).key("peakMB").value(peakMB).end();
    writeList(json, "measurements", measurements);
    writeList(json, "scaling", scaling);
    writeList(json, "hardCases", hardCases);
    writeList(json, "ratios", ratios);
    json.end();
    return json.text();
}

std::string BenchReport::text() const {
    std::string out = machine.driver + ", times by " + timing + "\n";
    for (const Measurement& m : measurements) {
        std::string name = m.method;
        for (const auto& [knob, value] : m.knobs)
            name += " " + knob + "=" + value;
        out += formatted("  %-20s %4dx%-4d %-40s ", m.scene.c_str(), m.size.x, m.size.y, name.c_str());
        if (!m.refused.empty()) {
            out += "refused: " + m.refused + "\n";
            continue;
        }
        out += formatted("%10.3f ms (%.3f to %.3f)", m.ms->median, m.ms->low, m.ms->high);
        if (m.error) out += errorText(*m.error);
        if (m.modelError) out += formatted("  model error %.2e", m.modelError->rmse);
        if (m.modelError && m.modelError->flux)
            out += formatted(", misplaced %.2f %%", 100 * m.modelError->flux->misplaced);
        out += m.pareto ? "  *\n" : "\n";
    }
    for (const ScalingSeries& series : scaling)
        out += formatted("  %s over %s: time grows with the power %.2f\n", series.method.c_str(),
                         series.over.c_str(), series.exponent());
    std::map<std::string, std::array<int, 3>> counts; // of hard cases, by status
    for (const HardResult& hard : hardCases)
        ++counts[hard.method][std::size_t(hard.status)];
    for (const auto& [method, count] : counts)
        out += formatted("  hard cases by %s: %d pass, %d with an error, %d refused with a message\n",
                         method.c_str(), count[0], count[1], count[2]);
    for (const Ratio& ratio : ratios) {
        out += formatted("  %s: %.4g", ratio.name.c_str(), ratio.value);
        if (ratio.target)
            out += formatted(" (target %s %.4g: %s)", ratio.atLeast ? "at least" : "at most", *ratio.target,
                             ratio.met() ? "met" : "missed");
        out += "\n";
    }
    return out;
}

} // namespace lucent::measure

#include "measure/BudgetReport.h"

#include "base/JsonWriter.h"

#include <cmath>

namespace lucent::measure {

double relativeError(const Image& image, const Image& exact) {
    double sum = 0, mean = 0, covered = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); i += 4) {
        if (exact.pixels[i + 3] == 0) continue;
        covered += 3;
        for (std::size_t c = i; c < i + 3; ++c) {
            const double d = double(image.pixels[c]) - exact.pixels[c];
            sum += d * d;
            mean += exact.pixels[c];
        }
    }
    return std::sqrt(sum / covered) / (mean / covered);
}

Proof BudgetReport::proof() const { return {totals(), text(), json()}; }

std::string BudgetReport::text() const {
    std::string out;
    for (const BudgetResult& r : results)
        out +=
            formatted("  %-34s wanted %.3f got %.4f %s, %.0f ms (+ %.0f choosing) against %.0f ms %s: %s\n",
                      r.scene.c_str(), double(r.wanted), r.error, r.kept() ? "    " : "MISS", r.ms, r.planMs,
                      r.bestMs, r.quick() ? "    " : "SLOW", r.chosen.c_str());
    for (const Ratio& total : totals())
        out += formatted("  %s: %.3f\n", total.name.c_str(), total.value);
    return out;
}

std::vector<Ratio> BudgetReport::totals() const {
    std::vector<Ratio> list;
    for (float wanted : kWantedErrors) {
        int count = 0, kept = 0, quick = 0, possible = 0;
        for (const BudgetResult& r : results) {
            if (r.wanted != wanted) continue;
            ++count;
            kept += r.kept();
            quick += r.quick();
            possible += r.bestMs > 0;
        }
        const std::string name = formatted("maxError %.3f on %d %s: ", double(wanted), count, what.c_str());
        list.push_back({name + "share that keeps it", double(kept) / count, 0.95, true});
        list.push_back({name + "share within 1.5 of the best time", double(quick) / count, 0.95, true});
        list.push_back({name + "share where any setting keeps it", double(possible) / count, {}, true});
    }
    return list;
}

std::string BudgetReport::json() const {
    JsonWriter json;
    json.beginObject();
    json.key("format").value("lucent-budget-1");
    json.key("results").beginArray();
    for (const BudgetResult& r : results) {
        json.beginObject();
        json.key("scene").value(r.scene);
        json.key("wanted").value(r.wanted);
        json.key("chosen").value(r.chosen);
        json.key("predicted").value(r.predicted);
        json.key("error").value(r.error);
        json.key("ms").value(r.ms);
        json.key("planMs").value(r.planMs);
        json.key("bestMs").value(r.bestMs);
        json.key("best").value(r.best);
        json.end();
    }
    json.end();
    json.end();
    return json.text();
}

} // namespace lucent::measure

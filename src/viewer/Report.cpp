#include "viewer/Report.h"

#include "base/JsonWriter.h"

namespace lucent::viewer {

namespace {

std::string_view kindName(Kind kind) {
    constexpr std::string_view names[] = {"number", "integer", "toggle", "choice",
                                          "color",  "vector",  "range",  "pair"};
    return names[int(kind)];
}

void writeControl(JsonWriter& json, const Control& control, std::span<const Control> all) {
    const BoundParam& bound = control.bound;
    const Param& param = *bound.param;
    json.beginObject();
    json.key("path").value(bound.path).key("attribute").value(attributeName(bound));
    json.key("label").value(param.label).key("unit").value(param.unit);
    json.key("group").value(name(bound.group())).key("doc").value(param.doc);
    json.key("owner").value(headingOf(control, all));
    json.key("kind").value(kindName(param.kind)).key("components").value(componentCount(param.kind));
    json.key("min").value(param.min).key("max").value(param.max);
    json.key("low").value(param.low).key("high").value(param.high);
    json.key("logarithmic").value(param.logarithmic).key("axes").value(param.axes);
    json.key("choices").beginArray();
    for (const std::string_view choice : control.choices)
        json.value(choice);
    json.end();
    json.key("value").value(getText(param, bound.data)).key("default").value(control.loaded);
    json.end();
}

void writeAction(JsonWriter& json, const Action& action) {
    json.beginObject();
    json.key("path").value(action.path).key("attribute").value("").key("label").value(action.label);
    json.key("group").value(name(action.group)).key("doc").value(action.doc);
    json.key("owner").value("").key("kind").value("action").key("choices").beginArray().end();
    json.key("value").value("").key("default").value("").end();
}

// W of each colour.
void writeBalance(JsonWriter& json, const technique::Balance& balance) {
    json.beginObject();
    for (const auto& [name, watts] : balance) {
        const float numbers[] = {float(watts.r), float(watts.g), float(watts.b)};
        json.key(name).value(std::span<const float>(numbers));
    }
    json.end();
}

void writePlace(JsonWriter& json, vec2 place) {
    const float numbers[] = {place.x, place.y};
    json.value(std::span<const float>(numbers));
}

void writeRect(JsonWriter& json, const Rect& rect) {
    const float place[] = {rect.low.x, rect.low.y, rect.high.x - rect.low.x, rect.high.y - rect.low.y};
    json.value(std::span<const float>(place));
}

void writeNumbers(JsonWriter& json, const measure::Metrics& found) {
    json.key("rmse").value(found.rmse).key("relRmse").value(found.relRmse);
    json.key("max").value(found.maximum).key("bias").value(found.bias);
    json.key("p99").value(found.p99).key("full").value(fullScale(found.p99));
    if (found.flip) json.key("flip").value(*found.flip);
}

} // namespace

std::string controlsJson(std::span<const Control> controls, std::span<const Action> actions) {
    JsonWriter json;
    json.beginArray();
    for (const Control& control : controls)
        writeControl(json, control, controls);
    for (const Action& action : actions)
        writeAction(json, action);
    json.end();
    return json.text();
}

std::string changesJson(std::span<const Control> controls, const void* leftOut) {
    JsonWriter json;
    json.beginObject();
    for (const Control& control : controls) {
        const std::string now = getText(*control.bound.param, control.bound.data);
        if (control.bound.isDerived() || control.bound.data == leftOut) continue;
        if (now != control.loaded) json.key(control.bound.path).value(now);
    }
    json.end();
    return json.text();
}

std::string statsJson(const StatsInput& input) {
    JsonWriter json;
    json.beginObject();
    json.key("milliseconds").value(input.cost.milliseconds).key("passes").value(input.cost.passes);
    json.key("draws").value(input.cost.draws).key("lights").value(input.cost.lights);
    json.key("bytes").value(double(input.cost.bytes)).key("complete").value(input.complete);
    json.key("finished").value(input.finished).key("shown").value(input.shown);
    writePlace(json.key("open"), input.open);
    json.key("canUndo").value(input.canUndo).key("canRedo").value(input.canRedo);
    json.key("downscale").value(input.downscale);
    if (input.progress) {
        json.key("progress").beginObject().key("task").value(input.progress->task);
        json.key("share").value(input.progress->share);
        if (input.progress->secondsLeft) json.key("secondsLeft").value(*input.progress->secondsLeft);
        json.end();
    }
    if (!input.bakeWork.empty()) {
        json.key("bake").beginObject().key("technique").value(input.bakeTechnique);
        json.key("object").value(input.bakeObject).key("work").value(input.bakeWork).end();
    }
    json.key("settings").value(input.cost.settings).key("predicted").value(input.cost.predicted);
    json.key("pictures").value(input.pictures).key("reprojected").value(input.reprojected);
    json.key("frames").value(input.frames).key("revision").value(double(input.revision));
    if (input.light < input.lamps.size()) writePlace(json.key("light"), input.lamps[input.light].place);
    json.key("lamps").beginArray();
    for (const LightHandle& lamp : input.lamps) {
        writePlace(json.beginObject().key("place"), lamp.place);
        json.key("outside").value(lamp.towards.has_value()).end();
    }
    json.end();
    json.key("modes").beginArray();
    for (const Mode mode : input.modes)
        json.value(nameOf(mode));
    json.end().key("notDrawn").beginArray();
    for (const std::string& line : input.notDrawn)
        json.value(line);
    json.end();
    if (!input.balance.empty()) writeBalance(json.key("energy"), input.balance);
    json.key("panel").beginObject();
    for (const auto& [path, rect] : input.widgets)
        writeRect(json.key(path), rect);
    json.end().end();
    return json.text();
}

std::string comparisonJson(const ComparisonReport& report) {
    JsonWriter json;
    json.beginObject();
    json.key("mode").value(report.mode).key("divider").value(report.divider);
    json.key("truth").value(report.truth);
    const float size[] = {float(report.size.x), float(report.size.y)};
    json.key("size").value(std::span<const float>(size));
    if (report.noise) json.key("noise").value(*report.noise);
    if (report.place) writeRect(json.key("place"), *report.place);
    json.key("pixelsPerCssPixel").value(report.scale);
    if (report.numbers) writeNumbers(json, *report.numbers);
    if (!report.left.empty()) {
        json.key("left").value(report.left).key("right").beginObject();
        json.key("name").value(report.right);
        if (report.rightNumbers) writeNumbers(json, *report.rightNumbers);
        json.end();
    }
    json.key("milliseconds").value(report.cost.milliseconds).key("passes").value(report.cost.passes);
    json.end();
    return json.text();
}

} // namespace lucent::viewer

// lucent list: techniques, methods and parameters, from their declarations.
#include "cli/Command.h"

#include "base/JsonWriter.h"
#include "base/Param.h"
#include "base/Text.h"
#include "frame/Renderer.h"
#include "scene/Displacement.h"
#include "scene/Keys.h"
#include "scene/Scene.h"
#include "scene/Translucency.h"
#include "technique/Technique.h"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace lucent::cli {

namespace {
/// Parameters that stand together in a scene file.
struct Section {
    std::string title;
    std::string path; ///< before the parameter's id in --set
    const ParamTable* table;
};

std::vector<Section> sections() {
    std::vector<Section> all;
    for (const ParamTable* table : technique::tables())
        all.push_back(
            {"technique " + std::string(table->name), "technique." + std::string(table->name), table});
    for (const scene::TypeKeys& shape : scene::shapeTypes())
        all.push_back({"shape " + std::string(shape.type), "objects.NAME.shape", shape.keys.tables[0]});
    const std::string material = "objects.NAME.material";
    all.push_back({"material", material, &scene::choiceParams()});
    all.push_back({"material: relief, matt and glossy, or painted", material, &scene::colorParams()});
    all.push_back({"material: relief", material, &scene::reliefParams()});
    all.push_back({"material: clear", material, &scene::clearParams()});
    all.push_back({"material: translucent", material, &scene::translucentParams()});
    all.push_back({"absorption of both in other words", material, &scene::attenuationParams()});
    all.push_back({"layer on what scatters light", material + ".layers.N", &scene::layerParams()});
    all.push_back({"the same in other words, not in files", material, &scene::translucencyParams()});
    all.push_back({"material: glossy", material, &scene::glossyParams()});
    all.push_back({"material: phong", material, &scene::phongParams()});
    all.push_back({"material: blinn", material, &scene::blinnParams()});
    all.push_back({"material: cook-torrance", material, &scene::cookTorranceParams()});
    all.push_back({"material: oren-nayar", material, &scene::orenNayarParams()});
    all.push_back({"material: measured", material, &scene::measuredParams()});
    all.push_back({"transform", "objects.NAME.transform", &scene::transformParams()});
    all.push_back({"displacement of planes, spheres, tori and meshes", "objects.NAME.displacement",
                   &scene::displacementParams()});
    all.push_back({"wave, not of height fields and water", "objects.NAME.wave", &scene::waveParams()});
    for (const scene::TypeKeys& light : scene::lightTypes())
        for (const ParamTable* table : light.keys.tables)
            all.push_back({table == &scene::projectorParams() ? "projector, a spot light with an image"
                                                              : std::string(light.type) + " light",
                           "lights.N", table});
    all.push_back({"environment", "environment", &scene::environmentParams()});
    all.push_back({"camera", "camera", &scene::cameraParams()});
    all.push_back({"view", "view", &scene::viewParams()});
    all.push_back({"quality", "quality", &scene::qualityParams()});
    return all;
}

const void* defaultOf(const ParamTable& table, const Param& param) {
    return static_cast<const std::byte*>(table.defaults) + param.offset;
}

std::string_view kindName(Kind kind) {
    switch (kind) {
    case Kind::Number:
        return "number";
    case Kind::Integer:
        return "integer";
    case Kind::Toggle:
        return "toggle";
    case Kind::Choice:
        return "choice";
    case Kind::Color:
        return "color";
    case Kind::Vector:
        return "vector";
    case Kind::Range:
        return "range";
    case Kind::Pair:
        return "pair";
    }
    return "";
}

/// "[0, 1]", "above 0", "ratio | exponential"; "" where every value is legal.
std::string legalValues(const Param& param) {
    if (param.kind == Kind::Toggle) return "true | false";
    std::string text;
    for (const std::string_view choice : param.choices)
        text += (text.empty() ? "" : " | ") + std::string(choice);
    if (param.kind == Kind::Choice) return text;
    const bool unboundedBelow = param.min == -kLimitless, unboundedAbove = param.max == kLimitless;
    if (unboundedBelow && unboundedAbove) return "";
    const std::string low = param.min == kAboveZero ? "above 0" : "at least " + shortest(param.min);
    if (unboundedAbove) return low;
    if (unboundedBelow) return "at most " + shortest(param.max);
    if (param.min == kAboveZero) return low + ", at most " + shortest(param.max);
    return "[" + shortest(param.min) + ", " + shortest(param.max) + "]";
}

void printText() {
    for (const Section& section : sections()) {
        std::printf("%s: %s.KEY\n", section.title.c_str(), section.path.c_str());
        for (const Param& param : section.table->params) {
            std::string facts = std::string(kindName(param.kind));
            if (const std::string legal = legalValues(param); !legal.empty()) facts += " " + legal;
            if (!param.unit.empty()) facts += " " + std::string(param.unit);
            facts += ", default " + getText(param, defaultOf(*section.table, param));
            std::printf("  %-20s %s\n  %-20s %s\n", std::string(param.id).c_str(), facts.c_str(), "",
                        std::string(param.doc).c_str());
        }
        std::printf("\n");
    }
    std::printf("quantities (--aov):");
    for (const std::string_view name : scene::aovNames())
        std::printf(" %s", std::string(name).c_str());
    std::printf("\n");
}

void printMarkdown() {
    for (const Section& section : sections()) {
        std::printf("### %s (`%s`)\n\n", section.title.c_str(), section.path.c_str());
        std::printf("| key | values | unit | default | meaning |\n|---|---|---|---|---|\n");
        for (const Param& param : section.table->params) {
            std::string legal = legalValues(param);
            for (std::size_t bar = 0; (bar = legal.find('|', bar)) != std::string::npos; bar += 2)
                legal.insert(bar, "\\"); // a plain bar would end the cell
            std::printf(
                "| `%s` | %s %s | %s | `%s` | %s |\n", std::string(param.id).c_str(),
                std::string(kindName(param.kind)).c_str(), legal.c_str(), std::string(param.unit).c_str(),
                getText(param, defaultOf(*section.table, param)).c_str(), std::string(param.doc).c_str());
        }
        std::printf("\n");
    }
}

void writeParam(JsonWriter& json, const ParamTable& table, const Param& param) {
    json.beginObject();
    json.key("id").value(param.id).key("label").value(param.label).key("kind").value(kindName(param.kind));
    json.key("unit").value(param.unit);
    if (param.kind == Kind::Choice) {
        json.key("choices").beginArray();
        for (const std::string_view choice : param.choices)
            json.value(choice);
        json.end();
    } else if (param.kind != Kind::Toggle) {
        json.key("min").value(param.min == kAboveZero ? 0 : param.min); // null: no bound
        json.key("minIsExcluded").value(param.min == kAboveZero).key("max").value(param.max);
    }
    json.key("default").value(getText(param, defaultOf(table, param)));
    json.key("doc").value(param.doc);
    json.end();
}

void printJson() {
    JsonWriter json;
    json.beginObject().key("sections").beginArray();
    for (const Section& section : sections()) {
        json.beginObject().key("title").value(section.title).key("path").value(section.path);
        json.key("parameters").beginArray();
        for (const Param& param : section.table->params)
            writeParam(json, *section.table, param);
        json.end().end();
    }
    json.end().key("aovs").beginArray();
    for (const std::string_view name : scene::aovNames())
        json.value(name);
    json.end().end();
    std::fputs(json.text().c_str(), stdout);
}
} // namespace

Command addList(CLI::App& program) {
    CLI::App* parser = program.add_subcommand(
        "list", "Prints techniques, methods and parameters with units, ranges and defaults");
    const auto json = std::make_shared<bool>(false), markdown = std::make_shared<bool>(false);
    CLI::Option* asJson = parser->add_flag("--json", *json, "Prints JSON");
    parser->add_flag("--markdown", *markdown, "Prints tables for the documentation")->excludes(asJson);
    parser->footer("Examples:\n"
                   "  lucent list\n"
                   "  lucent list --json");
    return {parser, [json, markdown]() -> Status {
                if (*json)
                    printJson();
                else if (*markdown)
                    printMarkdown();
                else
                    printText();
                return Done{};
            }};
}

} // namespace lucent::cli

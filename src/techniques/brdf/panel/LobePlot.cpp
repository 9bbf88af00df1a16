#include "techniques/brdf/panel/LobePlot.h"

#include "base/JsonWriter.h"
#include "scene/Keys.h"
#include "techniques/brdf/Reflector.h"
#include "viewer/Figure.h"
#include "views/Surface.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

namespace lucent::brdf {

namespace {

constexpr float kLobeHeight = 190, kChartHeight = 156; // CSS pixels
constexpr float kMostAngle = 85; // degrees: of a lamp at the horizon nothing would be seen
constexpr float kAngles[] = {0, 60, 80};
constexpr int kPairs = 128;                           // of directions, in which tables are judged
constexpr float kLeastError = 1e-3f, kMostError = 10; // of the chart

using viewer::Theme;
namespace layout = viewer::layout;

std::string format(const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

float radians(float degrees) { return degrees * kPi / 180; }

// z is the normal.
vec3 direction(float theta, float phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// From a surface that faces +y; from 45 degrees where a scene has no lamp.
vec3 towardsFirstLamp(const scene::Scene& scene, const scene::Object& object) {
    const vec3 middle = views::boundsOf(object).center();
    if (scene.lights.empty()) return direction(radians(45), 0);
    vec3 way(0, 1, 0);
    if (const auto* light = std::get_if<scene::PointLight>(&scene.lights[0])) way = light->position - middle;
    if (const auto* light = std::get_if<scene::SpotLight>(&scene.lights[0])) way = light->position - middle;
    if (const auto* light = std::get_if<scene::DistantLight>(&scene.lights[0])) way = -light->direction;
    if (const auto* light = std::get_if<scene::AreaLight>(&scene.lights[0]))
        way = light->corner + 0.5f * (light->edgeU + light->edgeV) - middle;
    const float length = glm::length(way);
    return length > 0 ? vec3(way.x, -way.z, way.y) / length : vec3(0, 0, 1);
}

// What of a material its laws depend on.
struct LawsKey {
    ReflectorValues values;
    std::shared_ptr<const Image> table;
    int form, blocks;
    bool operator==(const LawsKey& b) const {
        return values.diffuse == b.values.diffuse && values.specular == b.values.specular &&
               values.lobe == b.values.lobe && table == b.table && form == b.form && blocks == b.blocks;
    }
};

LawsKey keyOf(const scene::Material& material) {
    const auto* measured = std::get_if<scene::MeasuredBrdf>(&material.kind);
    if (measured) return {{}, measured->table, int(measured->form), measured->blocks};
    return {reflectorOf(material), nullptr, 0, 0};
}

LobePlot::Laws makeLaws(const scene::Material& material) {
    LobePlot::Laws laws;
    for (int i = 0; i < 3; ++i)
        laws.albedo[i] = directionalAlbedo(material, std::cos(radians(kAngles[i])));
    laws.reciprocity = reciprocityError(material);
    for (std::size_t i = 0; i < laws.projected.size(); ++i) {
        const int n = LobePlot::kTableSizes[i / LobePlot::kTables],
                  m = LobePlot::kTableSizes[i % LobePlot::kTables];
        laws.projected[i] = tableError(material, scene::TableForm::Projected, n, m, kPairs);
        laws.equalArea[i] = tableError(material, scene::TableForm::EqualArea, n, m, kPairs);
    }
    return laws;
}

// They take tens of milliseconds, and a lamp that moves changes none.
const LobePlot::Laws& lawsOf(const scene::Object& object) {
    return object.kept.of<LobePlot::Laws>(keyOf(object.material), [&] { return makeLaws(object.material); });
}

bool hasLaws(const scene::Object& object) {
    return object.kept.find<LobePlot::Laws>(keyOf(object.material)) != nullptr;
}

bool hasPlot(const scene::Object& object) { return object.visible && object.material.isGlossy(); }

LobePlot plotOf(const scene::Scene& scene, const scene::Object& object) {
    const scene::Material& material = object.material;
    LobePlot plot;
    plot.owner = object.name;
    plot.model = scene::materialKinds()[material.kind.index()].type;
    const vec3 lamp = towardsFirstLamp(scene, object);
    const float angle = std::min(std::acos(std::clamp(lamp.z, -1.0f, 1.0f)), radians(kMostAngle));
    plot.lightAngle = angle * 180 / kPi;
    plot.lightTurn = std::atan2(lamp.y, lamp.x);
    const vec3 toLight = direction(angle, plot.lightTurn);
    const auto brdf = [of = brdfOf(material), toLight](float theta, float phi) {
        return of(dvec3(toLight), dvec3(direction(theta, phi)));
    };
    for (int ring = 0; ring < LobePlot::kRings; ++ring)
        for (int spoke = 0; spoke < LobePlot::kSpokes; ++spoke)
            plot.lobe.push_back(brdf(radians(89.9f) * float(ring) / (LobePlot::kRings - 1),
                                     2 * kPi * float(spoke) / LobePlot::kSpokes));
    for (int i = 0; i <= LobePlot::kSlice; ++i) {
        const float theta = radians(-89.9f + 179.8f * float(i) / LobePlot::kSlice);
        plot.slice.push_back(brdf(std::abs(theta), plot.lightTurn + (theta < 0 ? 0 : kPi)));
    }
    plot.laws = lawsOf(object);
    return plot;
}

float brightest(const vec3& color) { return std::max({color.r, color.g, color.b}); }

float largestOf(const std::vector<vec3>& values) {
    float largest = 0;
    for (const vec3& value : values)
        largest = std::max(largest, brightest(value));
    return largest;
}

// The body's points on the figure: seen from 25 degrees above, turned so that depth shows.
vec2 projected(vec3 point, vec2 foot, float scale) {
    const float aside = point.x * 0.94f - point.y * 0.34f, away = point.x * 0.34f + point.y * 0.94f;
    return foot + scale * vec2(aside, -0.91f * point.z - 0.42f * away);
}

void drawLobe(ImDrawList& list, vec2 foot, float scale, const LobePlot& plot, const Theme& theme) {
    const auto at = [&](vec3 point) {
        const vec2 p = projected(point, foot, scale);
        return ImVec2(p.x, p.y);
    };
    for (int i = 0; i < LobePlot::kSpokes; ++i) { // the surface
        const float from = 2 * kPi * float(i) / LobePlot::kSpokes, to = from + 2 * kPi / LobePlot::kSpokes;
        list.AddLine(at(direction(kPi / 2, from)), at(direction(kPi / 2, to)), theme.cardBorder);
    }
    const float largest = std::max(largestOf(plot.lobe), 1e-30f);
    const auto point = [&](int ring, int spoke) {
        const int at_ = spoke % LobePlot::kSpokes;
        const float radius = brightest(plot.lobe[std::size_t(ring * LobePlot::kSpokes + at_)]) / largest;
        return radius * direction(radians(89.9f) * float(ring) / (LobePlot::kRings - 1),
                                  2 * kPi * float(at_) / LobePlot::kSpokes);
    };
    for (int ring = 0; ring < LobePlot::kRings; ++ring)
        for (int spoke = 0; spoke < LobePlot::kSpokes; ++spoke) {
            if (ring > 0) list.AddLine(at(point(ring, spoke)), at(point(ring, spoke + 1)), theme.accentFaint);
            if (ring + 1 < LobePlot::kRings)
                list.AddLine(at(point(ring, spoke)), at(point(ring + 1, spoke)), theme.accent);
        }
    const vec3 light = direction(radians(plot.lightAngle), plot.lightTurn);
    list.AddLine(at(vec3(0)), at(light), theme.text, 1.5f);
    list.AddCircleFilled(at(light), 3.5f, theme.text);
}

// From the light's side on the left to the side that mirrors on the right.
void drawSlice(ImDrawList& list, vec2 foot, float scale, const LobePlot& plot, const Theme& theme) {
    constexpr ImU32 kInks[] = {IM_COL32(226, 74, 66, 255), IM_COL32(44, 158, 84, 255),
                               IM_COL32(70, 120, 240, 255)};
    const float largest = std::max(largestOf(plot.slice), 1e-30f);
    const auto at = [&](float theta, float radius) {
        return ImVec2(foot.x + scale * radius * std::sin(theta), foot.y - scale * radius * std::cos(theta));
    };
    list.AddLine(at(-kPi / 2, 1), at(kPi / 2, 1), theme.cardBorder);
    for (const float share : {0.5f, 1.0f}) {
        std::vector<ImVec2> arc;
        for (int i = 0; i <= 32; ++i)
            arc.push_back(at(kPi * (float(i) / 32 - 0.5f), share));
        list.AddPolyline(arc.data(), int(arc.size()), theme.cardBorder, 0, 1);
    }
    for (int c = 0; c < 3; ++c) {
        std::vector<ImVec2> curve;
        for (int i = 0; i <= LobePlot::kSlice; ++i)
            curve.push_back(at(radians(-89.9f + 179.8f * float(i) / LobePlot::kSlice),
                               plot.slice[std::size_t(i)][c] / largest));
        list.AddPolyline(curve.data(), int(curve.size()), kInks[c], 0, 1.5f);
    }
    list.AddLine(at(0, 0), at(-radians(plot.lightAngle), 1), theme.text, 1.5f);
    list.AddText({foot.x - scale, foot.y + 4}, theme.muted,
                 format("full radius %.3g 1/sr", double(largest)).c_str());
}

std::string jsonOf(const LobePlot& plot) {
    JsonWriter json;
    const auto colors = [&](const char* key, const std::vector<vec3>& values) {
        json.key(key).beginArray();
        for (const vec3& value : values) {
            const float row[] = {value.r, value.g, value.b};
            json.value(std::span<const float>(row));
        }
        json.end();
    };
    json.beginObject().key("owner").value(plot.owner).key("model").value(plot.model);
    const LobePlot::Laws& laws = plot.laws;
    json.key("lightAngle").value(plot.lightAngle).key("reciprocity").value(laws.reciprocity);
    colors("albedo", {laws.albedo[0], laws.albedo[1], laws.albedo[2]});
    colors("slice", plot.slice);
    json.key("tables").beginObject().key("sizes").beginArray();
    for (const int size : LobePlot::kTableSizes)
        json.value(size);
    json.end().key("projected").value(std::span<const float>(laws.projected));
    json.key("equalArea").value(std::span<const float>(laws.equalArea)).end();
    json.key("text").value(describe(plot)).end();
    return json.text();
}

// Errors of tables over m, a line for each n; both logarithmic.
void drawTables(ImDrawList& list, vec2 at, float width, const LobePlot::Laws& laws, const Theme& theme) {
    constexpr ImU32 kProjected = IM_COL32(226, 120, 40, 255), kEqualArea = IM_COL32(60, 130, 230, 255);
    list.AddText({at.x, at.y}, theme.muted, "Error as a table, n x n blocks of m x m texels");
    list.AddText({at.x, at.y + 16}, kProjected, "projected");
    list.AddText({at.x + 72, at.y + 16}, kEqualArea, "equal-area");
    list.AddText({at.x + 150, at.y + 16}, theme.muted, "across m, lines n");
    const vec2 low = at + vec2(44, 42), size(width - 68, kChartHeight - 60);
    const float decades = std::log10(kMostError / kLeastError);
    const auto heightOf = [&](float error) {
        return low.y +
               size.y * (1 - std::log10(std::clamp(error, kLeastError, kMostError) / kLeastError) / decades);
    };
    for (const auto& [error, name] :
         {std::pair(10.0f, "1000 %"), std::pair(1.0f, "100 %"), std::pair(0.1f, "10 %"),
          std::pair(0.01f, "1 %"), std::pair(0.001f, "0.1 %")}) {
        const float y = heightOf(error);
        list.AddLine({low.x, y}, {low.x + size.x, y}, theme.cardBorder);
        list.AddText({at.x, y - 7}, theme.muted, name);
    }
    const auto across = [&](std::size_t m) { return low.x + size.x * float(m) / (LobePlot::kTables - 1); };
    for (std::size_t m = 0; m < LobePlot::kTables; ++m)
        list.AddText({across(m) - 6, low.y + size.y + 4}, theme.muted,
                     std::to_string(LobePlot::kTableSizes[m]).c_str());
    float under = low.y + size.y + 11; // of the number below
    for (std::size_t n = LobePlot::kTables; n-- > 0;) {
        const float thickness = 0.6f + 0.5f * float(n);
        for (const auto& [errors, ink] :
             {std::pair(&laws.equalArea, kEqualArea), std::pair(&laws.projected, kProjected)}) {
            ImVec2 line[LobePlot::kTables];
            for (std::size_t m = 0; m < LobePlot::kTables; ++m)
                line[m] = {across(m), heightOf((*errors)[n * LobePlot::kTables + m])};
            list.AddPolyline(line, LobePlot::kTables, ink, 0, thickness);
        }
        under = std::min(heightOf(laws.projected[(n + 1) * LobePlot::kTables - 1]), under - 11);
        list.AddText({low.x + size.x + 4, under - 7}, theme.muted,
                     std::to_string(LobePlot::kTableSizes[n]).c_str());
    }
}

void drawPlot(ImDrawList& list, vec2 at, float width, const LobePlot& plot, const Theme& theme) {
    const LobePlot::Laws& laws = plot.laws;
    const std::string numbers = format("Furnace %.1f %%", 100 * double(brightest(laws.albedo[0]))) +
                                format(", at 60° %.1f %%", 100 * double(brightest(laws.albedo[1]))) +
                                format(", at 80° %.1f %%", 100 * double(brightest(laws.albedo[2])));
    list.AddText({at.x, at.y}, theme.muted, numbers.c_str());
    list.AddText({at.x, at.y + 18}, theme.muted,
                 format("Reciprocity error %.1e", double(laws.reciprocity)).c_str());
    const float scale = std::min(0.23f * width, kLobeHeight - 90);
    drawLobe(list, at + vec2(0.25f * width, kLobeHeight - 50), scale, plot, theme);
    drawSlice(list, at + vec2(0.76f * width, kLobeHeight - 36), scale, plot, theme);
    drawTables(list, at + vec2(0, kLobeHeight), width, laws, theme);
}

viewer::Figure pendingOf(const scene::Object& object) {
    return {.owner = object.name, .text = "", .height = 0, .json = {}, .draw = {}, .isPending = true};
}

std::vector<viewer::Figure> figures(const scene::Scene& scene, double ms) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + std::chrono::duration<double, std::milli>(ms);
    std::vector<viewer::Figure> list;
    for (const scene::Object& object : scene.objects) {
        if (!hasPlot(object)) continue;
        if (!hasLaws(object) && Clock::now() > until) {
            list.push_back(pendingOf(object));
            continue;
        }
        const auto plot = std::make_shared<const LobePlot>(plotOf(scene, object));
        list.push_back({.owner = plot->owner,
                        .text = describe(*plot),
                        .height = kLobeHeight + kChartHeight,
                        .json = [plot] { return jsonOf(*plot); },
                        .draw = [plot](ImDrawList& drawn, vec2 at, float width,
                                       const Theme& theme) { drawPlot(drawn, at, width, *plot, theme); },
                        .place = Group::Material});
    }
    return list;
}

} // namespace

std::vector<LobePlot> lobePlots(const scene::Scene& scene) {
    std::vector<LobePlot> plots;
    for (const scene::Object& object : scene.objects)
        if (hasPlot(object)) plots.push_back(plotOf(scene, object));
    return plots;
}

std::string describe(const LobePlot& plot) {
    std::string text =
        "Reflectance of " + plot.owner + ", " + std::string(plot.model) + ": of even light from all around";
    for (int i = 0; i < 3; ++i)
        text += (i ? ", " : " ") + format("%.1f %%", 100 * double(brightest(plot.laws.albedo[i]))) +
                format(" are seen from %.0f degrees", double(kAngles[i]));
    return text + format("; light and view may be exchanged to %.1e", double(plot.laws.reciprocity)) +
           "; a table of 32 x 32 blocks of 32 x 32 texels is" +
           format(" %.2g %% off projected,", 100 * double(plot.laws.projected.back())) +
           format(" %.2g %% with equal areas.", 100 * double(plot.laws.equalArea.back()));
}

extern const viewer::PanelPart kPanelPart;
const viewer::PanelPart kPanelPart{figures};

} // namespace lucent::brdf

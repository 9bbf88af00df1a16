#include "techniques/subsurface/panel/ProfilePlot.h"

#include "base/JsonWriter.h"
#include "techniques/subsurface/Subsurface.h"
#include "views/Surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace lucent::subsurface {

namespace {

constexpr double kMm = 1e-3;       // m
constexpr int kPoints = 96;        // of a curve, denser near 0
constexpr int kDecades = 5;        // shown below the largest value
constexpr float kPlotHeight = 168; // CSS pixels

using viewer::Theme;
namespace layout = viewer::layout;

constexpr std::array<std::string_view, 3> kColors{"red", "green", "blue"};
// Not pure: to be told apart on light and dark ground, and by their brightness too.
constexpr std::array<ImU32, 3> kInks{IM_COL32(226, 74, 66, 255), IM_COL32(44, 158, 84, 255),
                                     IM_COL32(70, 120, 240, 255)};

std::string format(const char* pattern, double value) {
    char text[32];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

void addValues(ProfilePlot& plot, const std::array<diffusion::Profile, 3>& profiles) {
    const double reach = *std::max_element(plot.reach.begin(), plot.reach.end());
    if (reach == 0) return;
    for (int i = 1; i <= kPoints; ++i) {
        const double share = double(i) / kPoints, mm = reach * share * share;
        dvec3 value;
        for (int c = 0; c < 3; ++c)
            value[c] = kMm * kMm * profiles[std::size_t(c)].at(mm * kMm);
        plot.distances.push_back(mm);
        plot.values.push_back(value);
    }
}

ProfilePlot plotOf(const scene::Object& object, const Settings& settings) {
    ProfilePlot plot;
    plot.owner = object.name;
    const ParamTable& table = Subsurface::params();
    for (const Param& param : table.params)
        if (param.id == "profile") plot.profile = param.choices[std::size_t(settings.profile)];
    const std::array<diffusion::Profile, 3> profiles =
        diffusion::profilesOf(diffusion::mediaOf(object.material), settings.profile,
                              double(object.material.translucent().thickness));
    const double most = 2 * double(views::boundsOf(object).radius());
    for (std::size_t c = 0; c < 3; ++c) {
        plot.reach[c] = profiles[c].reach(double(settings.epsilon), most) / kMm;
        plot.whole[c] = profiles[c].total();
    }
    addValues(plot, profiles);
    return plot;
}

double largestOf(const ProfilePlot& plot) {
    double largest = 0;
    for (const dvec3& value : plot.values)
        largest = std::max({largest, value.r, value.g, value.b});
    return largest;
}

// Between values and places in a rectangle.
struct Axes {
    vec2 low, high;
    double reach;  // mm at the right end
    int topDecade; // the power of ten at the upper end

    float x(double mm) const { return glm::mix(low.x, high.x, float(mm / reach)); }
    float y(double value) const {
        const double below =
            std::clamp(topDecade - std::log10(std::max(value, 1e-300)), 0.0, double(kDecades));
        return glm::mix(low.y, high.y, float(below / kDecades));
    }
};

void drawAxes(ImDrawList& list, const Axes& axes, const Theme& theme) {
    list.AddRect({axes.low.x, axes.low.y}, {axes.high.x, axes.high.y}, theme.cardBorder);
    for (int i = 0; i <= kDecades; ++i) {
        const float y = glm::mix(axes.low.y, axes.high.y, float(i) / kDecades);
        if (i > 0 && i < kDecades) list.AddLine({axes.low.x, y}, {axes.high.x, y}, theme.cardBorder);
        if (i % 2) continue;
        const std::string power = "1e" + std::to_string(axes.topDecade - i);
        list.AddText({axes.low.x - ImGui::CalcTextSize(power.c_str()).x - 4, y - layout::kText / 2},
                     theme.muted, power.c_str());
    }
    const std::string far = format("%.3g mm", axes.reach);
    list.AddText({axes.low.x, axes.high.y + 3}, theme.muted, "0");
    list.AddText({axes.high.x - ImGui::CalcTextSize(far.c_str()).x, axes.high.y + 3}, theme.muted,
                 far.c_str());
}

void drawCurve(ImDrawList& list, const Axes& axes, const ProfilePlot& plot, int color) {
    std::vector<ImVec2> points;
    for (std::size_t i = 0; i < plot.values.size(); ++i)
        if (plot.values[i][color] > 0)
            points.push_back({axes.x(plot.distances[i]), axes.y(plot.values[i][color])});
    const ImU32 ink = kInks[std::size_t(color)];
    list.PushClipRect({axes.low.x, axes.low.y}, {axes.high.x, axes.high.y}, true);
    list.AddPolyline(points.data(), int(points.size()), ink, 0, 1.5f);
    list.PopClipRect();
    const float x = axes.x(plot.reach[std::size_t(color)]);
    list.AddTriangleFilled({x, axes.high.y - 7}, {x - 4, axes.high.y}, {x + 4, axes.high.y}, ink);
}

} // namespace

std::vector<ProfilePlot> profilePlots(const scene::Scene& scene) {
    std::vector<ProfilePlot> plots;
    const auto& settings = scene.technique.at("subsurface").as<Settings>();
    for (const scene::Object& object : scene.objects)
        if (object.visible && !object.isField() && object.material.isScattering())
            plots.push_back(plotOf(object, settings));
    return plots;
}

std::string describe(const ProfilePlot& plot) {
    std::string text = "Subsurface scattering of " + plot.owner + ", " + std::string(plot.profile) + ":";
    for (std::size_t c = 0; c < 3; ++c)
        text += (c ? "; " : " ") + std::string(kColors[c]) + format(" reaches %.3g mm,", plot.reach[c]) +
                format(" %.1f %% leaves again", 100 * plot.whole[c]);
    return text + ".";
}

namespace {

// Owner, profile, reach, whole, distances, values, text.
std::string jsonOf(const ProfilePlot& plot) {
    JsonWriter json;
    const auto numbers = [&](const char* key, const auto& list) {
        const std::vector<float> row(list.begin(), list.end());
        json.key(key).value(std::span<const float>(row));
    };
    json.beginObject().key("owner").value(plot.owner).key("profile").value(plot.profile);
    numbers("reach", plot.reach);
    numbers("whole", plot.whole);
    numbers("distances", plot.distances);
    json.key("values").beginArray();
    for (const dvec3& value : plot.values) {
        const float row[] = {float(value.r), float(value.g), float(value.b)};
        json.value(std::span<const float>(row));
    }
    json.end().key("text").value(describe(plot)).end();
    return json.text();
}

// Curves over distance, their values on a scale of decades; a tick at each colour's reach; what leaves of
// each colour above.
void drawProfilePlot(ImDrawList& list, vec2 at, float width, const ProfilePlot& plot, const Theme& theme) {
    float x = at.x;
    const auto write = [&](ImU32 ink, const std::string& text) {
        list.AddText({x, at.y}, ink, text.c_str());
        x += ImGui::CalcTextSize(text.c_str()).x + 10;
    };
    write(theme.muted, "Leaves again");
    for (std::size_t c = 0; c < 3; ++c)
        write(kInks[c], format("%.1f %%", 100 * plot.whole[c]));
    const double largest = largestOf(plot);
    if (largest == 0) return;
    constexpr float kLabels = 34, kFoot = layout::kText + 6;
    const Axes axes{.low = at + vec2(kLabels, layout::kLine),
                    .high = at + vec2(width, kPlotHeight - kFoot),
                    .reach = plot.distances.back(),
                    .topDecade = int(std::ceil(std::log10(largest)))};
    drawAxes(list, axes, theme);
    const float middle = (axes.low.x + axes.high.x) / 2;
    const std::string title = "R_d, 1/mm², by " + std::string(plot.profile);
    list.AddText({middle - ImGui::CalcTextSize(title.c_str()).x / 2, axes.high.y + 3}, theme.muted,
                 title.c_str());
    for (int c = 0; c < 3; ++c)
        drawCurve(list, axes, plot, c);
}

std::vector<viewer::Figure> figures(const scene::Scene& scene, double) {
    std::vector<viewer::Figure> list;
    for (ProfilePlot& made : profilePlots(scene)) {
        const auto plot = std::make_shared<const ProfilePlot>(std::move(made));
        list.push_back(
            {.owner = plot->owner,
             .text = describe(*plot),
             .height = kPlotHeight,
             .json = [plot] { return jsonOf(*plot); },
             .draw = [plot](ImDrawList& drawn, vec2 at, float width,
                            const Theme& theme) { drawProfilePlot(drawn, at, width, *plot, theme); }});
    }
    return list;
}

} // namespace

extern const viewer::PanelPart kPanelPart;
const viewer::PanelPart kPanelPart{figures};

} // namespace lucent::subsurface

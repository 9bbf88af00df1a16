#include "scene/Strokes.h"

#include "base/Text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lucent::scene {
namespace {

constexpr std::string_view kBrushNames[] = {"translucency", "blur", "glow", "outgoing"};
constexpr Key kScript[] = {
    {"lucentStrokes", KeyType::Constant, "Version of this format.", "1"},
    {"strokes", KeyType::Content, "Strokes, the first one first."},
};
constexpr Key kFill[] = {
    {"low", KeyType::Content, "Lower corner of the box."},
    {"high", KeyType::Content, "Upper corner of the box."},
    {"veins", KeyType::Content, "Of marble: metres from one to the next."},
};

bool isScalar(PaintMap map) { return map == PaintMap::Translucency || map == PaintMap::Blur; }

// The value of a brush as a parameter: its range depends on the map.
struct Value {
    float one = 1;
    vec3 three{1};
};
const Param& valueParam(PaintMap map) {
    static const Param share =
        declare(&Value::one, {.id = "value", .label = "", .min = 0, .max = 1, .doc = ""});
    static const Param blur = declare(
        &Value::one,
        {.id = "value", .label = "", .min = 1 / kMostSharpness, .max = 1 / kLeastSharpness, .doc = ""});
    static const Param color = declare(
        &Value::three, {.id = "value", .label = "", .min = 0, .max = kMostPaint, .doc = "", .color = true});
    if (map == PaintMap::Translucency) return share;
    return map == PaintMap::Blur ? blur : color;
}

const Param& veinsParam() {
    static const Param veins = declare(
        &Stroke::Fill::veins, {.id = "veins", .label = "", .min = kAboveZero, .max = kLargest, .doc = ""});
    return veins;
}

class StrokeReading : JsonReading {
public:
    StrokeReading(const std::string& path) : JsonReading(path, "the script") {}

    Result<std::vector<Stroke>> readScript(const Place& place) {
        static const KeySet keys{{}, kScript};
        if (!readKeys(place, keys, {})) return error();
        const Json* version = place.json.find("lucentStrokes");
        if (!version) return complaint(missing(place, "lucentStrokes", "1"));
        if (version->type != Json::Type::Number || version->number != 1)
            return complaint(wrongType(place.at(*version, "lucentStrokes"), "1"));
        const Json* list = place.json.find("strokes");
        if (!list) return complaint(missing(place, "strokes", "a list"));
        return readList(place.at(*list, "strokes"));
    }

    Result<std::vector<Stroke>> readList(const Place& place) {
        if (!expect(place, Json::Type::Array, "a list")) return error();
        std::vector<Stroke> strokes(place.json.items.size());
        for (std::size_t i = 0; i < strokes.size(); ++i)
            if (!readStroke(place.at(place.json.items[i], std::to_string(i)), strokes[i])) return error();
        return strokes;
    }

private:
    Error complaint(bool) { return error(); }

    bool readStroke(const Place& place, Stroke& stroke) {
        if (!readKeys(place, strokeKeys(), {&stroke.brush})) return false;
        if (!place.json.find("brush")) return missing(place, "brush", "translucency, blur, glow or outgoing");
        const Json *dabs = place.json.find("dabs"), *fill = place.json.find("fill");
        if (bool(dabs) == bool(fill))
            return fail(place, dabs ? " has dabs and fill; must have one of them"
                                    : " has neither dabs nor fill; must have one of them");
        return readValue(place, stroke.brush) &&
               (dabs ? readDabs(place.at(*dabs, "dabs"), stroke.dabs)
                     : readFill(place.at(*fill, "fill"), stroke.fill.emplace()));
    }

    bool readValue(const Place& place, Brush& brush) {
        const Param& param = valueParam(brush.map);
        const Json* json = place.json.find("value");
        if (!json)
            return brush.erase ||
                   missing(place, "value", isScalar(brush.map) ? "a number" : "a list of 3 numbers");
        if (brush.erase)
            return fail(place.at(*json, "value"), " does nothing beside erase; must be left out");
        Value value;
        void* data = isScalar(brush.map) ? static_cast<void*>(&value.one) : &value.three;
        if (!readParam(place.at(*json, "value"), param, data)) return false;
        brush.value = isScalar(brush.map) ? vec3(value.one) : value.three;
        return true;
    }

    bool readDabs(const Place& place, std::vector<Dab>& dabs) {
        if (!expect(place, Json::Type::Array, "a list of dabs")) return false;
        for (std::size_t i = 0; i < place.json.items.size(); ++i)
            if (!readDab(place.at(place.json.items[i], std::to_string(i)), dabs.emplace_back())) return false;
        return true;
    }
    bool readDab(const Place& place, Dab& dab) {
        std::array<float, 7> n{};
        if (!readNumbers(place, n)) return wrongType(place, "a list of 7 numbers");
        dab = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6]};
        const bool legal =
            std::all_of(n.begin(), n.end(), [](float v) { return std::abs(v) <= float(kFar); });
        if (!legal) return fail(place, " holds a number beyond 1e9; must be nearer");
        if (dab.normal == vec3(0)) return fail(place, " has the normal 0 0 0; must have a length");
        if (dab.pressure < 0 || dab.pressure > 1)
            return fail(place, " has the pressure " + shortest(dab.pressure) + "; must be in [0, 1]");
        return true;
    }
    static bool readNumbers(const Place& place, std::span<float> numbers) {
        const std::vector<Json>& items = place.json.items;
        if (place.json.type != Json::Type::Array || items.size() != numbers.size()) return false;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (items[i].type != Json::Type::Number) return false;
            numbers[i] = float(items[i].number);
        }
        return true;
    }

    bool readFill(const Place& place, Stroke::Fill& fill) {
        static const KeySet keys{{}, kFill};
        constexpr float kEndless = std::numeric_limits<float>::infinity();
        return readKeys(place, keys, {}) && readCorner(place, "low", -kEndless, fill.low) &&
               readCorner(place, "high", kEndless, fill.high) && readVeins(place, fill.veins);
    }
    bool readVeins(const Place& place, float& veins) {
        const Json* json = place.json.find("veins");
        return !json || readParam(place.at(*json, "veins"), veinsParam(), &veins);
    }
    bool readCorner(const Place& place, std::string_view key, float endless, vec3& corner) {
        corner = vec3(endless);
        const Json* json = place.json.find(key);
        if (!json) return true;
        const Place member = place.at(*json, key);
        const auto legal = [](const Json& item) {
            return item.type == Json::Type::Null ||
                   (item.type == Json::Type::Number && std::abs(item.number) <= kFar);
        };
        const std::vector<Json>& items = json->items;
        if (json->type != Json::Type::Array || items.size() != 3 ||
            !std::all_of(items.begin(), items.end(), legal))
            return wrongType(member, "a list of 3 numbers up to 1e9 or null");
        for (int i = 0; i < 3; ++i)
            if (items[std::size_t(i)].type == Json::Type::Number)
                corner[i] = float(items[std::size_t(i)].number);
        return true;
    }
};

void writeParam(JsonWriter& json, const Param& param, const Brush& brush) {
    const void* data = reinterpret_cast<const std::byte*>(&brush) + param.offset;
    const void* normal = static_cast<const std::byte*>(brushParams().defaults) + param.offset;
    const std::string text = getText(param, data);
    if (text == getText(param, normal) && param.id != "brush") return;
    json.key(param.id);
    param.kind == Kind::Choice ? json.value(text) : json.raw(text);
}

// One number of it stands for an endless box as null.
void writeCorner(JsonWriter& json, std::string_view key, vec3 corner) {
    if (std::isinf(corner.x) && std::isinf(corner.y) && std::isinf(corner.z)) return;
    json.key(key).beginArray();
    for (int i = 0; i < 3; ++i)
        json.value(corner[i]);
    json.end();
}

void writeStroke(JsonWriter& json, const Stroke& stroke) {
    json.beginObject();
    for (const Param& param : brushParams().params)
        writeParam(json, param, stroke.brush);
    const vec3 value = stroke.brush.value;
    const float numbers[] = {value.x, value.y, value.z};
    if (!stroke.brush.erase && isScalar(stroke.brush.map))
        json.key("value").value(value.x);
    else if (!stroke.brush.erase)
        json.key("value").value(std::span<const float>(numbers));
    if (stroke.fill) {
        json.key("fill").beginObject();
        writeCorner(json, "low", stroke.fill->low);
        writeCorner(json, "high", stroke.fill->high);
        if (stroke.fill->veins > 0) json.key("veins").value(stroke.fill->veins);
        json.end();
    } else {
        json.key("dabs").beginArray();
        for (const Dab& dab : stroke.dabs) {
            const float list[] = {dab.place.x,  dab.place.y,  dab.place.z, dab.normal.x,
                                  dab.normal.y, dab.normal.z, dab.pressure};
            json.value(std::span<const float>(list));
        }
        json.end();
    }
    json.end();
}

} // namespace

const ParamTable& brushParams() {
    static const Param params[] = {
        declare(&Brush::map,
                {.id = "brush",
                 .label = "Brush",
                 .group = Group::Mode,
                 .doc = "What it changes: which share of the light goes inside, how far it spreads there, "
                        "its brightness and colour, or the colour of what leaves.",
                 .choices = kBrushNames}),
        declare(&Brush::radius, {.id = "radius",
                                 .label = "Radius",
                                 .unit = "m",
                                 .min = kAboveZero,
                                 .max = kLargest,
                                 .low = 0.001,
                                 .logarithmic = true,
                                 .group = Group::Mode,
                                 .doc = "Of a dab at full pressure, in the world."}),
        declare(&Brush::hardness, {.id = "hardness",
                                   .label = "Hardness",
                                   .min = 0,
                                   .max = 1,
                                   .group = Group::Mode,
                                   .doc = "Share of the radius in which a dab has its full strength."}),
        declare(&Brush::strength,
                {.id = "strength",
                 .label = "Strength",
                 .min = 0,
                 .max = 1,
                 .group = Group::Mode,
                 .doc = "How near one stroke comes to the value, however its dabs overlap."}),
        declare(&Brush::erase, {.id = "erase",
                                .label = "Erase",
                                .group = Group::Mode,
                                .doc = "Brings back how the object began: by hand opaque, in scripts as the "
                                       "first stroke fills all of it with translucency or else as its "
                                       "material is; blur, glow and outgoing as the material has them."}),
        declare(&Brush::symmetric, {.id = "symmetric",
                                    .label = "Symmetric",
                                    .group = Group::Mode,
                                    .doc = "Paints the other side of the object's plane x = 0 as well."}),
    };
    static const ParamTable table = tableOf<Brush>("brush", params);
    return table;
}

Result<std::vector<Stroke>> strokesFrom(const Place& list, const std::string& path) {
    return StrokeReading(path).readList(list);
}

void writeStrokes(JsonWriter& json, std::span<const Stroke> strokes) {
    json.beginArray();
    for (const Stroke& stroke : strokes)
        writeStroke(json, stroke);
    json.end();
}

Result<std::vector<Stroke>> parseStrokes(std::span<const std::byte> text, const std::string& name) {
    const Result<Json> root = parseJson(text, name, false);
    if (!root) return root.error();
    return StrokeReading(name).readScript({*root, ""});
}

std::string toJson(std::span<const Stroke> strokes) {
    JsonWriter json;
    json.beginObject().key("lucentStrokes").value(1);
    json.key("strokes");
    writeStrokes(json, strokes);
    return json.end().text();
}

} // namespace lucent::scene

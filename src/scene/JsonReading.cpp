#include "scene/JsonReading.h"

#include "base/Text.h"

#include <algorithm>
#include <cstddef>

namespace lucent::scene {

bool JsonReading::fail(const Place& place, const std::string& what) {
    const std::string subject = place.path.empty() ? std::string(whole_) : place.path;
    error_ = {path_ + ":" + std::to_string(place.json.line) + ": " + subject + what};
    return false;
}

bool JsonReading::wrongType(const Place& place, std::string_view expected) {
    return fail(place, " is " + place.json.describe() + "; must be " + std::string(expected));
}

bool JsonReading::missing(const Place& place, std::string_view key, std::string_view expected) {
    return fail(place.at(place.json, key), " is missing; must be " + std::string(expected));
}

bool JsonReading::keepStatus(const Place& place, const Status& status) {
    return status || fail(place, "." + status.error().message);
}

bool JsonReading::expect(const Place& place, Json::Type type, std::string_view expected) {
    return place.json.type == type || wrongType(place, expected);
}

bool JsonReading::readText(const Place& place, std::string& text) {
    if (!expect(place, Json::Type::String, "text")) return false;
    text = place.json.string;
    return true;
}

bool JsonReading::readBool(const Place& place, bool& value) {
    if (!expect(place, Json::Type::Bool, "true or false")) return false;
    value = place.json.boolean;
    return true;
}

bool JsonReading::readParam(const Place& place, const Param& param, void* data) {
    const Json& json = place.json;
    const int count = componentCount(param.kind);
    if (param.kind == Kind::Toggle) {
        bool value = false;
        if (!readBool(place, value)) return false;
        setComponent(param, data, 0, value);
        return true;
    }
    std::string text;
    if (param.kind == Kind::Choice || (param.kind == Kind::Color && json.type == Json::Type::String)) {
        if (!expect(place, Json::Type::String, "text")) return false;
        text = json.string;
    } else if (count == 1) {
        if (!expect(place, Json::Type::Number, param.kind == Kind::Integer ? "an integer" : "a number"))
            return false;
        text = shortest(json.number);
    } else if (param.axes == "rgb" && json.type != Json::Type::Array) { // the same for each colour
        if (!expect(place, Json::Type::Number, "a number or a list of 3 numbers")) return false;
        for (int i = 0; i < count; ++i)
            text += shortest(json.number) + " ";
    } else {
        const bool numbers = json.type == Json::Type::Array && int(json.items.size()) == count &&
                             std::all_of(json.items.begin(), json.items.end(),
                                         [](const Json& item) { return item.type == Json::Type::Number; });
        if (!numbers)
            return wrongType(place, "a list of " + std::to_string(count) + " numbers" +
                                        (param.kind == Kind::Color ? " or \"#rrggbb\"" : ""));
        for (const Json& item : json.items)
            text += shortest(item.number) + " ";
    }
    const Status set = setText(param, data, text);
    return set || fail(place, " " + set.error().message);
}

bool JsonReading::readKeys(const Place& place, const KeySet& keys, const std::vector<void*>& structs) {
    if (!expect(place, Json::Type::Object, "an object")) return false;
    const std::vector<std::string_view> known = keys.ids();
    for (std::size_t i = 0; i < place.json.keys.size(); ++i) {
        const std::string& key = place.json.keys[i];
        const Place member = place.at(place.json.items[i], key);
        if (std::find(known.begin(), known.end(), key) == known.end())
            return fail(member, " is an unknown key; the nearest is " + inQuotes(nearest(key, known)));
        for (std::size_t t = 0; t < keys.tables.size(); ++t)
            for (const Param& param : keys.tables[t]->params)
                if (param.id == key &&
                    !readParam(member, param, static_cast<std::byte*>(structs[t]) + param.offset))
                    return false;
    }
    return true;
}

} // namespace lucent::scene

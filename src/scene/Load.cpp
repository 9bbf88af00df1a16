#include "scene/Load.h"

#include "base/Text.h"
#include "scene/Environment.h"
#include "scene/HeightSource.h"
#include "scene/ImageUse.h"
#include "scene/Json.h"
#include "scene/Keys.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {
namespace {

bool isProcedural(std::string_view source) {
    const auto names = proceduralEnvironments();
    return std::find(names.begin(), names.end(), source) != names.end();
}

// A value in the file and its path for messages: "objects.coin.material".
struct Place {
    const Json& json;
    std::string path;

    Place at(const Json& child, std::string_view key) const {
        return {child, path.empty() ? std::string(key) : path + "." + std::string(key)};
    }
};

// Turns the tree into a scene. Functions return false after the first complaint, which is kept.
class Loader {
public:
    Loader(const std::string& path, const ReadFile& read, std::span<const ParamTable* const> techniques)
        : path_(path), read_(read), techniques_(techniques) {}

    Result<Scene> load(const Json& root) {
        Scene scene;
        for (const ParamTable* table : techniques_)
            scene.technique.emplace(table->name, Settings(*table));
        if (!readScene({root, ""}, scene)) return error_;
        return scene;
    }

private:
    // --- complaints ---
    bool fail(const Place& place, const std::string& what) {
        const std::string subject = place.path.empty() ? "the scene" : place.path;
        error_ = {path_ + ":" + std::to_string(place.json.line) + ": " + subject + what};
        return false;
    }
    bool wrongType(const Place& place, std::string_view expected) {
        return fail(place, " is " + place.json.describe() + "; must be " + std::string(expected));
    }
    bool missing(const Place& place, std::string_view key, std::string_view expected) {
        return fail(place.at(place.json, key), " is missing; must be " + std::string(expected));
    }

    bool keepStatus(const Place& place, const Status& status) {
        return status || fail(place, "." + status.error().message);
    }

    // --- plain values ---
    bool expect(const Place& place, Json::Type type, std::string_view expected) {
        return place.json.type == type || wrongType(place, expected);
    }
    bool readText(const Place& place, std::string& text) {
        if (!expect(place, Json::Type::String, "text")) return false;
        text = place.json.string;
        return true;
    }
    bool readBool(const Place& place, bool& value) {
        if (!expect(place, Json::Type::Bool, "true or false")) return false;
        value = place.json.boolean;
        return true;
    }
    bool readFileName(const Place& place, std::string& file) {
        const bool named = place.json.type == Json::Type::String && !place.json.string.empty();
        if (!named) return wrongType(place, "the name of a file");
        file = place.json.string;
        return true;
    }
    bool readSize(const Place& place, ivec2& size) {
        const auto legal = [](const Json& side) {
            return side.type == Json::Type::Number && side.number >= 1 && side.number <= kMaxPictureSide &&
                   side.number == std::floor(side.number);
        };
        const std::vector<Json>& sides = place.json.items;
        if (place.json.type != Json::Type::Array || sides.size() != 2 || !legal(sides[0]) || !legal(sides[1]))
            return wrongSize(place);
        size = {int(sides[0].number), int(sides[1].number)};
        return true;
    }
    bool wrongSize(const Place& place) {
        std::string found = place.json.describe();
        if (place.json.type == Json::Type::Array) {
            found = "[";
            for (const Json& item : place.json.items)
                found += (&item == &place.json.items[0] ? "" : ", ") + item.describe();
            found += "]";
        }
        return fail(place, " is " + found + "; must be two integers in [1, " +
                               std::to_string(kMaxPictureSide) + "]");
    }

    // --- parameters ---
    // The value as the text that setText() reads: one way of checking for files, command line and page.
    bool readParam(const Place& place, const Param& param, void* data) {
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
        } else {
            const bool numbers = json.type == Json::Type::Array && int(json.items.size()) == count &&
                                 std::all_of(json.items.begin(), json.items.end(), [](const Json& item) {
                                     return item.type == Json::Type::Number;
                                 });
            if (!numbers)
                return wrongType(place, "a list of " + std::to_string(count) + " numbers" +
                                            (param.kind == Kind::Color ? " or \"#rrggbb\"" : ""));
            for (const Json& item : json.items)
                text += shortest(item.number) + " ";
        }
        const Status set = setText(param, data, text);
        return set || fail(place, " " + set.error().message);
    }

    // Reads the parameters of an object into their structs, one for each table of `keys`, and refuses keys
    // that nobody knows.
    bool readKeys(const Place& place, const KeySet& keys, std::initializer_list<void*> structs) {
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
                        !readParam(member, param, static_cast<std::byte*>(structs.begin()[t]) + param.offset))
                        return false;
        }
        return true;
    }

    // Calls `read(member, target)` when the object has the key.
    template <class Target>
    bool optional(const Place& place, std::string_view key, bool (Loader::*read)(const Place&, Target&),
                  Target& target) {
        const Json* member = place.json.find(key);
        return !member || (this->*read)(place.at(*member, key), target);
    }

    // --- files ---
    // Reads a file that the scene names and decodes it: `decode(bytes, name)`.
    template <class Value, class Decode>
    bool readFile(const Place& place, const std::string& file, Value& value, Decode decode) {
        const std::string name = resolvePath(path_, file);
        const Result<Bytes> bytes = read_(name);
        if (!bytes) return fail(place, ": " + bytes.error().message);
        auto decoded = decode(*bytes, name);
        if (!decoded) return fail(place, ": " + decoded.error().message);
        value = std::move(*decoded);
        return true;
    }
    bool readMap(const Place& place, std::string_view key, std::string& file,
                 std::shared_ptr<const Image>& map) {
        const Json* json = place.json.find(key);
        if (!json) return true;
        const Place member = place.at(*json, key);
        return readFileName(member, file) && readFile(member, file, map, decodeColors);
    }

    // --- parts of a scene ---
    bool readScene(const Place& place, Scene& scene) {
        if (!readKeys(place, sceneKeys(), {})) return false;
        const Json* version = place.json.find("lucent");
        if (!version) return missing(place, "lucent", "1");
        if (version->type != Json::Type::Number || version->number != 1)
            return wrongType(place.at(*version, "lucent"), "1");
        if (!place.json.find("objects")) return missing(place, "objects", "a list of at least one object");
        return optional(place, "title", &Loader::readText, scene.title) &&
               optional(place, "caption", &Loader::readText, scene.caption) &&
               optional(place, "size", &Loader::readSize, scene.size) &&
               optional(place, "camera", &Loader::readCamera, scene.camera) &&
               optional(place, "view", &Loader::readView, scene.view) &&
               optional(place, "lights", &Loader::readLights, scene.lights) &&
               optional(place, "technique", &Loader::readTechniques, scene.technique) &&
               optional(place, "quality", &Loader::readQuality, scene.quality) &&
               optional(place, "environment", &Loader::readEnvironment, scene.environment) &&
               optional(place, "objects", &Loader::readObjects, scene.objects);
    }
    bool readCamera(const Place& place, Camera& camera) {
        return readKeys(place, cameraKeys(), {&camera}) && keepStatus(place, check(camera));
    }
    bool readView(const Place& place, View& view) { return readKeys(place, viewKeys(), {&view}); }

    bool readQuality(const Place& place, Quality& quality) {
        return readKeys(place, qualityKeys(), {&quality});
    }

    bool readTechniques(const Place& place, std::map<std::string, Settings>& techniques) {
        if (!expect(place, Json::Type::Object, "an object")) return false;
        std::vector<std::string_view> known;
        for (const ParamTable* table : techniques_)
            known.push_back(table->name);
        for (std::size_t i = 0; i < place.json.keys.size(); ++i) {
            const std::string& name = place.json.keys[i];
            const Place member = place.at(place.json.items[i], name);
            const auto found = techniques.find(name);
            if (found == techniques.end())
                return fail(member,
                            " is an unknown technique; the nearest is " + inQuotes(nearest(name, known)));
            const KeySet keys{{&found->second.table()}, {}};
            if (!readKeys(member, keys, {found->second.data()})) return false;
        }
        return true;
    }

    bool readLights(const Place& place, std::vector<Light>& lights) {
        if (!expect(place, Json::Type::Array, "a list")) return false;
        for (std::size_t i = 0; i < place.json.items.size(); ++i)
            if (!readLight(place.at(place.json.items[i], std::to_string(i)), lights.emplace_back()))
                return false;
        return true;
    }
    bool readLight(const Place& place, Light& light) {
        if (!expect(place, Json::Type::Object, "an object")) return false;
        const Json* type = place.json.find("type");
        if (!type) return missing(place, "type", "point or distant");
        const bool point = type->string == "point";
        if (!point && type->string != "distant")
            return wrongType(place.at(*type, "type"), "point or distant");
        const bool read = point ? readKeys(place, pointLightKeys(), {&light.emplace<PointLight>()})
                                : readKeys(place, distantLightKeys(), {&light.emplace<DistantLight>()});
        return read && keepStatus(place, check(light));
    }

    bool readEnvironment(const Place& place, std::optional<Environment>& slot) {
        Environment& environment = slot.emplace();
        if (!readKeys(place, environmentKeys(), {&environment})) return false;
        const Json* source = place.json.find("source");
        const Place member = source ? place.at(*source, "source") : place;
        if (source && !readFileName(member, environment.source)) return false;
        if (!isProcedural(environment.source))
            return readFile(member, environment.source, environment.map, decodeColors);
        environment.map = *loadEnvironmentMap(environment.source, {});
        return true;
    }

    bool readObjects(const Place& place, std::vector<Object>& objects) {
        if (!expect(place, Json::Type::Array, "a list of at least one object")) return false;
        if (place.json.items.empty()) return fail(place, " is empty; must hold at least one object");
        for (std::size_t i = 0; i < place.json.items.size(); ++i) {
            Object object;
            if (!readObject(place, place.json.items[i], std::to_string(i), object)) return false;
            const auto same = [&](const Object& other) { return other.name == object.name; };
            if (std::any_of(objects.begin(), objects.end(), same))
                return fail(place.at(place.json.items[i], std::to_string(i)),
                            ".name is " + inQuotes(object.name) + ", as another object's; must be unique");
            objects.push_back(std::move(object));
        }
        return true;
    }
    bool readObject(const Place& objects, const Json& json, const std::string& number, Object& object) {
        const Place unnamed = objects.at(json, number);
        object.name = number;
        if (!expect(unnamed, Json::Type::Object, "an object")) return false;
        if (const Json* name = json.find("name")) {
            const bool legal = name->type == Json::Type::String && !name->string.empty() &&
                               name->string.find('.') == std::string::npos;
            if (!legal) return wrongType(unnamed.at(*name, "name"), "text without dots");
            object.name = name->string;
        }
        const Place place = objects.at(json, object.name);
        if (!readKeys(place, objectKeys(), {})) return false;
        if (!json.find("shape")) return missing(place, "shape", "an object");
        return optional(place, "visible", &Loader::readBool, object.visible) &&
               optional(place, "transform", &Loader::readTransform, object.transform) &&
               optional(place, "material", &Loader::readMaterial, object.material) &&
               optional(place, "shape", &Loader::readShape, object.field());
    }
    bool readTransform(const Place& place, Transform& transform) {
        return readKeys(place, transformKeys(), {&transform});
    }
    bool readMaterial(const Place& place, Material& material) {
        return readKeys(place, materialKeys(), {&material}) &&
               readMap(place, "baseMap", material.baseMapFile, material.baseMap) &&
               readMap(place, "diffuseMap", material.diffuseMapFile, material.diffuseMap) &&
               readMap(place, "specularMap", material.specularMapFile, material.specularMap);
    }

    bool readShape(const Place& place, HeightField& field) {
        if (!expect(place, Json::Type::Object, "an object")) return false;
        const Json* type = place.json.find("type");
        if (!type) return missing(place, "type", "heightfield");
        if (type->string != "heightfield") return wrongType(place.at(*type, "type"), "heightfield");
        return readKeys(place, shapeKeys(), {&field, &field.source}) && readHeights(place, field) &&
               readAlpha(place, field);
    }
    bool readHeights(const Place& place, HeightField& field) {
        constexpr std::string_view kKeys[] = {"heights", "normalMap",
                                              "mesh"}; // in the order of HeightSource::Kind
        const Json* found = nullptr;
        std::string_view foundKey;
        for (int kind = 0; kind < 3; ++kind) {
            const Json* json = place.json.find(kKeys[kind]);
            if (!json) continue;
            if (found)
                return fail(place, " has " + std::string(foundKey) + " and " + std::string(kKeys[kind]) +
                                       "; must have one of heights, normalMap, mesh");
            found = json;
            foundKey = kKeys[kind];
            field.source.kind = HeightSource::Kind(kind);
        }
        if (!found) return fail(place, " has no heights; must have one of heights, normalMap, mesh");
        if (!refuseMeshKeys(place, field.source.kind) ||
            !optional(place, "resolution", &Loader::readSize, field.source.resolution))
            return false;

        const Place member = place.at(*found, foundKey);
        SourcedHeights sourced;
        const auto decode = [&](std::span<const std::byte> bytes, const std::string& name) {
            return loadHeights(field.source, bytes, name);
        };
        if (!readFileName(member, field.source.file) || !readFile(member, field.source.file, sourced, decode))
            return false;
        field.heights = sourced.image;
        if (field.source.kind == HeightSource::Kind::NormalMap && !place.json.find("heightScale"))
            field.heightScale = sourced.texelsPerHeight * field.texelSize();
        return true;
    }
    // Keys that only a mesh's depth uses would otherwise be ignored in silence.
    bool refuseMeshKeys(const Place& place, HeightSource::Kind kind) {
        if (kind == HeightSource::Kind::Mesh) return true;
        for (const std::string_view key : {"resolution", "meshRotate", "margin", "floorGap"})
            if (const Json* json = place.json.find(key))
                return fail(place.at(*json, key), " is given without a mesh; must stand beside mesh");
        return true;
    }
    bool readAlpha(const Place& place, HeightField& field) {
        if (!optional(place, "alphaIsSolid", &Loader::readBool, field.alphaIsSolid)) return false;
        const Json* json = place.json.find("alpha");
        if (!json) return true;
        const Place member = place.at(*json, "alpha");
        if (!readFileName(member, field.alphaFile) ||
            !readFile(member, field.alphaFile, field.alpha, decodeAlpha))
            return false;
        if (!field.alphaIsSolid) digHoles(field);
        return true;
    }

    const std::string& path_;
    const ReadFile& read_;
    std::span<const ParamTable* const> techniques_;
    Error error_;
};

} // namespace

Result<Scene> load(const std::string& path, const ReadFile& read,
                   std::span<const ParamTable* const> techniques) {
    const Result<Bytes> bytes = read(path);
    if (!bytes) return bytes.error();
    const Result<Json> root = parseJson(*bytes, path);
    if (!root) return root.error();
    return Loader(path, read, techniques).load(*root);
}

Result<std::vector<std::string>> dependencies(const std::string& path, std::span<const std::byte> scene) {
    const Result<Json> root = parseJson(scene, path);
    if (!root) return root.error();
    std::vector<std::string> files;
    const auto collect = [&](const Json& object, std::initializer_list<std::string_view> fileKeys) {
        for (std::size_t i = 0; i < object.keys.size(); ++i) {
            const std::string& name = object.items[i].string;
            const bool isFile = std::find(fileKeys.begin(), fileKeys.end(), object.keys[i]) != fileKeys.end();
            if (!isFile || name.empty() || isProcedural(name)) continue;
            const std::string file = resolvePath(path, name);
            if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
        }
    };
    for (std::size_t i = 0; i < root->keys.size(); ++i) {
        if (root->keys[i] == "environment") collect(root->items[i], {"source"});
        if (root->keys[i] != "objects") continue;
        for (const Json& object : root->items[i].items)
            for (const Json& part : object.items) // only a shape and a material have such keys
                collect(part,
                        {"heights", "normalMap", "mesh", "alpha", "baseMap", "diffuseMap", "specularMap"});
    }
    return files;
}

} // namespace lucent::scene

#include "scene/Load.h"

#include "base/Text.h"
#include "scene/Canvas.h"
#include "scene/Displacement.h"
#include "scene/Environment.h"
#include "scene/FileReading.h"
#include "scene/HeightSource.h"
#include "scene/ImageUse.h"
#include "scene/Json.h"
#include "scene/Keys.h"
#include "scene/MaterialPresets.h"
#include "scene/Memory.h"
#include "scene/Mesh.h"
#include "scene/Painting.h"
#include "scene/ReflectanceTable.h"
#include "scene/Strokes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>

namespace lucent::scene {
namespace {

bool isProcedural(std::string_view source) {
    const auto names = proceduralEnvironments();
    return std::find(names.begin(), names.end(), source) != names.end();
}

// "point, distant, spot or area"
std::string listOf(std::span<const TypeKeys> types) {
    std::string list;
    for (const TypeKeys& one : types)
        (list += list.empty() ? "" : &one == &types.back() ? " or " : ", ") += one.type;
    return list;
}

// Turns the tree into a scene. Functions return false after the first complaint, which is kept.
class Loader : FileReading {
public:
    Loader(const std::string& path, const ReadFile& read, std::span<const ParamTable* const> techniques,
           Decoded& decoded)
        : FileReading(path, read, decoded), techniques_(techniques) {}

    Result<Scene> load(const Json& root) {
        Scene scene;
        for (const ParamTable* table : techniques_)
            scene.technique.emplace(table->name, Settings(*table));
        if (!readScene({root, ""}, scene)) return error();
        return scene;
    }

private:
    // --- plain values ---
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

    // Calls `read(member, target)` when the object has the key.
    template <class Reading, class Target>
    bool optional(const Place& place, std::string_view key, bool (Reading::*read)(const Place&, Target&),
                  Target& target) {
        const Json* member = place.json.find(key);
        return !member || (this->*read)(place.at(*member, key), target);
    }

    // --- colours ---
    bool readColors(const Place& place, const std::string& file, std::shared_ptr<const Image>& map) {
        const std::string name = resolvePath(path(), file);
        return pieces<ColorsMaking>(place, name + " colors", map, name, read_);
    }
    bool readColorMap(const Place& place, std::string_view key, std::string& file,
                      std::shared_ptr<const Image>& map) {
        const Json* json = place.json.find(key);
        if (!json) return true;
        const Place member = place.at(*json, key);
        return readFileName(member, file) && readColors(member, file, map);
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
        std::size_t index = 0;
        if (!readType(place, lightTypes(), index)) return false;
        light = alternative<Light>(index);
        const KeySet& keys = typeOf(light).keys;
        if (!readKeys(place, keys, std::vector<void*>(keys.tables.size(), dataOf(light)))) return false;
        auto* spot = std::get_if<SpotLight>(&light);
        return (!spot || readPicture(place, *spot)) && keepStatus(place, check(light));
    }
    bool readPicture(const Place& place, SpotLight& spot) {
        if (!readMap(place, "image", spot.imageFile, spot.image, decodePicture)) return false;
        for (const Param& param : projectorParams().params)
            if (const Json* json = place.json.find(param.id); json && !spot.image)
                return fail(place.at(*json, param.id),
                            " does nothing without a picture; must stand beside image");
        return true;
    }
    // Which of the types the object under `place` is of.
    bool readType(const Place& place, std::span<const TypeKeys> types, std::size_t& index) {
        if (!expect(place, Json::Type::Object, "an object")) return false;
        const Json* type = place.json.find("type");
        if (!type) return missing(place, "type", listOf(types));
        const auto found = std::find_if(types.begin(), types.end(),
                                        [&](const TypeKeys& one) { return one.type == type->string; });
        if (found == types.end()) return wrongType(place.at(*type, "type"), listOf(types));
        index = std::size_t(found - types.begin());
        return true;
    }

    bool readEnvironment(const Place& place, std::optional<Environment>& slot) {
        Environment& environment = slot.emplace();
        if (!readKeys(place, environmentKeys(), {&environment})) return false;
        const Json* source = place.json.find("source");
        const Place member = source ? place.at(*source, "source") : place;
        if (source && !readFileName(member, environment.source)) return false;
        if (!isProcedural(environment.source)) return readColors(member, environment.source, environment.map);
        environment.map = *loadEnvironmentMap(environment.source, {});
        return true;
    }

    bool readObjects(const Place& place, std::vector<Object>& objects) {
        if (!expect(place, Json::Type::Array, "a list of at least one object")) return false;
        if (place.json.items.empty()) return fail(place, " is empty; must hold at least one object");
        std::set<std::string> names;
        for (std::size_t i = 0; i < place.json.items.size(); ++i) {
            std::vector<Object> read(1);
            if (!readObject(place, place.json.items[i], std::to_string(i), read)) return false;
            for (Object& object : read) {
                if (!names.insert(object.name).second)
                    return fail(place.at(place.json.items[i], std::to_string(i)),
                                ".name is " + inQuotes(object.name) +
                                    ", as another object's; must be unique");
                objects.push_back(std::move(object));
            }
        }
        return true;
    }
    // Reads into the first of `read`; a mesh that brings its materials becomes several.
    bool readObject(const Place& objects, const Json& json, const std::string& number,
                    std::vector<Object>& read) {
        Object& object = read.front();
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
               optional(place, "shape", &Loader::readShape, object) &&
               optional(place, "displacement", &Loader::readDisplacement, object) &&
               optional(place, "paint", &Loader::readPaint, object) &&
               optional(place, "material", &Loader::readMaterial, object) &&
               optional(place, "wave", &Loader::readWave, object) &&
               optional(place, "bake", &Loader::readBake, object) &&
               (json.find("material") || takeMaterials(place, read)) && refuseIdlePaint(place, read);
    }
    bool readTransform(const Place& place, Transform& transform) {
        return readKeys(place, transformKeys(), {&transform});
    }
    // Whether it fits the object only its technique can tell.
    bool readBake(const Place& place, Object& object) {
        const auto share = [](const Bytes& bytes,
                              const std::string&) -> Result<std::shared_ptr<const Bytes>> {
            return std::make_shared<const Bytes>(bytes);
        };
        return readFileName(place, object.bakeFile) && readFile(place, object.bakeFile, object.bake, share);
    }
    bool readWave(const Place& place, Object& object) {
        if (const std::string why = whyIdle(object, "wave"); !why.empty()) return fail(place, why);
        if (!readKeys(place, waveKeys(), {&object.wave})) return false;
        if (!place.json.find("amplitude")) return missing(place, "amplitude", "a list of 3 numbers");
        return keepStatus(place, check(object.wave));
    }

    bool readMaterial(const Place& place, Object& object) {
        if (!expect(place, Json::Type::Object, "an object")) return false;
        Material& material = object.material;
        return chooseKind(place, object) && refuseOtherKinds(place, object) && readKind(place, object) &&
               readPreset(place, material) && readTable(place, material) &&
               keepStatus(place, check(material)) && spendBody(place, object) &&
               readColorMap(place, "baseMap", material.baseMapFile, material.baseMap) &&
               readColorMap(place, "diffuseMap", material.diffuseMapFile, material.diffuseMap) &&
               readColorMap(place, "specularMap", material.specularMapFile, material.specularMap);
    }
    bool readTable(const Place& place, Material& material) {
        auto* measured = std::get_if<MeasuredBrdf>(&material.kind);
        if (!measured) return true;
        const Json* json = place.json.find("table");
        if (!json) return missing(place, "table", "the name of a file");
        const auto decode = [&](std::span<const std::byte> bytes, const std::string& name) {
            return decodeTable(bytes, name, measured->form, measured->blocks);
        };
        if (measured->form == TableForm::Merl)
            return readMap(place, "table", measured->tableFile, measured->table, decode);
        if (!readColorMap(place, "table", measured->tableFile, measured->table)) return false;
        const Status fits = checkTable(*measured->table, measured->form, measured->blocks);
        return fits || fail(place.at(*json, "table"),
                            ": " + resolvePath(path(), measured->tableFile) + ": " + fits.error().message);
    }
    // A height field that is no relief is drawn as triangles.
    bool spendBody(const Place& place, const Object& object) {
        const auto* field = std::get_if<HeightField>(&object.shape);
        if (!field || object.isField()) return true;
        const ivec2 texels = field->texels();
        const std::string why = whyTooLarge(std::to_string(texels.x) + " x " + std::to_string(texels.y),
                                            bytes_ += bytesOfBody(*field));
        return why.empty() || fail(place, ": the map of heights" + why);
    }
    // The kind that the file names, or that of the one number above 0 that makes a kind.
    bool chooseKind(const Place& place, Object& object) {
        KindChoice choice;
        for (const Param& param : choiceParams().params)
            if (const Json* json = place.json.find(param.id))
                if (!readParam(place.at(*json, param.id), param,
                               reinterpret_cast<std::byte*>(&choice) + param.offset))
                    return false;
        struct Maker {
            std::string_view key;
            MaterialKind kind;
            bool says;
        };
        const bool isMeasured = place.json.find("preset") != nullptr;
        const Maker makers[] = {{"transmission", MaterialKind::Clear, choice.transmission > 0},
                                {"reflectance", MaterialKind::Mirror, choice.reflectance != vec3(0)},
                                {"scattering", MaterialKind::Translucent, choice.scattering != vec3(0)},
                                {"preset", MaterialKind::Translucent, isMeasured}};
        const bool isNamed = place.json.find("kind") != nullptr;
        MaterialKind kind = isNamed ? choice.kind : ownKind(object.shape);
        std::string_view maker = isNamed ? "kind" : "";
        for (const Maker& one : makers) {
            if (!one.says || one.kind == kind) continue;
            if (!maker.empty())
                return fail(place.at(*place.json.find(one.key), one.key),
                            " makes another kind of material than " + std::string(maker) +
                                "; must stand without it");
            kind = one.kind;
            maker = one.key;
        }
        object.material.kind = alternative<MaterialKinds>(std::size_t(kind));
        return true;
    }
    // Keys that change nothing about the object would otherwise be ignored in silence.
    bool refuseOtherKinds(const Place& place, const Object& object) {
        for (std::size_t i = 0; i < place.json.keys.size(); ++i)
            if (const std::string why = whyIdle(object, place.json.keys[i]); !why.empty())
                return fail(place.at(place.json.items[i], place.json.keys[i]), why);
        return true;
    }
    bool readKind(const Place& place, Object& object) {
        Material& material = object.material;
        KindChoice known;
        Attenuation attenuation;
        const KeySet& own = materialKeysOf(object);
        KeySet keys{{&choiceParams()}, own.keys};
        std::vector<void*> structs{&known};
        for (const ParamTable* table : own.tables) {
            keys.tables.push_back(table);
            structs.push_back(table == &attenuationParams() ? &attenuation : structOf(material, *table));
        }
        if (!readKeys(place, keys, structs)) return false;
        if (material.isScattering() &&
            !optional(place, "layers", &Loader::readLayers, material.translucent().layers))
            return false;
        const Json *color = place.json.find("attenuationColor"),
                   *distance = place.json.find("attenuationDistance");
        for (const std::string_view other : {"attenuationColor", "attenuationDistance"})
            if (place.json.find("absorption") && place.json.find(other))
                return fail(place,
                            " has absorption and " + std::string(other) +
                                "; must have absorption, or attenuationColor with attenuationDistance");
        if (color && !distance)
            return fail(place.at(*color, "attenuationColor"),
                        " is given without a distance; must stand beside attenuationDistance");
        return !distance || keepStatus(place, store(attenuation, "attenuationDistance", material));
    }
    bool readLayers(const Place& place, std::vector<MediumLayer>& layers) {
        const std::string expected = "a list of at most " + std::to_string(kMostMediumLayers) + " layers";
        if (!expect(place, Json::Type::Array, expected)) return false;
        if (place.json.items.size() > kMostMediumLayers)
            return fail(place,
                        " has " + std::to_string(place.json.items.size()) + " layers; must be " + expected);
        for (std::size_t i = 0; i < place.json.items.size(); ++i)
            if (!readLayer(place.at(place.json.items[i], std::to_string(i)), layers.emplace_back()))
                return false;
        return true;
    }
    // Keys beside the preset replace its values.
    bool readLayer(const Place& place, MediumLayer& layer) {
        if (!readKeys(place, layerKeys(), {&layer})) return false;
        const Json* json = place.json.find("preset");
        if (!json) return true;
        const MaterialPreset* preset = nullptr;
        if (!readPresetName(place.at(*json, "preset"), preset)) return false;
        MediumLayer measured = layer;
        apply(*preset, measured);
        if (!place.json.find("scattering")) layer.scattering = measured.scattering;
        if (!place.json.find("absorption")) layer.absorption = measured.absorption;
        if (!place.json.find("ior")) layer.ior = measured.ior;
        return true;
    }
    bool readPresetName(const Place& member, const MaterialPreset*& preset) {
        std::string name;
        if (!readText(member, name)) return false;
        const auto presets = materialPresets();
        const auto found = std::find_if(presets.begin(), presets.end(),
                                        [&](const MaterialPreset& preset) { return preset.name == name; });
        if (found == presets.end()) {
            std::string known;
            for (const MaterialPreset& preset : presets)
                (known += known.empty() ? "" : &preset == &presets.back() ? " or " : ", ") += preset.name;
            return wrongType(member, known);
        }
        preset = &*found;
        return true;
    }
    // Keys beside the preset replace its values.
    bool readPreset(const Place& place, Material& material) {
        const Json* json = place.json.find("preset");
        if (!json) return true;
        const MaterialPreset* preset = nullptr;
        if (!readPresetName(place.at(*json, "preset"), preset)) return false;
        Translucent& inside = material.translucent();
        const Translucent own = inside;
        apply(*preset, inside);
        if (place.json.find("scattering")) inside.scattering = own.scattering;
        if (place.json.find("ior")) inside.ior = own.ior;
        if (place.json.find("absorption") || place.json.find("attenuationDistance"))
            inside.absorption = own.absorption;
        return true;
    }

    // --- paint
    // Maps of files, or unpainted ones, and strokes on top of them. The shape is known.
    bool readPaint(const Place& place, Object& object) {
        PaintSource source;
        Painting files;
        if (const std::string why = whyIdle(object, "paint"); !why.empty()) return fail(place, why);
        if (!readKeys(place, paintKeys(), {&source}) ||
            !readMap(place, "entering", files.enteringFile, files.entering, decodeEntering) ||
            !readMap(place, "leaving", files.leavingFile, files.leaving, decodeLeaving) ||
            !optional(place, "strokes", &Loader::readStrokes, files))
            return false;
        const Image* map = files.entering ? files.entering.get() : files.leaving.get();
        if (files.entering && files.leaving && files.entering->width != files.leaving->width)
            return fail(place, " has maps of " + std::to_string(files.entering->width) + " and " +
                                   std::to_string(files.leaving->width) +
                                   " texels a side; must be equally large");
        if (const Json* side = place.json.find("side"); side && map)
            return fail(place.at(*side, "side"), " is given beside maps; must stand without them");
        if (!map && !place.json.find("strokes"))
            return fail(place, " holds no paint; must have entering, leaving or strokes");
        const int side = map ? map->width : source.side;
        if (!spend(place, "side", std::to_string(side), bytesOfPaint(side))) return false;
        std::shared_ptr<Canvas> canvas;
        if (!play(place, object, files, side, canvas)) return false;
        files.entering = canvas->entering();
        files.leaving = canvas->leaving();
        files.scale = object.transform.scale;
        object.painting = std::make_shared<const Painting>(std::move(files));
        return true;
    }
    // An atlas that the object keeps.
    bool lay(const Place& place, const Object& object, int side, std::shared_ptr<const Atlas>& atlas) {
        const std::pair source(meshOf(object), side);
        if (!pieces<AtlasMaking>(place, place.path + " atlas", atlas, source.first, Charting{side}))
            return false;
        object.kept.of<std::shared_ptr<const Atlas>>(source, [&] { return atlas; });
        return true;
    }
    // Paints the strokes piece by piece: the atlas, its texels, one stroke after the other.
    bool play(const Place& place, Object& object, const Painting& painting, int side,
              std::shared_ptr<Canvas>& canvas) {
        std::shared_ptr<const Atlas> atlas;
        std::shared_ptr<const PaintSurface> surface;
        if (!piece(place, place.path + " kept", object.kept, [&]() -> Result<Kept> { return object.kept; }) ||
            !lay(place, object, side, atlas) ||
            !pieces<PaintSurfaceMaking>(place, place.path + " texels", surface, atlas) ||
            !piece(place, place.path + " canvas", canvas, [&]() -> Result<std::shared_ptr<Canvas>> {
                return std::make_shared<Canvas>(surface, object.transform.scale, painting.entering,
                                                painting.leaving, 0);
            }))
            return false;
        object.kept.of<PaintSurfaceMaking::Made>(atlas, [&] { return surface; }); // for who goes on painting
        while (canvas->strokes().size() < painting.strokes.size()) {
            if (decoded_.isOver()) return false;
            canvas->addSome(painting.strokes[canvas->strokes().size()]);
            decoded_.isNew = true;
        }
        return true;
    }
    // The name of a script, or the strokes themselves.
    bool readStrokes(const Place& place, Painting& painting) {
        if (place.json.type == Json::Type::Array) {
            Result<std::vector<Stroke>> strokes = strokesFrom(place, path());
            if (!strokes) return keep(strokes.error());
            painting.strokes = std::move(*strokes);
            return true;
        }
        if (place.json.type != Json::Type::String || place.json.string.empty())
            return wrongType(place, "the name of a file or a list of strokes");
        painting.strokesFile = place.json.string;
        return readFile(place, painting.strokesFile, painting.strokes, parseStrokes);
    }
    // Materials may come from the file of a mesh, so that this is known last.
    bool refuseIdlePaint(const Place& place, const std::vector<Object>& read) {
        const Json* json = place.json.find("paint");
        if (!json) return true;
        if (read.size() > 1)
            return fail(place.at(*json, "paint"), " is for one object, but the file brings " +
                                                      std::to_string(read.size()) +
                                                      " materials; must stand beside a part or a material");
        return read[0].material.isScattering() ||
               fail(place.at(*json, "paint"),
                    " does nothing where nothing scatters; must stand on a translucent object");
    }

    // --- meshes
    bool readMesh(const Place& place, MeshShape& shape) {
        if (!readKeys(place, typeOf(Shape(shape)).keys, {&shape})) return false;
        const Json* source = place.json.find("source");
        if (!source) return missing(place, "source", "the name of a file");
        const Place member = place.at(*source, "source");
        if (!readFileName(member, shape.source)) return false;
        std::shared_ptr<const Mesh>& whole = meshes_[{shape.source, ""}];
        const std::string file = resolvePath(path(), shape.source);
        if (!whole && !(pieces<MeshMaking>(member, file + " mesh", whole, file, read_) &&
                        spendTextures(place, shape.source, *whole)))
            return false;
        shape.mesh = whole;
        return optional(place, "part", &Loader::readPart, shape);
    }
    // Once here and once on the GPU.
    bool spendTextures(const Place& place, const std::string& source, const Mesh& mesh) {
        double texels = 0;
        for (const auto& image : mesh.images)
            texels += double(image->texels.size());
        return spend(place, "source",
                     inQuotes(source) + " with " + std::to_string(std::lround(texels / 1e6)) +
                         " MB of textures",
                     2 * texels);
    }
    bool readPart(const Place& place, MeshShape& shape) {
        std::string wanted;
        if (!readText(place, wanted)) return false;
        std::vector<std::string_view> known;
        for (const Mesh::Part& part : shape.mesh->parts) {
            known.push_back(part.material);
            if (part.material != wanted) continue;
            usePart(shape, part);
            return true;
        }
        if (known.empty())
            return fail(place,
                        " is " + inQuotes(wanted) + ", but the file has no materials; must be left out");
        return fail(place, " is " + inQuotes(wanted) + ", no material of the file; the nearest is " +
                               inQuotes(nearest(wanted, known)));
    }
    // `part` belongs to the whole mesh that the shape holds.
    void usePart(MeshShape& shape, const Mesh::Part& part) {
        std::shared_ptr<const Mesh>& mesh = meshes_[{shape.source, part.material}];
        if (!mesh) mesh = std::make_shared<Mesh>(partOf(*shape.mesh, part));
        shape.part = part.material;
        shape.mesh = mesh;
    }
    // An object without a material of its own takes those of its file.
    bool takeMaterials(const Place& place, std::vector<Object>& read) {
        const Object object = read.front();
        const auto* shape = std::get_if<MeshShape>(&object.shape);
        if (!shape) return true;
        const std::shared_ptr<const Mesh> whole = meshes_[{shape->source, ""}];
        if (whole->parts.empty()) return true;
        read.clear();
        for (const Mesh::Part& part : whole->parts) {
            if (!shape->part.empty() && shape->part != part.material) continue;
            Object& taken = read.emplace_back(object);
            if (shape->part.empty()) {
                usePart(std::get<MeshShape>(taken.shape), part);
                taken.name += "/" + part.material;
                std::replace(taken.name.begin(), taken.name.end(), '.', '-'); // paths are cut at dots
            }
            if (!takeMaterial(place, part, taken)) return false;
        }
        return true;
    }
    // Only what a scene file could say as well.
    bool takeMaterial(const Place& place, const Mesh::Part& part, Object& object) {
        object.material = part.values;
        const auto complain = [&](const std::string& what) {
            return fail(place, ".shape.source: material " + inQuotes(part.material) + ": " + what);
        };
        for (const ParamTable* table : materialKeysOf(object).tables) {
            if (table == &attenuationParams()) continue;
            const auto* values = static_cast<const std::byte*>(structOf(part.values, *table));
            for (const Param& param : table->params)
                if (Status legal = checkRange(param, values + param.offset); !legal)
                    return complain(std::string(param.id) + " " + legal.error().message);
        }
        const Status legal = check(object.material);
        return legal || complain(legal.error().message);
    }

    // --- shapes
    bool readShape(const Place& place, Object& object) {
        std::size_t index = 0;
        if (!readType(place, shapeTypes(), index)) return false;
        object.shape = alternative<Shape>(index);
        object.material.kind = alternative<MaterialKinds>(std::size_t(ownKind(object.shape)));
        if (object.isField()) return readHeightField(place, object.field());
        if (auto* mesh = std::get_if<MeshShape>(&object.shape)) return readMesh(place, *mesh);
        const auto* water = std::get_if<Water>(&object.shape);
        return readKeys(place, typeOf(object.shape).keys, {dataOf(object.shape)}) &&
               keepStatus(place, check(object.shape)) &&
               (!water || spend(place, "cells", std::to_string(water->cells), bytesOf(*water)));
    }
    bool readDisplacement(const Place& place, Object& object) {
        if (const std::string why = whyIdle(object, "displacement"); !why.empty()) return fail(place, why);
        Displacement displacement;
        SourcedHeights sourced;
        if (!readKeys(place, displacementKeys(), {&displacement, &displacement.source}) ||
            !readHeights(place, displacement.source, sourced))
            return false;
        displacement.heights = sourced.image;
        object.displacement = std::move(displacement);
        return keepStatus(place, checkDisplacement(object));
    }
    bool readHeightField(const Place& place, HeightField& field) {
        SourcedHeights sourced;
        if (!readKeys(place, shapeTypes()[0].keys, {&field, &field.source}) ||
            !readHeights(place, field.source, sourced))
            return false;
        field.heights = sourced.image;
        if (field.source.kind == HeightSource::Kind::NormalMap && !place.json.find("heightScale"))
            field.heightScale = sourced.texelsPerHeight * field.texelSize();
        return readAlpha(place, field);
    }
    bool readHeights(const Place& place, HeightSource& source, SourcedHeights& sourced) {
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
            source.kind = HeightSource::Kind(kind);
        }
        if (!found) return fail(place, " has no heights; must have one of heights, normalMap, mesh");
        if (!refuseMeshKeys(place, source.kind) ||
            !optional(place, "resolution", &Loader::readSize, source.resolution))
            return false;

        const ivec2 resolution = source.resolution;
        if (source.kind == HeightSource::Kind::Mesh &&
            !spend(place, "resolution", std::to_string(resolution.x) + " x " + std::to_string(resolution.y),
                   bytesOfHeights(resolution)))
            return false;

        const Place member = place.at(*found, foundKey);
        if (!readFileName(member, source.file)) return false;
        const bool isMesh =
            source.kind == HeightSource::Kind::Mesh; // which turns and fits it as its place says
        const std::string file = resolvePath(path(), source.file);
        return pieces<HeightsMaking>(member, file + " " + (isMesh ? member.path : std::string(foundKey)),
                                     sourced, source, file, read_);
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

    std::span<const ParamTable* const> techniques_;
    std::map<std::pair<std::string, std::string>, std::shared_ptr<const Mesh>> meshes_; // by source and part
};

} // namespace

Result<Scene> load(const std::string& path, const ReadFile& read,
                   std::span<const ParamTable* const> techniques) {
    return *Loading(path, read, techniques).advance(std::numeric_limits<double>::infinity());
}

struct Loading::State {
    std::string path;
    ReadFile read;
    std::span<const ParamTable* const> techniques;
    Decoded decoded{};
    std::optional<Result<Json>> root{};

    Result<Json> parse() const {
        const Result<Bytes> bytes = read(path);
        return bytes ? parseJson(*bytes, path) : Result<Json>(bytes.error());
    }
};

Loading::Loading(const std::string& path, ReadFile read, std::span<const ParamTable* const> techniques)
    : state_(std::make_unique<State>(State{path, std::move(read), techniques})) {}
Loading::~Loading() = default;

std::optional<Result<Scene>> Loading::advance(double ms) {
    using Clock = std::chrono::steady_clock;
    State& s = *state_;
    const bool begins = !s.root;
    if (begins) s.root = s.parse();
    if (!*s.root) return s.root->error();
    const std::chrono::duration<double, std::milli> patience(std::min(ms, 1e9));
    s.decoded.until = Clock::now() + std::chrono::duration_cast<Clock::duration>(patience);
    s.decoded.pauses = false;
    s.decoded.isNew = begins; // the tree, which takes its time, too
    Result<Scene> scene = Loader(s.path, s.read, s.techniques, s.decoded).load(**s.root);
    if (s.decoded.pauses || s.decoded.isOver()) return std::nullopt; // whoever takes it has work, too
    return scene;
}

Result<std::vector<std::string>> dependencies(const std::string& path, std::span<const std::byte> scene) {
    const Result<Json> root = parseJson(scene, path);
    if (!root) return root.error();
    std::vector<std::string> files;
    const auto collect = [&](const Json& object, const KeySet& keys) {
        for (std::size_t i = 0; i < object.keys.size(); ++i) {
            const std::string& name = object.items[i].string;
            const bool isFile = std::any_of(keys.keys.begin(), keys.keys.end(), [&](const Key& key) {
                return (key.type == KeyType::File || key.type == KeyType::Strokes) &&
                       key.id == object.keys[i];
            });
            if (!isFile || name.empty()) continue;
            const std::string file = resolvePath(path, name);
            if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
        }
    };
    for (std::size_t i = 0; i < root->keys.size(); ++i) {
        const Json& item = root->items[i];
        if (root->keys[i] == "environment") {
            const Json* source = item.find("source");
            if (source && !isProcedural(source->string)) collect(item, environmentKeys());
        }
        if (root->keys[i] == "lights")
            for (const Json& light : item.items)
                for (const TypeKeys& type : lightTypes())
                    collect(light, type.keys);
        if (root->keys[i] != "objects") continue;
        for (const Json& object : item.items)
            for (std::size_t k = 0; k < object.keys.size(); ++k) {
                if (object.keys[k] == "material") collect(object.items[k], materialKeys());
                if (object.keys[k] == "paint") collect(object.items[k], paintKeys());
                if (object.keys[k] == "displacement") collect(object.items[k], displacementKeys());
                if (object.keys[k] != "shape") continue;
                for (const TypeKeys& type : shapeTypes())
                    collect(object.items[k], type.keys);
            }
    }
    return files;
}

} // namespace lucent::scene

// The published JSON Schema of scene files.
#include "base/JsonWriter.h"
#include "scene/Keys.h"
#include "scene/Load.h"
#include "scene/MaterialPresets.h"

#include <set>

namespace lucent::scene {
namespace {

void writeBounds(JsonWriter& json, const Param& param) {
    if (param.min == kAboveZero)
        json.key("exclusiveMinimum").value(0);
    else if (param.min != -kLimitless)
        json.key("minimum").value(param.min);
    if (param.max != kLimitless) json.key("maximum").value(param.max);
}

// "type": "array" of numbers, each within the parameter's bounds.
void writeNumbers(JsonWriter& json, const Param& param) {
    const int count = componentCount(param.kind);
    json.key("type").value("array");
    json.key("items").beginObject().key("type").value("number");
    writeBounds(json, param);
    json.end();
    json.key("minItems").value(count).key("maxItems").value(count);
}

// A number that is not negative, or three.
void writeCoefficientType(JsonWriter& json, double most = kFar) {
    const auto writeNumber = [&] {
        json.beginObject().key("type").value("number");
        json.key("minimum").value(0).key("maximum").value(most).end();
    };
    json.key("anyOf").beginArray();
    writeNumber();
    json.beginObject().key("type").value("array");
    json.key("items");
    writeNumber();
    json.key("minItems").value(3).key("maxItems").value(3).end();
    json.end();
}

void writeType(JsonWriter& json, const Param& param) {
    switch (param.kind) {
    case Kind::Toggle:
        json.key("type").value("boolean");
        break;
    case Kind::Choice:
        json.key("enum").beginArray();
        for (const std::string_view choice : param.choices)
            json.value(choice);
        json.end();
        break;
    case Kind::Color:
        json.key("anyOf").beginArray().beginObject();
        writeNumbers(json, param);
        json.end().beginObject();
        json.key("type").value("string").key("pattern").value("^#[0-9a-fA-F]{6}$");
        json.end().end();
        break;
    case Kind::Vector:
        if (param.axes == "rgb") return writeCoefficientType(json, param.max);
        writeNumbers(json, param);
        break;
    case Kind::Range:
    case Kind::Pair:
        writeNumbers(json, param);
        break;
    default:
        json.key("type").value(param.kind == Kind::Integer ? "integer" : "number");
        writeBounds(json, param);
    }
}

void writeParam(JsonWriter& json, const Param& param) {
    json.key(param.id).beginObject();
    writeType(json, param);
    json.key("description")
        .value(std::string(param.doc) + (param.unit.empty() ? "" : " [" + std::string(param.unit) + "]"));
    json.end();
}

// A picture's width and height.
void writeSizeType(JsonWriter& json) {
    json.key("type").value("array");
    json.key("items").beginObject().key("type").value("integer");
    json.key("minimum").value(1).key("maximum").value(kMaxPictureSide).end();
    json.key("minItems").value(2).key("maxItems").value(2);
}

class SchemaWriter {
public:
    explicit SchemaWriter(std::span<const ParamTable* const> techniques) : techniques_(techniques) {}

    std::string write() {
        json_.beginObject();
        json_.key("$schema").value("https://json-schema.org/draft/2020-12/schema");
        json_.key("title").value("Lucent scene");
        writeObject(sceneKeys(), {"lucent", "objects"});
        json_.end();
        return json_.text();
    }

private:
    // Members of the schema of one object of the file, inside an object that is already open.
    void writeObject(const KeySet& keys, std::initializer_list<std::string_view> required = {}) {
        json_.key("type").value("object");
        json_.key("properties").beginObject();
        std::set<std::string_view> written; // kinds of a material share keys
        for (const ParamTable* table : keys.tables)
            for (const Param& param : table->params)
                if (written.insert(param.id).second) writeParam(json_, param);
        for (const Key& key : keys.keys)
            writeKey(key);
        json_.end();
        if (required.size()) {
            json_.key("required").beginArray();
            for (const std::string_view id : required)
                json_.value(id);
            json_.end();
        }
        json_.key("additionalProperties").value(false);
    }

    void writeKey(const Key& key) {
        json_.key(key.id).beginObject();
        json_.key("description").value(key.doc);
        writeKeyType(key);
        json_.end();
    }

    void writeKeyType(const Key& key) {
        switch (key.type) {
        case KeyType::Constant:
            json_.key("const").raw(key.constant);
            break;
        case KeyType::Text:
            json_.key("type").value("string");
            break;
        case KeyType::Name:
            json_.key("type").value("string").key("pattern").value("^[^.]+$");
            break;
        case KeyType::File:
            json_.key("type").value("string").key("minLength").value(1);
            break;
        case KeyType::Toggle:
            json_.key("type").value("boolean").key("default").value(true);
            break;
        case KeyType::Size:
            writeSizeType(json_);
            break;
        case KeyType::Preset:
            json_.key("enum").beginArray();
            for (const MaterialPreset& preset : materialPresets())
                json_.value(preset.name);
            json_.end();
            break;
        case KeyType::Coefficient:
            writeCoefficientType(json_);
            break;
        case KeyType::Strokes:
            writeStrokes();
            break;
        case KeyType::Content:
            writeContent(key.id);
            break;
        }
    }

    void writeContent(std::string_view id) {
        if (id == "camera")
            writeObject(cameraKeys());
        else if (id == "view")
            writeObject(viewKeys());
        else if (id == "environment")
            writeObject(environmentKeys());
        else if (id == "lights")
            writeLights();
        else if (id == "objects")
            writeObjects();
        else if (id == "technique")
            writeTechniques();
        else if (id == "quality")
            writeObject(qualityKeys());
        else if (id == "shape")
            writeTypes(shapeTypes());
        else if (id == "material")
            writeObject(materialKeys());
        else if (id == "layers")
            writeLayers();
        else if (id == "transform")
            writeObject(transformKeys());
        else if (id == "wave")
            writeObject(waveKeys(), {"amplitude"});
        else if (id == "displacement") {
            writeObject(displacementKeys());
            writeHeightSources();
        } else if (id == "paint")
            writeObject(paintKeys());
        else if (id == "dabs")
            writeDabs();
        else if (id == "fill")
            writeFill();
    }

    // A file, or the list that stands in it.
    void writeStrokes() {
        json_.key("anyOf").beginArray();
        json_.beginObject().key("type").value("string").key("minLength").value(1).end();
        json_.beginObject().key("type").value("array").key("items").beginObject();
        writeObject(strokeKeys(), {"brush"});
        json_.key("oneOf").beginArray();
        for (const std::string_view what : {"dabs", "fill"})
            json_.beginObject().key("required").beginArray().value(what).end().end();
        json_.end().end().end().end();
    }
    void writeDabs() {
        json_.key("type").value("array").key("items").beginObject();
        json_.key("type").value("array").key("items").beginObject().key("type").value("number").end();
        json_.key("minItems").value(7).key("maxItems").value(7).end();
    }
    void writeFill() {
        json_.key("type").value("object").key("properties").beginObject();
        for (const std::string_view end : {"low", "high"}) {
            json_.key(end).beginObject().key("type").value("array").key("items").beginObject();
            json_.key("type").beginArray().value("number").value("null").end().end();
            json_.key("minItems").value(3).key("maxItems").value(3).end();
        }
        json_.key("veins").beginObject().key("type").value("number").key("exclusiveMinimum").value(0).end();
        json_.end().key("additionalProperties").value(false);
    }

    void writeLights() {
        json_.key("type").value("array").key("items").beginObject();
        writeTypes(lightTypes());
        json_.end();
    }

    // One schema for each "type".
    void writeTypes(std::span<const TypeKeys> types) {
        json_.key("oneOf").beginArray();
        for (const TypeKeys& one : types) {
            json_.beginObject();
            writeType(one);
            json_.end();
        }
        json_.end();
    }
    void writeType(const TypeKeys& one) {
        if (one.type == "mesh") return writeObject(one.keys, {"type", "source"});
        writeObject(one.keys, {"type"});
        if (one.type == "heightfield") writeHeightSources();
    }
    // Exactly one of them.
    void writeHeightSources() {
        json_.key("oneOf").beginArray();
        for (const std::string_view source : {"heights", "normalMap", "mesh"})
            json_.beginObject().key("required").beginArray().value(source).end().end();
        json_.end();
    }

    void writeObjects() {
        json_.key("type").value("array").key("minItems").value(1).key("items").beginObject();
        writeObject(objectKeys(), {"shape"});
        json_.end();
    }

    void writeLayers() {
        json_.key("type").value("array").key("maxItems").value(int(kMostMediumLayers));
        json_.key("items").beginObject();
        writeObject(layerKeys());
        json_.end();
    }

    void writeTechniques() {
        json_.key("type").value("object").key("properties").beginObject();
        for (const ParamTable* table : techniques_) {
            json_.key(table->name).beginObject();
            writeObject({{table}, {}});
            json_.end();
        }
        json_.end().key("additionalProperties").value(false);
    }

    JsonWriter json_;
    std::span<const ParamTable* const> techniques_;
};

} // namespace

std::string jsonSchema(std::span<const ParamTable* const> techniques) {
    return SchemaWriter(techniques).write();
}

} // namespace lucent::scene

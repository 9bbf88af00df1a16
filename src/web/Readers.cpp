/// The page's second module: it turns glTF and EXR into what the first one reads, and is fetched only when a
/// scene names such a file. C functions as in Api.h; strings returned stay valid until the next call that
/// returns one.

#include "scene/readers/Readers.h"
#include "base/JsonWriter.h"
#include "scene/readers/Obj.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>

using namespace lucent;

namespace {

struct Converter {
    std::map<std::string, Bytes> files;
    Bytes plain;
    std::string answer;
};

Converter& converter() {
    static Converter only;
    return only;
}

const char* answer(std::string text) {
    converter().answer = std::move(text);
    return converter().answer.c_str();
}

int hexDigit(char c) {
    const std::string_view digits = "0123456789abcdef";
    const std::size_t place = digits.find(char(c | 0x20));
    return place == digits.npos ? -1 : int(place);
}

// A URI names a file as a URL does: %20 is a blank.
std::string decodedUri(const std::string& uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded =
            uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0;
        name += coded ? char(hexDigit(uri[i + 1]) * 16 + hexDigit(uri[i + 2])) : uri[i];
        i += coded ? 2 : 0;
    }
    return name;
}

std::string namesJson(const std::vector<std::string>& names) {
    JsonWriter json;
    json.beginArray();
    for (const std::string& name : names)
        json.value(name);
    return json.end().text();
}

// Files were put under the names that reader_needs() gave, which are relative to the file that needs them.
ReadFile filesBeside(const std::string& name) {
    return [name](const std::string& path) -> Result<Bytes> {
        for (const auto& [key, bytes] : converter().files)
            if (resolvePath(name, key) == path) return bytes;
        return Error{path + ": was not fetched; must lie beside " + name};
    };
}

} // namespace

extern "C" {

/// Keeps a file for the next conversion; the bytes are copied.
void reader_file_put(const char* name, const std::uint8_t* bytes, int size) {
    const auto content = std::as_bytes(std::span(bytes, std::size_t(size)));
    converter().files[name] = Bytes(content.begin(), content.end());
}

/// 1 for bytes that reader_to_plain() would change.
int reader_is_foreign(const char* name, const std::uint8_t* bytes, int size) {
    return scene::isForeign(name, std::as_bytes(std::span(bytes, std::size_t(size))));
}

/// JSON array of the files that a .gltf which was put keeps its data in, relative to it, or those in which an
/// .obj has its materials. A text that is no glTF needs nothing here: reader_to_plain() says what is wrong
/// with it.
const char* reader_needs(const char* name) {
    const Bytes& bytes = converter().files[name];
    if (scene::isObj(name)) return answer(namesJson(scene::materialFilesOf(bytes)));
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const nlohmann::json gltf = nlohmann::json::parse(text, text + bytes.size(), nullptr, false);
    std::vector<std::string> names;
    const auto buffers = gltf.find("buffers"); // of anything but an object: its end
    if (buffers != gltf.end() && buffers->is_array())
        for (const nlohmann::json& buffer : *buffers) {
            const auto uri = buffer.find("uri");
            if (uri == buffer.end() || !uri->is_string()) continue;
            const auto& place = uri->get_ref<const std::string&>();
            if (!place.starts_with("data:")) names.push_back(decodedUri(place));
        }
    return answer(namesJson(names));
}

/// Converts a file that was put and forgets all files. "" or the message; the result is at reader_bytes().
const char* reader_to_plain(const char* name) {
    Converter& c = converter();
    Result<Bytes> plain = scene::toPlain(name, std::move(c.files[name]), filesBeside(name));
    c.files.clear();
    if (!plain) return answer(plain.error().message);
    c.plain = std::move(*plain);
    return answer(std::string());
}

const std::uint8_t* reader_bytes() { return reinterpret_cast<const std::uint8_t*>(converter().plain.data()); }
int reader_size() { return int(converter().plain.size()); }
}

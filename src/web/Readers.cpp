/// The page's second module: it turns glTF and EXR into what the first one reads and a person's own files
/// into scenes, and is fetched only when a scene names such a file or a person brings one. C functions as in
/// Api.h; strings returned stay valid until the next call that returns one.

#include "scene/readers/Readers.h"
#include "base/JsonWriter.h"
#include "scene/Ptm.h"
#include "scene/readers/GltfTextures.h"
#include "scene/readers/Obj.h"
#include "scene/readers/Photos.h"
#include "web/Files.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>

using namespace lucent;

namespace {

struct Converter {
    PutFiles files;
    Bytes plain;
    scene::Brought brought;
    std::vector<scene::LitPhoto> photos; // that a light file names
    std::optional<scene::PhotometricStereo> stereo;
    std::size_t photo = 0; // the next to come
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

// Files that the elements of a glTF file's list name.
std::vector<std::string> filesIn(const nlohmann::json& gltf, const char* list) {
    std::vector<std::string> names;
    const auto elements = gltf.find(list); // of anything but an object: its end
    if (elements == gltf.end() || !elements->is_array()) return names;
    for (const nlohmann::json& element : *elements) {
        const auto uri = element.find("uri");
        if (uri == element.end() || !uri->is_string()) continue;
        const auto& place = uri->get_ref<const std::string&>();
        if (!place.starts_with("data:")) names.push_back(scene::decodedUri(place));
    }
    return names;
}

// Where a picture lies in the file that uses it, bytes.
struct Inside {
    std::size_t at, size;
};

// The text of a glTF file of either form.
struct GltfText {
    std::string_view text;
    std::size_t data = 0; // bytes before those that the file brings itself; 0: it brings none
};

GltfText textOf(std::span<const std::byte> file) {
    constexpr std::size_t kHeader = 12, kChunkHeader = 8, kText = kHeader + kChunkHeader;
    const std::string_view all(reinterpret_cast<const char*>(file.data()), file.size());
    if (!all.starts_with("glTF") || all.size() < kText) return {all};
    std::uint32_t length;
    std::memcpy(&length, &file[kHeader], sizeof length);
    return {all.substr(kText, length), kText + length + kChunkHeader};
}

std::size_t wholeIn(const nlohmann::json& object, const char* key, std::size_t otherwise) {
    const auto found = object.find(key);
    return found != object.end() && found->is_number_unsigned() ? found->get<std::size_t>() : otherwise;
}

// Pictures that lie in the file itself.
std::vector<Inside> picturesInside(const nlohmann::json& gltf, std::size_t data, std::size_t end) {
    std::vector<Inside> found;
    const auto images = gltf.find("images"), views = gltf.find("bufferViews");
    if (images == gltf.end() || views == gltf.end() || !images->is_array() || !views->is_array())
        return found;
    for (const nlohmann::json& image : *images) {
        const std::size_t number = wholeIn(image, "bufferView", views->size());
        if (number >= views->size()) continue;
        const nlohmann::json& view = (*views)[number];
        const Inside here{data + wholeIn(view, "byteOffset", 0), wholeIn(view, "byteLength", 0)};
        const bool isHere = data > 0 && wholeIn(view, "buffer", 0) == 0;
        if (isHere && here.at <= end && here.size <= end - here.at) found.push_back(here);
    }
    return found;
}

// [{"file", "optional"}] of what must be there, and of what its file is read without as well; [{"at",
// "size"}] of pictures that it brings.
std::string needsJson(const std::vector<std::string>& needed, const std::vector<std::string>& optional,
                      const std::vector<Inside>& inside = {}) {
    JsonWriter json;
    json.beginArray();
    for (const auto* names : {&needed, &optional})
        for (const std::string& name : *names)
            json.beginObject().key("file").value(name).key("optional").value(names == &optional).end();
    for (const Inside& picture : inside)
        json.beginObject().key("at").value(int(picture.at)).key("size").value(int(picture.size)).end();
    return json.end().text();
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
        const PutFiles& files = converter().files;
        for (const std::string& key : files.names())
            if (resolvePath(name, key) == path) return files.read(key);
        return Error{path + ": was not fetched; must lie beside " + name};
    };
}

std::vector<Output> takeFiles() {
    const PutFiles files = std::exchange(converter().files, {});
    std::vector<Output> taken;
    for (const std::string& name : files.names())
        taken.push_back({name, *files.read(name)});
    return taken;
}

const char* answer(const Error& error) {
    JsonWriter json;
    return answer(json.beginObject().key("error").value(error.message).end().text());
}

const char* answer(Result<scene::Brought> brought) {
    if (!brought) return answer(brought.error());
    JsonWriter json;
    json.beginObject();
    converter().brought = std::move(*brought);
    json.key("files").beginArray();
    for (const Output& file : converter().brought) {
        json.beginObject().key("name").value(file.path);
        json.key("at").value(double(std::uintptr_t(file.bytes.data())));
        json.key("size").value(int(file.bytes.size())).end();
    }
    return answer(json.end().end().text());
}

} // namespace

extern "C" {

/// Makes room for a file for the next conversion. @return  where its bytes are to be written
std::uint8_t* reader_file_space(const char* name, int size) { return converter().files.space(name, size); }

/// 1 for bytes that reader_to_plain() would change.
int reader_is_foreign(const char* name, const std::uint8_t* bytes, int size) {
    return scene::isForeign(name, std::as_bytes(std::span(bytes, std::size_t(size))));
}

/// The files that a glTF file which was put keeps its data and pictures in, or those in which an .obj has its
/// materials and these their textures: JSON array of {"file", "optional"}, relative to it, and of pictures
/// that lie in it {"at", "size"} in bytes. A text that is no glTF needs nothing here: reader_to_plain() says
/// what is wrong with it.
const char* reader_needs(const char* name) {
    const std::span<const std::byte> bytes = converter().files.find(name);
    if (scene::isObj(name) || scene::isMaterialFile(name))
        return answer(needsJson({}, scene::filesNamedIn(bytes)));
    const GltfText file = textOf(bytes);
    const nlohmann::json gltf = nlohmann::json::parse(file.text, nullptr, false);
    return answer(needsJson(filesIn(gltf, "buffers"), filesIn(gltf, "images"),
                            picturesInside(gltf, file.data, bytes.size())));
}

/// Converts a file that was put and forgets all files. "" or the message; the result is at reader_bytes().
const char* reader_to_plain(const char* name) {
    Converter& c = converter();
    Result<Bytes> file = c.files.read(name);
    Result<Bytes> plain = file ? scene::toPlain(name, std::move(*file), filesBeside(name)) : file;
    c.files.clear();
    if (!plain) return answer(plain.error().message);
    c.plain = std::move(*plain);
    return answer(std::string());
}

/// Linear values, `channels` (1, 3 or 4) floats a pixel with row 0 at the top, as EXR: "" or the message; the
/// result is at reader_bytes().
const char* reader_to_exr(int width, int height, int channels, const std::uint8_t* floats, int size) {
    Image image(width, height, channels);
    if (std::size_t(size) != image.pixels.size() * sizeof(float))
        return answer("picture: has " + std::to_string(size) + " bytes; must have 4 for each value");
    std::memcpy(image.pixels.data(), floats, std::size_t(size));
    Result<Bytes> exr = scene::encodeExr(image);
    if (!exr) return answer(exr.error().message);
    converter().plain = std::move(*exr);
    return answer(std::string());
}

/// A picture for a mesh, decoded apart from it: JSON {"files"} as of reader_bring_maps(), what stands in for
/// it among the parts of the mesh's file, and its texels; {"error"} for what is none, or too large to be
/// taken as it is.
/// @param number  of the texels' file, at most 255
const char* reader_to_texels(int number, const std::uint8_t* bytes, int size) {
    Result<ByteImage> image = decodeBytes(std::as_bytes(std::span(bytes, std::size_t(size))), "picture");
    if (!image) return answer(image.error());
    if (std::max(image->size.x, image->size.y) > scene::kMostTextureSide)
        return answer(Error{"picture: must be averaged"});
    const auto texels = std::as_bytes(std::span(image->values));
    return answer(scene::Brought{{"standIn", scene::standInFor(image->size, std::uint8_t(number))},
                                 {"texels", Bytes(texels.begin(), texels.end())}});
}

const std::uint8_t* reader_bytes() { return reinterpret_cast<const std::uint8_t*>(converter().plain.data()); }
int reader_size() { return int(converter().plain.size()); }

/// The name of what reader_to_plain() made of a file.
const char* reader_plain_name(const char* name, const std::uint8_t* bytes, int size) {
    return answer(scene::plainName(name, std::as_bytes(std::span(bytes, std::size_t(size)))));
}

/// JSON array of what each picture that was put, in plain form, is for: {"name", "use"}, with the use ""
/// where a person must be asked. Forgets all files.
const char* reader_uses() {
    const std::vector<Output> pictures = takeFiles();
    const auto uses = scene::usesOf(pictures);
    JsonWriter json;
    json.beginArray();
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        json.beginObject().key("name").value(pictures[i].path);
        json.key("use").value(uses[i] ? scene::mapUseNames()[std::size_t(*uses[i])] : "").end();
    }
    return answer(json.end().text());
}

/// The scene of pictures that were put. `uses` is JSON: the use of each by its name, others are left out.
/// JSON:
/// {"files": [{"name", "at", "size"}]}, the scene first, or {"error"}; the bytes stay until the next call
/// that answers so. Forgets all files.
const char* reader_bring_maps(const char* uses) {
    const nlohmann::json wanted = nlohmann::json::parse(uses, nullptr, false);
    std::vector<scene::MapFile> maps;
    for (Output& file : takeFiles()) {
        const auto use = scene::mapUseNamed(wanted.value(file.path, ""));
        if (use) maps.push_back({*use, file.path, std::move(file.bytes)});
    }
    return answer(scene::sceneOfMaps(maps));
}

/// The same of a mesh that was put in plain form.
const char* reader_bring_mesh(const char* name) {
    const PutFiles files = std::exchange(converter().files, {});
    return answer(scene::sceneOfMesh(name, files.find(name)));
}

/// The same of a table of a BRDF that was put.
const char* reader_bring_table(const char* name) {
    const PutFiles files = std::exchange(converter().files, {});
    return answer(scene::sceneOfTable(name, files.find(name)));
}

/// The same of a PTM file that was put.
const char* reader_bring_ptm(const char* name) {
    const PutFiles files = std::exchange(converter().files, {});
    const Result<scene::SurfaceMaps> maps = scene::decodePtm(files.find(name), name);
    if (!maps) return answer(maps.error());
    return answer(scene::sceneOfSurface(scene::titleOf(name), *maps));
}

/// A light file: JSON, {"files": [...]} of the photographs in the order in which they are to come, or
/// {"error"}.
const char* stereo_begin(const char* name, const std::uint8_t* bytes, int size) {
    constexpr std::size_t kMostBytes = std::size_t(512) << 20; // a quarter of a module's memory
    Converter& c = converter();
    auto photos = scene::parseLightFile(std::as_bytes(std::span(bytes, std::size_t(size))), name);
    if (!photos) return answer(photos.error());
    c.photos = std::move(*photos);
    c.photo = 0;
    std::vector<dvec3> lights;
    std::vector<std::string> files;
    for (const scene::LitPhoto& photo : c.photos) {
        lights.push_back(photo.light);
        files.push_back(photo.file);
    }
    c.stereo.emplace(lights, kMostBytes);
    return answer("{\"files\": " + namesJson(files) + "}");
}

/// Takes the next photograph; "" or the message.
const char* stereo_add(const std::uint8_t* bytes, int size) {
    Converter& c = converter();
    const std::string& name = c.photos[c.photo++].file;
    const auto content = std::as_bytes(std::span(bytes, std::size_t(size)));
    const Result<Bytes> plain =
        scene::toPlain(name, Bytes(content.begin(), content.end()), filesBeside(name));
    if (!plain) return answer(plain.error().message);
    const Result<Image> image = decodeImage(*plain, name, Encoding::Srgb);
    if (!image) return answer(image.error().message);
    const Status added = c.stereo->add(*image, name);
    return answer(added ? std::string() : added.error().message);
}

/// Works for about that long; the share that is done, [0,1].
double stereo_step(double milliseconds) { return converter().stereo->step(milliseconds / 1000); }

/// What it comes to, in words; once stereo_step() has returned 1.
const char* stereo_text() { return answer(scene::describe(*converter().stereo)); }

/// As reader_bring_maps(), and behind the scene's files those of the normals and the residual.
const char* stereo_scene(const char* title) {
    return answer(scene::sceneOfSurface(title, converter().stereo->maps()));
}

/// What all files of a set are called.
const char* reader_title(const char* name) { return answer(scene::titleOf(name)); }
}

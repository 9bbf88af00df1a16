#include "cli/TruthCache.h"

#include "BuildInfo.h"
#include "base/File.h"
#include "base/Pfm.h"
#include "scene/Load.h"
#include "scene/Mesh.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace lucent::cli {

namespace {

// FNV-1a, 64 bits: tells apart what one folder holds.
class Hash {
public:
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes)
            state_ = (state_ ^ std::uint64_t(byte)) * 0x100000001b3u;
    }
    void add(const std::string& text) { add(std::as_bytes(std::span(text))); }
    void add(const Image* image) {
        if (!image) return;
        const int shape[] = {image->width, image->height, image->channels};
        add(std::as_bytes(std::span(shape)));
        add(std::as_bytes(std::span(image->pixels)));
    }
    std::string text() const {
        char hex[17];
        std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(state_));
        return hex;
    }

private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

// Light, coverage and standard errors: seven numbers a pixel. PFM has no such pixels: they stand there as a
// grey picture seven times as wide.
constexpr int kNumbers = 7;

Image flattened(const truth::Picture& picture) {
    Image flat(kNumbers * picture.values.width, picture.values.height, 1);
    float* out = flat.pixels.data();
    for (int y = 0; y < picture.values.height; ++y) {
        for (int x = 0; x < picture.values.width; ++x) {
            out = std::copy_n(picture.values.at(x, y), 4, out);
            out = std::copy_n(picture.errors.at(x, y), 3, out);
        }
    }
    return flat;
}

truth::Picture unflattened(const Image& flat) {
    truth::Picture picture({flat.width / kNumbers, flat.height});
    const float* in = flat.pixels.data();
    for (int y = 0; y < picture.values.height; ++y) {
        for (int x = 0; x < picture.values.width; ++x, in += kNumbers) {
            std::copy_n(in, 4, picture.values.at(x, y));
            std::copy_n(in + 4, 3, picture.errors.at(x, y));
        }
    }
    return picture;
}

} // namespace

std::string truthPath(const std::string& folder, const scene::Scene& scene, int directions) {
    Hash hash;
    hash.add(LUCENT_TRUTH_VERSION);
    hash.add(toJson(scene) + std::to_string(directions));
    const int view[] = {scene.size.x, scene.size.y, int(scene.view.show)};
    hash.add(std::as_bytes(std::span(view)));
    for (const auto& map : scene::lightPictures(scene))
        hash.add(map.get());
    for (const scene::Object& object : scene.objects) {
        if (const auto* field = std::get_if<scene::HeightField>(&object.shape))
            for (const auto& map : {field->heights, field->alpha})
                hash.add(map.get());
        if (const auto* shape = std::get_if<scene::MeshShape>(&object.shape))
            hash.add(encodeMesh(*shape->mesh));
        for (const auto& map : object.material.maps())
            hash.add(map.get());
    }
    return (std::filesystem::path(folder) / (hash.text() + ".pfm")).string();
}

Result<truth::Picture> cachedTruth(const std::string& path,
                                   const std::function<Result<truth::Picture>()>& solve) {
    if (std::filesystem::exists(path)) {
        const Result<Bytes> bytes = readFile(path);
        if (!bytes) return bytes.error();
        const Result<Image> flat = decodePfm(*bytes, path);
        if (!flat) return flat.error();
        return unflattened(*flat);
    }
    Result<truth::Picture> solved = solve();
    if (!solved) return solved;
    if (Status written = writeFile(path, encodePfm(flattened(*solved))); !written) return written.error();
    return solved;
}

} // namespace lucent::cli

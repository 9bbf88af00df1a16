#include "cli/Bring.h"

#include "cli/Files.h"
#include "cli/ProgressBar.h"
#include "scene/Mesh.h"
#include "scene/Ptm.h"
#include "scene/readers/Photos.h"
#include "scene/readers/Readers.h"

#include <cstdio>
#include <filesystem>

namespace lucent::cli {

namespace {
namespace fs = std::filesystem;

Result<std::vector<Output>> readAll(const std::vector<std::string>& inputs,
                                    const std::vector<std::string>& allowed) {
    std::vector<Output> files;
    for (const std::string& path : inputs) {
        Result<Bytes> bytes = scene::plainFiles(path, allowed)(path);
        if (!bytes) return bytes.error();
        const std::string name = scene::plainName(fs::path(path).filename().string(), *bytes);
        files.push_back({name, std::move(*bytes)});
    }
    return files;
}

Result<scene::Brought> sceneOf(const std::vector<Output>& files) {
    for (const Output& file : files)
        if (scene::isMesh(file.bytes)) {
            if (files.size() > 1) return Error{file.path + ": is a mesh beside other files; must come alone"};
            return scene::sceneOfMesh(file.path, file.bytes);
        }
    if (files.size() == 1 && fs::path(files[0].path).extension() == ".binary")
        return scene::sceneOfTable(files[0].path, files[0].bytes);
    if (files.size() == 1 && scene::isPtm(files[0].bytes)) {
        const auto maps = scene::decodePtm(files[0].bytes, files[0].path);
        if (!maps) return maps.error();
        return scene::sceneOfSurface(scene::titleOf(files[0].path), *maps);
    }
    const auto uses = scene::usesOf(files);
    std::vector<scene::MapFile> maps;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!uses[i])
            return Error{files[i].path +
                         ": does not say what it is for; its name must end in _height, _normal, "
                         "_albedo, _alpha or _specular"};
        maps.push_back({*uses[i], files[i].path, files[i].bytes});
    }
    return scene::sceneOfMaps(maps);
}

bool isLightFile(const std::string& path) {
    const std::string ending = fs::path(path).extension().string();
    return ending == ".lp" || ending == ".LP";
}

// Light files often hold the folders of the machine that made them.
std::string besideLightFile(const std::string& path, const std::string& file) {
    const bool isElsewhere = file.starts_with('/') || (file.size() > 1 && file[1] == ':');
    return resolvePath(path, isElsewhere ? file.substr(file.find_last_of('/') + 1) : file);
}

Result<scene::Brought> sceneOfPhotos(const std::string& path, const std::vector<std::string>& allowed) {
    constexpr std::size_t kMostBytes = std::size_t(8) << 30; // half of what a scene may ask for
    constexpr double kStep = 0.2;                            // s
    const ReadFile read = scene::plainFiles(path, allowed);
    const Result<Bytes> bytes = read(path);
    if (!bytes) return bytes.error();
    const auto photos = scene::parseLightFile(*bytes, path);
    if (!photos) return photos.error();
    std::vector<dvec3> lights;
    for (const scene::LitPhoto& photo : *photos)
        lights.push_back(photo.light);
    scene::PhotometricStereo stereo(lights, kMostBytes);
    for (const scene::LitPhoto& photo : *photos) {
        const std::string file = besideLightFile(path, photo.file);
        const Result<Bytes> content = read(file);
        if (!content) return content.error();
        const Result<Image> image = decodeImage(*content, file, Encoding::Srgb);
        if (!image) return image.error();
        if (Status added = stereo.add(*image, file); !added) return added.error();
    }
    ProgressBar bar;
    for (double share = 0; share < 1; bar.show(share))
        share = stereo.step(kStep);
    std::fprintf(stderr, "lucent: %s: %s\n", path.c_str(), scene::describe(stereo).c_str());
    return scene::sceneOfSurface(scene::titleOf(path), stereo.maps());
}

Result<scene::Brought> bring(const std::vector<std::string>& inputs,
                             const std::vector<std::string>& allowed) {
    for (const std::string& input : inputs)
        if (isLightFile(input)) {
            if (inputs.size() > 1) return Error{input + ": names its photographs itself; must come alone"};
            return sceneOfPhotos(input, allowed);
        }
    const auto files = readAll(inputs, allowed);
    if (!files) return files.error();
    return sceneOf(*files);
}

} // namespace

Status bringInto(const std::string& folder, const std::vector<std::string>& inputs,
                 const std::vector<std::string>& allowed) {
    Result<scene::Brought> brought = bring(inputs, allowed);
    if (!brought) return brought.error();
    std::error_code failed; // where it is there already, nothing fails
    fs::create_directory(folder, failed);
    std::vector<std::string> outputs;
    for (Output& file : *brought)
        outputs.push_back(file.path = (fs::path(folder) / file.path).string());
    if (Status possible = checkOutputs(outputs, inputs); !possible) return possible;
    if (Status written = writeAll(*brought); !written) return written;
    for (const Output& file : *brought)
        std::printf("%s: %zu bytes\n", file.path.c_str(), file.bytes.size());
    return Done{};
}

} // namespace lucent::cli

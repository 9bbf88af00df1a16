#include "scene/readers/Readers.h"

#include "base/Archive.h"
#include "base/Beneath.h"

#include <filesystem>

namespace lucent::scene {
namespace {

// Files by their paths as if the archive were a folder.
ReadFile readInside(const std::string& path, Archive archive) {
    return [path, archive = std::move(archive)](const std::string& wanted) -> Result<Bytes> {
        const std::string folder = path + "/";
        const bool isBelow = wanted.starts_with(folder);
        const std::string file =
            isBelow ? std::filesystem::path(wanted.substr(folder.size())).lexically_normal().string() : "..";
        if (file == ".." || file.starts_with("../"))
            return Error{wanted + ": lies outside " + path + "; must lie in it"};
        return archive.read(file);
    };
}

ReadFile asPlain(ReadFile read) {
    return [read = std::move(read)](const std::string& wanted) -> Result<Bytes> {
        Result<Bytes> bytes = read(wanted);
        if (!bytes) return bytes;
        return toPlain(wanted, std::move(*bytes), read);
    };
}

} // namespace

ReadFile plainFiles(const std::string& path, const std::vector<std::string>& allowed) {
    return asPlain(readBeneath(path, allowed));
}

Result<SceneSource> sceneSource(const std::string& path, const std::vector<std::string>& allowed) {
    if (!isArchive(path)) return SceneSource{path, plainFiles(path, allowed)};
    Result<Bytes> bytes = readFile(path);
    if (!bytes) return bytes.error();
    Result<Archive> archive = Archive::open(path, std::move(*bytes));
    if (!archive) return archive.error();
    const Result<std::string> file = archive->sceneFile();
    if (!file) return file.error();
    return SceneSource{path + "/" + *file, asPlain(readInside(path, std::move(*archive)))};
}

} // namespace lucent::scene

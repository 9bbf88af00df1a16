#pragma once
/// Zip archives, as the page saves a scene in them with all its files.

#include "base/File.h"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

struct zip;

namespace lucent {

/// A zip archive in memory. A file is unpacked when it is asked for, and never to disk.
class Archive {
public:
    static constexpr int kMostFiles = 1000;
    static constexpr std::uint64_t kMostBytes = std::uint64_t(1) << 30; ///< of all files, unpacked

    /// Reads the list of files. Folders are left out.
    ///
    /// @param name  of the archive, for messages
    /// @return      Error "NAME: what; what was expected" for what is no archive, has a name twice or one
    /// that
    ///              leads outside, or says that it unpacks to more than the limits
    static Result<Archive> open(const std::string& name, Bytes bytes);

    /// Unpacks a file. Error "NAME/FILE: what; what was expected" where there is none of that name, where it
    /// is damaged, encrypted, or larger than the archive says.
    Result<Bytes> read(const std::string& file) const;

    /// The scene: "scene.json", else the only .json that lies in no folder. Error where there is none.
    Result<std::string> sceneFile() const;

private:
    struct Entry {
        std::uint64_t index, size;
    };
    Archive(std::string name, std::shared_ptr<Bytes> bytes, std::shared_ptr<zip> opened)
        : name_(std::move(name)), bytes_(std::move(bytes)), zip_(std::move(opened)) {}
    Status readList();

    std::string name_;
    std::shared_ptr<Bytes> bytes_; // which zip_ reads
    std::shared_ptr<zip> zip_;
    std::map<std::string, Entry> entries_;
};

/// Whether a path names an archive: by its ending, .zip.
bool isArchive(const std::string& path);

} // namespace lucent

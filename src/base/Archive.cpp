#include "base/Archive.h"

#include "base/Text.h"

#include <algorithm>
#include <optional>
#include <zip.h>

namespace lucent {
namespace {

// Text of a failure; takes it over.
std::string textOf(zip_error_t& error) {
    std::string text = zip_error_strerror(&error);
    zip_error_fini(&error);
    return text;
}

// Neither absolute nor with a part "." or "..".
bool staysInside(const std::string& name) {
    for (std::size_t start = 0; start <= name.size();) {
        const std::size_t end = std::min(name.find('/', start), name.size());
        const std::string part = name.substr(start, end - start);
        if (part.empty() || part == "." || part == "..") return false;
        start = end + 1;
    }
    return true;
}

} // namespace

bool isArchive(const std::string& path) { return path.ends_with(".zip"); }

Result<Archive> Archive::open(const std::string& name, Bytes bytes) {
    const auto content = std::make_shared<Bytes>(std::move(bytes));
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(content->data(), content->size(), 0, &error);
    zip_t* opened = source ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr;
    if (!opened) {
        if (source) zip_source_free(source);
        return Error{name + ": cannot be read (" + textOf(error) + "); must be a zip archive"};
    }
    zip_error_fini(&error);
    Archive archive(name, content, std::shared_ptr<zip>(opened, zip_discard));
    if (Status listed = archive.readList(); !listed) return listed.error();
    return archive;
}

Status Archive::readList() {
    const auto count = std::uint64_t(zip_get_num_entries(zip_.get(), 0));
    if (count > kMostFiles)
        return Error{name_ + ": has " + std::to_string(count) + " files; must have at most " +
                     std::to_string(kMostFiles)};
    std::uint64_t total = 0;
    for (std::uint64_t index = 0; index < count; ++index) {
        zip_stat_t stat;
        constexpr std::uint64_t kNeeded = ZIP_STAT_NAME | ZIP_STAT_SIZE;
        if (zip_stat_index(zip_.get(), index, 0, &stat) != 0 || (stat.valid & kNeeded) != kNeeded)
            return Error{name_ + ": file " + std::to_string(index + 1) +
                         " has no name or no size; must have both"};
        const std::string file = stat.name;
        const bool isFolder = file.ends_with('/');
        if (!staysInside(isFolder ? file.substr(0, file.size() - 1) : file))
            return Error{name_ + ": has a file " + inQuotes(file) + ", which leads outside; must lie in it"};
        if (stat.size > kMostBytes - total)
            return Error{name_ + ": unpacks to more than 1 GiB with " + inQuotes(file) +
                         "; must be at most that"};
        total += stat.size;
        if (!isFolder && !entries_.emplace(file, Entry{index, stat.size}).second)
            return Error{name_ + ": has two files " + inQuotes(file) + "; must have one of a name"};
    }
    return Done{};
}

Result<Bytes> Archive::read(const std::string& file) const {
    const std::string where = name_ + "/" + file;
    const auto found = entries_.find(file);
    if (found == entries_.end()) return Error{where + ": is not in the archive; must be"};
    const Entry& entry = found->second;
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> opened(
        zip_fopen_index(zip_.get(), entry.index, 0), zip_fclose);
    if (!opened)
        return Error{where + ": cannot be read (" + zip_strerror(zip_.get()) + "); must be a plain file"};
    // What the list says of its size may be wrong: no more is taken than comes.
    Bytes bytes;
    std::byte block[1 << 16];
    std::int64_t taken = 0;
    while ((taken = zip_fread(opened.get(), block, sizeof block)) > 0) {
        bytes.insert(bytes.end(), block, block + taken);
        if (bytes.size() > entry.size) break;
    }
    if (taken < 0)
        return Error{where + ": cannot be read (" + zip_file_strerror(opened.get()) + "); must be undamaged"};
    if (bytes.size() != entry.size)
        return Error{where + ": unpacks to " + (taken > 0 ? "more" : "fewer") + " than the " +
                     std::to_string(entry.size) + " bytes that the archive says; must be as many"};
    return bytes;
}

Result<std::string> Archive::sceneFile() const {
    if (entries_.contains("scene.json")) return std::string("scene.json");
    std::optional<std::string> only;
    for (const auto& [file, entry] : entries_) {
        if (!file.ends_with(".json") || file.find('/') != file.npos) continue;
        if (only)
            return Error{name_ + ": has " + inQuotes(*only) + " and " + inQuotes(file) +
                         "; must have scene.json, or one .json file"};
        only = file;
    }
    if (!only) return Error{name_ + ": has no scene; must have scene.json, or one .json file"};
    return *only;
}

} // namespace lucent

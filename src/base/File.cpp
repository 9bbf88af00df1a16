#include "base/File.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <unistd.h>

namespace lucent {
namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, Close>;

Error failed(const std::string& path, const char* what, int reason) {
    return {path + ": cannot be " + what + " (" + std::strerror(reason) + ")"};
}

bool writeAll(const std::string& path, std::span<const std::byte> bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) return false;
    const bool written = bytes.empty() || std::fwrite(bytes.data(), bytes.size(), 1, file) == 1;
    return std::fclose(file) == 0 && written; // a full disk may show only when the last bytes are flushed
}

} // namespace

Result<Bytes> readFile(const std::string& path) {
    const OpenFile file(std::fopen(path.c_str(), "rb"));
    if (!file) return failed(path, "read", errno);
    Bytes bytes;
    std::byte block[1 << 16];
    while (const std::size_t count = std::fread(block, 1, sizeof block, file.get()))
        bytes.insert(bytes.end(), block, block + count);
    if (std::ferror(file.get())) return failed(path, "read", errno);
    return bytes;
}

Status writeFile(const std::string& path, std::span<const std::byte> bytes) {
    const std::string temporary = path + "." + std::to_string(getpid()) + ".part"; // one per process
    std::error_code ignored;
    if (!writeAll(temporary, bytes) || std::rename(temporary.c_str(), path.c_str()) != 0) {
        const int reason = errno;
        std::filesystem::remove(temporary, ignored);
        return failed(path, "written", reason);
    }
    return Done{};
}

} // namespace lucent

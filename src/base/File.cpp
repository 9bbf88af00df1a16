#include "base/File.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lucent {
namespace {

Error failed(const std::string& path, int reason) {
    return {path + ": cannot be read (" + std::strerror(reason) + ")"};
}

/// A file that is open for reading.
class OpenFile {
public:
    // A pipe would wait for its other end before anybody could ask what it is.
    explicit OpenFile(const std::string& path)
        : file_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    ~OpenFile() {
        if (file_ >= 0) close(file_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    explicit operator bool() const { return file_ >= 0; }
    bool isDeviceOrPipe() const {
        struct stat found;
        return fstat(file_, &found) == 0 && !S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode);
    }
    ssize_t take(std::span<std::byte> block) const {
        ssize_t count = -1;
        do
            count = read(file_, block.data(), block.size());
        while (count < 0 && errno == EINTR);
        return count;
    }

private:
    int file_;
};

} // namespace

Result<Bytes> readFile(const std::string& path) {
    const OpenFile file(path);
    if (!file) return failed(path, errno);
    if (file.isDeviceOrPipe()) return Error{path + ": is a device or a pipe; must be a regular file"};
    Bytes bytes;
    std::byte block[1 << 16];
    ssize_t count = 0;
    while ((count = file.take(block)) > 0)
        bytes.insert(bytes.end(), block, block + count);
    if (count < 0) return failed(path, errno);
    return bytes;
}

} // namespace lucent

#include "base/Output.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <memory>
#include <sys/stat.h>
#include <unistd.h>

namespace lucent {
namespace {

namespace fs = std::filesystem;

Error failed(const std::string& path, int reason) {
    return {path + ": cannot be written (" + std::strerror(reason) + ")"};
}

std::atomic<int> caught = 0;
static_assert(std::atomic<int>::is_always_lock_free); // or a signal handler must not touch it

/// Keeps signals that end the program waiting for as long as it lives.
class HeldSignals {
public:
    HeldSignals() {
        caught = 0;
        struct sigaction hold {};
        hold.sa_handler = [](int signal) { caught = signal; };
        for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
            struct sigaction before;
            sigaction(signal, nullptr, &before);
            if (before.sa_handler == SIG_IGN) continue;
            sigaction(signal, &hold, nullptr);
            before_.emplace(signal, before);
        }
        // A file that grows past a limit of the system fails as on a full disk.
        struct sigaction ignore {};
        ignore.sa_handler = SIG_IGN;
        sigaction(SIGXFSZ, &ignore, &before_[SIGXFSZ]);
    }
    ~HeldSignals() {
        for (const auto& [signal, before] : before_)
            sigaction(signal, &before, nullptr);
        if (const int signal = caught.exchange(0)) raise(signal);
    }
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;

    /// Whether one waits that the program itself does not handle: nothing more needs to be done.
    bool areFatal() const {
        const int signal = caught;
        return signal && before_.at(signal).sa_handler == SIG_DFL;
    }

private:
    std::map<int, struct sigaction> before_;
};

/// A file on its way: first beside the one that it replaces, then in its place.
class Replacement {
public:
    explicit Replacement(const Output& output)
        : output_(output), target_(targetOf(output.path)), folder_(fs::path(target_).parent_path()) {}
    ~Replacement() {
        for (const fs::path& left : {temporary_, old_})
            if (!left.empty()) unlink(left.c_str());
    }
    Replacement(const Replacement&) = delete;
    Replacement& operator=(const Replacement&) = delete;

    const std::string& path() const { return output_.path; }

    /// Errors are left in errno.
    bool write(const HeldSignals& signals) {
        const int file = open();
        if (file < 0) return false;
        const bool written = writeTo(file, signals) && keepMode(file);
        const int reason = errno;
        const bool closed = close(file) == 0; // a full disk may show only now
        if (!written) errno = reason;
        return written && closed;
    }
    /// Takes its place. Keeps what was there for undo(), unless it is the only one.
    bool place(bool isOnly) {
        if (!isOnly && !keepOld()) return false;
        if (rename(temporary_.c_str(), target_.c_str()) != 0) return false;
        temporary_.clear();
        isPlaced_ = true;
        return true;
    }
    void undo() {
        if (!old_.empty() && rename(old_.c_str(), target_.c_str()) == 0)
            old_.clear();
        else if (isPlaced_)
            unlink(target_.c_str());
        isPlaced_ = false;
    }

private:
    // A name of its own beside the target, whatever was left there and however long the target's name is.
    fs::path neighbour() const {
        static std::atomic<int> number = 0;
        return folder_ / (".lucent-" + std::to_string(getpid()) + "-" + std::to_string(++number) + ".part");
    }
    int open() {
        for (;;) {
            const fs::path name = neighbour();
            const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (file >= 0) temporary_ = name;
            if (file >= 0 || errno != EEXIST) return file;
        }
    }
    bool writeTo(int file, const HeldSignals& signals) const {
        constexpr std::size_t kBlock = 1 << 20; // a signal waits no longer than for one
        for (std::span<const std::byte> rest = output_.bytes; !rest.empty();) {
            if (signals.areFatal()) return errno = EINTR, false;
            const ssize_t count = ::write(file, rest.data(), std::min(rest.size(), kBlock));
            if (count < 0 && errno != EINTR) return false;
            rest = rest.subspan(std::size_t(std::max<ssize_t>(count, 0)));
        }
        return true;
    }
    // Of what is replaced; a new file has the usual one.
    bool keepMode(int file) const {
        struct stat before;
        return stat(target_.c_str(), &before) != 0 || fchmod(file, before.st_mode & 07777) == 0;
    }
    bool keepOld() {
        const fs::path name = neighbour();
        const bool kept =
            link(target_.c_str(), name.c_str()) == 0 ||
            (errno != ENOENT && rename(target_.c_str(), name.c_str()) == 0); // no hard links there
        if (kept) old_ = name;
        return kept || errno == ENOENT; // there was nothing
    }

    const Output& output_;
    std::string target_;
    fs::path folder_, temporary_, old_; ///< the last two: "" while there is no such file
    bool isPlaced_ = false;
};

Status writeAndPlace(std::vector<std::unique_ptr<Replacement>>& files, const HeldSignals& signals) {
    for (const auto& file : files)
        if (!file->write(signals)) return failed(file->path(), errno);
    for (const auto& file : files) {
        if (file->place(files.size() == 1)) continue;
        const int reason = errno;
        for (const auto& each : files)
            each->undo();
        return failed(file->path(), reason);
    }
    return Done{};
}

// What a file is, where it is none that could be replaced; "" else.
std::string strangeKind(const std::string& path) {
    struct stat found;
    if (stat(path.c_str(), &found) != 0 || S_ISREG(found.st_mode)) return "";
    return S_ISDIR(found.st_mode)                             ? "a folder"
           : S_ISCHR(found.st_mode) || S_ISBLK(found.st_mode) ? "a device"
                                                              : "a pipe";
}

// One name for one file, by whatever way its folder is named.
std::string identity(const std::string& path) {
    std::error_code ignored; // a folder that is not there is told by writing
    const fs::path target = fs::absolute(targetOf(path), ignored);
    return (fs::weakly_canonical(target.parent_path(), ignored) / target.filename()).string();
}

} // namespace

std::string targetOf(const std::string& path) {
    constexpr int kMostLinks = 40; // as the kernel: behind them it refuses
    std::error_code ignored;
    fs::path target = path;
    for (int i = 0; i < kMostLinks && fs::is_symlink(target, ignored); ++i)
        target = target.parent_path() / fs::read_symlink(target, ignored);
    return target.string();
}

Status checkOutputs(std::span<const std::string> paths) {
    std::map<std::string, std::string> known;
    for (const std::string& path : paths) {
        if (path.empty()) continue;
        if (const std::string kind = strangeKind(path); !kind.empty())
            return Error{path + ": is " + kind + "; must be a regular file, or a new one"};
        if (access(path.c_str(), W_OK) != 0 && errno != ENOENT) return failed(path, errno);
        const auto [other, isNew] = known.emplace(identity(path), path);
        if (!isNew)
            return Error{path + ": is written twice, as " + other->second + " too; must be two files"};
    }
    return Done{};
}

Status writeFiles(std::span<const Output> outputs) {
    std::vector<std::string> paths;
    for (const Output& output : outputs)
        paths.push_back(output.path);
    if (Status possible = checkOutputs(paths); !possible) return possible;
    const HeldSignals signals;
    std::vector<std::unique_ptr<Replacement>> files; // gone before the signals come
    for (const Output& output : outputs)
        files.push_back(std::make_unique<Replacement>(output));
    return writeAndPlace(files, signals);
}

Status writeFile(const std::string& path, std::span<const std::byte> bytes) {
    const Output whole{path, Bytes(bytes.begin(), bytes.end())};
    return writeFiles({&whole, 1});
}

} // namespace lucent

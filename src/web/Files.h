#pragma once
/// Files that a page gives to its modules.

#include "base/File.h"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lucent {

/// They lie as the page wrote them until they are forgotten.
class PutFiles {
public:
    /// Room for a file, in the place of one of that name, which the page writes: nobody clears it before,
    /// which for large ones takes longer than to write them.
    std::uint8_t* space(const std::string& name, int size) {
        File& file = files_[name] = {std::unique_ptr<std::byte[]>(new std::byte[std::size_t(size)]),
                                     std::size_t(size)};
        return reinterpret_cast<std::uint8_t*>(file.data.get());
    }
    /// Where its bytes lie; empty where there is none.
    std::span<const std::byte> find(const std::string& name) const {
        const auto found = files_.find(name);
        if (found == files_.end()) return {};
        return {found->second.data.get(), found->second.size};
    }
    /// A copy. Error "NAME: ..." where there is none
    Result<Bytes> read(const std::string& name) const {
        if (!files_.contains(name)) return Error{name + ": was not put; must be before it is read"};
        const auto bytes = find(name);
        return Bytes(bytes.begin(), bytes.end());
    }
    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& [name, file] : files_)
            all.push_back(name);
        return all;
    }
    void forget(const std::string& name) { files_.erase(name); }
    void clear() { files_.clear(); }

private:
    struct File {
        std::unique_ptr<std::byte[]> data;
        std::size_t size = 0;
    };
    std::map<std::string, File> files_;
};

} // namespace lucent

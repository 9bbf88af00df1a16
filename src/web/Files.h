#pragma once
/// Files that a page gives to its modules.

#include "base/File.h"

#include <cstdint>
#include <map>
#include <string>

namespace lucent {

/// Room for a file, in the place of one of that name: the page writes into it, so that nothing is copied
/// twice.
inline std::uint8_t* spaceFor(std::map<std::string, Bytes>& files, const char* name, int size) {
    Bytes& file = files[name] = Bytes(std::size_t(size));
    return reinterpret_cast<std::uint8_t*>(file.data());
}

} // namespace lucent

#include "scene/readers/Readers.h"

#include "base/Beneath.h"

namespace lucent::scene {

ReadFile plainFiles(const std::string& path, const std::vector<std::string>& allowed) {
    return [read = readBeneath(path, allowed)](const std::string& wanted) -> Result<Bytes> {
        Result<Bytes> bytes = read(wanted);
        if (!bytes) return bytes;
        return toPlain(wanted, std::move(*bytes), read);
    };
}

} // namespace lucent::scene

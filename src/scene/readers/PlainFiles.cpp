#include "scene/readers/Readers.h"

namespace lucent::scene {

ReadFile plainFiles() {
    return [](const std::string& path) -> Result<Bytes> {
        Result<Bytes> bytes = readFile(path);
        if (!bytes) return bytes;
        return toPlain(path, std::move(*bytes), readFile);
    };
}

} // namespace lucent::scene

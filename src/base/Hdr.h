#pragma once
/// Reads Radiance pictures (.hdr). By hand: stb's reader never ends on a file that was cut inside a run.

#include "base/Image.h"

#include <memory>
#include <optional>

namespace lucent {

/// Whether a file begins as such a picture does.
bool isHdr(std::span<const std::byte> bytes);

/// RGBE pixels, rows from the top, flat or run-length coded (old and new kind). Values are taken as they
/// stand, finite and at least 0: the header's EXPOSURE is a note of how the picture was made, which other
/// readers ignore as well.
Result<Image> decodeHdr(std::span<const std::byte> bytes, const std::string& name);
/// The same piece by piece, for who must not wait.
class HdrReading {
public:
    HdrReading(Bytes bytes, std::string name);
    ~HdrReading();
    /// Some rows more; the picture once it is whole.
    std::optional<Result<Image>> advance();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace lucent

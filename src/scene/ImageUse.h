#pragma once
/// From decoded files to the channels that a scene uses.

#include "base/File.h"
#include "base/Image.h"

#include <memory>
#include <optional>

namespace lucent::scene {

/// Picture as 3 linear channels: 8 and 16 bit are decoded from sRGB, grey is spread, alpha left out.
/// Error when a value is not finite, naming the texel.
Result<std::shared_ptr<const Image>> decodeColors(std::span<const std::byte> bytes, const std::string& name);
/// The same piece by piece, for who must not wait.
class ColorsMaking {
public:
    /// @param read  gives the file
    ColorsMaking(std::string name, ReadFile read);
    ~ColorsMaking();
    /// One piece more; the picture once it is whole.
    std::optional<Result<std::shared_ptr<const Image>>> advance();
    /// How much of a file the next piece decodes.
    std::size_t bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The same for a lamp to project: values of at least 0, each side halved until it has kMostPictureSide at
/// most, and that said on stderr.
Result<std::shared_ptr<const Image>> decodePicture(std::span<const std::byte> bytes, const std::string& name);

/// Picture as one channel of heights: the first of one or two, else the mean of red, green and blue.
/// Error when a height is not finite or beyond 1e9, naming the texel.
Result<std::shared_ptr<const Image>> decodeHeights(std::span<const std::byte> bytes, const std::string& name);
/// The same of a picture that is decoded.
Result<std::shared_ptr<const Image>> heightsOf(const Image& image, const std::string& name);

/// Picture as one channel of coverage: its alpha where it has one, else as decodeHeights() does.
/// Error when a value is outside [0, 1], naming the texel.
Result<std::shared_ptr<const Image>> decodeAlpha(std::span<const std::byte> bytes, const std::string& name);

} // namespace lucent::scene

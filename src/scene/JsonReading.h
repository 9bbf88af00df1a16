#pragma once
/// What readers of JSON files share: complaints that name their place, plain values, parameters.

#include "base/Param.h"
#include "scene/Json.h"
#include "scene/Keys.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lucent::scene {

/// A value in the file and its path for messages: "objects.coin.material".
struct Place {
    const Json& json;
    std::string path;

    Place at(const Json& child, std::string_view key) const {
        return {child, path.empty() ? std::string(key) : path + "." + std::string(key)};
    }
};

/// Functions return false after the first complaint, which is kept.
class JsonReading {
public:
    /// @param path   of the file
    /// @param whole  what messages call all of it
    explicit JsonReading(const std::string& path, std::string_view whole = "the scene")
        : path_(path), whole_(whole) {}

    const std::string& path() const { return path_; }
    const Error& error() const { return error_; }

    // --- complaints ---
    bool fail(const Place& place, const std::string& what);
    bool wrongType(const Place& place, std::string_view expected);
    bool missing(const Place& place, std::string_view key, std::string_view expected);
    bool keepStatus(const Place& place, const Status& status);
    bool keep(Error error) {
        error_ = std::move(error);
        return false;
    }

    // --- plain values ---
    bool expect(const Place& place, Json::Type type, std::string_view expected);
    bool readText(const Place& place, std::string& text);
    bool readBool(const Place& place, bool& value);

    // --- parameters ---
    /// The value as the text that setText() reads: one way of checking for files, command line and page.
    bool readParam(const Place& place, const Param& param, void* data);
    /// Reads the parameters of an object into their structs, one for each table of `keys`, and refuses keys
    /// that nobody knows.
    bool readKeys(const Place& place, const KeySet& keys, const std::vector<void*>& structs);

private:
    std::string path_;
    std::string_view whole_;
    Error error_;
};

} // namespace lucent::scene

#pragma once
/// What readers of JSON files share that name other files: these are read and decoded once, in pieces of
/// time.

#include "scene/JsonReading.h"
#include "scene/Load.h"
#include "scene/Memory.h"

#include <any>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <type_traits>

namespace lucent::scene {

/// What an interrupted load need not decode again.
struct Decoded {
    std::map<std::string, std::any> values; ///< by file and decoder, or by place and what it is
    std::chrono::steady_clock::time_point until{};
    bool pauses = false, isNew = false; ///< something was decoded since the load began or went on

    template <class Value>
    bool find(const std::string& key, Value& value) const {
        const auto found = values.find(key);
        if (found != values.end()) value = *std::any_cast<Value>(&found->second);
        return found != values.end();
    }
    template <class Value>
    void add(const std::string& key, const Value& value) {
        values.emplace(key, value);
        isNew = true;
    }
    /// Before something is decoded: whether it must wait.
    bool isOver() { return waits(std::chrono::steady_clock::duration(0)); }
    /// The same of what takes about so long by itself.
    bool waits(std::chrono::steady_clock::duration least) {
        return pauses = isNew && std::chrono::steady_clock::now() + least > until;
    }
};

/// Functions return false after the first complaint, which is kept, or where the load is interrupted.
class FileReading : public JsonReading {
public:
    /// @param path     of the file that names the others
    /// @param read     gives a file by its path
    /// @param decoded  what earlier calls have decoded; outlives the reading, as `read` does
    FileReading(const std::string& path, const ReadFile& read, Decoded& decoded)
        : JsonReading(path), read_(read), decoded_(decoded) {}

protected:
    bool readFileName(const Place& place, std::string& file) {
        const bool named = place.json.type == Json::Type::String && !place.json.string.empty();
        if (!named) return wrongType(place, "the name of a file");
        file = place.json.string;
        return true;
    }

    // --- memory ---
    /// Refuses the value of a key that asks for more than is left.
    bool spend(const Place& place, std::string_view key, const std::string& value, double bytes) {
        const Json* json = place.json.find(key);
        const std::string why = whyTooLarge(value, bytes_ += bytes);
        return why.empty() || fail(place.at(json ? *json : place.json, key), why);
    }

    // --- files ---
    /// That decoding so much of a picture takes in a browser.
    static std::chrono::milliseconds timeFor(std::size_t bytes) {
        constexpr std::size_t kBytesPerMs = 100'000;
        return std::chrono::milliseconds(bytes / kBytesPerMs);
    }
    /// Functions do the same for every place; others depend on what stands beside it.
    template <class Decode>
    static std::string roleOf(const Place& place, Decode decode) {
        if constexpr (std::is_pointer_v<Decode>)
            return std::to_string(reinterpret_cast<std::uintptr_t>(decode));
        else
            return place.path;
    }
    /// Reads a file that the scene names and decodes it: `decode(bytes, name)`.
    template <class Value, class Decode>
    bool readFile(const Place& place, const std::string& file, Value& value, Decode decode) {
        return readFile(place, file, value, decode, roleOf(place, decode));
    }
    /// @param role  by which a file is decoded in the same way
    template <class Value, class Decode>
    bool readFile(const Place& place, const std::string& file, Value& value, Decode decode,
                  const std::string& role) {
        const std::string name = resolvePath(path(), file), key = name + " " + role;
        if (decoded_.find(key, value)) return true;
        if (decoded_.isOver()) return false;
        const Result<Bytes> bytes = read_(name);
        if (!bytes) return fail(place, ": " + bytes.error().message);
        if (decoded_.waits(timeFor(bytes->size()))) return false;
        auto decoded = decode(*bytes, name);
        if (!decoded) return fail(place, ": " + decoded.error().message);
        decoded_.add(key, value = Value(std::move(*decoded)));
        return true;
    }
    /// What is made for a place, unless it was made before the load was interrupted.
    template <class Value, class Make>
    bool piece(const Place& place, const std::string& key, Value& value, const Make& make) {
        if (decoded_.find(key, value)) return true;
        if (decoded_.isOver()) return false;
        Result<Value> made = make();
        if (!made) return fail(place, ": " + made.error().message);
        decoded_.add(key, value = std::move(*made));
        return true;
    }
    /// Of what is made piece by piece, some more.
    template <class Making, class Value, class... Of>
    bool pieces(const Place& place, const std::string& key, Value& value, const Of&... of) {
        std::shared_ptr<Making> making;
        if (decoded_.find(key, value)) return true;
        if (!piece(place, key + ", begun", making,
                   [&]() -> Result<std::shared_ptr<Making>> { return std::make_shared<Making>(of...); }))
            return false;
        for (;;) {
            if (decoded_.isOver()) return false;
            if constexpr (requires { making->bytes(); })
                if (decoded_.waits(timeFor(making->bytes()))) return false;
            auto made = making->advance();
            decoded_.isNew = true;
            if (!made) continue;
            const Result<Value> whole(std::move(*made));
            if (!whole) return fail(place, ": " + whole.error().message);
            decoded_.add(key, value = *whole);
            return true;
        }
    }
    template <class Decode>
    bool readMap(const Place& place, std::string_view key, std::string& file,
                 std::shared_ptr<const Image>& map, Decode decode) {
        const Json* json = place.json.find(key);
        if (!json) return true;
        const Place member = place.at(*json, key);
        return readFileName(member, file) && readFile(member, file, map, decode);
    }

    const ReadFile& read_;
    Decoded& decoded_;
    double bytes_ = 0; ///< that what was read asks for
};

} // namespace lucent::scene

#include "scene/Json.h"

#include "base/Text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_set>

namespace lucent::scene {
namespace {

// Where the parser is. A line ends behind its line feed.
struct Position {
    int line = 1, column = 0;
    bool atLineFeed = false;

    void advance(char c) {
        if (atLineFeed) {
            ++line;
            column = 0;
        }
        ++column;
        atLineFeed = c == '\n';
    }
};

// Reads characters for the parser and counts them on their way.
class Reader {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Reader(const char* at, Position* position) : at_(at), position_(position) {}
    reference operator*() const { return *at_; }
    Reader& operator++() {
        position_->advance(*at_++);
        return *this;
    }
    bool operator==(const Reader& other) const { return at_ == other.at_; }
    bool operator!=(const Reader& other) const { return at_ != other.at_; }

private:
    const char* at_;
    Position* position_;
};

// Builds the tree from the parser's events; the names of its members are the parser's.
class Builder {
public:
    Builder(Json& root, const Position& position, const std::string& name, bool quotes)
        : root_(root), position_(position), name_(name), quotes_(quotes) {}

    const Error& error() const { return error_; }

    bool null() {
        add(Json::Type::Null);
        return true;
    }
    bool boolean(bool value) {
        add(Json::Type::Bool).boolean = value;
        return true;
    }
    bool number_integer(std::int64_t value) { return addNumber(double(value)); }
    bool number_unsigned(std::uint64_t value) { return addNumber(double(value)); }
    bool number_float(double value, const std::string&) { return addNumber(value); }
    bool string(std::string& value) {
        add(Json::Type::String).string = std::move(value);
        return true;
    }
    bool binary(const std::vector<std::uint8_t>&) { return false; } // JSON text has none
    bool start_object(std::size_t) { return open(Json::Type::Object); }
    bool start_array(std::size_t) { return open(Json::Type::Array); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }
    bool key(std::string& name) {
        Json& object = *open_.back();
        if (!keys_.back().insert(name).second)
            return fail("key " + inQuotes(name) + " stands here twice; must be unique");
        object.keys.push_back(name);
        keyLine_ = position_.line;
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& exception) {
        const std::string what = exception.what();
        const std::size_t dash = what.find(" - "); // before it stand the parser's own names and position
        return quotes_ ? fail(dash == what.npos ? what : what.substr(dash + 3)) : fail("is no JSON; must be");
    }

private:
    static constexpr std::size_t kMaxDepth = 32; // the tree is destroyed by recursion

    bool fail(const std::string& what) {
        error_ = {name_ + ":" + std::to_string(position_.line) + ":" + std::to_string(position_.column) +
                  ": " + what};
        return false;
    }

    Json& add(Json::Type type) {
        Json& json = open_.empty() ? root_ : open_.back()->items.emplace_back();
        json.type = type;
        // A number is known only when the character behind it, maybe a line feed, has been read.
        const bool isMember = !open_.empty() && open_.back()->type == Json::Type::Object;
        json.line = isMember ? keyLine_ : position_.line;
        return json;
    }
    bool addNumber(double value) {
        add(Json::Type::Number).number = value;
        return true;
    }
    bool open(Json::Type type) {
        if (open_.size() == kMaxDepth) return fail("nested deeper than 32; must be flatter");
        open_.push_back(&add(type)); // stays valid: its parent grows only after it is closed
        keys_.emplace_back();
        return true;
    }
    bool close() {
        open_.pop_back();
        keys_.pop_back();
        return true;
    }

    Json& root_;
    const Position& position_;
    const std::string& name_;
    const bool quotes_;
    std::vector<Json*> open_;
    std::vector<std::unordered_set<std::string>> keys_; // of each of these
    int keyLine_ = 1;
    Error error_;
};

} // namespace

const Json* Json::find(std::string_view key) const {
    const auto found = std::find(keys.begin(), keys.end(), key);
    return found == keys.end() ? nullptr : &items[std::size_t(found - keys.begin())];
}

std::string Json::describe() const {
    switch (type) {
    case Type::Null:
        return "null";
    case Type::Bool:
        return boolean ? "true" : "false";
    case Type::Number:
        return shortest(number);
    case Type::String:
        return inQuotes(string);
    case Type::Array:
        return "a list";
    case Type::Object:
        return "an object";
    }
    return {};
}

Result<Json> parseJson(std::span<const std::byte> text, const std::string& name, bool quotes) {
    const char* begin = reinterpret_cast<const char*>(text.data());
    Json root;
    Position position;
    Builder builder(root, position, name, quotes);
    if (!nlohmann::json::sax_parse(Reader(begin, &position), Reader(begin + text.size(), &position),
                                   &builder))
        return builder.error();
    return root;
}

} // namespace lucent::scene

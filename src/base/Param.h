#pragma once
/// Parameters are declared once, beside the struct that holds their values. From that one declaration come
/// the slider, the JSON key and its check, `--set`, the element's attribute and property, the accessible HTML
/// control, the JSON Schema and the table in the documentation.

#include "base/Math.h"
#include "base/Result.h"

#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lucent {

/// What kind of value a parameter has, and as what C++ type its struct stores it.
enum class Kind {
    Number,  ///< float
    Integer, ///< int
    Toggle,  ///< bool
    Choice,  ///< enum class : int; the index into `choices`
    Color,   ///< vec3, linear Rec. 709
    Vector,  ///< vec3
    Range,   ///< vec2, low and high end
    Pair,    ///< vec2, along x and z
};

/// Where a parameter stands in a panel. The order is the order of the panel.
enum class Group {
    None,
    Mode,
    Light,
    Material,
    Falloff,
    Subsurface,
    Refraction,
    Caustics,
    Environment,
    HeightField,
    Shape,
    Displacement,
    Waves,
    View
};
std::string_view name(Group group);

/// One declared parameter. `kLimitless` as min or max means no bound on that side.
struct Param {
    std::string_view id;                       ///< JSON key and last part of its path
    std::string_view label;                    ///< what a person reads
    std::string_view unit;                     ///< "m", "degrees", "" for plain numbers
    double min;                                ///< smallest legal value of a component
    double max;                                ///< largest legal value of a component
    double low;                                ///< left end of the slider
    double high;                               ///< right end of the slider
    bool logarithmic;                          ///< the slider moves through decades
    Group group;                               ///< None: file and command line only
    std::string_view doc;                      ///< one sentence, shown as tooltip and in the documentation
    std::span<const std::string_view> choices; ///< Choice only
    std::string_view attribute;                ///< name in the element; derived from table and id when empty
    std::string_view axes;                     ///< a letter for each component of a vector
    Kind kind;
    std::size_t offset; ///< of the member in its struct
};

inline constexpr double kLimitless = std::numeric_limits<double>::infinity();
/// As min: the value must be above 0 (the smallest normal float stands in for "just above").
inline constexpr double kAboveZero = std::numeric_limits<float>::min();

/// What a declaration says beyond its member: written with designated initialisers.
struct ParamText {
    std::string_view id, label, unit = "";
    double min = -kLimitless, max = kLimitless;
    double low = 0, high = 1;
    bool logarithmic = false;
    Group group = Group::None;
    std::string_view doc;
    std::span<const std::string_view> choices = {};
    std::string_view attribute = "";
    bool color = false; ///< a vec3 is a colour, not a vector
    bool pair = false;  ///< a vec2 is a vector, not a range
    std::string_view axes =
        "xyz"; ///< of a vec3 that is a vector: "rgb" where it has a number for each colour
};

/// Declares the parameter that lives in `member`; its kind follows from the member's type.
template <class Struct, class Member>
Param declare(Member Struct::*member, const ParamText& text) {
    static const Struct probe{};
    Kind kind = Kind::Number;
    if constexpr (std::is_same_v<Member, int>)
        kind = Kind::Integer;
    else if constexpr (std::is_same_v<Member, bool>)
        kind = Kind::Toggle;
    else if constexpr (std::is_enum_v<Member>)
        kind = Kind::Choice;
    else if constexpr (std::is_same_v<Member, vec3>)
        kind = text.color ? Kind::Color : Kind::Vector;
    else if constexpr (std::is_same_v<Member, vec2>)
        kind = text.pair ? Kind::Pair : Kind::Range;
    else
        static_assert(std::is_same_v<Member, float>, "a parameter is a float, int, bool, enum, vec2 or vec3");
    const auto offset =
        std::size_t(reinterpret_cast<const char*>(&(probe.*member)) - reinterpret_cast<const char*>(&probe));
    const std::string_view axes = kind == Kind::Pair ? "xz" : text.axes;
    return {
        text.id,    text.label, text.unit,    text.min,       text.max, text.low, text.high, text.logarithmic,
        text.group, text.doc,   text.choices, text.attribute, axes,     kind,     offset};
}

/// All parameters of one struct. Its defaults are those of the default-constructed struct.
struct ParamTable {
    std::string_view name; ///< "light", "material", "relief"
    std::span<const Param> params;
    const void* defaults;        ///< a default-constructed struct
    std::size_t size;            ///< sizeof the struct
    std::string_view label = ""; ///< what a person reads, where tables share a group
};

template <class Struct>
ParamTable tableOf(std::string_view name, std::span<const Param> params, std::string_view label = "") {
    static const Struct defaults{};
    return {name, params, &defaults, sizeof(Struct), label};
}

/// Settings of a technique that the scene carries without knowing its struct.
class Settings {
public:
    Settings() = default;
    explicit Settings(const ParamTable& table);
    const ParamTable& table() const { return *table_; }
    void* data() { return bytes_.data(); }
    const void* data() const { return bytes_.data(); }
    template <class Struct>
    const Struct& as() const {
        static_assert(std::is_trivially_copyable_v<Struct>);
        assert(table_ && table_->size == sizeof(Struct));
        return *reinterpret_cast<const Struct*>(bytes_.data());
    }

private:
    const ParamTable* table_ = nullptr;
    std::vector<std::byte> bytes_; // the allocator aligns for every scalar type
};

/// What a parameter needs that no struct holds: its value is computed from others when it is bound.
struct Computed {
    std::shared_ptr<const void> owner; ///< of what BoundParam::data points to
    std::function<Status()> store;     ///< carries that over to the others; an error leaves them alone
    bool isOwn = false; ///< no other parameter says the same, so that links must carry it as well
};

/// A declared parameter bound to the struct that holds its value now.
struct BoundParam {
    std::string path; ///< "objects.coin.material.specularity": what --set and links use
    std::string
        prefix; ///< of the attribute: "light", "material", "env", "relief", "view"; "": has no attribute
    const Param* param;
    void* data;                  ///< the value
    const void* defaults;        ///< the value to which reset goes back
    bool shown = true;           ///< false: reachable by its path, but in no panel
    std::string_view label = ""; ///< of its table
    Group place = Group::None;   ///< where it stands instead of its param's group
    Computed computed = {};      ///< without an owner: `data` is the value itself

    /// Where it stands in the panel now.
    Group group() const { return !shown ? Group::None : place != Group::None ? place : param->group; }
    bool isComputed() const { return computed.owner != nullptr; }
    /// Whether other parameters say the same.
    bool isDerived() const { return isComputed() && !computed.isOwn; }
};

/// Number of float components of a kind: 3 for colours and vectors, 2 for ranges and pairs, else 1.
int componentCount(Kind kind);

/// Value as text: "0.3", "0.1 0.2 0.3", "true", "hierarchy". Shortest form that reads back to the same value.
std::string getText(const Param& param, const void* data);

/// Reads a value from text (components separated by spaces or commas; colours also "#rrggbb", sRGB) into
/// `data`, or leaves `data` alone and says what was found and what is expected: "is 2; must be in [0, 1]".
Status setText(const Param& param, void* data, std::string_view text);

/// Component access as numbers, for sliders and JSON: toggles are 0 and 1, choices their index.
double getComponent(const Param& param, const void* data, int component);
/// Stores a component without a check.
void setComponent(const Param& param, void* data, int component, double value);

/// Checks every component against min and max: "is 2; must be in [0, 1]". The low end of a range must not lie
/// above its high end.
Status checkRange(const Param& param, const void* data);

/// "material-specular-falloff": kebab-case attribute of the custom element; "" when it has none.
std::string attributeName(const BoundParam& bound);

} // namespace lucent

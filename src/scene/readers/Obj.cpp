#include "scene/readers/Obj.h"

#include "base/Log.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>

namespace lucent::scene {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == text.npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// Takes the first word off a line.
std::string_view nextWord(std::string_view& line) {
    line = trimmed(line);
    const std::string_view word = line.substr(0, std::min(line.find_first_of(kBlanks), line.size()));
    line.remove_prefix(word.size());
    return word;
}

/// Gives a text line by line: comments left out, lines that end in a backslash joined.
class Lines {
public:
    explicit Lines(std::span<const std::byte> bytes)
        : rest_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

    /// False at the end; the line stays valid until the next call.
    bool next(std::string_view& line) {
        joined_.clear();
        while (!rest_.empty()) {
            line = takeLine();
            const bool goesOn = line.ends_with('\\');
            if (goesOn) line.remove_suffix(1);
            if (goesOn || !joined_.empty()) {
                joined_.append(line).append(" ");
                line = joined_;
            }
            if (!goesOn) return true;
        }
        line = joined_;
        return !joined_.empty();
    }
    int number() const { return number_; }

private:
    std::string_view takeLine() {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++number_;
        return trimmed(line.substr(0, line.find('#')));
    }
    std::string_view rest_;
    std::string joined_;
    int number_ = 0;
};

std::optional<float> toNumber(std::string_view word) {
    char text[64]; // strtod wants an end; no number is longer
    if (word.empty() || word.size() >= sizeof text) return {};
    text[word.copy(text, sizeof text - 1)] = 0;
    char* end = nullptr;
    const float number = std::strtof(text, &end);
    return end == text + word.size() ? std::optional(number) : std::nullopt;
}

/// Reads values of lines and remembers what was wrong with the first bad one.
class LineReader {
public:
    /// @param quotes  whether messages may repeat words of the file
    LineReader(const std::string& name, std::span<const std::byte> bytes, bool quotes)
        : name_(name), lines_(bytes), quotes_(quotes) {}

    bool next(std::string_view& keyword, std::string_view& rest) {
        while (error_.empty() && lines_.next(rest))
            if (keyword = nextWord(rest); !keyword.empty()) return true;
        return false;
    }
    void fail(const std::string& what) {
        if (error_.empty()) error_ = name_ + ":" + std::to_string(lines_.number()) + ": " + what;
    }
    vec3 vector(std::string_view keyword, std::string_view& rest) {
        vec3 v(0);
        for (int i = 0; i < 3; ++i)
            v[i] = number(keyword, rest);
        return v;
    }
    float number(std::string_view keyword, std::string_view& rest) {
        const std::string_view word = nextWord(rest);
        const std::optional<float> value = toNumber(word);
        const std::string found = quotes_ ? "\"" + std::string(word) + "\"" : "what is none";
        if (!value) fail(std::string(keyword) + " has " + found + "; must be a number");
        return value.value_or(0);
    }
    const std::string& error() const { return error_; }

private:
    const std::string& name_;
    Lines lines_;
    bool quotes_;
    std::string error_;
};

struct ObjMaterial {
    Material values;
    std::string color, emission, normal; // files of its textures, beside the scene
};
using Materials = std::map<std::string, ObjMaterial, std::less<>>;
using Names = std::set<std::string>;

// Keywords of the material format by their names. Others are not repeated: an .obj may name any file beside
// it as its materials, and what is said of that may be seen by people who should not read it.
std::string nameOf(std::string_view keyword) {
    constexpr std::string_view kKnown[] = {
        "Ks",     "Ns",     "Tf",    "Pr",       "Pm",       "Ps",     "Pc",     "Pcr",    "aniso",
        "anisor", "norm",   "bump",  "disp",     "decal",    "refl",   "map_Ka", "map_Kd", "map_Ks",
        "map_Ke", "map_Ns", "map_d", "map_Bump", "map_bump", "map_Pr", "map_Pm", "map_Ps", "sharpness"};
    const bool known = std::find(std::begin(kKnown), std::end(kKnown), keyword) != std::end(kKnown);
    return known ? std::string(keyword) : "lines of unknown kinds";
}

// Which of a material's textures a line names; null: none.
std::string ObjMaterial::*textureNamed(std::string_view keyword) {
    if (keyword == "map_Kd") return &ObjMaterial::color;
    if (keyword == "map_Ke") return &ObjMaterial::emission;
    return keyword == "norm" ? &ObjMaterial::normal : nullptr;
}

// A file beside the one that names it, as Windows may write that.
std::string fileNamed(std::string_view words) {
    std::string file(trimmed(words));
    std::replace(file.begin(), file.end(), '\\', '/');
    return file.starts_with("./") ? file.substr(2) : file;
}

// Behind options the last word, else all of it, blanks included.
std::string textureFile(std::string_view rest) {
    rest = trimmed(rest);
    const std::size_t blank = rest.find_last_of(kBlanks);
    return fileNamed(rest.starts_with('-') && blank != rest.npos ? rest.substr(blank + 1) : rest);
}

// What Wavefront's material format says that means the same here.
Status readMaterials(const std::string& name, std::span<const std::byte> bytes, Materials& materials,
                     Names& unread) {
    LineReader lines(name, bytes, false);
    ObjMaterial* known = nullptr;
    Material* material = nullptr;
    Clear clear;
    std::optional<Glossy> glossy;
    const auto take = [&] {
        if (clear.transmission > 0)
            material->kind = clear;
        else if (glossy)
            material->kind = *glossy;
        else
            material->kind = Matt{};
    };
    const auto share = [&](std::string_view of, std::string_view& words) {
        const float value = lines.number(of, words);
        if (!(value >= 0 && value <= 1))
            lines.fail(std::string(of) + " is " + std::to_string(value) + "; must be in [0, 1]");
        return value;
    };
    std::string_view keyword, rest;
    while (lines.next(keyword, rest)) {
        if (keyword == "newmtl") {
            known = &materials[std::string(trimmed(rest))];
            material = &known->values;
            clear = {.transmission = 0, .ior = 1}; // the format's defaults
            glossy.reset();
            take();
        } else if (!material) {
            lines.fail("a line comes before a material; must follow newmtl");
        } else if (keyword == "Kd") {
            material->diffuse = lines.vector(keyword, rest);
        } else if (keyword == "Ke") {
            material->base = lines.vector(keyword, rest);
        } else if (keyword == "Ni") {
            clear.ior = lines.number(keyword, rest);
            if (!(clear.ior > 0)) lines.fail("Ni is " + std::to_string(clear.ior) + "; must be above 0");
            take();
        } else if (keyword == "d" || keyword == "Tr") { // how solid it is, or how clear
            const float part = share(keyword, rest);
            clear.transmission = keyword == "d" ? 1 - part : part;
            take();
        } else if (keyword == "Pr" || keyword == "Pm") { // of newer files: as glTF's roughness and metal
            if (!glossy) glossy = Glossy{.roughness = 1};
            (keyword == "Pr" ? glossy->roughness : glossy->metallic) = share(keyword, rest);
            take();
        } else if (std::string ObjMaterial::*const texture = textureNamed(keyword)) {
            known->*texture = resolvePath(name, textureFile(rest));
            if (trimmed(rest).starts_with('-')) unread.insert("options of textures");
        } else if (keyword != "Ka" &&
                   keyword != "illum") { // light of renderers past, and their choice of terms
            unread.insert(nameOf(keyword));
        }
    }
    if (!lines.error().empty()) return Error{lines.error()};
    return Done{};
}

// Triangles of a polygon, as places in its list of corners: ears are cut off as long as there are any, and
// what is left, folded or without area, is cut from its first corner. Nothing is lost.
std::vector<std::array<std::size_t, 3>> triangulate(const std::vector<dvec3>& corners) {
    std::vector<std::array<std::size_t, 3>> triangles;
    dvec3 normal(0);
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += glm::cross(corners[i], corners[(i + 1) % corners.size()]);
        left.push_back(i);
    }
    const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
        return glm::dot(glm::cross(corners[b] - corners[a], corners[c] - corners[a]), normal);
    };
    const auto isEar = [&](std::size_t at) {
        const std::size_t a = left[(at + left.size() - 1) % left.size()], b = left[at],
                          c = left[(at + 1) % left.size()];
        return turn(a, b, c) > 0 && std::none_of(left.begin(), left.end(), [&](std::size_t p) {
                   return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                          turn(c, a, p) >= 0;
               });
    };
    while (left.size() > 3) {
        std::size_t ear = 0;
        while (ear < left.size() && !isEar(ear))
            ++ear;
        if (ear == left.size()) break;
        triangles.push_back(
            {left[(ear + left.size() - 1) % left.size()], left[ear], left[(ear + 1) % left.size()]});
        left.erase(left.begin() + std::ptrdiff_t(ear));
    }
    for (std::size_t i = 1; i + 1 < left.size(); ++i)
        triangles.push_back({left[0], left[i], left[i + 1]});
    return triangles;
}

class ObjReader {
public:
    ObjReader(const std::string& name, std::span<const std::byte> bytes, const ReadFile& read)
        : name_(name), lines_(name, bytes, true), read_(read) {}

    Result<Mesh> read(Materials materials, Names unread) {
        unread_ = std::move(unread);
        std::string_view keyword, rest;
        while (lines_.next(keyword, rest))
            readLine(keyword, rest);
        if (!lines_.error().empty()) return Error{lines_.error()};
        finishNormals();
        finishParts(materials);
        if (mesh_.indices.empty()) return Error{name_ + ": holds no faces; must hold at least one"};
        std::string names;
        for (const std::string& what : unread_)
            names += (names.empty() ? "" : ", ") + what;
        if (!names.empty()) warnOnce(name_ + ": not read: " + names);
        return std::move(mesh_);
    }

private:
    /// A vertex of ours: a position with a normal, -1 for none; then faces of one smoothing group share it,
    /// and other faces have their own. -1: without texture coordinates.
    struct Corner {
        std::int64_t position = -1, normal = -1, coordinate = -1, group = 0;
        bool operator==(const Corner&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Corner& c) const {
            std::size_t hash = std::size_t(c.position);
            for (const std::int64_t other : {c.normal, c.coordinate, c.group})
                hash = hash * 1000003u ^ std::size_t(other);
            return hash;
        }
    };

    void readLine(std::string_view keyword, std::string_view rest) {
        if (keyword == "v") {
            positions_.push_back(lines_.vector(keyword, rest));
            readColor(rest);
        } else if (keyword == "vn") {
            normals_.push_back(lines_.vector(keyword, rest));
        } else if (keyword == "vt") { // v points up there
            const float u = lines_.number(keyword, rest);
            coordinates_.emplace_back(u, 1 - (trimmed(rest).empty() ? 0 : lines_.number(keyword, rest)));
        } else if (keyword == "f") {
            readFace(rest);
        } else if (keyword == "usemtl") {
            indices_ = &partNamed(trimmed(rest));
            hasMaterials_ = true;
        } else if (keyword == "s") {
            smoothing_ = groupOf(trimmed(rest));
        } else if (keyword == "p" || keyword == "l") {
            unread_.insert("points and lines");
        } else if (keyword != "g" && keyword != "o" && keyword != "mtllib") {
            unread_.insert(std::string(keyword));
        }
    }

    // What follows a position: nothing, a weight, of use to curves only, or the colour that scanners put
    // there.
    void readColor(std::string_view rest) {
        std::string_view behind = rest;
        nextWord(behind);
        if (trimmed(behind).empty()) return;
        const vec3 color = glm::clamp(lines_.vector("v", rest), vec3(0), vec3(1));
        colors_.resize(positions_.size(), vec3(1)); // of what has none
        colors_.back() = {linearFromSrgb(color.r), linearFromSrgb(color.g), linearFromSrgb(color.b)};
    }

    // "off" and 0: none; groups are numbers, and any other word counts as one.
    static std::int64_t groupOf(std::string_view word) {
        if (word.empty() || word == "off") return 0;
        std::int64_t number = 0;
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
        return problem == std::errc() ? std::abs(number) : 1;
    }

    std::vector<std::uint32_t>& partNamed(std::string_view name) {
        if (name.empty()) name = "default";
        const auto [known, isNew] = partNumbers_.emplace(name, parts_.size());
        if (isNew) parts_.emplace_back(name, std::vector<std::uint32_t>());
        return parts_[known->second].second;
    }

    static constexpr std::size_t kMostCorners = 4096;

    void readFace(std::string_view rest) {
        face_.clear();
        points_.clear();
        const std::int64_t group = smoothing_ > 0 ? smoothing_ : -++faces_;
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
            const std::size_t first = std::min(word.find('/'), word.size()),
                              second = std::min(word.find('/', first + 1), word.size());
            Corner corner{.position = place(word.substr(0, first), positions_.size(), "position")};
            if (second > first + 1)
                corner.coordinate = place(word.substr(first + 1, second - first - 1), coordinates_.size(),
                                          "texture coordinate");
            if (second < word.size())
                corner.normal = place(word.substr(second + 1), normals_.size(), "normal");
            if (!lines_.error().empty()) return;
            if (corner.normal < 0) corner.group = group;
            face_.push_back(vertex(corner));
            points_.emplace_back(positions_[std::size_t(corner.position)]);
        }
        if (face_.size() < 3)
            return lines_.fail("f has " + std::to_string(face_.size()) + " corners; must have three or more");
        if (face_.size() > kMostCorners) // cutting takes the square of their number
            return lines_.fail("f has " + std::to_string(face_.size()) + " corners; must have at most " +
                               std::to_string(kMostCorners));
        if (!indices_) indices_ = &partNamed("");
        for (const std::array<std::size_t, 3>& triangle : triangulate(points_))
            for (const std::size_t corner : triangle)
                indices_->push_back(face_[corner]);
    }

    // Places count from 1, or backwards from the end.
    std::int64_t place(std::string_view word, std::size_t count, const char* what) {
        std::int64_t number = 0;
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
        const std::int64_t index = number < 0 ? number + std::int64_t(count) : number - 1;
        if (problem != std::errc() || end != word.data() + word.size() || number == 0 || index < 0 ||
            index >= std::int64_t(count))
            lines_.fail("f names " + std::string(what) + " \"" + std::string(word) +
                        "\"; must be one of the " + std::to_string(count) + " before it");
        return index;
    }

    std::uint32_t vertex(const Corner& corner) {
        const auto [known, isNew] = vertices_.emplace(corner, std::uint32_t(mesh_.positions.size()));
        if (isNew) {
            mesh_.positions.push_back(positions_[std::size_t(corner.position)]);
            mesh_.normals.push_back(corner.normal < 0 ? vec3(0) : normals_[std::size_t(corner.normal)]);
            const bool hasColor = std::size_t(corner.position) < colors_.size();
            mesh_.colors.push_back(hasColor ? colors_[std::size_t(corner.position)] : vec3(1));
            mesh_.coordinates.push_back(corner.coordinate < 0 ? vec2(0)
                                                              : coordinates_[std::size_t(corner.coordinate)]);
        }
        return known->second;
    }

    // Those that the file leaves out, or gives no direction, follow from the faces around: of the vertex, so
    // that they are flat outside of smoothing groups.
    void finishNormals() {
        std::vector<std::uint32_t> all;
        for (const auto& [name, indices] : parts_)
            all.insert(all.end(), indices.begin(), indices.end());
        const std::vector<vec3> found = areaWeightedNormals(mesh_.positions, all);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const float length = glm::length(mesh_.normals[i]);
            mesh_.normals[i] = length == 0 ? found[i] : mesh_.normals[i] / length;
        }
    }

    void finishParts(const Materials& materials) {
        const bool isColored = !colors_.empty();
        if (!isColored) mesh_.colors.clear();
        for (const auto& [name, indices] : parts_) {
            if (indices.empty()) continue;
            const auto found = materials.find(name);
            ObjMaterial material =
                found == materials.end() ? ObjMaterial{{.kind = Matt{}}, {}, {}, {}} : found->second;
            if (isColored && !hasMaterials_) material.values.diffuse = vec3(1);
            if (hasMaterials_ || isColored)
                mesh_.parts.push_back({name, std::uint32_t(mesh_.indices.size()),
                                       std::uint32_t(indices.size()), material.values, texturesOf(material)});
            mesh_.indices.insert(mesh_.indices.end(), indices.begin(), indices.end());
        }
        if (mesh_.images.empty()) mesh_.coordinates.clear();
    }

    Textures texturesOf(const ObjMaterial& material) {
        if (!showsTextures(material.values)) return {};
        return {.color = useOf(material.color, Encoding::Srgb),
                .emission = useOf(material.emission, Encoding::Srgb),
                .roughness = {},
                .normal = useOf(material.normal, Encoding::Linear),
                .vertexColors = !colors_.empty()};
    }

    TextureUse useOf(const std::string& file, Encoding encoding) {
        if (file.empty()) return {};
        const auto [known, isNew] = images_.emplace(std::pair(file, encoding), -1);
        if (isNew) {
            const Result<Bytes> bytes = read_(file);
            Result<TextureImage> image =
                bytes ? decodeTexture(*bytes, file, encoding) : Result<TextureImage>(bytes.error());
            if (image) {
                known->second = std::int32_t(mesh_.images.size());
                mesh_.images.push_back(std::make_shared<const TextureImage>(std::move(*image)));
            } else {
                unread_.insert("a texture (" + image.error().message + ")");
            }
        }
        return {.image = known->second};
    }

    const std::string& name_;
    LineReader lines_;
    const ReadFile& read_;
    std::vector<vec3> positions_, normals_, colors_; ///< colors_ up to the last position that has one
    std::vector<vec2> coordinates_;
    std::map<std::pair<std::string, Encoding>, std::int32_t> images_; // places in the mesh's; -1: not read
    std::unordered_map<Corner, std::uint32_t, Hash> vertices_;
    std::vector<std::pair<std::string, std::vector<std::uint32_t>>> parts_; // by material, as they come
    std::unordered_map<std::string, std::size_t> partNumbers_;              // in these, by name
    std::vector<std::uint32_t>* indices_ = nullptr;                         // of the part that faces go to
    std::vector<std::uint32_t> face_;
    std::vector<dvec3> points_;
    Names unread_;
    std::int64_t smoothing_ = 0, faces_ = 0; // group that is in force, 0: none; faces so far
    bool hasMaterials_ = false;
    Mesh mesh_;
};

} // namespace

bool isObj(const std::string& name) { return name.ends_with(".obj") || name.ends_with(".OBJ"); }
bool isMaterialFile(const std::string& name) { return name.ends_with(".mtl") || name.ends_with(".MTL"); }

std::vector<std::string> filesNamedIn(std::span<const std::byte> bytes) {
    std::vector<std::string> files;
    Lines lines(bytes);
    for (std::string_view line; lines.next(line);) {
        const std::string_view keyword = nextWord(line);
        if (keyword == "mtllib") files.push_back(fileNamed(line));
        if (textureNamed(keyword)) files.push_back(textureFile(line));
    }
    return files;
}

Result<Mesh> readObj(const std::string& name, std::span<const std::byte> bytes, const ReadFile& read) {
    Materials materials;
    Names unread;
    for (const std::string& file : filesNamedIn(bytes)) {
        const std::string path = resolvePath(name, file);
        const Result<Bytes> text = read(path);
        if (!text) {
            unread.insert("materials (" + text.error().message + ")");
            continue;
        }
        if (Status done = readMaterials(path, *text, materials, unread); !done) return done.error();
    }
    return ObjReader(name, bytes, read).read(std::move(materials), std::move(unread));
}

Bytes encodeObj(const Mesh& mesh) {
    std::string text;
    char line[128];
    const auto vectors = [&](const char* format, const std::vector<vec3>& values) {
        for (const vec3& v : values)
            text.append(line, std::size_t(std::snprintf(line, sizeof line, format, double(v.x), double(v.y),
                                                        double(v.z))));
    };
    vectors("v %.9g %.9g %.9g\n", mesh.positions);
    vectors("vn %.9g %.9g %.9g\n", mesh.normals);
    auto part = mesh.parts.begin();
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        if (part != mesh.parts.end() && part->firstIndex == i) text += "usemtl " + (part++)->material + "\n";
        const std::uint32_t a = mesh.indices[i] + 1, b = mesh.indices[i + 1] + 1, c = mesh.indices[i + 2] + 1;
        const int length = mesh.normals.empty() ? std::snprintf(line, sizeof line, "f %u %u %u\n", a, b, c)
                                                : std::snprintf(line, sizeof line, "f %u//%u %u//%u %u//%u\n",
                                                                a, a, b, b, c, c);
        text.append(line, std::size_t(length));
    }
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    return Bytes(begin, begin + text.size());
}

} // namespace lucent::scene

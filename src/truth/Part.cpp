#include "truth/Part.h"

#include "base/ImageSize.h"
#include "base/JsonWriter.h"
#include "base/Text.h"
#include "scene/Json.h"
#include "scene/Load.h"
#include "scene/Mesh.h"
#include "truth/Photons.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <utility>

namespace lucent::truth {

namespace {
static_assert(std::endian::native == std::endian::little); // the order of the bytes in a part

constexpr std::string_view kMagic = "lucent part ";
constexpr std::size_t kLongestFirstLine = 64; // magic, up to 19 digits, checksum, line feed

/// FNV-1a, 64 bits: no two scenes meet by accident, and nobody forges tiles.
class Hash {
public:
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes)
            state_ = (state_ ^ std::uint64_t(byte)) * 0x100000001b3u;
    }
    void add(const std::shared_ptr<const Image>& image) {
        if (!image) return;
        const int sizes[] = {image->width, image->height, image->channels};
        add(std::as_bytes(std::span(sizes)));
        add(std::as_bytes(std::span(image->pixels)));
    }
    void add(const scene::Shape& shape) {
        if (const auto* field = std::get_if<scene::HeightField>(&shape)) {
            add(field->heights);
            add(field->alpha);
        }
        if (const auto* mesh = std::get_if<scene::MeshShape>(&shape)) add(scene::encodeMesh(*mesh->mesh));
    }
    std::string text() const {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(state_));
        return digits;
    }

private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

void writeFacts(JsonWriter& json, const Facts& facts) {
    json.key("scene").value(facts.scene).key("fingerprint").value(facts.fingerprint);
    json.key("width").value(facts.size.x).key("height").value(facts.size.y);
    json.key("aov").value(facts.aov).key("estimator").value(facts.estimator);
    json.key("seed").raw(std::to_string(facts.seed));
    json.key("samples").value(facts.samples).key("directions").value(facts.directions);
    json.key("photons").raw(std::to_string(facts.photons)).key("antialias").value(facts.antialias);
    json.key("exposure").value(facts.exposure);
}

/// Red, green and blue of each entry: "met": { "red": 1, ... }.
void writeEnergy(JsonWriter& json, const EnergyBook& energy) {
    json.key("energy").beginObject();
    for (const EnergyBook::Entry& entry : EnergyBook::kEntries) {
        const dvec3& flux = energy.*entry.value;
        json.key(entry.name).beginObject();
        json.key("red").value(flux.r).key("green").value(flux.g).key("blue").value(flux.b);
        json.end();
    }
    json.end();
}

/// Members of a JSON object by name; remembers when one was missing or of another type.
class Reader {
public:
    explicit Reader(const scene::Json& json) : json_(json) {}
    std::string text(std::string_view key) { return member(key, scene::Json::Type::String).string; }
    double number(std::string_view key) { return member(key, scene::Json::Type::Number).number; }
    /// A whole number in [low, high].
    std::int64_t whole(std::string_view key, double low, double high) {
        const double value = number(key);
        if (value < low || value > high || value != std::floor(value)) {
            complete_ = false;
            return std::int64_t(low);
        }
        return std::int64_t(value);
    }
    bool truth(std::string_view key) { return member(key, scene::Json::Type::Bool).boolean; }
    Reader object(std::string_view key) { return Reader(member(key, scene::Json::Type::Object)); }
    void require(const Reader& other) { complete_ &= other.complete_; }
    bool complete() const { return complete_; }

private:
    const scene::Json& member(std::string_view key, scene::Json::Type type) {
        static const scene::Json kNothing;
        const scene::Json* found = json_.find(key);
        if (found && found->type == type) return *found;
        complete_ = false;
        return kNothing;
    }
    const scene::Json& json_;
    bool complete_ = true;
};

Facts readFacts(Reader& reader) {
    constexpr double kMany = 2147483647;
    Facts facts;
    facts.scene = reader.text("scene");
    facts.fingerprint = reader.text("fingerprint");
    facts.size = {int(reader.whole("width", 1, kMaxImageSide)),
                  int(reader.whole("height", 1, kMaxImageSide))};
    facts.aov = reader.text("aov");
    facts.estimator = reader.text("estimator");
    facts.seed = std::uint64_t(reader.whole("seed", 0, 0x1p53));
    facts.samples = int(reader.whole("samples", 0, kMany));
    facts.directions = int(reader.whole("directions", 0, kMany));
    facts.photons = reader.whole("photons", 0, 0x1p53);
    facts.antialias = reader.truth("antialias");
    facts.exposure = float(reader.number("exposure"));
    return facts;
}

EnergyBook readEnergy(Reader& reader) {
    EnergyBook energy;
    Reader book = reader.object("energy");
    for (const EnergyBook::Entry& entry : EnergyBook::kEntries) {
        Reader flux = book.object(entry.name);
        energy.*entry.value = {flux.number("red"), flux.number("green"), flux.number("blue")};
        book.require(flux);
    }
    reader.require(book);
    return energy;
}

/// Name and value of all that two parts of one picture have in common. What says most comes first; the
/// fingerprint, which many of the others change as well, last.
std::vector<std::pair<std::string, std::string>> identity(const Part& part) {
    const Facts& facts = part.facts;
    return {{"the size", std::to_string(facts.size.x) + "x" + std::to_string(facts.size.y)},
            {"the AOV", facts.aov},
            {"the estimator", facts.estimator},
            {"the seed", std::to_string(facts.seed)},
            {"the number of samples", std::to_string(facts.samples)},
            {"the number of directions", std::to_string(facts.directions)},
            {"the number of photons", std::to_string(facts.photons)},
            {"the antialiasing", facts.antialias ? "on" : "off"},
            {"the exposure", shortest(facts.exposure)},
            {"the number of parts", std::to_string(part.tile.count)},
            {"the scene's fingerprint", facts.fingerprint}};
}

Status checkSame(const Part& first, const std::string& firstName, const Part& other,
                 const std::string& name) {
    const auto expected = identity(first), found = identity(other);
    for (std::size_t i = 0; i < expected.size(); ++i)
        if (found[i].second != expected[i].second)
            return Error{name + ": " + found[i].first + " is " + found[i].second + "; must be " +
                         expected[i].second + " as in " + firstName};
    return Done{};
}

std::string partNumber(int index, int count) {
    return "part " + std::to_string(index + 1) + " of " + std::to_string(count);
}

Picture mergeRows(std::span<const Part* const> parts) {
    const auto copyRow = [](const Image& from, int fromRow, Image& to, int toRow) {
        std::memcpy(to.at(0, toRow), from.at(0, fromRow),
                    std::size_t(from.width) * std::size_t(from.channels) * sizeof(float));
    };
    Picture picture(parts.front()->facts.size);
    for (const Part* part : parts)
        for (int row = 0; row < part->rows.values.height; ++row) {
            copyRow(part->rows.values, row, picture.values, part->tile.row(row));
            copyRow(part->rows.errors, row, picture.errors, part->tile.row(row));
        }
    return picture;
}

void append(Bytes& bytes, std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

/// What a part holds behind its header, as it lies in memory.
std::vector<std::span<std::byte>> blocksOf(Picture& rows) {
    std::vector<std::span<std::byte>> blocks{std::as_writable_bytes(std::span(rows.values.pixels)),
                                             std::as_writable_bytes(std::span(rows.errors.pixels))};
    if (Rays* rays = rows.rays.get())
        blocks.insert(blocks.end(), {std::as_writable_bytes(std::span(rays->pixels)),
                                     std::as_writable_bytes(std::span(rays->energy)),
                                     std::as_writable_bytes(std::span(&rays->strongest, 1)),
                                     std::as_writable_bytes(std::span(rays->worth))});
    return blocks;
}
} // namespace

std::string fingerprint(const scene::Scene& scene) {
    Hash hash;
    const std::string json = scene::toJson(scene);
    hash.add(std::as_bytes(std::span(json)));
    for (const scene::Object& object : scene.objects) {
        hash.add(object.shape);
        for (const auto& map : object.material.maps())
            hash.add(map);
    }
    for (const auto& map : scene::lightPictures(scene))
        hash.add(map);
    return hash.text();
}

std::string sidecar(const Facts& facts, const Picture& picture) {
    JsonWriter json;
    json.beginObject();
    writeFacts(json, facts);
    json.key("standardError").value(picture.standardError());
    if (picture.energy) writeEnergy(json, *picture.energy);
    json.end();
    return json.text();
}

// "lucent part LENGTH CHECKSUM", the checksum of all that follows; LENGTH bytes of JSON; the blocks.
Bytes encodePart(Part part) {
    JsonWriter json;
    json.beginObject();
    writeFacts(json, part.facts);
    json.key("part").value(part.tile.index + 1).key("parts").value(part.tile.count);
    if (part.rows.energy) writeEnergy(json, *part.rows.energy);
    json.end();
    const std::string header = json.text();
    Bytes content;
    append(content, std::as_bytes(std::span(header)));
    for (const std::span<std::byte> block : blocksOf(part.rows))
        append(content, block);
    Hash checksum;
    checksum.add(content);
    const std::string line =
        std::string(kMagic) + std::to_string(header.size()) + " " + checksum.text() + "\n";
    Bytes bytes;
    append(bytes, std::as_bytes(std::span(line)));
    append(bytes, content);
    return bytes;
}

Result<Part> decodePart(std::span<const std::byte> bytes, const std::string& name) {
    const std::string start(reinterpret_cast<const char*>(bytes.data()),
                            std::min(bytes.size(), kLongestFirstLine));
    const std::size_t line = start.find('\n');
    if (start.rfind(kMagic, 0) != 0 || line == std::string::npos)
        return Error{name + ": is no part of a truth; must be a file that lucent truth --tile wrote"};
    char* end = nullptr;
    const std::size_t length = std::size_t(std::strtoull(start.c_str() + kMagic.size(), &end, 10));
    const Error damaged{name +
                        ": the header of the part is damaged; must be as lucent truth --tile wrote it"};
    if (length > bytes.size() - line - 1) return damaged;
    const Result<scene::Json> json = scene::parseJson(bytes.subspan(line + 1, length), name);
    if (!json) return json.error();

    Reader reader(*json);
    Part part{readFacts(reader), {}, {}};
    const double most = part.facts.photons > 0 ? double(part.facts.photons) : part.facts.size.y;
    part.tile.count = int(reader.whole("parts", 1, std::min(most, 0x1p31 - 1)));
    part.tile.index = int(reader.whole("part", 1, part.tile.count)) - 1;
    const bool byRays = part.facts.photons > 0 && part.tile.count > 1;
    std::optional<EnergyBook> energy;
    if (part.facts.photons > 0 && !byRays) energy = readEnergy(reader);
    if (!reader.complete()) return damaged;
    if (Status size = checkImageSize(part.facts.size.x, part.facts.size.y, 4, name); !size)
        return size.error();

    part.rows = Picture({part.facts.size.x, part.tile.rows(part.facts.size.y)});
    part.rows.energy = energy;
    if (byRays) {
        const std::size_t pixels = std::size_t(part.facts.size.x) * std::size_t(part.facts.size.y);
        part.rows.rays = std::make_shared<Rays>(pixels);
        part.rows.rays->worth.resize(pixels);
    }
    const std::vector<std::span<std::byte>> blocks = blocksOf(part.rows);
    const std::size_t needed =
        std::accumulate(blocks.begin(), blocks.end(), line + 1 + length,
                        [](std::size_t sum, const auto& block) { return sum + block.size(); });
    if (bytes.size() != needed)
        return Error{name + ": has " + std::to_string(bytes.size()) + " bytes; must have " +
                     std::to_string(needed)};
    Hash found;
    found.add(bytes.subspan(line + 1));
    if (" " + found.text() !=
        start.substr(std::size_t(end - start.c_str()), line - std::size_t(end - start.c_str())))
        return Error{
            name +
            ": has another checksum than its first line says; must be as lucent truth --tile wrote it"};
    const std::byte* data = bytes.data() + line + 1 + length;
    for (const std::span<std::byte> block : blocks) {
        std::copy_n(data, block.size(), block.data());
        data += block.size();
    }
    return part;
}

Result<Picture> merge(std::span<const Part> parts, std::span<const std::string> names) {
    const Part& first = parts.front();
    const int count = first.tile.count;
    std::vector<const Part*> ordered(std::size_t(count), nullptr);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (Status same = checkSame(first, names[0], parts[i], names[i]); !same) return same.error();
        const Part*& place = ordered[std::size_t(parts[i].tile.index)];
        if (place)
            return Error{names[i] + ": is " + partNumber(parts[i].tile.index, count) + ", as " +
                         names[std::size_t(place - parts.data())] + " is; must be given once"};
        place = &parts[i];
    }
    std::string missing;
    for (int index = 0; index < count; ++index)
        if (!ordered[std::size_t(index)])
            missing += (missing.empty() ? "" : ", ") + std::to_string(index + 1);
    if (!missing.empty())
        return Error{names[0] + ": is " + partNumber(first.tile.index, count) +
                     " and these are missing: " + missing + "; must be given all " + std::to_string(count)};

    Picture picture = mergeRows(ordered);
    picture.energy = first.rows.energy;
    if (!first.rows.rays) return picture;
    Rays rays(first.rows.rays->pixels.size());
    rays.worth = first.rows.rays->worth;
    for (const Part* part : ordered)
        rays.add(*part->rows.rays);
    addRays(picture, rays, first.facts.photons);
    return picture;
}

} // namespace lucent::truth

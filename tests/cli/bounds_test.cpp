// Small files that once took minutes or gigabytes.
#include "tests/cli/Program.h"

#include <chrono>

namespace lucent::test {
namespace {

class Bounds : public ProgramTest {
protected:
    // Well above what it takes on a busy machine, well below what it once took.
    static constexpr std::chrono::seconds kSoon{12};

    Outcome runSoon(const std::string& arguments) const {
        const auto start = std::chrono::steady_clock::now();
        const Outcome outcome = run(arguments);
        EXPECT_LT(std::chrono::steady_clock::now() - start, kSoon) << arguments;
        return outcome;
    }
};

// A triangle of 36 bytes.
const std::string kBuffer =
    R"("buffers": [ { "byteLength": 36, "uri": "data:application/octet-stream;base64,)"
    R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" } ],
       "bufferViews": [ { "buffer": 0, "byteLength": 36 } ], )";

std::string gltfOf(const std::string& members) {
    return R"({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [ 0 ] } ], )" + kBuffer +
           members + " }";
}

TEST_F(Bounds, AGltfHasNoMoreUnstoredElementsThanBytes) {
    write("sparse.gltf", gltfOf(R"("nodes": [ { "mesh": 0 } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 } } ] } ],
        "accessors": [ { "componentType": 5126, "type": "VEC3", "count": 16777216 } ])"));
    expectRefusal(
        "convert sparse.gltf -o out.mesh",
        "sparse.gltf: has an accessor of 16777216 elements without data; must have at most 36, as many as "
        "the file has bytes of data");
}

TEST_F(Bounds, AMeshOnManyNodesIsCountedOnEach) {
    std::string nodes = R"({ "children": [ 1)", others;
    for (int i = 2; i <= 1000; ++i)
        nodes += ", " + std::to_string(i);
    for (int i = 1; i <= 1000; ++i)
        others += R"(, { "mesh": 0 })";
    std::string primitives;
    for (int i = 0; i < 6000; ++i) // 18 000 vertices a node
        primitives += std::string(i ? ", " : "") + R"({ "attributes": { "POSITION": 0 } })";
    write("many.gltf", gltfOf(R"("nodes": [ )" + nodes + " ] }" + others +
                              R"( ], "meshes": [ { "primitives": [ )" + primitives + R"( ] } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 } ])"));
    expectRefusal(
        "convert many.gltf -o out.mesh",
        "many.gltf: has more than 16777216 vertices or 100663296 corners of triangles where its nodes put "
        "them; must have fewer");
}

TEST_F(Bounds, ThousandsOfMaterialsMayHaveOneName) {
    std::string materials, primitives;
    for (int i = 0; i < 8000; ++i) {
        materials += std::string(i ? ", " : "") + R"({ "name": "m" })";
        primitives += std::string(i ? ", " : "") + R"({ "attributes": { "POSITION": 0 }, "material": )" +
                      std::to_string(i) + " }";
    }
    write("same.gltf", gltfOf(R"("nodes": [ { "mesh": 0 } ], "materials": [ )" + materials +
                              R"( ], "meshes": [ { "primitives": [ )" + primitives + R"( ] } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 } ])"));
    const Outcome outcome = runSoon("convert same.gltf -o out.mesh");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* name : {"\"m\"", "\"m'\"", "\"m'3\"", "\"m'8000\""})
        EXPECT_NE(outcome.out.find(name), std::string::npos) << name;
}

TEST_F(Bounds, ThousandsOfKeysAreReadOnceEach) {
    std::string keys;
    for (int i = 0; i < 100000; ++i)
        keys += (i ? ", \"k" : "\"k") + std::to_string(i) + "\": 1";
    write("keys.json", "{ \"lucent\": 1, \"objects\": [], \"other\": { " + keys + " } }");
    EXPECT_EQ(runSoon("truth keys.json -o out.pfm").code, 1);
}

TEST_F(Bounds, APolygonHasFewCorners) {
    std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int i = 0; i < 5000; ++i)
        obj += " " + std::to_string(i % 3 + 1);
    write("polygon.obj", obj + "\n");
    expectRefusal("convert polygon.obj -o out.mesh",
                  "polygon.obj:4: f has 5000 corners; must have at most 4096");
}

} // namespace
} // namespace lucent::test

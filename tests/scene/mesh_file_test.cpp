#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

// A triangle on one joint of two nodes, with a morph target, two channels and a material.
Mesh movingMesh() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.joints.assign(3, {0, 0, 0, 0});
    mesh.jointWeights.assign(3, {0.5f, 0.25f, 0.25f, 0});
    Rig& rig = mesh.rig;
    rig.nodes = {{-1, {1, 2, 3}, {0, 1, 0, 0}, {4, 5, 6}}, {0, {}, {1, 0, 0, 0}, vec3(1)}};
    rig.joints = {1};
    rig.jointFromMesh = {mat4(2)};
    rig.targets = {{{{7, 0, 0}, {8, 0, 0}, {9, 0, 0}}, {}}};
    rig.weights = {0.5f};
    Channel turn;
    turn.node = 1;
    turn.path = Channel::Path::Rotation;
    turn.times = {0, 2};
    turn.values = {0, 0, 0, 1, 1, 0, 0, 0};
    Channel weigh;
    weigh.path = Channel::Path::Weights;
    weigh.interpolation = Channel::Interpolation::CubicSpline;
    weigh.times = {1};
    weigh.values = {0, 1, 0};
    rig.channels = {turn, weigh};
    rig.duration = 2;
    Material glass;
    glass.kind = Clear{.transmission = 0.75f, .absorption = {0.1f, 0.2f, 0.3f}};
    mesh.parts = {{"glass", 0, 3, glass}};
    return mesh;
}

// The message for a mesh that was written with something wrong in it.
template <class Change>
std::string messageAfter(Change change) {
    Mesh mesh = movingMesh();
    change(mesh);
    const Result<Mesh> back = decodeMesh(encodeMesh(mesh), "a");
    return back ? "" : back.error().message;
}

TEST(MeshFile, KeepsTheKindOfAMaterial) {
    Mesh mesh = movingMesh();
    Material& material = mesh.parts[0].values;
    const auto back = [&] {
        const Bytes file = encodeMesh(mesh);
        EXPECT_TRUE(isMesh(file));
        const Result<Mesh> read = decodeMesh(file, "a");
        EXPECT_TRUE(read) << read.error().message;
        EXPECT_EQ(encodeMesh(*read), file);
        return read->parts[0].values;
    };
    material.kind = Translucent{.scattering = {1, 2, 3}, .anisotropy = -0.5f, .roughness = 0.125f};
    const Material scattering = back();
    EXPECT_EQ(scattering.translucent().scattering, vec3(1, 2, 3));
    EXPECT_EQ(scattering.translucent().anisotropy, -0.5f);
    EXPECT_EQ(scattering.translucent().roughness, 0.125f);
    material.kind = Mirror{{0.1f, 0.2f, 0.3f}};
    EXPECT_EQ(back().mirror().reflectance, vec3(0.1f, 0.2f, 0.3f));
    material.kind = Matt{};
    EXPECT_EQ(back().kind.index(), material.kind.index());
}

TEST(MeshFile, KeepsEveryBit) {
    const Mesh mesh = movingMesh();
    const Bytes file = encodeMesh(mesh);
    EXPECT_TRUE(isMesh(file));
    const Result<Mesh> back = decodeMesh(file, "a");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(encodeMesh(*back), file);
    EXPECT_EQ(back->positions, mesh.positions);
    EXPECT_EQ(back->indices, mesh.indices);
    EXPECT_EQ(back->normals, mesh.normals);
    EXPECT_EQ(back->joints, mesh.joints);
    EXPECT_EQ(back->jointWeights, mesh.jointWeights);
    EXPECT_EQ(back->rig.nodes[0].rotate, glm::quat(0, 1, 0, 0));
    EXPECT_EQ(back->rig.nodes[1].parent, 0);
    EXPECT_EQ(back->rig.jointFromMesh, mesh.rig.jointFromMesh);
    EXPECT_EQ(back->rig.targets[0].positions, mesh.rig.targets[0].positions);
    EXPECT_EQ(back->rig.channels[1].interpolation, Channel::Interpolation::CubicSpline);
    EXPECT_EQ(back->rig.channels[0].values, mesh.rig.channels[0].values);
    EXPECT_EQ(back->rig.duration, 2);
    EXPECT_EQ(back->parts[0].material, "glass");
    EXPECT_EQ(back->parts[0].values.clear().transmission, 0.75f);
    EXPECT_EQ(back->parts[0].values.clear(), mesh.parts[0].values.clear());
}

TEST(MeshFile, OfTheVersionBeforeIsReadWithoutWhatIsNew) {
    const Mesh mesh = movingMesh();
    const Bytes now = encodeMesh(mesh);
    Bytes before = now;
    const auto drop = [&](std::size_t at, std::size_t bytes) {
        before.erase(before.begin() + std::ptrdiff_t(at), before.begin() + std::ptrdiff_t(at + bytes));
    };
    // From the end: no cameras, no lamps; before the count of pictures the part's cutoff, and, before its
    // scale and its word on colours, which coordinates each of its four textures lies by.
    drop(before.size() - 8, 8);
    drop(before.size() - 4 - 4, 4);
    const std::size_t uses = before.size() - 4 - 5 - 4 * 7;
    for (std::size_t i = 4; i-- > 0;)
        drop(uses + 7 * i + 6, 1);
    const std::size_t lists = 12 * mesh.positions.size() + 4 * mesh.indices.size() +
                              12 * mesh.normals.size() + 8 * mesh.joints.size() +
                              16 * mesh.jointWeights.size();
    drop(8 + lists + 6 * 4, 4); // the count of second coordinates
    before[7] = std::byte('6');
    const Result<Mesh> read = decodeMesh(before, "a");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(encodeMesh(*read), now);
}

TEST(MeshFile, LampsAndCamerasAreKeptAndChecked) {
    Mesh mesh = movingMesh();
    mesh.lights = {{.kind = FileLight::Kind::Spot, .position = {1, 2, 3}, .intensity = 5, .innerAngle = 10}};
    mesh.cameras = {{.perspective = false, .eye = {4, 5, 6}, .height = 2, .aspect = 1.5f}};
    const Result<Mesh> back = decodeMesh(encodeMesh(mesh), "a");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->lights[0].kind, FileLight::Kind::Spot);
    EXPECT_EQ(back->lights[0].position, vec3(1, 2, 3));
    EXPECT_EQ(back->lights[0].innerAngle, 10);
    EXPECT_FALSE(back->cameras[0].perspective);
    EXPECT_EQ(back->cameras[0].height, 2);
    EXPECT_EQ(back->cameras[0].aspect, 1.5f);
    mesh.cameras[0].height = 0;
    EXPECT_TRUE(decodeMesh(encodeMesh(mesh), "a").error().message.starts_with("a: has a camera"));
    mesh.cameras.clear();
    mesh.lights[0].direction = vec3(2);
    EXPECT_TRUE(decodeMesh(encodeMesh(mesh), "a").error().message.starts_with("a: has a lamp"));
}

TEST(MeshFile, ColorsOfVerticesAreKeptAndChecked) {
    Mesh mesh = movingMesh();
    mesh.colors = {vec3(0.25f), vec3(0.5f), vec3(1)};
    mesh.parts[0].textures.vertexColors = true;
    const Result<Mesh> back = decodeMesh(encodeMesh(mesh), "a");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->colors, mesh.colors);
    EXPECT_TRUE(back->parts[0].textures.vertexColors);
    mesh.colors[1].g = -1;
    EXPECT_EQ(decodeMesh(encodeMesh(mesh), "a").error().message,
              "a: colour 1 is negative or not finite; must be 0 or more");
    mesh.colors.pop_back();
    EXPECT_EQ(decodeMesh(encodeMesh(mesh), "a").error().message, "a: has 2 colours; must have 3");
    mesh.colors.clear();
    EXPECT_EQ(decodeMesh(encodeMesh(mesh), "a").error().message,
              "a: part \"glass\" shows colours of vertices that have none; must have them");
}

TEST(MeshFile, CutFilesAreRefused) {
    const Bytes file = encodeMesh(movingMesh());
    for (std::size_t length = 0; length < file.size(); ++length)
        EXPECT_FALSE(decodeMesh(std::span(file).first(length), "a")) << length;
    EXPECT_EQ(decodeMesh(std::span(file).first(7), "a").error().message,
              "a: is no mesh file; must be glTF 2.0, OBJ or start with LUCENTM7");
    // Behind the magic and the count of 3 positions (36 bytes) stand 20 - 12 = 8 bytes.
    EXPECT_EQ(decodeMesh(std::span(file).first(20), "a").error().message,
              "a: the mesh file ends in its positions, of which 8 bytes are there; must have 36");
    Bytes longer = file;
    longer.push_back(std::byte(0));
    EXPECT_EQ(decodeMesh(longer, "a").error().message, "a: 1 bytes follow the mesh; must be none");
}

TEST(MeshFile, CountsAreCheckedBeforeMemoryIsTaken) {
    const Bytes file = encodeMesh(movingMesh());
    for (std::size_t at = 8; at + 4 <= file.size(); ++at) { // a count of 2^32 - 1 wherever one may stand
        Bytes huge = file;
        std::fill_n(huge.begin() + std::ptrdiff_t(at), 4, std::byte(0xff));
        const Result<Mesh> mesh = decodeMesh(huge, "a");
        EXPECT_TRUE(!mesh || mesh->positions.size() == 3) << at;
    }
    Bytes huge = file;
    std::fill_n(huge.begin() + 8, 4, std::byte(0xff)); // 12 * (2^32 - 1)
    EXPECT_EQ(decodeMesh(huge, "a").error().message, "a: the mesh file ends in its positions, of which " +
                                                         std::to_string(file.size() - 12) +
                                                         " bytes are there; must have 51539607540");
}

TEST(MeshFile, WrongTrianglesAreRefused) {
    EXPECT_EQ(messageAfter([](Mesh& m) { m.indices[1] = 3; }),
              "a: index 3 points outside the 3 positions; must be smaller");
    EXPECT_EQ(messageAfter([](Mesh& m) {
                  m.indices = {0, 1};
              }),
              "a: has 2 indices; must be three a triangle, at least one");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.indices.clear(); }),
              "a: has 0 indices; must be three a triangle, at least one");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.positions[2].y = NAN; }), "a: position 2 is not finite; must be");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.normals.pop_back(); }), "a: has 2 normals; must have 3");
    EXPECT_EQ(messageAfter([](Mesh& m) {
                  m.normals[1] = {0, 2, 0};
              }),
              "a: normal 1 has length 2.000000; must be 1");
}

TEST(MeshFile, WrongRigsAreRefused) {
    EXPECT_EQ(messageAfter([](Mesh& m) { m.joints[1][2] = 1; }),
              "a: joint 1 points outside the 1 joints; must be smaller");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.jointWeights.pop_back(); }),
              "a: has 2 weights of joints; must have 3");
    EXPECT_EQ(messageAfter([](Mesh& m) {
                  m.jointWeights[2] = {1, 1, 0, 0};
              }),
              "a: weights of joints 2 are negative or sum to 2.000000; must be 0 or more and sum to 1");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.nodes[0].parent = 0; }),
              "a: node 0 has parent 0; must be a node before it, or -1");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.nodes[1].scale.x = INFINITY; }),
              "a: node 1 is not finite; must be");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.joints[0] = 2; }),
              "a: joint of node 2 points outside the 2 nodes; must be smaller");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.jointFromMesh.clear(); }),
              "a: has 0 matrices of joints; must have 1");
    EXPECT_EQ(
        messageAfter([](Mesh& m) { m.rig.targets[0].positions.pop_back(); }),
        "a: morph target 0: has 2 positions and 0 normals; must have 3 positions, and as many normals or "
        "none");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.weights.clear(); }),
              "a: has 0 weights of morph targets; must have 1");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.duration = -1; }), "a: lasts -1.000000 s; must be 0 or more");
}

TEST(MeshFile, WrongChannelsAreRefused) {
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[0].node = 2; }),
              "a: channel 0: node 2 points outside the 2 nodes; must be smaller");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[1].firstTarget = 1; }),
              "a: channel 1: morph target 1 points outside the 1 morph targets; must be smaller");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[0].path = Channel::Path(4); }),
              "a: channel 0 has path 4 and interpolation 0; must be 0 to 3 and 0 to 2");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[0].times.clear(); }),
              "a: channel 0 has no times; must have at least one");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[0].times[1] = 0; }),
              "a: channel 0: time 1 is not behind the one before; must be");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[0].values.pop_back(); }),
              "a: channel 0 has 7 values at 2 times; must be 8");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[1].values.pop_back(); }),
              "a: channel 1 has 2 values at 1 times; must be a multiple of 3");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.rig.channels[0].values[3] = NAN; }),
              "a: channel 0: value 3 is not finite; must be");
}

TEST(MeshFile, WrongPartsAreRefused) {
    EXPECT_EQ(messageAfter([](Mesh& m) { m.parts[0].indexCount = 6; }),
              "a: its parts end at index 6; must end at 3");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.parts[0].firstIndex = 3; }),
              "a: part \"glass\" begins at index 3 and has 3; must begin at 0 and have three a triangle");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.parts.push_back(m.parts[0]); }),
              "a: part \"glass\" has the name of another or none; must have one of its own");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.parts[0].values.clear().ior = 0; }),
              "a: part \"glass\" has a value that is not finite or an ior of 0 or less; must not");
}

} // namespace
} // namespace lucent::scene

#include "scene/readers/Obj.h"
#include "scene/readers/Readers.h"
#include "tests/base/Png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace lucent::scene {
namespace {

using test::bytesOf;

// The mesh as a scene gets it, or the message in `error`. Material files lie in m/.
Mesh read(const std::string& text, std::string& error, const std::map<std::string, std::string>& files = {}) {
    const ReadFile reader = [&](const std::string& path) -> Result<Bytes> {
        const auto found = files.find(path);
        if (found == files.end()) return Error{path + ": cannot be read (none)"};
        return bytesOf(found->second);
    };
    const Result<Bytes> plain = toPlain("m/a.obj", bytesOf(text), reader);
    const Result<Mesh> mesh = plain ? decodeMesh(*plain, "m/a.obj") : Result<Mesh>(plain.error());
    error = mesh ? "" : mesh.error().message;
    return mesh ? *mesh : Mesh();
}

Mesh sound(const std::string& text, const std::map<std::string, std::string>& files = {}) {
    std::string error;
    Mesh mesh = read(text, error, files);
    EXPECT_EQ(error, "");
    return mesh;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

double areaOf(const Mesh& mesh) {
    double area = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        area += double(glm::cross(mesh.positions[mesh.indices[i + 1]] - mesh.positions[mesh.indices[i]],
                                  mesh.positions[mesh.indices[i + 2]] - mesh.positions[mesh.indices[i]])
                           .z) /
                2;
    return area;
}

TEST(Obj, FacesMayNameTheirCornersInEveryForm) {
    for (const std::string face : {"f 1 2 3 4", "f 1/1 2/1 3/1 4/1", "f -4 -3 -2 -1", "f 1 2 3 \\\n 4",
                                   "  f\t1 2  3 4 # a square\r"}) {
        const Mesh mesh = sound("# square\n" + kSquare + "vt 0 0\n" + face);
        EXPECT_EQ(mesh.positions.size(), 4u) << face;
        EXPECT_EQ(mesh.indices.size(), 6u) << face;
        EXPECT_EQ(areaOf(mesh), 1) << face;
        EXPECT_EQ(mesh.normals[0], vec3(0, 0, 1)) << face;
        EXPECT_TRUE(mesh.parts.empty());
    }
}

TEST(Obj, NormalsOfTheFileAreKeptAndPartVertices) {
    // Both triangles use positions 1 and 3, with other normals: 6 vertices. (0, 3, 4) is made unit.
    const Mesh mesh = sound(kSquare + "vn 0 0 1\nvn 0 3 4\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n");
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.normals[0], vec3(0, 0, 1));
    EXPECT_LT(glm::distance(mesh.normals[3], vec3(0, 0.6f, 0.8f)), 1e-7f);
}

TEST(Obj, FacesWithoutNormalsAreFlatOutsideOfSmoothingGroups) {
    // Two squares at a right angle, along y.
    const std::string roof = kSquare + "v 1 0 -1\nv 1 1 -1\n";
    const Mesh flat = sound(roof + "f 1 2 3 4\nf 2 5 6 3\n");
    ASSERT_EQ(flat.positions.size(), 8u);
    EXPECT_EQ(flat.normals[1], vec3(0, 0, 1));
    EXPECT_EQ(flat.normals[4], vec3(1, 0, 0));
    EXPECT_EQ(sound(roof + "s 1\nf 1 2 3 4\ns off\nf 2 5 6 3\n").positions.size(), 8u);
    const Mesh smooth = sound(roof + "s 1\nf 1 2 3 4\nf 2 5 6 3\n");
    ASSERT_EQ(smooth.positions.size(), 6u);
    EXPECT_GT(std::min(smooth.normals[1].x, smooth.normals[1].z), 0.4f); // of both faces
}

TEST(Obj, HollowPolygonsAreCutWithoutLossOrOverlap) {
    // A square of side 3 with a bite of 1 x 2 from its right side: area 7, and no triangle is turned round.
    const Mesh mesh = sound("v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 2 0\nv 3 2 0\nv 3 3 0\nv 0 3 0\n"
                            "f 1 2 3 4 5 6 7 8\n");
    EXPECT_EQ(mesh.indices.size(), 3 * 6u);
    EXPECT_EQ(areaOf(mesh), 7);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        Mesh one = mesh;
        one.indices.assign(mesh.indices.begin() + std::ptrdiff_t(i),
                           mesh.indices.begin() + std::ptrdiff_t(i + 3));
        EXPECT_GT(areaOf(one), 0);
    }
}

TEST(Obj, GroupsOfOneMaterialBecomeOnePart) {
    const std::string library = "newmtl glass\nKd 0.1 0.2 0.3\nNi 1.33\nd 0.25\nillum 4\n"
                                "newmtl lamp\nKe 3 2 1\nKa 1 1 1\n"
                                "newmtl metal\nKd 1 0.8 0.3\nPm 1\nPr 0.25\n";
    const Mesh mesh =
        sound("mtllib a b.mtl\n" + kSquare +
                  "usemtl glass\nf 1 2 3\ng other\nusemtl lamp\nf 1 3 4\nusemtl glass\nf 4 3 1\n"
                  "usemtl metal\nf 1 2 4\n",
              {{"m/a b.mtl", library}});
    ASSERT_EQ(mesh.parts.size(), 3u);
    EXPECT_EQ(mesh.parts[0].material, "glass");
    EXPECT_EQ(mesh.parts[0].indexCount, 6u);
    EXPECT_EQ(mesh.parts[0].values.diffuse, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(mesh.parts[0].values.clear().transmission, 0.75f);
    EXPECT_EQ(mesh.parts[0].values.clear().ior, 1.33f);
    EXPECT_EQ(mesh.parts[1].firstIndex, 6u);
    EXPECT_EQ(mesh.parts[1].values.base, vec3(3, 2, 1));
    EXPECT_TRUE(std::holds_alternative<Matt>(mesh.parts[1].values.kind));
    const auto* metal = std::get_if<Glossy>(&mesh.parts[2].values.kind);
    ASSERT_TRUE(metal);
    EXPECT_EQ(metal->metallic, 1);
    EXPECT_EQ(metal->roughness, 0.25f);
    EXPECT_EQ(filesNamedIn(bytesOf("mtllib a b.mtl\nmap_Kd .\\c\\d.png\n")),
              (std::vector<std::string>{"a b.mtl", "c/d.png"}));
}

TEST(Obj, PositionsMayHaveColoursBehindThem) {
    const std::string corners = "v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 1\n"; // a colour, nothing, a weight
    const Mesh mesh = sound(corners + "f 1 2 3\n");
    ASSERT_EQ(mesh.colors.size(), 3u);
    EXPECT_EQ(mesh.colors[0], vec3(1, linearFromSrgb(0.5f), 0));
    EXPECT_EQ(mesh.colors[1], vec3(1));
    EXPECT_EQ(mesh.colors[2], vec3(1));
    ASSERT_EQ(mesh.parts.size(), 1u) << "a material whose albedo they are";
    EXPECT_EQ(mesh.parts[0].values.diffuse, vec3(1));
    EXPECT_TRUE(mesh.parts[0].textures.vertexColors);
    EXPECT_TRUE(sound(kSquare + "f 1 2 3\n").colors.empty());
}

TEST(Obj, WhatIsNotReadIsNamedOnce) {
    testing::internal::CaptureStderr();
    sound("mtllib none.mtl\n" + kSquare + "s 1\nusemtl x\nf 1 2 3\nl 1 2\ncurv 0 1 2\nv 1 2 3 0.5\n");
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "warning: m/a.obj: not read: curv, materials (m/none.mtl: cannot be read "
              "(none)), points and lines\n");
}

TEST(Obj, WrongLinesAreNamed) {
    const auto messageOf = [](const std::string& text, const std::map<std::string, std::string>& files = {}) {
        std::string error;
        read(text, error, files);
        return error;
    };
    EXPECT_EQ(messageOf("v 1 2\n"), "m/a.obj:1: v has \"\"; must be a number");
    EXPECT_EQ(messageOf("\n\nv 1 2,5 3\n"), "m/a.obj:3: v has \"2,5\"; must be a number");
    EXPECT_EQ(messageOf(kSquare + "f 1 2 5\n"),
              "m/a.obj:5: f names position \"5\"; must be one of the 4 before it");
    EXPECT_EQ(messageOf(kSquare + "f 1 2 -5\n"),
              "m/a.obj:5: f names position \"-5\"; must be one of the 4 before it");
    EXPECT_EQ(messageOf(kSquare + "f 0 1 2\n"),
              "m/a.obj:5: f names position \"0\"; must be one of the 4 before it");
    EXPECT_EQ(messageOf(kSquare + "f 1//1 2//1 3//1\n"),
              "m/a.obj:5: f names normal \"1\"; must be one of the 0 before it");
    EXPECT_EQ(messageOf(kSquare + "f 1 2\n"), "m/a.obj:5: f has 2 corners; must have three or more");
    EXPECT_EQ(messageOf(kSquare), "m/a.obj: holds no faces; must hold at least one");
    EXPECT_EQ(messageOf("v nan 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"),
              "m/a.obj: position 0 is not finite; must be");
    EXPECT_EQ(messageOf("mtllib b.mtl\n" + kSquare + "f 1 2 3\n", {{"m/b.mtl", "newmtl a\nNi 0\n"}}),
              "m/b.mtl:2: Ni is 0.000000; must be above 0");
    EXPECT_EQ(messageOf("mtllib b.mtl\n" + kSquare + "f 1 2 3\n", {{"m/b.mtl", "newmtl a\nTr 1.5\n"}}),
              "m/b.mtl:2: Tr is 1.500000; must be in [0, 1]");
    EXPECT_EQ(messageOf("mtllib b.mtl\n" + kSquare + "f 1 2 3\n", {{"m/b.mtl", "Kd 1 1 1\n"}}),
              "m/b.mtl:1: a line comes before a material; must follow newmtl");
}

TEST(Obj, WrittenMeshesComeBackToTheBit) {
    Mesh mesh = meshOf(Torus{0.7f, 0.3f}, 12);
    mesh.parts = {{"red", 0, 30, {}}, {"blue", 30, std::uint32_t(mesh.indices.size()) - 30, {}}};
    const Bytes file = encodeObj(mesh);
    std::string error;
    const Mesh back = read(std::string(reinterpret_cast<const char*>(file.data()), file.size()), error);
    ASSERT_EQ(error, "");
    ASSERT_EQ(back.indices.size(), mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) { // vertices come in the order of their use
        EXPECT_EQ(back.positions[back.indices[i]], mesh.positions[mesh.indices[i]]);
        EXPECT_LT(glm::distance(back.normals[back.indices[i]], mesh.normals[mesh.indices[i]]), 2e-7f);
    }
    EXPECT_EQ(back.parts[1].material, "blue");
}

} // namespace
} // namespace lucent::scene

#include "scene/Mesh.h"
#include "scene/readers/Readers.h"
#include "tests/cli/Program.h"

#include <cmath>

namespace lucent {
namespace {

class ConvertMesh : public test::ProgramTest {};

TEST_F(ConvertMesh, WritesTheWholeMeshOrAnObj) {
    // A tetrahedron without its bottom, of two materials: three edges are open.
    write("tent.obj",
          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 4\nf 2 3 4\nusemtl blue\nf 3 1 4\n");
    const test::Outcome plain = run("convert tent.obj -o tent.mesh");
    EXPECT_EQ(plain.code, 0) << plain.err;
    EXPECT_EQ(plain.out, "tent.mesh: 9 vertices, 3 triangles, 3 open edges\n"
                         "part \"red\": 2 triangles\npart \"blue\": 1 triangles\n");
    const Result<Bytes> file = readFile(path("tent.mesh"));
    ASSERT_TRUE(file);
    EXPECT_FALSE(scene::isForeign("tent.mesh", *file)) << "a page reads it without the second module";
    const Result<scene::Mesh> mesh = scene::decodeMesh(*file, "tent.mesh");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->parts.size(), 2u);

    EXPECT_EQ(run("convert tent.mesh -o back.obj").code, 0);
    EXPECT_EQ(run("convert back.obj -o back.mesh").code, 0);
    const Result<scene::Mesh> back = scene::decodeMesh(*readFile(path("back.mesh")), "back.mesh");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->indices, mesh->indices);
    EXPECT_EQ(back->positions, mesh->positions);
}

TEST_F(ConvertMesh, RefusesWhatIsNoMeshAndOptionsOfHeights) {
    write("tent.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expectRefusal("convert tent.obj -o out.mesh --size 3x3",
                  "out.mesh: is a mesh; --normals, --size, --rotate, --margin and --floor-gap make heights");
    write("heights.pfm", Image(2, 2, 1));
    expectRefusal("convert heights.pfm -o out.mesh",
                  "heights.pfm: is no mesh file; must be glTF 2.0, OBJ or start with LUCENTM7");
    write("bad.obj", "v 0 0\n");
    expectRefusal("convert bad.obj -o out.mesh", "bad.obj:1: v has \"\"; must be a number");
}

class ConvertFolder : public test::ProgramTest {};

TEST_F(ConvertFolder, HoldsTheSceneOfASetOfPicturesWithAllItsFiles) {
    write("coin_height.pfm", Image(8, 4, 1));
    write("coin_albedo.png", Image(8, 4, 3));
    const test::Outcome made = run("convert coin_height.pfm coin_albedo.png -o coin");
    EXPECT_EQ(made.code, 0) << made.err;
    for (const char* name : {"coin/coin.json", "coin/coin_height.pfm", "coin/coin_albedo.png"})
        EXPECT_TRUE(readFile(path(name))) << name;
    EXPECT_EQ(run("explain coin/coin.json").code, 0);
}

TEST_F(ConvertFolder, OfPhotographsHoldsWhatTheyTell) {
    // A flat grey plane under four lamps: E = n . l.
    std::string lights = "4\n";
    const float places[][3] = {{1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, 0, 1}};
    for (int k = 0; k < 4; ++k) {
        const auto& at = places[k];
        Image photo(6, 4, 3);
        std::fill(photo.pixels.begin(), photo.pixels.end(), 0.5f * (k < 3 ? std::sqrt(0.5f) : 1));
        write("photo" + std::to_string(k) + ".pfm", photo);
        lights += "/elsewhere/photo" + std::to_string(k) + ".pfm " + std::to_string(at[0]) + " " +
                  std::to_string(at[1]) + " " + std::to_string(at[2]) + "\n";
    }
    write("plane.lp", lights);
    const test::Outcome made = run("convert plane.lp -o plane");
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(made.err.find("plane.lp: residual 0") != std::string::npos) << made.err;
    const Result<Bytes> file = readFile(path("plane/plane_normal.png"));
    ASSERT_TRUE(file);
    const Result<Image> normals = decodeImage(*file, "plane_normal.png", Encoding::Linear);
    ASSERT_TRUE(normals) << normals.error().message;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(normals->at(3, 2)[c], c < 2 ? 0.5f : 1.0f, 1e-3f);
    for (const char* name :
         {"plane/plane.json", "plane/plane_height.pfm", "plane/plane_albedo.png", "plane/plane_residual.png"})
        EXPECT_TRUE(readFile(path(name))) << name;
}

TEST_F(ConvertFolder, RefusesWhatDoesNotSayWhatItIsFor) {
    write("a.pfm", Image(2, 2, 1));
    write("b.pfm", Image(2, 2, 1));
    expectRefusal(
        "convert a.pfm b.pfm -o out",
        "a.pfm: does not say what it is for; its name must end in _height, _normal, _albedo, _alpha or "
        "_specular");
    expectRefusal("convert a.pfm b.pfm -o out.pfm",
                  "out.pfm: is to be made of 2 files; several become a folder");
    expectRefusal("convert a.pfm -o out --normals",
                  "out: is a folder; --normals, --size, --rotate, --margin and --floor-gap make heights");
}

} // namespace
} // namespace lucent

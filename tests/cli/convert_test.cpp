#include "scene/Mesh.h"
#include "scene/readers/Readers.h"
#include "tests/cli/Program.h"

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
                  "heights.pfm: is no mesh file; must be glTF 2.0, OBJ or start with LUCENTM4");
    write("bad.obj", "v 0 0\n");
    expectRefusal("convert bad.obj -o out.mesh", "bad.obj:1: v has \"\"; must be a number");
}

} // namespace
} // namespace lucent

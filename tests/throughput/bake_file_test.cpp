#include "techniques/throughput/BakeFile.h"

#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <cstring>

namespace lucent::throughput {
namespace {

scene::MeshShape ofBall(float radius) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<const scene::Mesh>(scene::meshOf(scene::Sphere{radius}, 12));
    return shape;
}

scene::Object ball() {
    scene::Object object;
    object.name = "ball";
    object.shape = ofBall(0.01f);
    object.material.kind =
        scene::Translucent{.scattering = {2190, 2620, 3000}, .absorption = {2.1f, 4.1f, 7.1f}};
    return object;
}

BakeOptions optionsOf(Local local, Global global) {
    BakeOptions options;
    options.side = 128;
    options.local = local;
    options.factors.method = global;
    return options;
}

struct File {
    BakeKey key;
    Bake bake;
    Bytes bytes;
};
File fileOf(const BakeOptions& options) {
    File file;
    file.key = keyOf(ball(), options, DipoleGeometry::Planar);
    Result<Bake> baked = bake(ball(), options, DipoleGeometry::Planar);
    EXPECT_TRUE(baked) << baked.error().message;
    file.bake = std::move(*baked);
    file.bytes = encodeBake(file.key, file.bake);
    return file;
}

std::string refusal(const Bytes& bytes, const BakeKey& key) {
    const Result<Bake> read = decodeBake(bytes, "ball.bake", key);
    EXPECT_FALSE(read);
    return read ? "" : read.error().message;
}

TEST(BakeFile, ReadsBackToTheSameLight) {
    for (const Local local : {Local::Live, Local::Stored})
        for (const Global global : {Global::Dense, Global::Sparse, Global::Hierarchical}) {
            const File file = fileOf(optionsOf(local, global));
            const Result<Bake> read = decodeBake(file.bytes, "ball.bake", file.key);
            ASSERT_TRUE(read) << read.error().message;
            std::vector<vec3> light;
            for (std::size_t i = 0; i < file.bake.surface.texels.list.size(); ++i)
                light.emplace_back(float(i % 7));
            const Lit before = file.bake.relight(light), after = read->relight(light);
            EXPECT_EQ(before.local, after.local);
            EXPECT_EQ(before.global, after.global);
            EXPECT_EQ(encodeBake(file.key, *read), file.bytes);
        }
}

TEST(BakeFile, RefusesAnotherMeshMaterialOrSettings) {
    const BakeOptions options = optionsOf(Local::Live, Global::Sparse);
    const File file = fileOf(options);
    scene::Object other = ball();
    other.shape = ofBall(0.011f);
    const std::string mesh = refusal(file.bytes, keyOf(other, options, DipoleGeometry::Planar));
    EXPECT_TRUE(mesh.starts_with("ball.bake: is baked of another mesh, ")) << mesh;
    EXPECT_TRUE(mesh.ends_with(": bake again")) << mesh;
    other = ball();
    other.transform.scale = 2;
    EXPECT_TRUE(refusal(file.bytes, keyOf(other, options, DipoleGeometry::Planar))
                    .starts_with("ball.bake: is baked of another mesh, "));
    other = ball();
    other.material.translucent().absorption.r *= 2;
    EXPECT_EQ(refusal(file.bytes, keyOf(other, options, DipoleGeometry::Planar)),
              "ball.bake: is baked of another material; must be of the object's: bake again");
    EXPECT_EQ(
        refusal(file.bytes, keyOf(ball(), optionsOf(Local::Live, Global::Dense), DipoleGeometry::Planar)),
        "ball.bake: is baked with other settings; must be with the scene's: bake again");
}

TEST(BakeFile, RefusesWhatIsNoBakeOrAnEarlierOne) {
    File file = fileOf(optionsOf(Local::Live, Global::Sparse));
    EXPECT_EQ(refusal({}, file.key), "ball.bake: is no bake; must be a file of lucent bake throughput");
    Bytes earlier = file.bytes;
    earlier[8] = std::byte(0);
    EXPECT_EQ(refusal(earlier, file.key),
              "ball.bake: is a bake of version 0; must be of version 2: bake again");
    Bytes longer = file.bytes;
    longer.push_back(std::byte(0));
    EXPECT_EQ(refusal(longer, file.key), "ball.bake: has 1 bytes behind its bake; must end there");
}

TEST(BakeFile, RefusesTruncatedFilesWhereverTheyEnd) {
    const File file = fileOf(optionsOf(Local::Stored, Global::Hierarchical));
    for (std::size_t part = 1; part < 40; ++part) {
        const Bytes cut(file.bytes.begin(),
                        file.bytes.begin() + std::ptrdiff_t(file.bytes.size() * part / 40));
        const std::string message = refusal(cut, file.key);
        EXPECT_TRUE(message.starts_with("ball.bake: the bake ends in its ")) << message;
    }
}

TEST(BakeFile, RefusesIndicesThatLeadNowhere) {
    File file = fileOf(optionsOf(Local::Live, Global::Sparse));
    file.bake.factors.close.columns[3] = 1u << 30;
    EXPECT_EQ(refusal(encodeBake(file.key, file.bake), file.key),
              "ball.bake: holds numbers that no bake has; must be baked again");
    file = fileOf(optionsOf(Local::Live, Global::Sparse));
    file.bake.surface.texels.list[5].place.triangle = 1u << 30;
    EXPECT_EQ(refusal(encodeBake(file.key, file.bake), file.key),
              "ball.bake: holds numbers that no bake has; must be baked again");
}

} // namespace
} // namespace lucent::throughput

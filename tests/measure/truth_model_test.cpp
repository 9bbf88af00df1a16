#include "measure/TruthModel.h"

#include "tests/truth/scenes.h"

namespace lucent::measure {
namespace {
using test::glass;
using test::matt;
using test::mirror;
using test::sceneOf;

scene::Object field() { return matt(scene::HeightField{}); }

TEST(UsualTruth, IsTheReliefsOwnWhereNothingElseIs) {
    EXPECT_EQ(usualTruth(sceneOf({field()})), TruthModel::Relief);
    EXPECT_EQ(usualTruth(sceneOf({field(), field()})), TruthModel::Glass); // they shadow each other
    scene::Scene spot = sceneOf({field()});
    spot.lights = {scene::SpotLight{}};
    EXPECT_EQ(usualTruth(spot), TruthModel::Glass);
    EXPECT_EQ(usualTruth(sceneOf({field(), matt(scene::Sphere{})})), TruthModel::Glass);
}

TEST(UsualTruth, OfGlassBesideMattThingsIsGlassUntilALampShinesThroughIt) {
    scene::Scene scene = sceneOf({glass(scene::Sphere{}, 1.5f), matt(scene::Plane{})});
    test::addSky(scene, vec3(1));
    EXPECT_EQ(usualTruth(scene), TruthModel::Glass);
    scene.lights.emplace_back();
    EXPECT_EQ(usualTruth(scene), TruthModel::Light);
    scene.view.show = scene::Aov::Direction; // which no lamp changes
    EXPECT_EQ(usualTruth(scene), TruthModel::Glass);
    scene.objects[0] = mirror(scene::Sphere{});
    EXPECT_EQ(usualTruth(scene), TruthModel::Glass);
    scene.view.show = scene::Aov::Irradiance;
    EXPECT_EQ(usualTruth(scene), TruthModel::Light);
}

TEST(UsualTruth, OfLightInsideIsTheDipole) {
    scene::Scene scene = sceneOf({matt(scene::Sphere{})});
    scene.objects[0].material.kind = scene::Translucent{};
    EXPECT_EQ(usualTruth(scene), TruthModel::Dipole);
    scene.view.show = scene::Aov::Depth;
    EXPECT_EQ(usualTruth(scene), TruthModel::Glass);
    scene.view.show = scene::Aov::Radiosity;
    EXPECT_EQ(usualTruth(scene), TruthModel::Dipole);
}

} // namespace
} // namespace lucent::measure

#include "techniques/brdf/bench/Bench.h"

#include "scene/Environment.h"
#include "scene/Keys.h"
#include "technique/Technique.h"
#include "techniques/brdf/Reflector.h"

#include <algorithm>
#include <cmath>

namespace lucent::brdf {

namespace {

using namespace measure;

// --- error over the directions of a lobe

scene::Scene ballUnderSky(float roughness, int size) {
    scene::Scene scene;
    scene.size = ivec2(size);
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0, 0.6f, 3};
    scene.camera.fov = 45;
    scene.environment.emplace();
    scene.environment->source = "sky";
    scene.environment->map = std::make_shared<const Image>(scene::proceduralEnvironment("sky"));
    technique::addSettings(scene);
    scene::Object& ball = scene.objects.emplace_back();
    ball.name = "ball";
    ball.shape = scene::Sphere{1};
    ball.material.diffuse = {0.9f, 0.6f, 0.3f};
    ball.material.kind = scene::Glossy{.metallic = 1, .roughness = roughness};
    return scene;
}

std::vector<Setting> directionSettings() {
    std::vector<Setting> settings;
    for (const char* directions : {"1", "4", "16", "64", "256"})
        settings.push_back({"lobe", {{"lobeDirections", directions}}});
    return settings;
}

Status addLobes(Plan& plan, const BenchAssets&) {
    const int size = plan.quick ? 64 : 128;
    for (const float roughness : {0.1f, 0.25f, 0.5f}) {
        const scene::Scene scene = ballUnderSky(roughness, size);
        plan.cases.push_back(
            {.technique = "brdf",
             .name = "metal, roughness " + std::to_string(roughness).substr(0, 4),
             .scene = {[scene]() -> Result<scene::Scene> { return scene; }, double(size) * size * 256},
             .settings = directionSettings(),
             .toPhysics = {}});
    }
    return Done{};
}

// --- laws

struct Model {
    const char* name;
    scene::MaterialKinds kind;
    std::optional<double> most; // of what the furnace may show; nothing: gives more than it gets, as is known
};

const Model kModels[] = {
    {"lambert", scene::OrenNayar{.roughness = 0}, 1.0},
    {"glossy, metal", scene::Glossy{.metallic = 1, .roughness = 0.4f}, 1.0},
    {"glossy, white", scene::Glossy{.roughness = 0.4f}, {}},
    {"phong", scene::Phong{.specular = vec3(0.3f), .exponent = 32}, 1.0},
    {"phong as printed", scene::Phong{.specular = vec3(0.3f), .exponent = 32, .asPrinted = true}, {}},
    {"blinn", scene::Blinn{.specular = vec3(0.3f), .exponent = 128}, 1.0},
    {"blinn as printed", scene::Blinn{.specular = vec3(0.3f), .exponent = 128, .asPrinted = true}, {}},
    {"cook-torrance", scene::CookTorrance{.roughness = 0.5f}, 1.0},
    {"cook-torrance as printed", scene::CookTorrance{.roughness = 0.5f, .asPrinted = true}, {}},
    {"oren-nayar", scene::OrenNayar{.roughness = 0.6f}, 1.0},
};

// As white as the model may be without giving more than it gets from straight above.
scene::Material whiteOf(const Model& model) {
    scene::Material material;
    material.kind = model.kind;
    const bool addsLobe =
        std::holds_alternative<scene::Phong>(model.kind) || std::holds_alternative<scene::Blinn>(model.kind);
    material.diffuse = vec3(addsLobe                                                  ? 0.7f
                            : std::holds_alternative<scene::CookTorrance>(model.kind) ? 0.0f
                                                                                      : 1.0f);
    return material;
}

void addLaws(Proof& proof) {
    for (const Model& model : kModels) {
        const scene::Material material = whiteOf(model);
        double most = 0;
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 88.0})
            most =
                std::max(most, double(directionalAlbedo(material, float(std::cos(degrees * kPi / 180))).y));
        // 0.5 %: what 4096 directions say
        const std::optional<double> target = model.most ? std::optional(1.005 * *model.most) : std::nullopt;
        proof.ratios.push_back({std::string(model.name) + ": most of a white furnace's light that is seen",
                                most, target, false});
        proof.ratios.push_back({std::string(model.name) + ": reciprocity error",
                                double(reciprocityError(material)), 1e-4, false});
    }
}

// --- tables

void addTables(Proof& proof, bool quick) {
    constexpr int kPairs = 4096;
    scene::Material material;
    material.diffuse = vec3(0.3f);
    material.kind = scene::CookTorrance{.specular = vec3(0.8f), .roughness = 0.6f, .ior = 2};
    const auto add = [&](const std::string& form, double error) {
        proof.ratios.push_back(
            {"table of cook-torrance, " + form + ": error over the mean", error, {}, false});
    };
    for (const int side : {8, 16, 32, 64}) {
        if (quick && side > 32) continue;
        const std::string size = std::to_string(side) + " x " + std::to_string(side) + " blocks";
        add("projected, " + size, tableError(material, scene::TableForm::Projected, side, side, kPairs));
        add("equal-area, " + size, tableError(material, scene::TableForm::EqualArea, side, side, kPairs));
    }
    add("merl", tableError(material, scene::TableForm::Merl, 1, 1, kPairs));
}

constexpr BenchPart kParts[] = {
    {.name = "brdf",
     .help = "glossy lobes: error over directions, furnace, reciprocity and tables",
     .plan = addLobes,
     .prove = proveModels},
};

} // namespace

Result<Proof> proveModels(const BenchRun& run) {
    Proof proof;
    addLaws(proof);
    addTables(proof, run.quick);
    for (const Ratio& ratio : proof.ratios) {
        char line[160];
        std::snprintf(line, sizeof line, "%-64s %.4g\n", ratio.name.c_str(), ratio.value);
        proof.text += line;
    }
    return proof;
}

extern const TechniqueBench kBench;
const TechniqueBench kBench{kParts};

} // namespace lucent::brdf

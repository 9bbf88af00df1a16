#include "scene/readers/GltfMaterial.h"

#include "scene/Keys.h"
#include "scene/Mesh.h"

#include <algorithm>
#include <optional>

namespace lucent::scene {
namespace {

constexpr std::string_view kTransmission = "KHR_materials_transmission", kIor = "KHR_materials_ior",
                           kVolume = "KHR_materials_volume", kDispersion = "KHR_materials_dispersion",
                           kStrength = "KHR_materials_emissive_strength",
                           kScatter = "KHR_materials_volume_scatter",
                           kDiffuse = "KHR_materials_diffuse_transmission",
                           kSpecular = "KHR_materials_specular";
constexpr std::string_view kKnown[] = {kTransmission,
                                       kIor,
                                       kVolume,
                                       kDispersion,
                                       kStrength,
                                       kScatter,
                                       kDiffuse,
                                       kSpecular,
                                       "KHR_lights_punctual",
                                       "KHR_mesh_quantization",
                                       "KHR_texture_transform"};

vec3 rgb(const std::vector<double>& values, vec3 otherwise) {
    return values.size() < 3 ? otherwise : vec3(values[0], values[1], values[2]);
}

// Albedo of one collision from that of a half space, by the fit that the extension prescribes.
dvec3 singleAlbedo(const dvec3& whole, double anisotropy) {
    const dvec3 s =
        4.09712 + 4.20863 * whole - glm::sqrt(9.59217 + 41.6808 * whole + 17.7126 * whole * whole);
    return glm::clamp((1.0 - s * s) / (1.0 - anisotropy * s * s), 0.0, 1.0); // the fit passes 0 by 1e-5
}

class MaterialReader {
public:
    MaterialReader(const tinygltf::Material& gltf, std::set<std::string>& unread)
        : gltf_(gltf), unread_(unread) {}

    Material read() {
        const tinygltf::PbrMetallicRoughness& pbr = gltf_.pbrMetallicRoughness;
        const vec3 color = rgb(pbr.baseColorFactor, vec3(1));
        Material m;
        m.diffuse = color;
        m.kind = kindOf(color);
        readEmission(m);
        nameWhen(!showsTextures(m) && hasTextures(gltf_),
                 "textures of what is clear, translucent or a mirror");
        nameWhen(!m.isScattering() && number(kDiffuse, "diffuseTransmissionFactor", 0) > 0,
                 "diffuseTransmissionFactor");
        if (m.isScattering()) nameWhen(color != vec3(1), "baseColorFactor of what light is scattered in");
        if (m.isRefractive()) nameWhen(color != vec3(1), "baseColorFactor of what light passes through");
        nameWhen(gltf_.occlusionTexture.index >= 0, "occlusionTexture (occlusion is computed)");
        nameWhen(property(kSpecular, "specularTexture"), "specularTexture");
        nameWhen(property(kSpecular, "specularColorTexture"), "specularColorTexture");
        nameWhen(property(kTransmission, "transmissionTexture"), "transmissionTexture");
        nameWhen(property(kScatter, "multiscatterColorTexture"), "multiscatterColorTexture");
        const bool showsAlpha =
            showsTextures(m) && (gltf_.alphaMode == "BLEND" || pbr.baseColorTexture.index >= 0);
        nameWhen(gltf_.alphaMode != "OPAQUE" && !showsAlpha, "alphaMode " + gltf_.alphaMode);
        return m;
    }

private:
    MaterialKinds kindOf(vec3 color) {
        const tinygltf::PbrMetallicRoughness& pbr = gltf_.pbrMetallicRoughness;
        const float ior = number(kIor, "ior", 1.5f);
        if (ior == 0) return Mirror{vec3(1)}; // reflects everything: nothing gets inside
        if (pbr.metallicFactor == 1 && pbr.roughnessFactor == 0 && !hasTextures(gltf_)) {
            if (color == vec3(0)) return Matt{};
            return Mirror{color};
        }
        if (const std::optional<Translucent> inside = readScattering(ior)) return *inside;
        const float transmission =
            number(kTransmission, "transmissionFactor", 0) * float(1 - pbr.metallicFactor);
        if (transmission > 0) {
            nameWhen(pbr.roughnessFactor > 0, "roughnessFactor of what light passes through");
            nameWhen(pbr.metallicFactor > 0, "metallicFactor of what light passes through");
            return readVolume(transmission, ior);
        }
        return isGlossy() ? readGloss(ior) : MaterialKinds(Matt{});
    }

    // What mirrors more than the rough surface of something that is no metal, which few files mean.
    bool isGlossy() const {
        const tinygltf::PbrMetallicRoughness& pbr = gltf_.pbrMetallicRoughness;
        return pbr.metallicRoughnessTexture.index >= 0 || pbr.roughnessFactor < 1 ||
               (pbr.metallicFactor > 0 && !saysNothing());
    }

    MaterialKinds readGloss(float ior) {
        const tinygltf::PbrMetallicRoughness& pbr = gltf_.pbrMetallicRoughness;
        nameWhen(number(kSpecular, "specularFactor", 1) != 1, "specularFactor where the view grazes");
        return Glossy{.metallic = float(pbr.metallicFactor),
                      .roughness = float(pbr.roughnessFactor),
                      .ior = ior,
                      .specular = number(kSpecular, "specularFactor", 1) *
                                  color(kSpecular, "specularColorFactor", vec3(1))};
    }

    void nameWhen(bool found, const std::string& property) {
        if (found) unread_.insert(property);
    }

    // A file without a word about its surface gets glTF's defaults, a rough metal.
    bool saysNothing() const {
        return gltf_.pbrMetallicRoughness.metallicFactor == 1 &&
               gltf_.pbrMetallicRoughness.roughnessFactor == 1 && gltf_.extensions.empty();
    }

    const tinygltf::Value* property(std::string_view extension, const char* key) const {
        const auto found = gltf_.extensions.find(std::string(extension));
        return found != gltf_.extensions.end() && found->second.Has(key) ? &found->second.Get(key) : nullptr;
    }

    float number(std::string_view extension, const char* key, float otherwise) const {
        const tinygltf::Value* value = property(extension, key);
        return value && value->IsNumber() ? float(value->GetNumberAsDouble()) : otherwise;
    }

    vec3 color(std::string_view extension, const char* key, vec3 otherwise) const {
        const tinygltf::Value* value = property(extension, key);
        for (std::size_t c = 0; value && c < std::min<std::size_t>(value->ArrayLen(), 3); ++c)
            otherwise[int(c)] = float(value->Get(int(c)).GetNumberAsDouble());
        return otherwise;
    }

    void readEmission(Material& m) {
        m.base = rgb(gltf_.emissiveFactor, vec3(0)) * number(kStrength, "emissiveStrength", 1);
    }

    // The thickness itself, and its texture, are of use to rasterisers alone: here light takes its true way.
    Clear readVolume(float transmission, float ior) {
        if (!isVolume()) {
            unread_.insert("the reflection of thin walls (KHR_materials_volume.thicknessFactor 0)");
            return {.transmission = transmission, .ior = 1};
        }
        const Attenuation attenuation = readAttenuation();
        return {.transmission = transmission,
                .ior = ior,
                .absorption = absorptionOf(attenuation),
                .dispersion = number(kDispersion, "dispersion", 0),
                .attenuationDistance = attenuation.distance};
    }

    bool isVolume() const { return number(kVolume, "thicknessFactor", 0) > 0; }

    Attenuation readAttenuation() const { // a distance that is not said is infinite, our 0
        return {number(kVolume, "attenuationDistance", 0), color(kVolume, "attenuationColor", vec3(1))};
    }

    std::optional<Translucent> readScattering(float ior) {
        const vec3 seen = color(kScatter, "multiscatterColor", vec3(0));
        if (seen == vec3(0)) return {};
        const dvec3 extinction(absorptionOf(readAttenuation()));
        if (!isVolume() || extinction == dvec3(0)) {
            unread_.insert("multiscatterColor without a volume that attenuates light");
            return {};
        }
        const float anisotropy = number(kScatter, "scatterAnisotropy", 0);
        const dvec3 albedo = singleAlbedo(dvec3(seen), double(anisotropy));
        return Translucent{.scattering = vec3(albedo * extinction),
                           .absorption = vec3((1.0 - albedo) * extinction),
                           .ior = ior,
                           .anisotropy = anisotropy,
                           .roughness = float(gltf_.pbrMetallicRoughness.roughnessFactor)};
    }

    const tinygltf::Material& gltf_;
    std::set<std::string>& unread_;
};

} // namespace

bool hasTextures(const tinygltf::Material& material) {
    const auto& pbr = material.pbrMetallicRoughness;
    return pbr.baseColorTexture.index >= 0 || pbr.metallicRoughnessTexture.index >= 0 ||
           material.normalTexture.index >= 0 || material.emissiveTexture.index >= 0;
}

std::span<const std::string_view> knownGltfExtensions() { return kKnown; }

Material materialOf(const tinygltf::Material& gltf, std::set<std::string>& unread) {
    return MaterialReader(gltf, unread).read();
}

} // namespace lucent::scene

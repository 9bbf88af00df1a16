#pragma once
/// What a glTF material says in our words.

#include "scene/Scene.h"
#include "scene/readers/TinyGltf.h"

#include <set>
#include <string>

namespace lucent::scene {

/// Names of extensions that readers understand wholly or in part.
std::span<const std::string_view> knownGltfExtensions();

/// Whether it has one of the textures that are read: base colour, metallic-roughness, normal, emission.
bool hasTextures(const tinygltf::Material& material);

/// Base colour, metal and roughness, emission and the KHR extensions for transmission, ior, volume,
/// dispersion, emissive strength, specular, and the draft of volume scatter (2025). Its textures are
/// GltfTextures'.
///
/// - Only what is not metal lets light through: the transmission is transmissionFactor (1 - metallicFactor).
/// - An `ior` of 0 stands for an infinite one, whose Fresnel reflectance is 1 at every angle: a mirror.
/// - A smooth metal (metallicFactor 1, roughnessFactor 0) is a mirror of its colour; that a metal grows paler
///   towards grazing angles is left out.
/// - A transmissive material with thicknessFactor 0 is thin-walled: glTF lets light pass unbent, without way
///   through a medium. It becomes a medium of ior 1 without absorption; its reflection is left out and named
///   on stderr.
/// - A volume with a thickness above 0, an attenuation and a multiscatterColor above 0 has subsurface
/// scattering. Its
///   attenuation is extinction then, and each channel's albedo of one collision that which gives a half space
///   the albedo of the color (Kulla, Conty 2017, by s² = (1 - albedo) / (1 - g albedo) for any anisotropy).
///   By which extension light enters makes no difference.
/// - A rough surface (roughnessFactor 1) of no metal, or of which the file says nothing, is matt.
///
/// @param unread  takes the names of properties that were found and not read
Material materialOf(const tinygltf::Material& gltf, std::set<std::string>& unread);

} // namespace lucent::scene

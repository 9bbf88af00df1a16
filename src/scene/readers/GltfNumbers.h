#pragma once
/// Numbers out of the buffers of a glTF file.

#include "base/Result.h"
#include "scene/readers/TinyGltf.h"

#include <string>
#include <vector>

namespace lucent::scene {

/// All numbers of an accessor behind each other: sparse ones put in their places, normalised ones scaled
/// (glTF 2.0, 3.6.2). Matrices column by column.
///
/// @param type  TINYGLTF_TYPE_*, which the accessor must have
/// @param what  in words, for messages: "positions"
/// @return      Error "NAME: has WHAT ...; must ..."
Result<std::vector<double>> readNumbers(const tinygltf::Model& model, int accessor, int type,
                                        const std::string& what, const std::string& name);

/// The same for whole numbers of an unsigned type.
Result<std::vector<std::uint32_t>> readIndices(const tinygltf::Model& model, int accessor, int type,
                                               const std::string& what, const std::string& name);

} // namespace lucent::scene

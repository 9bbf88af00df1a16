#pragma once
/// tinygltf as we use it: no exceptions, no disk, no pictures.

#include <fstream> // tinygltf names its types even where it opens no files

#define TINYGLTF_NOEXCEPTION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <cstddef>
#include <vector>

namespace lucent::scene {

/// Element of a list that a file points into; null when it points outside.
template <class T>
const T* element(const std::vector<T>& list, int index) {
    return index >= 0 && std::size_t(index) < list.size() ? &list[std::size_t(index)] : nullptr;
}

} // namespace lucent::scene

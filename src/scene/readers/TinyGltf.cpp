#define TINYGLTF_IMPLEMENTATION
#include "scene/readers/TinyGltf.h"

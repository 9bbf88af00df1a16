#pragma once
/// What the surface of an object depends on: while it stays, its images in a view do.

#include "scene/Scene.h"

#include <memory>
#include <vector>

namespace lucent::views {

struct ObjectKey {
    std::shared_ptr<const void> shape, mask;
    std::vector<float> numbers;
    mat4 worldFromObject;
    bool visible;
    bool operator==(const ObjectKey&) const = default;
};

/// @param time  s; of account where the object moves. Water moves by itself: see Waters::changes()
ObjectKey objectKey(const scene::Object& object, float time);

} // namespace lucent::views

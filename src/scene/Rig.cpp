#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {
namespace {

/// The two keys around a time, and how far it is from one to the other.
struct Span {
    std::size_t from = 0, to = 0;
    float part = 0;    ///< [0,1)
    float seconds = 0; ///< between the keys
};

// Before the first key and behind the last one the value stands still (glTF 2.0, 3.11).
Span spanAt(const std::vector<float>& times, float time) {
    const auto after = std::size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (after == 0) return {};
    if (after == times.size()) return {after - 1, after - 1, 0, 0};
    const float seconds = times[after] - times[after - 1];
    return {after - 1, after, (time - times[after - 1]) / seconds, seconds};
}

// A channel's numbers at one time, `width` of them; see glTF 2.0, appendix C.
class Sampler {
public:
    Sampler(const Channel& channel, float time)
        : channel_(channel), width_(channel.width()), span_(spanAt(channel.times, time)) {}

    std::size_t width() const { return width_; }

    float number(std::size_t i) const {
        if (channel_.interpolation == Channel::Interpolation::Step) return key(span_.from, i);
        if (channel_.interpolation == Channel::Interpolation::Linear)
            return glm::mix(key(span_.from, i), key(span_.to, i), span_.part);
        const float t = span_.part, t2 = t * t, t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * key(span_.from, i) +
               span_.seconds * (t3 - 2 * t2 + t) * tangent(span_.from, 2, i) +
               (3 * t2 - 2 * t3) * key(span_.to, i) + span_.seconds * (t3 - t2) * tangent(span_.to, 0, i);
    }

    vec3 vector() const { return {number(0), number(1), number(2)}; }

    glm::quat rotation() const {
        if (channel_.interpolation != Channel::Interpolation::Linear)
            return unit({number(3), number(0), number(1), number(2)});
        return glm::slerp(rotationKey(span_.from), rotationKey(span_.to), span_.part); // the shorter way
    }

private:
    bool isCubic() const { return channel_.interpolation == Channel::Interpolation::CubicSpline; }
    // Of a cubic spline's three: 0 the tangent in, 1 the value, 2 the tangent out.
    float tangent(std::size_t key, std::size_t which, std::size_t i) const {
        return channel_.values[(3 * key + which) * width_ + i];
    }
    float key(std::size_t k, std::size_t i) const {
        return isCubic() ? tangent(k, 1, i) : channel_.values[k * width_ + i];
    }
    glm::quat rotationKey(std::size_t k) const { return unit({key(k, 3), key(k, 0), key(k, 1), key(k, 2)}); }
    static glm::quat unit(const glm::quat& q) {
        const float length = glm::length(q);
        return length > 0 ? q / length : glm::quat(1, 0, 0, 0);
    }

    const Channel& channel_;
    std::size_t width_;
    Span span_;
};

mat4 parentFromNode(const Node& node) {
    return glm::scale(glm::translate(mat4(1), node.translate) * glm::mat4_cast(node.rotate), node.scale);
}

// Normals go by the inverse transpose; this multiple of it exists for flat matrices as well.
mat3 normalFromMatrix(const mat3& m) {
    const mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

} // namespace

std::size_t Channel::width() const {
    if (path == Path::Rotation) return 4;
    if (path != Path::Weights) return 3;
    return values.size() / times.size() / (interpolation == Interpolation::CubicSpline ? 3 : 1);
}

Pose poseAt(const Rig& rig, float time) {
    if (rig.duration > 0) time -= rig.duration * std::floor(time / rig.duration);
    std::vector<Node> nodes = rig.nodes;
    Pose pose{{}, rig.weights};
    for (const Channel& channel : rig.channels) {
        const Sampler sampler(channel, time);
        switch (channel.path) {
        case Channel::Path::Translation:
            nodes[std::size_t(channel.node)].translate = sampler.vector();
            break;
        case Channel::Path::Rotation:
            nodes[std::size_t(channel.node)].rotate = sampler.rotation();
            break;
        case Channel::Path::Scale:
            nodes[std::size_t(channel.node)].scale = sampler.vector();
            break;
        case Channel::Path::Weights:
            for (std::size_t i = 0; i < sampler.width(); ++i)
                pose.weights[std::size_t(channel.firstTarget) + i] = sampler.number(i);
            break;
        }
    }
    std::vector<mat4> rootFromNode;
    for (const Node& node : nodes)
        rootFromNode.push_back(node.parent < 0
                                   ? parentFromNode(node)
                                   : rootFromNode[std::size_t(node.parent)] * parentFromNode(node));
    for (std::size_t i = 0; i < rig.joints.size(); ++i)
        pose.joints.push_back(rootFromNode[std::size_t(rig.joints[i])] * rig.jointFromMesh[i]);
    return pose;
}

Mesh posed(const Mesh& mesh, const Pose& pose) {
    Mesh out{.positions = mesh.positions,
             .indices = mesh.indices,
             .normals = mesh.normals,
             .coordinates = mesh.coordinates,
             .secondCoordinates = mesh.secondCoordinates,
             .colors = mesh.colors,
             .parts = mesh.parts,
             .images = mesh.images};
    for (std::size_t t = 0; t < pose.weights.size(); ++t) {
        const MorphTarget& target = mesh.rig.targets[t];
        for (std::size_t i = 0; i < out.positions.size(); ++i)
            out.positions[i] += pose.weights[t] * target.positions[i];
        for (std::size_t i = 0; i < std::min(out.normals.size(), target.normals.size()); ++i)
            out.normals[i] += pose.weights[t] * target.normals[i];
    }
    for (std::size_t i = 0; i < mesh.joints.size(); ++i) {
        mat4 moved(0);
        for (int j = 0; j < 4; ++j)
            moved += mesh.jointWeights[i][j] * pose.joints[mesh.joints[i][std::size_t(j)]];
        out.positions[i] = vec3(moved * vec4(out.positions[i], 1));
        if (!out.normals.empty()) out.normals[i] = normalFromMatrix(mat3(moved)) * out.normals[i];
    }
    for (std::size_t i = 0; i < out.normals.size(); ++i) {
        const float length = glm::length(out.normals[i]);
        out.normals[i] = length > 0 ? out.normals[i] / length : mesh.normals[i];
    }
    return out;
}

std::vector<vec3> areaWeightedNormals(std::span<const vec3> positions,
                                      std::span<const std::uint32_t> indices) {
    std::vector<dvec3> sums(positions.size(), dvec3(0)); // double: sides of 1e-10 m have areas all the same
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const dvec3 a(positions[indices[i]]), b(positions[indices[i + 1]]), c(positions[indices[i + 2]]);
        const dvec3 twiceArea = glm::cross(b - a, c - a);
        for (std::size_t corner = i; corner < i + 3; ++corner)
            sums[indices[corner]] += twiceArea;
    }
    std::vector<vec3> normals;
    normals.reserve(sums.size());
    for (const dvec3& sum : sums) {
        const double length = glm::length(sum);
        normals.push_back(length > 0 ? vec3(sum / length) : vec3(0, 1, 0));
    }
    return normals;
}

} // namespace lucent::scene

#include "scene/readers/GltfNumbers.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace lucent::scene {
namespace {

// A number in the file must not eat memory: of elements that it does not store it may have as many as bytes
// that it does. What uses those, displacements of stored vertices for instance, has some of each.
std::size_t mostUnstored(const tinygltf::Model& model) {
    std::size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : model.buffers)
        bytes += buffer.data.size();
    return bytes;
}

// `count` elements of a buffer view, each `stride` bytes apart.
struct View {
    const unsigned char* data = nullptr;
    std::size_t stride = 0;
    const unsigned char* at(std::size_t i) const { return data + i * stride; }
};

// One number of a component type, scaled when it is normalised (glTF 2.0, 3.6.2.2).
double readComponent(const unsigned char* data, int type, bool normalized) {
    const auto read = [&]<class T>(T value) {
        std::memcpy(&value, data, sizeof value);
        return normalized ? std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0)
                          : double(value);
    };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return read(std::int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return read(std::uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return read(std::int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return read(std::uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return read(std::uint32_t());
    default:
        break;
    }
    float value;
    std::memcpy(&value, data, sizeof value);
    return value;
}

std::string spelling(int type) {
    switch (type) {
    case TINYGLTF_TYPE_SCALAR:
        return "SCALAR";
    case TINYGLTF_TYPE_VEC2:
        return "VEC2";
    case TINYGLTF_TYPE_VEC3:
        return "VEC3";
    case TINYGLTF_TYPE_VEC4:
        return "VEC4";
    default:
        return "MAT4";
    }
}

class AccessorReader {
public:
    AccessorReader(const tinygltf::Model& model, const std::string& name) : model_(model), name_(name) {}

    Result<std::vector<double>> read(const tinygltf::Accessor& accessor) const {
        const int componentBytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType));
        if (componentBytes <= 0 || accessor.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE)
            return fail("has numbers of unknown type " + std::to_string(accessor.componentType) +
                        "; must be 5120 to 5123, 5125 or 5126");
        const auto width = std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)));
        const std::size_t bytes = std::size_t(componentBytes) * width;
        const auto component = [&](const unsigned char* from, std::size_t c) {
            return readComponent(from + c * std::size_t(componentBytes), accessor.componentType,
                                 accessor.normalized);
        };
        std::vector<double> values;
        if (accessor.bufferView >= 0) {
            const Result<View> dense =
                view(accessor.bufferView, accessor.byteOffset, accessor.count, bytes, false);
            if (!dense) return dense.error();
            values.reserve(accessor.count * width);
            for (std::size_t i = 0; i < accessor.count; ++i)
                for (std::size_t c = 0; c < width; ++c)
                    values.push_back(component(dense->at(i), c));
        } else if (accessor.count <= mostUnstored(model_)) {
            values.resize(accessor.count * width); // zeros unless sparse values follow
        } else {
            return fail("has an accessor of " + std::to_string(accessor.count) +
                        " elements without data; must have at most " + std::to_string(mostUnstored(model_)) +
                        ", as many as the file has bytes of data");
        }
        if (!accessor.sparse.isSparse) return values;

        const auto& sparse = accessor.sparse;
        const int indexBytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(sparse.indices.componentType));
        const std::size_t count = std::size_t(std::max(sparse.count, 0));
        if (indexBytes <= 0) return fail("has sparse indices of an unknown type; must be unsigned");
        const Result<View> places = view(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset),
                                         count, std::size_t(indexBytes), true);
        if (!places) return places.error();
        const Result<View> news =
            view(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), count, bytes, true);
        if (!news) return news.error();
        for (std::size_t i = 0; i < count; ++i) {
            const double place = readComponent(places->at(i), sparse.indices.componentType, false);
            if (!(place >= 0 && place < double(accessor.count)))
                return fail("has a sparse index outside its accessor; must be smaller");
            for (std::size_t c = 0; c < width; ++c)
                values[std::size_t(place) * width + c] = component(news->at(i), c);
        }
        return values;
    }

private:
    Error fail(const std::string& what) const { return {name_ + ": " + what}; }

    // `count` elements of `bytes` each, checked to lie inside their buffer.
    Result<View> view(int index, std::size_t offset, std::size_t count, std::size_t bytes,
                      bool packed) const {
        const tinygltf::BufferView* part = element(model_.bufferViews, index);
        const tinygltf::Buffer* buffer = part ? element(model_.buffers, part->buffer) : nullptr;
        if (!buffer) return fail("points to a buffer that does not exist");
        const std::size_t stride = packed || part->byteStride == 0 ? bytes : part->byteStride;
        const std::size_t size = buffer->data.size();
        const bool inside =
            part->byteOffset <= size && offset <= size - part->byteOffset &&
            (count == 0 || (bytes <= size - part->byteOffset - offset &&
                            (count - 1) <= (size - part->byteOffset - offset - bytes) / stride));
        if (!inside)
            return fail("has a buffer of " + std::to_string(size) +
                        " bytes that is too short for what points into it");
        return View{buffer->data.data() + part->byteOffset + offset, stride};
    }

    const tinygltf::Model& model_;
    const std::string& name_;
};

} // namespace

Result<std::vector<double>> readNumbers(const tinygltf::Model& model, int accessor, int type,
                                        const std::string& what, const std::string& name) {
    const tinygltf::Accessor* found = element(model.accessors, accessor);
    if (!found || found->type != type)
        return Error{name + ": has " + what + " of another form or none; must be " + spelling(type)};
    return AccessorReader(model, name).read(*found);
}

Result<std::vector<std::uint32_t>> readIndices(const tinygltf::Model& model, int accessor, int type,
                                               const std::string& what, const std::string& name) {
    const tinygltf::Accessor* found = element(model.accessors, accessor);
    if (!found || found->type != type || found->normalized ||
        (found->componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
         found->componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
         found->componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
        return Error{name + ": has " + what + " that are no whole numbers; must be " + spelling(type) +
                     " of an unsigned type"};
    const Result<std::vector<double>> values = AccessorReader(model, name).read(*found);
    if (!values) return values.error();
    return std::vector<std::uint32_t>(values->begin(), values->end());
}

} // namespace lucent::scene

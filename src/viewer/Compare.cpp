#include "viewer/Compare.h"

#include "base/Pfm.h"
#include "measure/Flip.h"
#include "scene/Load.h"
#include "scene/Mesh.h"
#include "scene/Painting.h"
#include "technique/Technique.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lucent::viewer {

namespace {

constexpr std::string_view kModes[] = {"off", "truth", "error", "methods", "materials"};

// Images and meshes that decide what a scene looks like, in a fixed order.
std::vector<const void*> contentOf(const scene::Scene& scene) {
    std::vector<const void*> content{scene.environment ? scene.environment->map.get() : nullptr};
    for (const scene::Object& object : scene.objects) {
        if (const auto* field = std::get_if<scene::HeightField>(&object.shape))
            content.insert(content.end(), {field->heights.get(), field->alpha.get()});
        if (const auto* shape = std::get_if<scene::MeshShape>(&object.shape))
            content.push_back(shape->mesh.get());
        for (const auto& map : object.material.maps())
            content.push_back(map.get());
        if (const scene::Painting* painting = object.painting.get())
            content.insert(content.end(), {painting->entering.get(), painting->leaving.get()});
    }
    return content;
}

// What the exact picture depends on, as text: the model of a technique counts, its methods and knobs do not.
std::string modelOf(scene::Scene scene) {
    scene = technique::withDefaults(std::move(scene));
    scene::View view;
    view.show = scene.view.show;
    view.time = scene.view.time;
    scene.view = view;
    scene.quality = {};
    return scene::toJson(scene);
}

// Names an image's file and adds it; null images have none.
void packImage(std::vector<std::pair<std::string, Bytes>>& files, const std::shared_ptr<const Image>& image,
               std::string& file) {
    if (!image) return;
    file = std::to_string(files.size()) + ".pfm";
    files.emplace_back(file, encodePfm(*image));
}

void packField(std::vector<std::pair<std::string, Bytes>>& files, scene::HeightField& field) {
    field.source = {};
    field.alphaIsSolid = true;
    packImage(files, field.heights, field.source.file);
    packImage(files, field.alpha, field.alphaFile);
}

// A part of a file becomes a file of its own.
void packMesh(std::vector<std::pair<std::string, Bytes>>& files, scene::MeshShape& shape) {
    shape.source = std::to_string(files.size()) + ".mesh";
    shape.part.clear();
    files.emplace_back(shape.source, scene::encodeMesh(*shape.mesh));
}

// The finished maps: strokes need not be painted again.
void packPainting(std::vector<std::pair<std::string, Bytes>>& files,
                  std::shared_ptr<const scene::Painting>& painting) {
    if (!painting) return;
    scene::Painting packed;
    packed.entering = painting->entering;
    packed.leaving = painting->leaving;
    packImage(files, packed.entering, packed.enteringFile);
    packImage(files, packed.leaving, packed.leavingFile);
    painting = std::make_shared<const scene::Painting>(std::move(packed));
}

} // namespace

std::span<const Param> compareParams() {
    static const Param params[] = {
        declare(&CompareSettings::mode,
                {.id = "compare",
                 .label = "Compare",
                 .group = Group::View,
                 .doc =
                     "A second picture right of a divider: the exact one, how far yours is from it in false "
                     "colours, or the same scene drawn by other methods or of other materials, which are "
                     "chosen below.",
                 .choices = kModes,
                 .attribute = "compare"}),
        declare(&CompareSettings::divider, {.id = "divider",
                                            .label = "Divider",
                                            .min = 0,
                                            .max = 1,
                                            .doc = "Share of the picture left of the divider.",
                                            .attribute = "divider"}),
    };
    return params;
}

std::vector<BoundParam> bindCompare(CompareSettings& settings) {
    static const CompareSettings defaults;
    std::vector<BoundParam> bound;
    for (const Param& param : compareParams()) {
        const auto member = [&](const void* base) {
            return static_cast<const std::byte*>(base) + param.offset;
        };
        bound.push_back({std::string(param.id), "compare", &param,
                         reinterpret_cast<std::byte*>(&settings) + param.offset, member(&defaults)});
    }
    return bound;
}

bool isPrecomputing(std::string_view path) { return path.ends_with(".precomputed"); }

bool isOfRight(CompareMode mode, std::string_view path) {
    if (mode == CompareMode::Methods)
        return path.starts_with("technique.") || path.starts_with("quality.") || isPrecomputing(path);
    return mode == CompareMode::Materials && path.starts_with("objects.") && !isPrecomputing(path) &&
           path.find(".material.") != path.npos;
}

std::string besideOwner(std::string_view object) { return std::string(object) + ", right of the divider"; }

std::vector<BoundParam> bindBeside(scene::Scene& right) {
    std::vector<BoundParam> settings;
    for (BoundParam& bound : scene::bindParams(right)) {
        if (!isOfRight(CompareMode::Methods, bound.path) && !isOfRight(CompareMode::Materials, bound.path))
            continue;
        bound.path.insert(0, kBeside);
        if (!bound.prefix.empty()) bound.prefix.insert(0, "beside-");
        bound.place = Group::Mode; // first, while two pictures are compared
        settings.push_back(std::move(bound));
    }
    return settings;
}

scene::Scene withSettingsOf(scene::Scene scene, const scene::Scene& settings) {
    scene.technique = settings.technique;
    scene.quality = settings.quality;
    for (std::size_t i = 0; i < std::min(scene.objects.size(), settings.objects.size()); ++i) {
        scene::Material& drawn = scene.objects[i].material;
        const scene::Material& chosen = settings.objects[i].material;
        if (drawn.isScattering() && chosen.isScattering())
            drawn.translucent().precomputed = chosen.translucent().precomputed;
    }
    return scene;
}

scene::Scene withMaterialsOf(const scene::Scene& scene, const scene::Scene& materials) {
    scene::Scene drawn = scene;
    for (std::size_t i = 0; i < std::min(scene.objects.size(), materials.objects.size()); ++i)
        drawn.objects[i].material = materials.objects[i].material;
    return withSettingsOf(std::move(drawn), scene); // how subsurface scattering is worked out is no material
}

Image asTruthImage(const Image& picture) {
    Image image(picture.width, picture.height, 4);
    const bool isGrey = picture.channels < 3;
    for (std::size_t i = 0; i < image.pixels.size() / 4; ++i) {
        const float* from = picture.pixels.data() + i * std::size_t(picture.channels);
        for (std::size_t channel = 0; channel < 3; ++channel)
            image.pixels[4 * i + channel] = from[isGrey ? 0 : channel];
        image.pixels[4 * i + 3] = picture.channels == 4 ? from[3] : -1;
    }
    return image;
}

bool samePicture(const scene::Scene& a, const scene::Scene& b) {
    return contentOf(a) == contentOf(b) && modelOf(a) == modelOf(b);
}

Result<measure::Metrics> compareWithTruth(const Image& picture, const Image& truth) {
    if (picture.size() != truth.size()) return measure::compare(picture, "picture", truth, "truth");
    Image coverage(picture.width, picture.height, 1);
    for (std::size_t i = 0; i < coverage.pixels.size(); ++i)
        coverage.pixels[i] = std::max(picture.pixels[4 * i + 3], truth.pixels[4 * i + 3]);
    return measure::compare(picture, "picture", truth, "truth", &coverage);
}

double visibleError(const Image& picture, const Image& truth, float exposure) {
    const auto shown = [&](Image image) {
        for (float& value : image.pixels)
            value *= std::exp2(exposure);
        return image;
    };
    return measure::flip(shown(picture), shown(truth)).mean;
}

void takeCoverage(Image& truth, const Image& picture) {
    for (std::size_t i = 3; i < truth.pixels.size(); i += 4)
        if (truth.pixels[i] < 0) truth.pixels[i] = picture.pixels[i];
}

Image differenceOf(const Image& picture, const Image& truth) {
    Image difference(truth.width, truth.height, 4);
    for (std::size_t i = 0; i < difference.pixels.size(); ++i) {
        const float a = picture.pixels[i], b = truth.pixels[i];
        difference.pixels[i] = i % 4 == 3 ? std::max(a, b) : std::abs(a - b);
    }
    return difference;
}

double fullScale(double p99) {
    const double smallest = 1e-7; // of light near 1 a 32-bit float says no more
    const double wanted = std::max(p99, smallest);
    const double exponent = std::floor(std::log10(wanted));
    // Powers of ten are exact upwards only, and a quotient of exact numbers prints short.
    const auto end = [&](double step) {
        return exponent < 0 ? step / std::pow(10.0, -exponent) : step * std::pow(10.0, exponent);
    };
    for (const double step : {1.0, 2.0, 5.0})
        if (wanted <= end(step)) return end(step);
    return end(10);
}

std::vector<std::pair<std::string, Bytes>> packScene(scene::Scene scene) {
    std::vector<std::pair<std::string, Bytes>> files{{"scene.json", {}}};
    if (scene.environment) packImage(files, scene.environment->map, scene.environment->source);
    for (scene::Light& light : scene.lights)
        if (auto* spot = std::get_if<scene::SpotLight>(&light))
            packImage(files, spot->image, spot->imageFile);
    for (scene::Object& object : scene.objects) {
        if (auto* field = std::get_if<scene::HeightField>(&object.shape)) packField(files, *field);
        if (auto* mesh = std::get_if<scene::MeshShape>(&object.shape)) packMesh(files, *mesh);
        scene::Material& material = object.material;
        packImage(files, material.baseMap, material.baseMapFile);
        packImage(files, material.diffuseMap, material.diffuseMapFile);
        packImage(files, material.specularMap, material.specularMapFile);
        if (auto* measured = std::get_if<scene::MeasuredBrdf>(&material.kind))
            packImage(files, measured->table, measured->tableFile);
        packPainting(files, object.painting);
        object.bakeFile.clear(); // exact solutions need none
        object.bake.reset();
    }
    const std::string text = scene::toJson(scene);
    const auto bytes = std::as_bytes(std::span(text));
    files.front().second.assign(bytes.begin(), bytes.end());
    return files;
}

} // namespace lucent::viewer

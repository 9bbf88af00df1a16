#include "scene/readers/Photos.h"

#include "scene/readers/Png16.h"

#include <algorithm>
#include <cstdio>

namespace lucent::scene {
namespace {

Image changed(Image image, float (*change)(float)) {
    std::transform(image.pixels.begin(), image.pixels.end(), image.pixels.begin(), change);
    return image;
}

} // namespace

Result<Brought> sceneOfSurface(const std::string& title, const SurfaceMaps& maps) {
    const Bytes normals = encodePng16(maps.normals);
    const MapFile set[] = {
        {MapUse::Normals, title + "_normal.png", normals},
        {MapUse::Albedo, title + "_albedo.png", encodePng16(changed(maps.albedo, srgbFromLinear))}};
    Result<Brought> files = sceneOfMaps(set);
    if (!files) return files;
    files->push_back({set[0].name, normals});
    if (maps.residual.empty()) return files;
    const auto asGrey = [](float residual) { return residual / kResidualWhite; };
    files->push_back({title + "_residual.png", encodePng16(changed(maps.residual, asGrey))});
    return files;
}

std::string describe(const PhotometricStereo& stereo) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "residual %.2g %% of the albedo (root mean square); %.2g %% of the values left out as shadows or "
        "highlights",
        100.0 * double(stereo.maps().rms), 100.0 * double(stereo.maps().leftOut));
    std::string all = text;
    if (stereo.reduction() > 1)
        all += "; photographs made smaller by a factor of " + std::to_string(stereo.reduction());
    return all;
}

} // namespace lucent::scene

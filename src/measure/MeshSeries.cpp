#include "measure/MeshSeries.h"

#include "scene/Mesh.h"

#include <algorithm>

namespace lucent::measure {

namespace {

double triangles(const BenchMesh& mesh) { return double(mesh.mesh->indices.size()) / 3; }

std::vector<BenchMesh> spheres() {
    std::vector<BenchMesh> meshes;
    for (const int segments : {32, 64, 128, 256, 512, 934}) // 934: as many triangles as the dragon has
        meshes.push_back({"sphere", std::make_shared<const scene::Mesh>(meshOf(scene::Sphere{1}, segments))});
    return meshes;
}

} // namespace

scene::Object objectOf(const BenchMesh& mesh) {
    vec3 low(mesh.mesh->positions.front()), high(low);
    for (const vec3& position : mesh.mesh->positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const vec3 extent = high - low;
    scene::Object object;
    object.name = mesh.name;
    object.shape = scene::MeshShape{.source = mesh.name, .part = {}, .mesh = mesh.mesh};
    object.transform.scale = 2 / std::max({extent.x, extent.y, extent.z});
    object.transform.translate = -object.transform.scale * 0.5f * (low + high);
    return object;
}

std::vector<Series::Point> overTriangles(std::vector<BenchMesh> meshes, bool quick, double pixels,
                                         const std::function<scene::Scene(const BenchMesh&)>& sceneOf) {
    if (meshes.empty()) meshes = spheres();
    const auto tooMany = [](const BenchMesh& mesh) { return triangles(mesh) > 100'000; };
    if (quick) meshes.erase(std::remove_if(meshes.begin(), meshes.end(), tooMany), meshes.end());
    std::sort(meshes.begin(), meshes.end(),
              [](const BenchMesh& a, const BenchMesh& b) { return triangles(a) < triangles(b); });
    std::vector<Series::Point> points;
    for (const BenchMesh& mesh : meshes)
        points.push_back({triangles(mesh),
                          {[mesh, sceneOf]() -> Result<scene::Scene> { return sceneOf(mesh); },
                           pixels + triangles(mesh)}});
    return points;
}

RatioRule growth(const std::string& stage, std::optional<double> target) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        for (const ScalingSeries& series : report.scaling) {
            if (series.method != stage || series.points.size() < 2) continue;
            const dvec2 few = series.points.front(), many = series.points.back();
            return Ratio{stage + " at " + std::to_string(long(many.x)) + " triangles over that at " +
                             std::to_string(long(few.x)),
                         many.y / few.y, target, false};
        }
        return std::nullopt;
    };
}

} // namespace lucent::measure

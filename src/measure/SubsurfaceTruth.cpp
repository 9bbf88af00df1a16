#include "measure/SubsurfaceTruth.h"

#include "technique/Technique.h"
#include "truth/Walk.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace lucent::measure {

namespace {

constexpr double kPi = std::numbers::pi;

double angleBetween(const dvec3& a, const dvec3& b) {
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

// --- the model

// On a ball, solved at even angles from the light and linear between them: marble's light falls by e within 7
// degrees, so that half a degree is off by 1e-3.
class BallEstimator : public truth::Estimator {
public:
    BallEstimator(const truth::DipoleEstimator& model, const scene::Scene& scene, const LitBall& ball)
        : model_(model), eye_(scene.camera, scene.size), toLight_(ball.toLight) {
        constexpr int kSteps = 360;
        const truth::Body& body = model.bodies().all().front();
        const dvec3 aside = std::abs(toLight_.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 across = glm::normalize(glm::cross(toLight_, aside));
        for (int i = 0; i <= kSteps; ++i) {
            const double angle = kPi * i / kSteps;
            const dvec3 normal = std::cos(angle) * toLight_ + std::sin(angle) * across;
            const auto hit = body.alone.intersect({2 * ball.radius * normal, -normal});
            values_.push_back(model.radiosity(body, *hit, std::uint64_t(i)).mean());
        }
    }
    truth::Pixel solve(ivec2 pixel) const override {
        const auto seen = model_.bodies().seenAt(eye_, pixel);
        if (!seen) return {};
        const double place = angleBetween(seen->hit.normal, toLight_) / kPi * double(values_.size() - 1);
        const auto low = std::min(std::size_t(place), values_.size() - 2);
        return {glm::mix(values_[low], values_[low + 1], place - double(low)), dvec3(0), 1};
    }

private:
    const truth::DipoleEstimator& model_;
    truth::Eye eye_;
    dvec3 toLight_;
    std::vector<dvec3> values_;
};

Result<truth::Picture> solveModel(const scene::Scene& scene, const truth::Tile& rows, int threads) {
    const std::optional<LitBall> ball = litBallOf(scene);
    truth::DipoleOptions options = dipoleOptionsOf(scene);
    options.samples = ball ? 4096 : 1024; // a mesh of marble: half a percent of its light is noise
    const auto model = truth::DipoleEstimator::create(scene, scene.size, options);
    if (!model) return model.error();
    const std::atomic<bool> never{false};
    if (!ball) return render(*model, scene.size, rows, {.threads = threads}, never);
    return render(BallEstimator(*model, scene, *ball), scene.size, rows, {.threads = threads}, never);
}

// --- the physics

// Mean light of a ring around the light's axis.
class Ring {
public:
    void add(const float* value, const float* error) {
        for (int c = 0; c < 3; ++c) {
            sum_[c] += double(value[c]);
            variance_[c] += double(error[c]) * double(error[c]);
        }
        ++count_;
    }
    bool isEmpty() const { return count_ == 0; }
    void put(float* value, float* error) const {
        for (int c = 0; c < 3; ++c) {
            value[c] = float(sum_[c] / count_);
            error[c] = float(std::sqrt(variance_[c]) / count_);
        }
    }

private:
    dvec3 sum_{0}, variance_{0};
    double count_ = 0;
};

// Rings that no pixel shows whole are like the nearest one that some pixel does.
void fillEmpty(std::vector<Ring>& rings) {
    const auto isKnown = [](const Ring& ring) { return !ring.isEmpty(); };
    const auto first = std::find_if(rings.begin(), rings.end(), isKnown);
    const auto last = std::find_if(rings.rbegin(), rings.rend(), isKnown);
    if (first == rings.end()) return;
    std::fill(rings.begin(), first, *first);
    std::fill(rings.rbegin(), last, *last);
}

// Gives each pixel of a ball the mean over its ring, as many as there are pixels along a half turn. Pixels on
// the outline, which show something else as well, count in none.
Status averageAround(truth::Picture& picture, const scene::Scene& scene, const LitBall& ball) {
    const Result<truth::Bodies> bodies = truth::Bodies::create(scene);
    if (!bodies) return bodies.error();
    const truth::Eye eye(scene.camera, scene.size);
    std::vector<Ring> rings(90);
    const auto forEachSeen = [&](const std::function<void(ivec2, Ring&, double)>& work) {
        for (int y = 0; y < scene.size.y; ++y)
            for (int x = 0; x < scene.size.x; ++x) {
                const auto seen = bodies->seenAt(eye, {x, y});
                if (!seen) continue;
                const double angle = angleBetween(seen->hit.normal, ball.toLight);
                const auto ring = std::size_t(angle / kPi * double(rings.size()));
                work({x, y}, rings[std::min(ring, rings.size() - 1)],
                     glm::dot(seen->hit.normal, seen->viewer));
            }
    };
    const double pixel = eye.pixelWidth(glm::distance(dvec3(scene.camera.eye), dvec3(0))) / ball.radius;
    const double grazing = std::sqrt(3 * pixel); // cosine one and a half pixels inside the outline
    forEachSeen([&](ivec2 at, Ring& ring, double cosine) {
        if (cosine > grazing) ring.add(picture.values.at(at.x, at.y), picture.errors.at(at.x, at.y));
    });
    fillEmpty(rings);
    forEachSeen([&](ivec2 at, Ring& ring, double) {
        if (!ring.isEmpty()) ring.put(picture.values.at(at.x, at.y), picture.errors.at(at.x, at.y));
    });
    return Done{};
}

Result<truth::Picture> solvePhysics(const scene::Scene& scene, const truth::Tile& rows, int threads,
                                    std::int64_t walksOfAPixel, std::optional<int> scatterings) {
    const std::int64_t pixels = std::int64_t(scene.size.x) * scene.size.y;
    const std::atomic<bool> never{false};
    Result<truth::Picture> picture = truth::traceWalks(scene, scene.size,
                                                       {.aov = scene.view.show,
                                                        .photons = rows.photons(walksOfAPixel * pixels),
                                                        .seed = std::uint64_t(rows.index),
                                                        .scatterings = scatterings},
                                                       {}, {.threads = threads}, never);
    const std::optional<LitBall> ball = litBallOf(scene);
    if (picture && ball)
        if (Status averaged = averageAround(*picture, scene, *ball); !averaged) return averaged.error();
    return picture;
}

} // namespace

truth::DipoleOptions dipoleOptionsOf(const scene::Scene& scene) {
    truth::DipoleOptions options = technique::modelOf(scene).dipole;
    options.aov = scene.view.show;
    return options;
}

Result<truth::Picture> solveSubsurface(const scene::Scene& scene, const truth::Tile& rows, int threads) {
    const bool walks = technique::modelOf(scene).walks;
    constexpr std::int64_t kWalksOfAPixel = 60; // on a ball 1 % of noise in front, once rings are averaged
    return walks ? solvePhysics(scene, rows, threads, kWalksOfAPixel, {}) : solveModel(scene, rows, threads);
}

Result<truth::Picture> solveScatteredOnce(const scene::Scene& scene, int threads) {
    constexpr std::int64_t kWalksOfAPixel = 15; // of such light rings hold enough
    return solvePhysics(scene, {}, threads, kWalksOfAPixel, 1);
}

std::optional<LitBall> litBallOf(const scene::Scene& scene) {
    if (scene.objects.size() != 1 || scene.lights.size() != 1 || scene.environment) return std::nullopt;
    const scene::Object& object = scene.objects.front();
    const auto* sphere = std::get_if<scene::Sphere>(&object.shape);
    const auto* light = std::get_if<scene::DistantLight>(&scene.lights.front());
    const bool isStill = object.transform.translate == vec3(0) && object.wave.amplitude == vec3(0);
    if (!sphere || !light || light->angle != 0 || !isStill || object.painting) return std::nullopt;
    return LitBall{double(sphere->radius) * double(object.transform.scale),
                   -glm::normalize(dvec3(light->direction))};
}

} // namespace lucent::measure

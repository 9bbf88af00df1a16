#pragma once
/// Which settings of caustics and refraction keep a wanted error at the least cost.
///
/// The very picture is drawn, no larger than kMostSide, with few rays and then with more, until what the
/// finer one changes is small enough. Twice that change stands for the error: each step has four times as
/// many points of a lamp, or twice as many rays a side, and halves the error at least where it falls with the
/// square root of the points and in proportion to the rays' distance.

#include "base/Image.h"
#include "techniques/caustics/Caustics.h"
#include "gl/Context.h"
#include "techniques/refract/Refract.h"

#include <memory>
#include <string>

namespace lucent::frame {

class Renderer;

class GlassBudget {
public:
    static constexpr int kMostSide = 512; ///< pixels
    /// Median angle [degrees] between directions of refracted rays that an error of 1 stands for.
    static constexpr float kDegrees = 10;

    struct Choice {
        int lightSamples = 0; ///< of caustics and of shadows; 0: no lamp has a size
        int grid = 0;         ///< rays a side; 0: nothing throws caustics
        int mapSize = 0;
        int maxLayers = 0;   ///< 0: nothing refracts
        float predicted = 0; ///< RMSE over the mean
        float degrees = 0;   ///< median, of refracted rays
        bool kept = true;    ///< false: nothing at hand keeps the wanted error

        /// "16 points a lamp, 128 rays a side, 4 layers, error about 0.8 %", for people.
        std::string text() const;
        /// The scene with these settings.
        scene::Scene applied(const scene::Scene& scene) const;
    };

    explicit GlassBudget(gl::Context& context);
    ~GlassBudget();

    /// Whether there is anything to choose.
    static bool matters(const scene::Scene& scene);

    /// Begins anew for a scene with quality.maxError > 0.
    void start(const scene::Scene& scene, ivec2 size);
    bool done() const { return phase_ == Phase::Done; }
    /// Draws one or two pictures.
    Status step(const scene::Scene& scene);
    /// After the last step.
    const Choice& choice() const { return choice_; }

private:
    enum class Phase { Points, Grid, Layers, Done };
    void begin(Phase phase);
    Status tryPoints(const scene::Scene& scene);
    Status tryGrid(const scene::Scene& scene);
    Status tryLayers(const scene::Scene& scene);
    Result<Image> draw(const scene::Scene& scene, const Choice& choice, scene::Aov show);
    Result<float> errorOf(const scene::Scene& scene, const Choice& coarse, const Choice& fine);
    void add(float error);

    gl::Context& context_;
    std::unique_ptr<Renderer> trial_;
    std::uint64_t trials_ = 0;
    Phase phase_ = Phase::Done;
    ivec2 size_{0};
    float wanted_ = 0; ///< of each part: their squares add up
    std::size_t next_ = 0;
    Image finer_; ///< of the candidate before: the next one's own picture
    Choice choice_;
};

} // namespace lucent::frame

#pragma once
/// Which values of the techniques' knobs keep a wanted error at the least cost.
///
/// The very picture is drawn, no larger than kMostSide, with the cheapest value of a knob and then with the
/// next ones, until what the finer one changes is small enough. Twice that change stands for the error: each
/// step has four times as many samples, or twice as many rays a side, and halves the error at least where it
/// falls with the square root of the samples and in proportion to the rays' distance.

#include "base/Image.h"
#include "gl/Context.h"
#include "technique/Guest.h"
#include "technique/Technique.h"

#include <memory>
#include <string>
#include <vector>

namespace lucent::frame {

class Renderer;

/// Turns every knob down to what a first look has.
void turnDown(scene::Scene& scene);

class Budget : public technique::Chooser {
public:
    static constexpr int kMostSide = 512; ///< pixels
    /// Median angle [degrees] between directions of refracted rays that an error of 1 stands for.
    static constexpr float kDegrees = 10;

    explicit Budget(gl::Context& context);
    ~Budget() override;

    /// Whoever else chooses how finely lamps are sampled: then this one does not.
    void leaveSampling(bool leave) { leavesSampling_ = leave; }

    bool matters(const scene::Scene& scene) const override;
    void start(const scene::Scene& scene, ivec2 size, bool dragged) override;
    void forget() override;
    bool done() const override { return next_ >= turned_.size(); }
    Status step(const scene::Scene& scene) override;
    void apply(scene::Scene& scene) const override;
    std::optional<Choice> choice() const override;

private:
    struct Turned {
        technique::KnobOf of;
        std::size_t step = 0; ///< of the knob's
        double value = 0;     ///< that is chosen so far
    };
    std::vector<technique::KnobOf> knobsOf(const scene::Scene& scene) const;
    scene::Scene trialOf(const scene::Scene& scene) const;
    Status tryNext(const scene::Scene& scene, Turned& turned);
    Status tryFewer(const scene::Scene& scene, Turned& turned);
    Result<Image> draw(scene::Scene trial, scene::Aov show);
    void finish(float error);

    gl::Context& context_;
    std::unique_ptr<Renderer> trial_;
    std::uint64_t trials_ = 0;
    bool leavesSampling_ = false, limited_ = false;
    std::vector<Turned> turned_;
    std::size_t next_ = 0; ///< of them
    ivec2 size_{0};
    float wanted_ = 0; ///< of each knob: their squares add up
    Image finer_;      ///< of the value before: the next one's own picture
    float predicted_ = 0;
    bool kept_ = true; ///< false: nothing at hand keeps the wanted error
};

} // namespace lucent::frame

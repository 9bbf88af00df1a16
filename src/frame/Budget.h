#pragma once
/// Which values of the knobs keep a wanted error at the least cost.
///
/// The very picture is drawn with the cheapest value of a knob and then with dearer ones, until the error
/// that is left is small enough: the squares of all knobs' errors add up to the wanted one's. Light adds up,
/// so each kind of light sample is tried beside the fewest of the others, on a few hundred pixels, against
/// many more of its own. What a technique does hangs on the pixels: it is tried on pictures of up to
/// kMostSide, against all that there is or against the next value. Twice that change stands for the error:
/// each step has four times as many samples, or twice as many rays a side, and halves the error at least
/// where it falls with the square root of the samples and in proportion to the rays' distance. The last
/// step's is foretold where the two before it leave no doubt: the one that it would be held against costs the
/// most. The environment's directions are few in these pictures, and the same. Where each sample of a pixel
/// has light samples of its own, their mean errs less, which is counted.

#include "base/Image.h"
#include "frame/Renderer.h"
#include "technique/Guest.h"
#include "technique/Technique.h"

#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lucent::frame {

/// Turns every knob down to what a preview has.
void turnDown(scene::Scene& scene, bool hasFewPixels);

class Budget {
public:
    static constexpr int kMostSide = 512; ///< pixels
    /// Median angle [degrees] between directions of refracted rays that an error of 1 stands for.
    static constexpr float kDegrees = 10;

    explicit Budget(Renderer::State& of);
    ~Budget();

    /// Whether any knob trades error for time in this scene.
    bool matters(const scene::Scene& scene) const;
    /// Begins anew for a scene with quality.maxError > 0 in which something matters().
    ///
    /// @param dragged  a preview: there is no time, the last choice serves again
    void start(const scene::Scene& scene, bool dragged);
    /// Whether nothing may become dearer than the scene's own settings, nor the choice dearer than what it
    /// saves: only light samples are chosen, where the scene has more of them than are drawn to choose.
    void beFrugal(bool frugal) { frugal_ = frugal; }
    /// The scene keeps no error: nothing is chosen any more.
    void forget();
    bool done() const { return next_ >= turned_.size(); }
    /// How much of the choice is made, about, [0,1].
    float share() const;
    /// Draws some of a trial.
    Status step(const scene::Scene& scene);
    /// Whether the GPU is still drawing what it was given of a trial: step() can do nothing now.
    bool waits() const;
    /// Puts what is chosen into a scene's settings, when it is done().
    void apply(scene::Scene& scene) const;
    /// Whether what a guest has baked keeps the wanted error. If not, or while that is still being found out:
    /// false; then the budget is not done() any more and goes on among directions, or is to be asked again.
    Result<bool> admitsBake(const scene::Scene& scene);

    struct Choice {
        std::string text;    ///< "16 samples a lamp, error about 0.8 %", for people
        float predicted = 0; ///< RMSE over the mean
    };
    /// Nothing before it is done.
    std::optional<Choice> choice() const;

private:
    struct Value {
        double number = 0;
        int placing = 0;
        bool baked = false; ///< what a guest works out in place of the number
        auto operator<=>(const Value&) const = default;
    };
    struct Turned {
        technique::KnobOf of;
        Value value;          ///< the best so far,
        float error;          ///< and its RMSE over the mean
        std::size_t step = 0; ///< of the knob's, that is tried
    };
    struct Trial {
        Value value;
        scene::Aov show;
        auto operator<=>(const Trial&) const = default;
    };
    /// Of the environment's light in place of directions; Taken: whether it keeps the error is not known yet.
    enum class Bake { None, Taken, Kept, Refused };

    std::vector<technique::KnobOf> knobsOf(const scene::Scene& scene) const;
    void begin(const scene::Scene& scene);
    void beginKnob();
    bool isBaked() const { return bake_ == Bake::Taken || bake_ == Bake::Kept; }
    float predicted() const;
    float wanted() const;
    void put(scene::Scene& scene, const Turned* tried, Value value) const;
    Result<bool> draw(const scene::Scene& scene, const Turned& turned, Trial trial);
    Result<bool> cover(const scene::Scene& scene, const Turned& turned);
    float differenceOf(const Image& coarse, const Image& fine) const;
    Result<std::optional<float>> errorOf(const scene::Scene& scene, const Turned& turned, Value tried,
                                         Value finer);
    Value finerThan(const Turned& turned, double number);
    std::optional<float> foretold() const;
    float leftOf(const scene::Scene& scene, const Turned& turned) const;
    bool isWorthBaking(const scene::Scene& scene, const Turned& turned) const;

    Renderer::State& of_;
    bool limited_ = false;              ///< an error is to be kept
    bool frugal_ = false;               ///< and none of the scene's own settings exceeded
    bool dragged_ = false;              ///< there is no time to choose
    technique::Guest* baker_ = nullptr; ///< who can bake the environment's light
    Bake bake_ = Bake::None;
    float maxError_ = 0;
    std::vector<Turned> turned_;
    std::size_t next_ = 0; ///< of them

    // the knob that is tried
    std::unique_ptr<Renderer::State> renderer_;
    std::uint64_t trials_ = 0;
    bool isDrawing_ = false;
    float shareOfTrial_ = 0;
    std::map<Trial, Image> drawn_;
    std::vector<float> errors_;                       ///< of its steps up to now
    ivec2 size_{0};                                   ///< of trials
    std::optional<std::vector<std::size_t>> covered_; ///< pixels that show an object
    double reference_ = 0;                            ///< how many samples numbers are held against
};

} // namespace lucent::frame

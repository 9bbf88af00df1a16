#pragma once
/// Which settings keep a wanted error at the least cost.
///
/// A few hundred pixels of the very picture are drawn with many lights, then with few and more until the
/// difference is small enough: what is predicted is measured on the scene at hand, not on others like it.
/// What was learned from others is how far such a sample can err (kSafety).

#include "techniques/relief/Relief.h"
#include "views/FieldTextures.h"

#include <functional>
#include <string>
#include <vector>

namespace lucent::frame {

class Budget {
public:
    /// A transfer may take this part of the wanted error on the texels it was tried on: between texels, on
    /// half floats and for a finite number of directions it errs a little more.
    static constexpr float kTransferShare = 0.8f;

    using RecordTransfers = std::function<Result<std::vector<relief::Transferred>>(graph::FrameGraph& graph)>;

    /// Settings for one picture.
    struct Choice {
        relief::Settings settings;
        float predicted = 0; ///< RMSE over the mean
        bool kept = true;    ///< false: nothing at hand keeps the wanted error; the settings come nearest
        bool environment = false, largeLamp = false; ///< what there is to choose for

        /// "45 directions by importance, error about 0.8 %", for people.
        std::string text() const;
    };

    Budget(gl::Context& context, graph::TexturePool& pool, views::ImageCache& images, relief::Relief& relief)
        : context_(context), pool_(pool), images_(images), relief_(relief) {}

    /// Whether any setting of this scene's techniques trades error for time.
    static bool matters(const scene::Scene& scene);

    /// Begins anew for a scene with quality.maxError > 0.
    void start(const scene::Scene& scene, ivec2 size);
    bool done() const { return phase_ == Phase::Done; }
    /// Draws one more sample.
    Status step(const scene::Scene& scene);
    /// After the last step.
    const Choice& choice() const { return choice_; }
    /// RMSE over the mean of a transfer, on the sample of the picture.
    ///
    /// @param record  adds what the light pass needs of the transfers to a graph
    Result<float> errorOfTransfer(const scene::Scene& scene, const relief::Settings& settings,
                                  const RecordTransfers& record);
    /// The transfer that was chosen does not keep the error: goes on among directions.
    void refuseTransfer();

private:
    enum class Phase { Surface, Reference, Lamps, Environment, Done };
    Status drawSurface(const scene::Scene& scene);
    enum class Part : int { Lamps, Environment, Nothing }; ///< light adds up, so each can be tried alone
    Status drawReference(const scene::Scene& scene);
    Result<Image> draw(const scene::Scene& scene, const relief::Settings& settings, Part part,
                       const RecordTransfers* transfers = nullptr);
    Result<std::vector<float>> differenceOf(const scene::Scene& scene, const relief::Settings& settings,
                                            Part part, const RecordTransfers* transfers = nullptr);
    Result<float> errorOf(const scene::Scene& scene, const relief::Settings& settings, Part part,
                          const RecordTransfers* transfers = nullptr);
    double meanOf(const Image& image) const;
    Status refine(const scene::Scene& scene, Part part, int& count, int candidate, int most);
    Status tryLamps(const scene::Scene& scene);
    Result<float> tryDirections(const scene::Scene& scene, int count, relief::EnvironmentSampling& better);
    Status tryEnvironment(const scene::Scene& scene);
    double transferRays(const scene::Scene& scene) const;

    gl::Context& context_;
    graph::TexturePool& pool_;
    views::ImageCache& images_;
    relief::Relief& relief_;
    Phase phase_ = Phase::Done;
    ivec2 size_{0}, sampleSize_{0};
    graph::Texture surface_;
    std::vector<std::size_t> covered_; ///< pixels of the sample that show an object
    float wanted_ = 0;                 ///< RMSE over the mean, on the sample
    relief::Settings reference_;
    Image exact_[2];                    ///< lamps alone, environment alone
    double mean_ = 0;                   ///< of both together
    std::vector<float> lampDifference_; ///< of the chosen lamp samples, beside an environment
    std::size_t next_ = 0;              ///< candidate
    bool mayTransfer_ = true;
    Choice choice_;
};

} // namespace lucent::frame

#pragma once
/// Which settings of light on height fields keep a wanted error at the least cost.
///
/// A few hundred pixels of the very picture are drawn with many lights, then with few and more until the
/// difference is small enough: what is predicted is measured on the scene at hand, not on others like it.
/// What was learned from others is how far such a sample can err (kSafety).

#include "technique/Guest.h"
#include "techniques/relief/Relief.h"
#include "techniques/relief/Transfers.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lucent::relief {

/// All by which a picture of height fields trades error for time.
struct Means : Settings {
    views::Sampling light;
};

class Budget : public technique::Chooser {
public:
    /// A transfer may take this part of the wanted error on the texels it was tried on: between texels, on
    /// half floats and for a finite number of directions it errs a little more.
    static constexpr float kTransferShare = 0.8f;

    using RecordTransfers = std::function<Result<std::vector<Transferred>>(graph::FrameGraph& graph)>;

    /// @param transfers  the guest's: where they are there already, they are chosen at once
    Budget(const technique::Store& store, Relief& relief, const Transfers& transfers)
        : context_(store.context), pool_(store.pool), images_(store.images), relief_(relief),
          transfers_(transfers) {}

    bool matters(const scene::Scene& scene) const override;
    void start(const scene::Scene& scene, ivec2 size, bool dragged) override;
    void forget() override;
    bool done() const override { return !choosing_; }
    Status step(const scene::Scene& scene) override;
    void apply(scene::Scene& scene) const override;
    std::optional<Choice> choice() const override;

    /// Whether a transfer that is there keeps the wanted error, on the sample of the picture; if not, the
    /// budget goes on among directions. True where no error is to be kept.
    ///
    /// @param record  adds what the light pass needs of the transfers to a graph
    Result<bool> admitsTransfer(const scene::Scene& scene, const RecordTransfers& record);

private:
    enum class Phase { Surface, Reference, Lamps, Environment, Done };
    struct Found {
        Means means;
        float predicted = 0; ///< RMSE over the mean
        bool kept = true;    ///< false: nothing at hand keeps the wanted error; the means come nearest
        bool environment = false, largeLamp = false; ///< what there is to choose for

        std::string text() const;
    };
    void begin(const scene::Scene& scene, ivec2 size);
    Status advance(const scene::Scene& scene);
    Status drawSurface(const scene::Scene& scene);
    enum class Part : int { Lamps, Environment, Nothing }; ///< light adds up, so each can be tried alone
    Status drawReference(const scene::Scene& scene);
    Result<Image> draw(const scene::Scene& scene, const Means& means, Part part,
                       const RecordTransfers* transfers = nullptr);
    Result<std::vector<float>> differenceOf(const scene::Scene& scene, const Means& means, Part part,
                                            const RecordTransfers* transfers = nullptr);
    Result<float> errorOf(const scene::Scene& scene, const Means& means, Part part,
                          const RecordTransfers* transfers = nullptr);
    Result<float> errorOfTransfer(const scene::Scene& scene, const RecordTransfers& record);
    double meanOf(const Image& image) const;
    Status refine(const scene::Scene& scene, Part part, int& count, int candidate, int most);
    Status tryLamps(const scene::Scene& scene);
    Result<float> tryDirections(const scene::Scene& scene, int count, views::EnvironmentSampling& better);
    Status tryEnvironment(const scene::Scene& scene);
    double transferRays(const scene::Scene& scene) const;

    gl::Context& context_;
    graph::TexturePool& pool_;
    views::ImageCache& images_;
    Relief& relief_;
    const Transfers& transfers_;
    bool limited_ = false;  ///< an error is to be kept
    bool dragged_ = false;  ///< there is no time to choose
    bool choosing_ = false; ///< step() has something to do
    Means applied_;
    std::optional<Found> last_; ///< of the last picture that had one

    Phase phase_ = Phase::Done;
    ivec2 size_{0}, sampleSize_{0};
    graph::Texture surface_;
    std::vector<std::size_t> covered_; ///< pixels of the sample that show an object
    float wanted_ = 0;                 ///< RMSE over the mean, on the sample
    Means reference_;
    Image exact_[2];                    ///< lamps alone, environment alone
    double mean_ = 0;                   ///< of both together
    std::vector<float> lampDifference_; ///< of the chosen lamp samples, beside an environment
    std::size_t next_ = 0;              ///< candidate
    bool mayTransfer_ = true;
    Found choice_;
};

} // namespace lucent::relief

#include "measure/Sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace lucent::measure {

namespace {

// Microseconds that work takes on two cores, roughly: only for the share that is done.
constexpr double kTruthRay = 2, kPictureRay = 0.15, kStep = 0.005;

double pictureCost(const Setting& setting, double rays) {
    for (const auto& [knob, value] : setting.knobs)
        if (knob == "steps") return rays * kStep * std::strtod(value.c_str(), nullptr);
    return rays * kPictureRay;
}

// Takes the colours of one picture off another one of the same size.
void takeOff(Image& image, const Image& rest) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % 4 != 3) image.pixels[i] -= rest.pixels[i];
}

// A renderer with what it draws: what one scene shows, and the two pictures whose difference is timed.
class Drawing {
public:
    Drawing(gl::Context& context, scene::Scene scene, const Timed& timed)
        : renderer_(context), scene_(std::move(scene)), with_(scene_), without_(scene_) {
        timed.with(with_);
        timed.without(without_);
    }

    Status with() { return draw(with_); }
    Status without() { return draw(without_); }
    // Nothing that was made for the light of one picture may be used for the next: an eighth of a turn of a
    // map, next to nothing of a sun's way; nor layers of glass: next to nothing of the eye's.
    void turnLight() {
        if (with_.environment) with_.environment->rotation.y += 45;
        isTurned_ = !isTurned_;
        for (scene::Light& light : with_.lights)
            if (auto* sun = std::get_if<scene::DistantLight>(&light))
                sun->direction += vec3(isTurned_ ? 1e-5f : -1e-5f);
        if (std::any_of(scene_.objects.begin(), scene_.objects.end(),
                        [](const scene::Object& one) { return one.material.isRefractive(); }))
            with_.camera.eye = without_.camera.eye + vec3(isTurned_ ? 1e-5f : -1e-5f);
    }
    // What the scene shows; stats() is then what the timed picture cost.
    Result<Image> picture() {
        if (Status done = with(); !done) return done.error();
        stats_ = renderer_.stats();
        if (with_.view.show != scene_.view.show)
            if (Status done = renderer_.finish(scene_, ++revision_, scene_.size); !done) return done.error();
        return renderer_.read(scene_, scene_.view.show);
    }
    // What is left of it where the other timed picture is taken off.
    Result<Image> difference() {
        Result<Image> whole = picture();
        if (!whole) return whole;
        if (Status done = without(); !done) return done.error();
        const Result<Image> rest = renderer_.read(without_, scene_.view.show);
        if (!rest) return rest;
        takeOff(*whole, *rest);
        return whole;
    }
    const frame::Stats& stats() const { return stats_; }
    frame::Renderer& renderer() { return renderer_; }
    const scene::Scene& scene() const { return scene_; }

private:
    // At once: in a browser, what runs portion by portion takes several tasks.
    Status draw(const scene::Scene& scene) {
        if (Status done = renderer_.finish(scene, ++revision_, scene.size); !done) return done;
        renderer_.wait();
        return Done{};
    }

    frame::Renderer renderer_;
    scene::Scene scene_, with_, without_;
    frame::Stats stats_;
    bool isTurned_ = false; // suns are
    std::uint64_t revision_ = 0;
};

std::unique_ptr<Stopwatch> stopwatchFor(gl::Context& context, Drawing& drawing, Repeats repeats) {
    return std::make_unique<Stopwatch>(
        context,
        [&drawing] {
            drawing.turnLight();
            return drawing.with();
        },
        [&drawing] { return drawing.without(); }, repeats);
}

double milliseconds(const std::function<Status()>& work, Status& status) {
    const auto start = std::chrono::steady_clock::now();
    status = work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

// --- pieces of work

struct Sweep::Task {
    std::string label;
    double cost = 0; // expected microseconds
    virtual ~Task() = default;
    virtual bool step(Sweep& sweep) = 0; // true when done
};

// What the settings of one case share.
struct Sweep::CaseState {
    explicit CaseState(const Case& plan) : plan(plan) {}
    const Case& plan;
    scene::Scene scene;
    truth::Picture truth;
    std::optional<truth::Picture> physics;
    std::optional<Image> layers;
    std::string refused; // the scene itself
};

// An exact solution in the making.
class Sweep::Solving {
public:
    Solving(const Sweep& sweep, const scene::Scene& scene)
        : sweep_(sweep), scene_(scene), picture_(scene.size) {}

    // True when the picture is whole.
    Result<bool> step() {
        const int parts = std::min(sweep_.plan_.truthParts, scene_.size.y);
        const truth::Tile tile{done_, parts};
        const Result<truth::Picture> part = sweep_.solve_(scene_, sweep_.plan_.directions, tile);
        if (!part) return part.error();
        if (part->values.height == scene_.size.y)
            addWhole(*part, parts);
        else
            copyRows(*part, tile);
        return ++done_ == parts;
    }
    const truth::Picture& picture() const { return picture_; }

private:
    void copyRows(const truth::Picture& rows, const truth::Tile& tile) {
        for (int y = 0; y < tile.rows(scene_.size.y); ++y) {
            const auto copyRow = [&](const Image& from, Image& to) {
                std::copy_n(from.at(0, y), from.width * from.channels, to.at(0, tile.row(y)));
            };
            copyRow(rows.values, picture_.values);
            copyRow(rows.errors, picture_.errors);
        }
    }
    // Parts by rays of their own, as many each: their mean counts.
    void addWhole(const truth::Picture& part, int parts) {
        const float share = 1 / float(parts);
        for (std::size_t i = 0; i < part.values.pixels.size(); ++i)
            picture_.values.pixels[i] += share * part.values.pixels[i];
        for (std::size_t i = 0; i < part.errors.pixels.size(); ++i)
            picture_.errors.pixels[i] = std::hypot(picture_.errors.pixels[i], share * part.errors.pixels[i]);
    }

    const Sweep& sweep_;
    const scene::Scene scene_;
    truth::Picture picture_;
    int done_ = 0;
};

class Sweep::CaseTruth : public Task {
public:
    explicit CaseTruth(std::shared_ptr<CaseState> state) : state_(std::move(state)) {
        label = state_->plan.name + ": exact solution";
    }
    bool step(Sweep& sweep) override {
        const Result<bool> done = solve(sweep);
        if (!done) state_->refused = done.error().message;
        return !done || *done;
    }

private:
    Result<bool> solve(Sweep& sweep) {
        CaseState& state = *state_;
        if (!solving_) {
            Result<scene::Scene> scene = state.plan.scene();
            if (!scene) return scene.error();
            state.scene = std::move(*scene);
            if (state.plan.closedForm) {
                state.truth = truth::Picture(state.scene.size);
                state.truth.values = state.plan.closedForm();
                return true;
            }
            solving_ = std::make_unique<Solving>(sweep, state.scene);
        }
        const Result<bool> done = solving_->step();
        if (!done || !*done) return done;
        if (isSecond_) {
            if (state.plan.comparesTimed)
                takeOff(state.truth.values, solving_->picture().values);
            else if (state.plan.toLayers)
                state.layers = solving_->picture().values;
            else
                state.physics = solving_->picture();
            return true;
        }
        state.truth = solving_->picture();
        const auto& toSecond = state.plan.comparesTimed ? state.plan.timed.without
                               : state.plan.toLayers    ? state.plan.toLayers
                                                        : state.plan.toPhysics;
        if (!toSecond) return true;
        scene::Scene second = state.scene;
        toSecond(second);
        solving_ = std::make_unique<Solving>(sweep, second);
        isSecond_ = true;
        return false;
    }

    std::shared_ptr<CaseState> state_;
    std::unique_ptr<Solving> solving_;
    bool isSecond_ = false; // physics, layers or what is taken off are being solved
};

class Sweep::Timing : public Task {
public:
    Timing(std::shared_ptr<CaseState> state, const Setting& setting)
        : state_(std::move(state)), setting_(setting) {
        label = state_->plan.name + ": " + setting_.name();
    }
    bool step(Sweep& sweep) override {
        if (!stopwatch_) {
            const Status begun = begin(sweep);
            return begun ? false : refuse(sweep, begun.error().message);
        }
        const Result<bool> done = stopwatch_->step();
        if (!done) return refuse(sweep, done.error().message);
        if (*done) finish(sweep);
        return *done;
    }

private:
    Status begin(Sweep& sweep) {
        result_.technique = state_->plan.technique;
        result_.scene = state_->plan.name;
        result_.method = setting_.method;
        result_.knobs = setting_.knobs;
        result_.size = state_->scene.size;
        if (!state_->refused.empty()) return Error{state_->refused};
        scene::Scene scene = state_->scene;
        if (Status set = setting_.putInto(scene, result_.technique); !set) return set;
        drawing_ = std::make_unique<Drawing>(sweep.context_, std::move(scene), state_->plan.timed);
        const Result<Image> image = state_->plan.comparesTimed ? drawing_->difference() : drawing_->picture();
        if (!image) return image.error();
        if (Status judged = judge(*image); !judged) return judged;
        const frame::Stats& stats = drawing_->stats();
        result_.passes = stats.passes;
        result_.draws = stats.draws;
        result_.bytes = stats.bytes;
        result_.lights = stats.lights;
        if (setting_.bakes)
            if (Status baked = timeBake(); !baked) return baked;
        stopwatch_ = stopwatchFor(sweep.context_, *drawing_, sweep.plan_.repeats);
        return Done{};
    }
    Status judge(const Image& image) {
        const CaseState& state = *state_;
        const Image& truth = state.truth.values;
        if (state.layers) {
            const Result<Metrics> angles = compareDirections(image, label, truth, *state.layers);
            if (!angles) return angles.error();
            result_.error = *angles;
            return Done{};
        }
        result_.truthNoise = state.truth.standardError();
        if (!setting_.isPhysics) {
            Result<Metrics> metrics = comparedWith(state.truth, "exact solution", image);
            if (!metrics) return metrics.error();
            if (!setting_.ownModel && !state.plan.comparesTimed) addPerceptual(*metrics, image, truth);
            (setting_.ownModel ? result_.modelError : result_.error) = *metrics;
        }
        if (setting_.ownModel || !state.physics) return Done{};
        const Result<Metrics> model = comparedWith(*state.physics, "physics", image);
        if (!model) return model.error();
        result_.modelError = *model;
        return Done{};
    }
    // With what is misplaced where light is compared: by way of something, or as it leaves a body, whose
    // exact solution is smooth.
    Result<Metrics> comparedWith(const truth::Picture& solution, const char* name, const Image& image) const {
        const CaseState& state = *state_;
        Result<Metrics> metrics = compare(image, label, solution.values, name, &state.truth.values);
        if (!metrics) return metrics;
        if (state.plan.comparesTimed)
            metrics->flux = compareFlux(image, solution.values, solution.errors);
        else if (state.scene.view.show == scene::Aov::Radiosity)
            metrics->flux = compareFlux(image, solution.values, solution.errors, 1);
        return metrics;
    }
    // Programs are compiled by now: with all memory given back, the first picture makes what the second
    // finds.
    Status timeBake() {
        Status done = Done{};
        drawing_->renderer().release();
        const double first = milliseconds([&] { return drawing_->with(); }, done);
        if (!done) return done;
        drawing_->turnLight();
        result_.bakeMs = first - milliseconds([&] { return drawing_->with(); }, done);
        return done;
    }
    void finish(Sweep& sweep) {
        result_.ms = stopwatch_->spread();
        sweep.report_.measurements.push_back(result_);
    }
    bool refuse(Sweep& sweep, const std::string& message) {
        result_.refused = message;
        sweep.report_.measurements.push_back(result_);
        return true;
    }

    std::shared_ptr<CaseState> state_;
    const Setting& setting_;
    Measurement result_;
    std::unique_ptr<Drawing> drawing_;
    std::unique_ptr<Stopwatch> stopwatch_;
};

class Sweep::SeriesPoint : public Task {
public:
    SeriesPoint(const Series& series, std::size_t index, std::size_t point)
        : series_(series), index_(index), point_(point) {
        label = series.name() + " over " + series.over + ", " + std::to_string(long(series.points[point].x));
    }
    bool step(Sweep& sweep) override {
        if (!stopwatch_) {
            Result<scene::Scene> scene = series_.points[point_].scene();
            if (!scene) return leaveOut(sweep, scene.error());
            if (Status set = series_.setting.putInto(*scene, series_.technique); !set)
                return leaveOut(sweep, set.error());
            drawing_ = std::make_unique<Drawing>(sweep.context_, std::move(*scene), series_.timed);
            stopwatch_ = stopwatchFor(sweep.context_, *drawing_, sweep.plan_.repeats);
            return false;
        }
        const Result<bool> done = stopwatch_->step();
        if (!done) return leaveOut(sweep, done.error());
        if (*done)
            sweep.report_.scaling[index_].points.push_back(
                {series_.points[point_].x, stopwatch_->spread().median});
        return *done;
    }

private:
    // A field may be too large for a GPU: the series goes on without it.
    bool leaveOut(Sweep& sweep, const Error& error) const {
        sweep.say_(label + ": left out: " + error.message);
        return true;
    }

    const Series& series_;
    std::size_t index_, point_;
    std::unique_ptr<Drawing> drawing_;
    std::unique_ptr<Stopwatch> stopwatch_;
};

class Sweep::Hard : public Task {
public:
    Hard(const HardTable& table, const HardCase& plan, const Setting& setting)
        : table_(table), plan_(plan), setting_(setting) {
        label = "hard case " + plan.name + ": " + setting.name();
    }
    bool step(Sweep& sweep) override {
        HardResult result{plan_.name, setting_.name(), HardResult::Status::Refused, 0, {}};
        Image exact;
        const Result<Image> image = pictures(sweep, exact);
        if (image)
            judge(*image, exact, result);
        else
            result.message = image.error().message;
        sweep.report_.hardCases.push_back(result);
        return true;
    }

private:
    // What the method draws; `exact` becomes what it should draw.
    Result<Image> pictures(Sweep& sweep, Image& exact) const {
        Result<scene::Scene> scene = plan_.scene();
        if (!scene) return scene.error();
        const Result<scene::Scene> reference = plan_.reference ? (*plan_.reference)() : scene;
        if (!reference) return reference.error();
        Solving solving(sweep, *reference); // small: it is no trouble to make it at once
        for (;;) {
            const Result<bool> done = solving.step();
            if (!done) return done.error();
            if (*done) break;
        }
        exact = solving.picture().values;
        if (Status set = setting_.putInto(*scene, table_.technique); !set) return set.error();
        return Drawing(sweep.context_, std::move(*scene), timedLight()).picture();
    }
    // A picture with values that are not finite is no refusal: it is an error without a figure.
    void judge(const Image& image, const Image& exact, HardResult& result) const {
        const Result<Metrics> metrics = compare(image, setting_.name(), exact, "exact solution", &exact);
        result.error = metrics ? metrics->rmse : std::numeric_limits<double>::quiet_NaN();
        if (!metrics) result.message = metrics.error().message;
        const bool passes = metrics && metrics->p99 <= table_.tolerance;
        result.status = passes ? HardResult::Status::Pass : HardResult::Status::Error;
    }

    const HardTable& table_;
    const HardCase& plan_;
    const Setting& setting_;
};

// --- the sweep

Sweep::Sweep(gl::Context& context, Plan plan, SolveTruth solve, Say say)
    : context_(context), plan_(std::move(plan)), solve_(std::move(solve)), say_(std::move(say)) {
    report_.quick = plan_.quick;
    report_.machine.driver = context_.caps().renderer;
    report_.machine.version = context_.caps().version;
    report_.timing = Stopwatch::kind(context_);
    addTasks();
}

Sweep::~Sweep() = default;

void Sweep::add(std::unique_ptr<Task> task, double cost) {
    task->cost = cost;
    total_ += cost;
    tasks_.push_back(std::move(task));
}

void Sweep::addTasks() {
    const auto timingCost = [this](const Setting& setting, double rays) {
        return std::max(1000 * plan_.repeats.enoughMs,
                        (plan_.repeats.least + 2) * pictureCost(setting, rays));
    };
    for (const Case& one : plan_.cases) {
        const auto state = std::make_shared<CaseState>(one);
        add(std::make_unique<CaseTruth>(state), kTruthRay * one.scene.rays);
        for (const Setting& setting : one.settings)
            add(std::make_unique<Timing>(state, setting), timingCost(setting, one.scene.rays));
    }
    for (const Series& series : plan_.series) {
        report_.scaling.push_back({series.technique, series.name(), series.over, {}});
        for (std::size_t i = 0; i < series.points.size(); ++i)
            add(std::make_unique<SeriesPoint>(series, report_.scaling.size() - 1, i),
                timingCost(series.setting, series.points[i].scene.rays));
    }
    for (const HardTable& table : plan_.hard)
        for (const HardCase& hard : table.cases)
            for (const Setting& setting : table.settings)
                add(std::make_unique<Hard>(table, hard, setting), kTruthRay * hard.scene.rays);
}

bool Sweep::step() {
    if (tasks_.empty()) return false;
    Task& task = *tasks_.front();
    if (!begun_) say_(task.label);
    begun_ = !task.step(*this);
    if (begun_) return true;
    done_ += task.cost;
    tasks_.pop_front();
    if (!tasks_.empty()) return true;
    report_.markParetoFronts();
    for (const RatioRule& rule : plan_.ratios)
        if (std::optional<Ratio> ratio = rule(report_)) report_.ratios.push_back(*ratio);
    return false;
}

BenchReport sweep(gl::Context& context, Plan plan, SolveTruth solve, const Say& say) {
    Sweep sweep(context, std::move(plan), std::move(solve), say);
    while (sweep.step())
        ;
    return sweep.report();
}

} // namespace lucent::measure

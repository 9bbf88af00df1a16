#include "views/Water.h"

#include "shaders/views/Blocks.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lucent::views {

using graph::Format;

namespace {

vec2 cellOf(const scene::Water& water) { return water.size / vec2(waterCells(water)); }

// (wave vector, amplitude, angular frequency) as Optics.h has them; too much damping lets nothing travel.
vec4 sineOf(const scene::Water& water) {
    const float k = 2 * kPi / water.wavelength;
    const float fastest = water.speed * k;
    const float frequency = std::sqrt(std::max(0.0f, fastest * fastest - water.damping * water.damping / 4));
    return {k * glm::normalize(water.direction), water.amplitude, frequency};
}

} // namespace

float waterReach(const scene::Water& water) {
    return 4 * water.amplitude + (water.dropInterval > 0 ? 2 * scene::fallingDrop(water, 1).depth : 0);
}

Result<std::unique_ptr<WaterSheet>> WaterSheet::create(gl::Context& context, const scene::Water& water) {
    const ivec2 size = waterCells(water) + 1;
    if (const int limit = context.caps().maxTextureSize; std::max(size.x, size.y) > limit)
        return Error{"water of " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                         " heights: too large for this GPU; must be at most " + std::to_string(limit) +
                         " along a side",
                     Fault::Machine};
    std::unique_ptr<WaterSheet> sheet(new WaterSheet(context, water));
    sheet->start_ = context.program("views/water_start");
    sheet->step_ = context.program("views/water_step");
    sheet->drop_ = context.program("views/water_drop");
    sheet->begin();
    return sheet;
}

WaterSheet::WaterSheet(gl::Context& context, const scene::Water& water)
    : context_(context), water_(water), cells_(waterCells(water)),
      seconds_(1.0 / scene::waterStepsPerSecond(water)) {
    const graph::TextureDesc desc{.size = cells_ + 1, .format = Format::RG32F};
    now_ = graph::Texture(context.device(), desc, "views.water");
    next_ = graph::Texture(context.device(), desc, "views.waterNext");
}

bool WaterSheet::shows(const scene::Water& water) const { return water == water_; }

graph::Block WaterSheet::block(ivec2 squares) const {
    WaterBlock block = blockFor({});
    block.squares = squares;
    return block;
}

WaterBlock WaterSheet::blockFor(const WaterDrop& drop) const {
    const vec2 cell = cellOf(water_);
    return {.sine = sineOf(water_),
            .drop = vec4(drop.place, std::max(drop.radius, 2 * std::max(cell.x, cell.y)), drop.depth),
            .size = water_.size,
            .cell = cell,
            .step = float(seconds_),
            .damping = water_.damping,
            .speed = water_.speed,
            .rest = rest_,
            .squares = cells_};
}

// Into the other image, which then is the state.
void WaterSheet::draw(const gl::Program& program, const WaterDrop& drop) {
    context_.device().runPass({.label = "views.water", .colors = {{.texture = next_.handle()}}},
                              [&](graph::Commands& commands) {
                                  graph::Draw call{.program = &program, .block = blockFor(drop)};
                                  if (&program != start_) call.textures = {{"uState", now_.handle()}};
                                  commands.draw(call);
                              });
    std::swap(now_, next_);
    ++changes_;
}

void WaterSheet::begin() {
    done_ = 0;
    rest_ = 0;
    draw(*start_, {});
}

// Drops fall between steps.
void WaterSheet::step() {
    draw(*step_, {});
    ++done_;
    if (water_.dropInterval > 0) {
        const auto fallenAfter = [&](std::int64_t steps) {
            return std::floor(double(steps) * seconds_ / double(water_.dropInterval));
        };
        const double fallen = fallenAfter(done_);
        if (fallen > fallenAfter(done_ - 1)) draw(*drop_, scene::fallingDrop(water_, fallen));
    }
    for (const Fallen& one : fallen_)
        if (one.step == done_) draw(*drop_, one.drop);
}

double WaterSheet::workUntil(float time) const {
    const double wanted = std::floor(double(time) / seconds_), done = double(done_);
    return (wanted < done ? wanted : wanted - done) * double(cells_.x) * double(cells_.y);
}

bool WaterSheet::advance(float time, int most) {
    constexpr double kRounding = 1e-5; // of a step: times come as floats
    const double steps = double(time) / seconds_;
    const auto wanted = std::int64_t(std::floor(steps + kRounding));
    if (wanted < done_) {
        std::erase_if(fallen_, [&](const Fallen& one) { return one.step > wanted; });
        begin();
        for (const Fallen& one : fallen_)
            if (one.step == 0) draw(*drop_, one.drop);
    }
    for (int i = 0; i < most && done_ < wanted; ++i)
        step();
    const float rest = done_ < wanted ? 0 : float(std::max(0.0, (steps - double(wanted)) * seconds_));
    if (rest != rest_) ++changes_;
    rest_ = rest;
    return done_ == wanted;
}

void WaterSheet::fall(const WaterDrop& drop) {
    fallen_.push_back({done_, drop});
    draw(*drop_, drop);
}

Result<bool> Waters::advance(const scene::Scene& scene) {
    const auto waterOf = [&](int object) {
        return object < int(scene.objects.size())
                   ? std::get_if<scene::Water>(&scene.objects[std::size_t(object)].shape)
                   : nullptr;
    };
    std::erase_if(sheets_, [&](const auto& entry) {
        const scene::Water* water = waterOf(entry.first);
        const bool gone = !water || !entry.second->shows(*water);
        if (gone) dropped_ += entry.second->changes();
        return gone;
    });
    bool there = true;
    for (int i = 0; i < int(scene.objects.size()); ++i) {
        const scene::Water* water = waterOf(i);
        if (!water) continue;
        std::unique_ptr<WaterSheet>& sheet = sheets_[i];
        if (!sheet) {
            Result<std::unique_ptr<WaterSheet>> made = WaterSheet::create(context_, *water);
            if (!made) {
                sheets_.erase(i);
                return made.error();
            }
            sheet = std::move(*made);
        }
        if (const double work = sheet->workUntil(scene.view.time); work > scene::kMostWaterWork)
            return scene::waterTooFarAhead(scene.objects[std::size_t(i)].name, scene.view.time, work);
        there &= sheet->advance(scene.view.time, kStepsAtOnce);
    }
    return there;
}

void Waters::fall(int object, const WaterDrop& drop) {
    const auto found = sheets_.find(object);
    assert(found != sheets_.end());
    found->second->fall(drop);
}

const WaterSheet* Waters::of(int object) const {
    const auto found = sheets_.find(object);
    return found == sheets_.end() ? nullptr : found->second.get();
}

std::uint64_t Waters::changes() const {
    std::uint64_t sum = dropped_;
    for (const auto& [object, sheet] : sheets_)
        sum += sheet->changes();
    return sum;
}

std::size_t Waters::bytes() const {
    std::size_t sum = 0;
    for (const auto& [object, sheet] : sheets_)
        sum += sheet->bytes();
    return sum;
}

Result<VertexImages> recordWater(graph::FrameGraph& graph, gl::Context& context, const WaterSheet& sheet,
                                 const scene::Object& object) {
    const gl::Program* program = context.program("views/water");
    const graph::TextureId state =
        graph.import(sheet.state().handle(), sheet.state().desc(), sheet.state().label());
    const ivec2 squares = waterCells(std::get<scene::Water>(object.shape), object.mostCells);
    const graph::Block block = sheet.block(squares);
    const graph::TextureDesc desc{.size = squares + 1, .format = Format::RGBA32F};
    VertexImages images;
    graph.addPass("views.water", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("object \"" + object.name + "\" is water: vertices from its heights");
        pass.sample(state);
        images = {pass.createColor("views.waterPositions", desc),
                  pass.createColor("views.waterNormals", desc)};
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .block = block, .textures = {{"uState", resources[state]}}});
        };
    });
    return images;
}

} // namespace lucent::views

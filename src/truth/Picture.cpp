#include "truth/Picture.h"

#include "truth/Random.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <thread>
#include <vector>

namespace lucent::truth {

namespace {
void write(const Pixel& pixel, Picture& picture, ivec2 at) {
    for (int channel = 0; channel < 3; ++channel) {
        picture.values.at(at.x, at.y)[channel] = float(pixel.value[channel]);
        picture.errors.at(at.x, at.y)[channel] = float(std::sqrt(pixel.variance[channel]));
    }
    picture.values.at(at.x, at.y)[3] = float(pixel.coverage);
}
} // namespace

Pixel PixelMean::solve(ivec2 pixel) const {
    Random random(seed_, std::uint64_t(pixel.y) << 32 | std::uint64_t(pixel.x), ~std::uint64_t(0));
    std::vector<int> rows(std::size_t(count_), 0);
    std::iota(rows.begin(), rows.end(), 0);
    for (int left = count_; left > 1; --left)
        std::swap(rows[std::size_t(left - 1)], rows[std::size_t(random.next() * left)]);
    std::vector<Pixel> places(std::size_t(count_), Pixel{});
    Pixel mean;
    for (int i = 0; i < count_; ++i) {
        Pixel& place = places[std::size_t(i)];
        place = places_->solve(count_ * pixel + ivec2(i, rows[std::size_t(i)]));
        mean.value += place.coverage * place.value;
        mean.coverage += place.coverage;
    }
    if (mean.coverage == 0) return {};
    mean.value /= mean.coverage;
    for (const Pixel& place : places) {
        const dvec3 away = place.coverage / mean.coverage * (place.value - mean.value);
        mean.variance += away * away * (double(count_) / (count_ - 1));
    }
    mean.coverage /= count_;
    return mean;
}

double Picture::standardError() const {
    double squares = 0;
    for (const float error : errors.pixels)
        squares += double(error) * double(error);
    return errors.empty() ? 0 : std::sqrt(squares / double(errors.pixels.size()));
}

Result<Picture> render(const Estimator& estimator, ivec2 size, const Tile& tile, const Work& work,
                       const std::atomic<bool>& cancel) {
    Picture picture({size.x, tile.rows(size.y)});
    std::atomic<int> nextRow = 0, doneRows = 0;
    const auto solveRows = [&](const std::function<void()>& afterRow) {
        for (int row; !cancel && (row = nextRow++) < picture.values.height; ++doneRows, afterRow())
            for (int x = 0; x < size.x && !cancel; ++x)
                write(estimator.solve({x, tile.row(row)}), picture, {x, row});
    };
    const int count =
        work.threads > 0 ? work.threads : int(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::thread> others; // the calling thread is one of them
    for (int i = 1; i < count; ++i)
        others.emplace_back([&] { solveRows([] {}); });
    work.progress(0);
    solveRows([&] { work.progress(double(doneRows) / picture.values.height); });
    for (std::thread& other : others)
        other.join();
    if (cancel) return Error{"truth: stopped before the picture was complete", Fault::Machine};
    work.progress(1);
    return picture;
}

} // namespace lucent::truth

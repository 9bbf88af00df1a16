#include "techniques/relief/Basis.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace lucent::relief {

namespace {

constexpr int kOversampling = 8;   // columns beside the wanted ones that make the randomised search sharp
constexpr int kIterations = 2;     // rounds of it
constexpr float kSmallest = 1e-5f; // components smaller than this part of the largest are rounding

const mat3 kObjectFromRings = rotationFromDegrees({37, 19, 0});

// A few rows of long vectors: all that is done here is dot products of rows and sums of rows, so this is the
// whole linear algebra that a page has to load.
struct Rows {
    int count, length;
    std::vector<float> values;

    Rows(int count, int length)
        : count(count), length(length), values(std::size_t(count) * std::size_t(length)) {}
    float* operator[](int row) { return values.data() + std::size_t(row) * std::size_t(length); }
    const float* operator[](int row) const { return values.data() + std::size_t(row) * std::size_t(length); }
};

// Four sums at once: the compiler may not reorder a single one.
float dot(const float* a, const float* b, int length) {
    float sum[4] = {};
    int i = 0;
    for (; i + 4 <= length; i += 4)
        for (int lane = 0; lane < 4; ++lane)
            sum[lane] += a[i + lane] * b[i + lane];
    for (; i < length; ++i)
        sum[0] += a[i] * b[i];
    return sum[0] + sum[1] + sum[2] + sum[3];
}

void add(float* to, float factor, const float* from, int length) {
    for (int i = 0; i < length; ++i)
        to[i] += factor * from[i];
}

// The d of the sample: rows of the image, from a column on.
struct Sample {
    const Image& image;
    int first, rows, column, length;
    const float* operator[](int row) const {
        return image.pixels.data() +
               std::size_t(first + row) * std::size_t(image.width) * std::size_t(image.channels) + column;
    }
};

// sample * vectors^T, transposed: for each vector its dot products with the sample's rows.
Rows onto(const Sample& sample, const Rows& vectors) {
    Rows result(vectors.count, sample.rows);
    for (int row = 0; row < sample.rows; ++row)
        for (int k = 0; k < vectors.count; ++k)
            result[k][row] = dot(sample[row], vectors[k], sample.length);
    return result;
}

// vectors * sample: for each vector the sum of the sample's rows that it weights.
Rows mixed(const Sample& sample, const Rows& vectors) {
    Rows result(vectors.count, sample.length);
    for (int row = 0; row < sample.rows; ++row)
        for (int k = 0; k < vectors.count; ++k)
            add(result[k], vectors[k][row], sample[row], sample.length);
    return result;
}

// Makes the rows orthonormal, or 0 where they depend on those before. Twice is enough (Kahan; Parlett 1980).
void orthonormalise(Rows& rows) {
    for (int k = 0; k < rows.count; ++k) {
        const float before = std::sqrt(dot(rows[k], rows[k], rows.length));
        for (int pass = 0; pass < 2; ++pass)
            for (int j = 0; j < k; ++j)
                add(rows[k], -dot(rows[j], rows[k], rows.length), rows[j], rows.length);
        const float after = std::sqrt(dot(rows[k], rows[k], rows.length));
        const float scale = after > 1e-5f * before ? 1 / after : 0;
        for (int i = 0; i < rows.length; ++i)
            rows[k][i] *= scale;
    }
}

// Turns the rows by plane rotations until all are perpendicular (one-sided Jacobi: Hestenes 1958), the same
// rotations on `along`, and sorts both by length, longest first.
void diagonalise(Rows& rows, Rows& along) {
    for (int sweep = 0, turned = 1; sweep < 30 && turned > 0; ++sweep) {
        turned = 0;
        for (int p = 0; p < rows.count; ++p) {
            for (int q = p + 1; q < rows.count; ++q) {
                const float a = dot(rows[p], rows[p], rows.length), b = dot(rows[q], rows[q], rows.length);
                const float c = dot(rows[p], rows[q], rows.length);
                if (std::abs(c) <= 1e-6f * std::sqrt(a * b) || c == 0) continue;
                ++turned;
                const float zeta = (b - a) / (2 * c);
                const float t = (zeta < 0 ? -1.0f : 1.0f) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
                const float cosine = 1 / std::sqrt(1 + t * t), sine = cosine * t;
                for (Rows* both : {&rows, &along}) {
                    for (int i = 0; i < both->length; ++i) {
                        const float x = (*both)[p][i], y = (*both)[q][i];
                        (*both)[p][i] = cosine * x - sine * y;
                        (*both)[q][i] = sine * x + cosine * y;
                    }
                }
            }
        }
    }
    std::vector<std::pair<float, int>> order;
    for (int k = 0; k < rows.count; ++k)
        order.push_back({-dot(rows[k], rows[k], rows.length), k});
    std::sort(order.begin(), order.end());
    for (Rows* both : {&rows, &along}) {
        Rows sorted(both->count, both->length);
        for (int k = 0; k < both->count; ++k)
            std::copy_n((*both)[order[std::size_t(k)].second], both->length, sorted[k]);
        *both = std::move(sorted);
    }
}

// What the rows are mostly made of, largest part first (randomised subspace iteration: Halko, Martinsson,
// Tropp 2011, algorithm 4.4).
struct Components {
    Rows directions;          ///< found x cells, orthonormal
    Rows rows;                ///< found x rows, orthonormal
    std::vector<float> sizes; ///< singular values; 0 for those that are rounding
};

Components principal(const Sample& sample, int wanted) {
    const int width = std::min({wanted + kOversampling, sample.rows, sample.length});
    std::mt19937 random(1); // the same basis everywhere: only the raw output is used
    Rows directions(width, sample.length);
    for (float& value : directions.values)
        value = float(random() & 0xffff) / 32767.5f - 1;
    for (int round = 0; round < kIterations; ++round) {
        Rows image = onto(sample, directions);
        orthonormalise(image);
        directions = mixed(sample, image);
        orthonormalise(directions);
    }
    Rows image = onto(sample, directions);
    diagonalise(image, directions);
    Components parts{std::move(directions), std::move(image), {}};
    for (int k = 0; k < width; ++k) {
        const float size = std::sqrt(dot(parts.rows[k], parts.rows[k], sample.rows));
        const bool counts = size > 0 && (k == 0 || size > kSmallest * parts.sizes.front());
        parts.sizes.push_back(counts ? size : 0);
        for (int i = 0; i < sample.rows; ++i)
            parts.rows[k][i] *= counts ? 1 / size : 0;
    }
    return parts;
}

// Solves matrix * x = right for several right sides at once; the matrix is symmetric and positive (Cholesky).
void solve(Rows& matrix, Rows& right) {
    const int n = matrix.count;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) {
            const float rest = matrix[i][j] - dot(matrix[i], matrix[j], j);
            matrix[i][j] = i == j ? std::sqrt(rest) : rest / matrix[j][j];
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < i; ++j)
            add(right[i], -matrix[i][j], right[j], right.length);
        for (int k = 0; k < right.length; ++k)
            right[i][k] /= matrix[i][i];
    }
    for (int i = n - 1; i >= 0; --i) {
        for (int j = i + 1; j < n; ++j)
            add(right[i], -matrix[j][i], right[j], right.length);
        for (int k = 0; k < right.length; ++k)
            right[i][k] /= matrix[i][i];
    }
}

} // namespace

Cells::Cells(int count) {
    const int rows = std::max(2, int(std::lround(std::sqrt(count * kPi / 4))));
    for (int row = 0; row < rows; ++row) {
        const double polar = (row + 0.5) * kPi / rows;
        first_.push_back(int(directions_.size()));
        columns_.push_back(std::max(3, int(std::lround(2 * rows * std::sin(polar)))));
        for (int column = 0; column < columns_.back(); ++column) {
            const double azimuth = 2 * kPi * (column + 0.5) / columns_.back();
            directions_.push_back(kObjectFromRings * vec3(std::sin(polar) * std::cos(azimuth),
                                                          std::sin(polar) * std::sin(azimuth),
                                                          std::cos(polar)));
        }
    }
}

int Cells::cellOf(vec3 direction) const {
    direction = direction * kObjectFromRings; // by the transpose: into the rings' frame
    const int rows = int(first_.size());
    const float polar = std::acos(std::clamp(direction.z, -1.0f, 1.0f));
    const int row = std::min(rows - 1, int(polar / kPi * float(rows)));
    const float turns = std::atan2(direction.y, direction.x) / (2 * kPi);
    const float inRing = turns < 0 ? turns + 1 : turns;
    const auto at = std::size_t(row);
    return first_[at] + std::min(columns_[at] - 1, int(inRing * float(columns_[at])));
}

std::vector<vec3> spiral(int count) {
    std::vector<vec3> list;
    const double golden = kPi * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, radius = std::sqrt(1 - z * z), azimuth = i * golden;
        list.push_back(vec3(radius * std::cos(azimuth), radius * std::sin(azimuth), z));
    }
    return list;
}

void Basis::learn(const Image& image, int cells, int firstSensor, int sensors, int terms) {
    const int learned = image.height - image.height / 4;
    const Sample all{image, 0, learned, 0, cells}, sensed{image, 0, learned, firstSensor, sensors};
    const Components parts = principal(all, terms);
    cells_ = cells;
    sensors_ = sensors;
    kept_ = image.height - learned;
    terms_ = int(parts.sizes.size()) < terms ? int(parts.sizes.size()) / 4 * 4 : terms;

    // The same components as they look in the sensor directions; and what the basis leaves out.
    Rows seen = mixed(sensed, parts.rows);
    double rest = 0;
    for (int row = 0; row < learned; ++row)
        rest += double(dot(all[row], all[row], cells));
    const double whole = rest;
    for (int k = 0; k < terms_; ++k) {
        const float size = parts.sizes[std::size_t(k)];
        rest -= double(size) * size;
        for (int i = 0; i < sensors; ++i)
            seen[k][i] *= size > 0 ? 1 / size : 0;
    }

    // Likeliest coefficients of a row from its values in the sensor directions: the coefficients vary as they
    // do among the rows, and what the basis leaves out is noise.
    const float noise = float(std::max(rest, 1e-9 * whole + 1e-12) / (double(learned) * cells));
    Rows normal(terms_, terms_), fit(terms_, sensors);
    for (int k = 0; k < terms_; ++k) {
        for (int j = 0; j < terms_; ++j)
            normal[k][j] = dot(seen[k], seen[j], sensors);
        const float size = parts.sizes[std::size_t(k)];
        normal[k][k] += size > 0 ? noise * float(learned) / (size * size) : 1;
        std::copy_n(seen[k], sensors, fit[k]);
    }
    solve(normal, fit);

    values_.assign(parts.directions.values.begin(),
                   parts.directions.values.begin() + std::ptrdiff_t(terms_) * cells);
    fit_ = fit.values;
    keptValues_.clear();
    keptCoefficients_.clear();
    for (int row = learned; row < image.height; ++row) {
        const float* d = Sample{image, row, 1, 0, cells}[0];
        keptValues_.insert(keptValues_.end(), d, d + cells);
        for (int k = 0; k < terms_; ++k)
            keptCoefficients_.push_back(dot(fit[k], d + firstSensor, sensors));
    }
}

Projection Basis::project(std::span<const vec4> flux, bool measures) const {
    Rows light(4, cells_); // a channel a row
    for (int cell = 0; cell < cells_; ++cell)
        for (int channel = 0; channel < 4; ++channel)
            light[channel][cell] = flux[std::size_t(cell)][channel];
    const auto along = [&](const float* values) {
        vec4 sum;
        for (int channel = 0; channel < 4; ++channel)
            sum[channel] = dot(values, light[channel], cells_);
        return sum;
    };
    Projection projection;
    for (int k = 0; k < terms_; ++k)
        projection.light.push_back(along(&values_[std::size_t(k) * std::size_t(cells_)]));
    if (!measures) return projection;

    std::vector<vec3> missing; // of each row that was kept back
    float mean = 0;
    for (int row = 0; row < kept_; ++row) {
        missing.push_back(vec3(along(&keptValues_[std::size_t(row) * std::size_t(cells_)])));
        mean += (missing.back().r + missing.back().g + missing.back().b) / float(3 * kept_);
    }
    for (int k = 0; k < terms_; ++k) {
        float square = 0;
        for (int row = 0; row < kept_; ++row) {
            const auto at = std::size_t(row);
            missing[at] -= keptCoefficients_[at * std::size_t(terms_) + std::size_t(k)] *
                           vec3(projection.light[std::size_t(k)]);
            square += glm::dot(missing[at], missing[at]) / float(3 * kept_);
        }
        if (k % 4 == 3) projection.errors.push_back(std::sqrt(square) / std::max(mean, 1e-20f));
    }
    return projection;
}

} // namespace lucent::relief

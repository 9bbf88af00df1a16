#include "base/Text.h"
#include "scene/Mesh.h"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

namespace lucent::scene {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

// Rows by columns of the picture, in double: the sums run over millions of texels.
using Field = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Cosine transforms of rows, equally fast for all lengths N, primes too: X_k = Re e(k/2) sum_n x_n e(nk) with
// e(a) = exp(-i pi a / N). As nk = (n^2 + k^2 - (k - n)^2) / 2, the sum is a convolution with a chirp
// (Bluestein 1970), done by Fourier transforms whose length is a power of two.
class CosineTransform {
public:
    explicit CosineTransform(Eigen::Index length) : length_(std::size_t(length)) {
        for (std::size_t n = 0; n < length_; ++n) {
            halfTurns_.push_back(std::polar(1.0, -kHalfTurn * double(n) / double(2 * length_)));
            // The angle is taken modulo a full turn while it is still an integer.
            chirp_.push_back(
                std::polar(1.0, -kHalfTurn * double(n * n % (4 * length_)) / double(2 * length_)));
        }
        std::vector<Complex> kernel(std::bit_ceil(2 * length_));
        for (std::size_t n = 0; n < length_; ++n)
            kernel[n] = kernel[(kernel.size() - n) % kernel.size()] = std::conj(chirp_[n]);
        fft_.fwd(kernel_, kernel);
        padded_.resize(kernel.size());
    }

    // X_k = sum_n x_n cos(pi k (2n + 1) / 2N)
    void forward(Field& field) {
        for (auto row : field.rowwise()) {
            for (std::size_t n = 0; n < length_; ++n)
                padded_[n] = row[Eigen::Index(n)];
            sum();
            for (std::size_t k = 0; k < length_; ++k)
                row[Eigen::Index(k)] = (halfTurns_[k] * padded_[k]).real();
        }
    }

    // x_n = (X_0 + 2 sum_k X_k cos(pi k (2n + 1) / 2N)) / N
    void inverse(Field& field) {
        for (auto row : field.rowwise()) {
            for (std::size_t k = 0; k < length_; ++k)
                padded_[k] = (k ? 2.0 : 1.0) / double(length_) * row[Eigen::Index(k)] * halfTurns_[k];
            sum();
            for (std::size_t n = 0; n < length_; ++n)
                row[Eigen::Index(n)] = padded_[n].real();
        }
    }

private:
    using Complex = std::complex<double>;

    // padded_[k] becomes sum_n padded_[n] exp(-i pi n k / N).
    void sum() {
        for (std::size_t n = 0; n < length_; ++n)
            padded_[n] *= chirp_[n];
        std::fill(padded_.begin() + std::ptrdiff_t(length_), padded_.end(), 0.0);
        fft_.fwd(spectrum_, padded_);
        for (std::size_t i = 0; i < kernel_.size(); ++i)
            spectrum_[i] *= kernel_[i];
        fft_.inv(padded_, spectrum_);
        for (std::size_t k = 0; k < length_; ++k)
            padded_[k] *= chirp_[k];
    }

    std::size_t length_;
    std::vector<Complex> halfTurns_, chirp_, kernel_, padded_, spectrum_;
    Eigen::FFT<double> fft_;
};

void transformColumns(Field& field, CosineTransform& transform, void (CosineTransform::*direction)(Field&)) {
    Field turned = field.transpose();
    (transform.*direction)(turned);
    field = turned.transpose();
}

// Solves for the field whose differences between neighbours, summed with signs at each texel, are
// `divergence`: the normal equations of least squares on a grid with free borders, which cosines diagonalise.
void solvePoisson(Field& divergence) {
    const Eigen::Index rows = divergence.rows(), cols = divergence.cols();
    CosineTransform alongRow(cols), alongColumn(rows);
    alongRow.forward(divergence);
    transformColumns(divergence, alongColumn, &CosineTransform::forward);
    for (Eigen::Index y = 0; y < rows; ++y)
        for (Eigen::Index x = 0; x < cols; ++x) {
            const double eigenvalue = 4 - 2 * std::cos(kHalfTurn * double(x) / double(cols)) -
                                      2 * std::cos(kHalfTurn * double(y) / double(rows));
            divergence(y, x) = x + y == 0 ? 0 : divergence(y, x) / eigenvalue; // the mean height is free
        }
    transformColumns(divergence, alongColumn, &CosineTransform::inverse);
    alongRow.inverse(divergence);
}

} // namespace

Result<Image> heightsFromNormals(const Image& normals, const std::string& name) {
    if (normals.channels < 3)
        return Error{name + ": has " + std::to_string(normals.channels) +
                     " channels; a normal map must have 3"};
    Field right(normals.height, normals.width), down = right; // slopes along the picture's x and downwards
    for (int y = 0; y < normals.height; ++y)
        for (int x = 0; x < normals.width; ++x) {
            const float* texel = normals.at(x, y);
            const dvec3 n = 2.0 * dvec3(texel[0], texel[1], texel[2]) - 1.0;
            if (!(n.z > 0) || !std::isfinite(n.x) || !std::isfinite(n.y) || !std::isfinite(n.z))
                return Error{name + ": texel (" + std::to_string(x) + ", " + std::to_string(y) +
                             ") holds the normal " + shortest(float(n.x)) + " " + shortest(float(n.y)) + " " +
                             shortest(float(n.z)) + "; must be finite with z above 0"};
            right(y, x) = -n.x / n.z;
            down(y, x) = n.y / n.z;
        }

    // The slope between two texels is the mean of theirs; each texel collects what comes in and what goes
    // out.
    Field height = Field::Zero(normals.height, normals.width);
    const auto connect = [&](int y, int x, int toY, int toX, const Field& slope) {
        const double difference = (slope(y, x) + slope(toY, toX)) / 2;
        height(toY, toX) += difference;
        height(y, x) -= difference;
    };
    for (int y = 0; y < normals.height; ++y)
        for (int x = 0; x < normals.width; ++x) {
            if (x + 1 < normals.width) connect(y, x, y, x + 1, right);
            if (y + 1 < normals.height) connect(y, x, y + 1, x, down);
        }
    solvePoisson(height);

    const double lowest = height.minCoeff();
    Image image(normals.width, normals.height, 1);
    for (int y = 0; y < normals.height; ++y)
        for (int x = 0; x < normals.width; ++x)
            *image.at(x, y) = float(height(y, x) - lowest);
    return image;
}

} // namespace lucent::scene

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

using Complex = std::complex<double>;

// exp(-i pi a / b)
Complex turned(std::size_t a, std::size_t b) { return std::polar(1.0, -kHalfTurn * double(a) / double(b)); }

// X_k = sum_n x_n exp(-2 pi i nk / N), equally fast for all lengths N, primes too. The library's own is for
// those of small factors alone. For others, as 2 nk = n^2 + k^2 - (k - n)^2, the sum is a convolution with a
// chirp (Bluestein 1970), done by transforms whose length is a power of two.
class FourierTransform {
public:
    explicit FourierTransform(std::size_t length) : length_(length) {
        std::size_t rest = length;
        for (const std::size_t factor : {2, 3, 5})
            while (rest % factor == 0)
                rest /= factor;
        if (rest == 1 && length > 1) return; // it takes no single value
        for (std::size_t n = 0; n < length;
             ++n) // the angle is taken modulo a full turn while it is still an integer
            chirp_.push_back(turned(n * n % (2 * length), length));
        std::vector<Complex> kernel(std::bit_ceil(2 * length));
        for (std::size_t n = 0; n < length; ++n)
            kernel[n] = kernel[(kernel.size() - n) % kernel.size()] = std::conj(chirp_[n]);
        fft_.fwd(kernel_, kernel);
    }

    void apply(std::vector<Complex>& values) {
        if (chirp_.empty()) {
            fft_.fwd(spectrum_, values);
            std::swap(spectrum_, values);
            return;
        }
        padded_.assign(kernel_.size(), 0.0);
        for (std::size_t n = 0; n < length_; ++n)
            padded_[n] = values[n] * chirp_[n];
        fft_.fwd(spectrum_, padded_);
        for (std::size_t i = 0; i < kernel_.size(); ++i)
            spectrum_[i] *= kernel_[i];
        fft_.inv(padded_, spectrum_);
        for (std::size_t k = 0; k < length_; ++k)
            values[k] = padded_[k] * chirp_[k];
    }

private:
    std::size_t length_;
    std::vector<Complex> chirp_, kernel_, padded_, spectrum_;
    Eigen::FFT<double> fft_;
};

// Cosine transforms of rows, by Fourier transforms of the same length (Makhoul 1980): of a row's even places
// forwards, then its odd ones backwards. Two rows are the real and the imaginary part of one.
class CosineTransform {
public:
    explicit CosineTransform(Eigen::Index length)
        : length_(std::size_t(length)), fourier_(length_), values_(length_) {
        for (std::size_t k = 0; k < length_; ++k)
            quarterTurns_.push_back(turned(k, 2 * length_));
    }

    // X_k = sum_n x_n cos(pi k (2n + 1) / 2N)
    void forward(Field& field) {
        for (Eigen::Index y = 0; y < field.rows(); y += 2) {
            const Eigen::Index next = std::min(y + 1, field.rows() - 1);
            for (std::size_t n = 0; n < length_; ++n)
                values_[n] = Complex(field(y, placeOf(n)), field(next, placeOf(n)));
            fourier_.apply(values_);
            for (std::size_t k = 0; k < length_; ++k) {
                const Complex a = values_[k], b = std::conj(values_[(length_ - k) % length_]);
                field(next, Eigen::Index(k)) = 0.5 * (quarterTurns_[k] * (a - b)).imag();
                field(y, Eigen::Index(k)) = 0.5 * (quarterTurns_[k] * (a + b)).real();
            }
        }
    }

    // x_n = (X_0 + 2 sum_k X_k cos(pi k (2n + 1) / 2N)) / N
    void inverse(Field& field) {
        const auto spectrumOf = [&](Eigen::Index y,
                                    std::size_t k) { // of a row's places as forward() takes them
            const double opposite = k ? field(y, Eigen::Index(length_ - k)) : 0;
            return std::conj(quarterTurns_[k]) * Complex(field(y, Eigen::Index(k)), -opposite);
        };
        for (Eigen::Index y = 0; y < field.rows(); y += 2) {
            const Eigen::Index next = std::min(y + 1, field.rows() - 1);
            for (std::size_t k = 0; k < length_; ++k) // conjugate, which makes it the inverse
                values_[k] =
                    std::conj(spectrumOf(y, k) + Complex(0, 1) * spectrumOf(next, k)) / double(length_);
            fourier_.apply(values_);
            for (std::size_t n = 0; n < length_; ++n) {
                field(next, placeOf(n)) = -values_[n].imag();
                field(y, placeOf(n)) = values_[n].real();
            }
        }
    }

private:
    Eigen::Index placeOf(std::size_t n) const {
        return Eigen::Index(2 * n < length_ ? 2 * n : 2 * (length_ - n) - 1);
    }

    std::size_t length_;
    FourierTransform fourier_;
    std::vector<Complex> values_, quarterTurns_;
};

void transformColumns(Field& field, CosineTransform& transform, void (CosineTransform::*direction)(Field&)) {
    Field turned = field.transpose();
    (transform.*direction)(turned);
    field = turned.transpose();
}

// The slopes of a normal map between its texels, summed with signs at each: what comes in less what goes out.
// The slope between two texels is the mean of theirs.
Result<Field> divergenceOf(const Image& normals, const std::string& name) {
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
    Field divergence = Field::Zero(normals.height, normals.width);
    const auto connect = [&](int y, int x, int toY, int toX, const Field& slope) {
        const double difference = (slope(y, x) + slope(toY, toX)) / 2;
        divergence(toY, toX) += difference;
        divergence(y, x) -= difference;
    };
    for (int y = 0; y < normals.height; ++y)
        for (int x = 0; x < normals.width; ++x) {
            if (x + 1 < normals.width) connect(y, x, y, x + 1, right);
            if (y + 1 < normals.height) connect(y, x, y + 1, x, down);
        }
    return divergence;
}

// From the spectrum of the divergence to that of the heights.
void divideByEigenvalues(Field& spectrum) {
    const Eigen::Index rows = spectrum.rows(), cols = spectrum.cols();
    for (Eigen::Index y = 0; y < rows; ++y)
        for (Eigen::Index x = 0; x < cols; ++x) {
            const double eigenvalue = 4 - 2 * std::cos(kHalfTurn * double(x) / double(cols)) -
                                      2 * std::cos(kHalfTurn * double(y) / double(rows));
            spectrum(y, x) = x + y == 0 ? 0 : spectrum(y, x) / eigenvalue; // the mean height is free
        }
}

Image aboveLowest(const Field& height) {
    const double lowest = height.minCoeff();
    Image image(int(height.cols()), int(height.rows()), 1);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            *image.at(x, y) = float(height(y, x) - lowest);
    return image;
}

} // namespace

// Solves for the field whose differences between neighbours, summed with signs at each texel, are the
// divergence: the normal equations of least squares on a grid with free borders, which cosines diagonalise.
struct NormalsIntegration::State {
    Result<Field> field; // divergence, its spectrum, that of the heights, heights
    CosineTransform alongRow{field ? field->cols() : 1}, alongColumn{field ? field->rows() : 1};
    int step = 0;

    std::optional<Image> advance() {
        switch (step++) {
        case 0:
            alongRow.forward(*field);
            break;
        case 1:
            transformColumns(*field, alongColumn, &CosineTransform::forward);
            break;
        case 2:
            divideByEigenvalues(*field);
            break;
        case 3:
            transformColumns(*field, alongColumn, &CosineTransform::inverse);
            break;
        default:
            alongRow.inverse(*field);
            return aboveLowest(*field);
        }
        return std::nullopt;
    }
};

NormalsIntegration::NormalsIntegration(const Image& normals, const std::string& name)
    : state_(std::make_unique<State>(State{divergenceOf(normals, name)})) {}
NormalsIntegration::~NormalsIntegration() = default;

std::optional<Result<Image>> NormalsIntegration::advance() {
    if (!state_->field) return Result<Image>(state_->field.error());
    std::optional<Image> heights = state_->advance();
    return heights ? std::optional<Result<Image>>(std::move(*heights)) : std::nullopt;
}

Result<Image> heightsFromNormals(const Image& normals, const std::string& name) {
    NormalsIntegration integration(normals, name);
    for (;;)
        if (std::optional<Result<Image>> made = integration.advance()) return std::move(*made);
}

} // namespace lucent::scene

#include "base/Text.h"
#include "scene/Mesh.h"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace lucent::scene {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

// Rows by columns of the picture, in double: the sums run over millions of texels.
using Field = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Cosine transform of each row. forward: X_k = sum_n x_n cos(pi k (2n + 1) / 2N). The row is mirrored to 2N
// values, whose Fourier transform is 2 exp(i pi k / 2N) X_k.
class CosineTransform {
public:
    explicit CosineTransform(Eigen::Index length) : length_(length) {
        for (Eigen::Index k = 0; k <= length; ++k)
            twist_.push_back(2.0 * std::polar(1.0, kHalfTurn * double(k) / (2.0 * double(length))));
        fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    }

    void forward(Field& field) {
        std::vector<double> mirrored(std::size_t(2 * length_));
        std::vector<std::complex<double>> spectrum;
        for (Eigen::Index row = 0; row < field.rows(); ++row) {
            for (Eigen::Index n = 0; n < length_; ++n)
                mirrored[std::size_t(n)] = mirrored[std::size_t(2 * length_ - 1 - n)] = field(row, n);
            fft_.fwd(spectrum, mirrored);
            for (Eigen::Index k = 0; k < length_; ++k)
                field(row, k) = (spectrum[std::size_t(k)] / twist_[std::size_t(k)]).real();
        }
    }

    void inverse(Field& field) {
        std::vector<double> mirrored;
        std::vector<std::complex<double>> spectrum(std::size_t(length_ + 1)); // the last stays zero
        for (Eigen::Index row = 0; row < field.rows(); ++row) {
            for (Eigen::Index k = 0; k < length_; ++k)
                spectrum[std::size_t(k)] = twist_[std::size_t(k)] * field(row, k);
            fft_.inv(mirrored, spectrum, 2 * length_);
            for (Eigen::Index n = 0; n < length_; ++n)
                field(row, n) = mirrored[std::size_t(n)];
        }
    }

private:
    Eigen::Index length_;
    std::vector<std::complex<double>> twist_;
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

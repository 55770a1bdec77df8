// LDR FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images" (Proc. ACM CGIT 3(2)). Section numbers below are
// that paper's. Filters are evaluated as two-dimensional kernels made separable: each contrast
// sensitivity filter is a sum of isotropic Gaussians, each of which separates.
//
// Deviation: at the borders the image is clamped (edge pixels repeat), as in the authors' code's
// replicate padding.
#include <array>

#include "lobelia/base/parallel.h"
#include "lobelia/film/metrics.h"

namespace lobelia {
namespace {

constexpr float kPixelsPerDegree = 67.0206f;  // 0.7 m from a 0.7 m wide 3840 pixel display

using Plane = std::vector<float>;
struct Planes {
  int width, height;
  std::array<Plane, 3> c;
  size_t size() const { return c[0].size(); }
};

// Linear RGB to XYZ (D65) and back; IEC 61966-2-1.
Vec3f rgbToXyz(Vec3f v) {
  return {0.4124564f * v.x + 0.3575761f * v.y + 0.1804375f * v.z,
          0.2126729f * v.x + 0.7151522f * v.y + 0.0721750f * v.z,
          0.0193339f * v.x + 0.1191920f * v.y + 0.9503041f * v.z};
}
Vec3f xyzToRgb(Vec3f v) {
  return {3.2404542f * v.x - 1.5371385f * v.y - 0.4985314f * v.z,
          -0.9692660f * v.x + 1.8760108f * v.y + 0.0415560f * v.z,
          0.0556434f * v.x - 0.2040259f * v.y + 1.0572252f * v.z};
}
constexpr Vec3f kWhite{0.9504700f, 1.0f, 1.0888300f};

Vec3f xyzToYcxcz(Vec3f xyz) {
  const Vec3f n = xyz / kWhite;
  return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}
Vec3f ycxczToXyz(Vec3f v) {
  const float y = (v.x + 16) / 116;
  return Vec3f{y + v.y / 500, y, y - v.z / 200} * kWhite;
}
float labCurve(float t) {
  constexpr float delta = 6.f / 29;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.f / 29;
}
Vec3f xyzToLab(Vec3f xyz) {
  const Vec3f n = xyz / kWhite;
  const float fx = labCurve(n.x), fy = labCurve(n.y), fz = labCurve(n.z);
  return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}
Vec3f huntAdjusted(Vec3f lab) { return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z}; }
float hyab(Vec3f a, Vec3f b) {
  return std::abs(a.x - b.x) + std::sqrt(sqr(a.y - b.y) + sqr(a.z - b.z));
}

using Kernel = std::vector<float>;  // odd length, centred

Plane convolve(const Plane& in, int width, int height, const Kernel& kx, const Kernel& ky) {
  Plane tmp(in.size()), out(in.size());
  const int rx = static_cast<int>(kx.size()) / 2, ry = static_cast<int>(ky.size()) / 2;
  const auto at = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  parallelFor(static_cast<size_t>(height), 8, [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      float s = 0;
      for (int k = -rx; k <= rx; ++k) {
        s += kx[static_cast<size_t>(k + rx)] * in[at(std::clamp(x + k, 0, width - 1), y)];
      }
      tmp[at(x, y)] = s;
    }
  });
  parallelFor(static_cast<size_t>(height), 8, [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      float s = 0;
      for (int k = -ry; k <= ry; ++k) {
        s += ky[static_cast<size_t>(k + ry)] * tmp[at(x, std::clamp(y + k, 0, height - 1))];
      }
      out[at(x, y)] = s;
    }
  });
  return out;
}

// Section 4.1.1, table 1: g(x) = a1 sqrt(pi/b1) exp(-pi^2 x^2 / b1) + the same with a2, b2; x in
// degrees. Normalised so that the sum over the (square) kernel is one.
struct ContrastSensitivity {
  float a1, b1, a2, b2;
};
constexpr std::array<ContrastSensitivity, 3> kSensitivity{
    {{1, 0.0047f, 0, 1e-5f}, {1, 0.0053f, 0, 1e-5f}, {34.1f, 0.04f, 13.5f, 0.025f}}};

Plane filterSensitivity(const Plane& in, int width, int height, const ContrastSensitivity& s) {
  constexpr float largestB = 0.04f;
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(largestB / (2 * kPi * kPi)) * kPixelsPerDegree));
  Plane sum(in.size(), 0.f);
  double total = 0;
  std::array<Kernel, 2> kernels;
  std::array<double, 2> amplitude{};
  for (int i = 0; i < 2; ++i) {
    const float a = i == 0 ? s.a1 : s.a2, b = i == 0 ? s.b1 : s.b2;
    amplitude[static_cast<size_t>(i)] = a * kPi / b;
    double line = 0;
    for (int k = -radius; k <= radius; ++k) {
      const float x = static_cast<float>(k) / kPixelsPerDegree;
      const float v = std::exp(-kPi * kPi * x * x / b);
      kernels[static_cast<size_t>(i)].push_back(v);
      line += v;
    }
    total += amplitude[static_cast<size_t>(i)] * line * line;
  }
  for (size_t i = 0; i < 2; ++i) {
    if (amplitude[i] == 0) continue;
    const Plane part = convolve(in, width, height, kernels[i], kernels[i]);
    const float scale = static_cast<float>(amplitude[i] / total);
    for (size_t p = 0; p < sum.size(); ++p) sum[p] += scale * part[p];
  }
  return sum;
}

Planes toYcxcz(const std::vector<uint8_t>& srgb, int width, int height) {
  Planes planes{width, height, {}};
  const size_t n = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (Plane& p : planes.c) p.resize(n);
  for (size_t i = 0; i < n; ++i) {
    Vec3f rgb;
    for (int k = 0; k < 3; ++k)
      rgb[k] = decodeSrgb(static_cast<float>(srgb[i * 3 + static_cast<size_t>(k)]) / 255);
    const Vec3f v = xyzToYcxcz(rgbToXyz(rgb));
    for (int k = 0; k < 3; ++k) planes.c[static_cast<size_t>(k)][i] = v[k];
  }
  return planes;
}

// Section 4.1: filtered, clamped to the RGB cube, to Hunt-adjusted L*a*b*.
std::vector<Vec3f> perceived(const Planes& in) {
  std::array<Plane, 3> filtered;
  for (size_t k = 0; k < 3; ++k)
    filtered[k] = filterSensitivity(in.c[k], in.width, in.height, kSensitivity[k]);
  std::vector<Vec3f> out(in.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const Vec3f rgb = xyzToRgb(ycxczToXyz({filtered[0][i], filtered[1][i], filtered[2][i]}));
    const Vec3f clamped = min(max(rgb, Vec3f(0.f)), Vec3f(1.f));
    out[i] = huntAdjusted(xyzToLab(rgbToXyz(clamped)));
  }
  return out;
}

// Section 4.2: lengths of the responses of first (edges) and second (points) Gaussian derivatives
// of a feature width of 0.082 degrees; positive and negative parts sum to one each.
struct Features {
  Plane edges, points;
};
Features features(const Planes& in) {
  const float sigma = 0.5f * 0.082f * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  Kernel g, d1, d2;
  for (int k = -radius; k <= radius; ++k) {
    const float x = static_cast<float>(k), e = std::exp(-x * x / (2 * sigma * sigma));
    g.push_back(e);
    d1.push_back(-x * e);
    d2.push_back((x * x / (sigma * sigma) - 1) * e);
  }
  const auto normalise = [](Kernel& k, float gaussSum) {
    float positive = 0, negative = 0;
    for (float v : k) (v > 0 ? positive : negative) += std::abs(v);
    for (float& v : k) v /= (v > 0 ? positive : negative) * gaussSum;
  };
  float gaussSum = 0;
  for (float v : g) gaussSum += v;
  normalise(d1, gaussSum);
  normalise(d2, gaussSum);
  Plane y = in.c[0];
  for (float& v : y) v = (v + 16) / 116;
  const auto magnitude = [&](const Kernel& d) {
    Plane dx = convolve(y, in.width, in.height, d, g);
    const Plane dy = convolve(y, in.width, in.height, g, d);
    for (size_t i = 0; i < dx.size(); ++i) dx[i] = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i]);
    return dx;
  };
  return {magnitude(d1), magnitude(d2)};
}

// Section 4.1.3: differences redistributed so that the largest common ones use the range [.95, 1].
float redistribute(float difference, float largest) {
  constexpr float pc = 0.4f, pt = 0.95f;
  const float knee = pc * largest;
  return difference < knee ? pt / knee * difference
                           : pt + (difference - knee) / (largest - knee) * (1 - pt);
}

}  // namespace

std::vector<float> flipMap(const std::vector<uint8_t>& image, const std::vector<uint8_t>& reference,
                           int width, int height) {
  constexpr float qc = 0.7f, qf = 0.5f;
  const Planes a = toYcxcz(image, width, height), b = toYcxcz(reference, width, height);
  const std::vector<Vec3f> colourA = perceived(a), colourB = perceived(b);
  const Features fa = features(a), fb = features(b);
  const Vec3f green = huntAdjusted(xyzToLab(rgbToXyz({0, 1, 0})));
  const Vec3f blue = huntAdjusted(xyzToLab(rgbToXyz({0, 0, 1})));
  const float largest = std::pow(hyab(green, blue), qc);
  std::vector<float> map(colourA.size());
  for (size_t i = 0; i < map.size(); ++i) {
    const float colour = redistribute(std::pow(hyab(colourA[i], colourB[i]), qc), largest);
    const float edge = std::abs(fa.edges[i] - fb.edges[i]),
                point = std::abs(fa.points[i] - fb.points[i]);
    const float feature = std::pow(std::max(edge, point) / std::sqrt(2.f), qf);
    map[i] = std::pow(std::clamp(colour, 0.f, 1.f), 1 - std::clamp(feature, 0.f, 1.f));
  }
  return map;
}

std::vector<float> flipMap(const Film& image, const Film& reference) {
  const ToneCurve curve = measureToneCurve(reference, {});
  return flipMap(toneMap(image, curve), toneMap(reference, curve), image.width, image.height);
}

std::vector<uint8_t> differencePicture(const Film& image, const Film& reference) {
  const std::vector<float> map = flipMap(image, reference);
  // Black through violet, orange and yellow to white: lightness rises with the error.
  constexpr std::array<Vec3f, 6> stops{{{0, 0, 0.02f},
                                        {0.27f, 0.06f, 0.42f},
                                        {0.63f, 0.17f, 0.39f},
                                        {0.93f, 0.41f, 0.15f},
                                        {0.98f, 0.75f, 0.14f},
                                        {0.99f, 1, 0.85f}}};
  std::vector<uint8_t> out(map.size() * 3);
  for (size_t i = 0; i < map.size(); ++i) {
    const float t = std::clamp(map[i], 0.f, 1.f) * (stops.size() - 1);
    const size_t s = std::min(static_cast<size_t>(t), stops.size() - 2);
    const Vec3f c = lerp(stops[s], stops[s + 1], t - static_cast<float>(s));
    for (int k = 0; k < 3; ++k)
      out[i * 3 + static_cast<size_t>(k)] = static_cast<uint8_t>(c[k] * 255 + 0.5f);
  }
  return out;
}

}  // namespace lobelia

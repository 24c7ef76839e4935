#include "world/propagation/reflection.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "world/gnss/constants.hpp"
#include "world/scene/scene_path.hpp"

namespace skyloop::inline world {
namespace {

constexpr double vacuum_permittivity = 8.8541878128e-12;  // F/m, CODATA 2018

constexpr std::array<SurfaceMaterial, 9> p2040_materials{{{"concrete", 5.24, 0, 0.0462, 0.7822},
                                                          {"brick", 3.91, 0, 0.0238, 0.16},
                                                          {"glass", 6.31, 0, 0.0036, 1.3394},
                                                          {"wood", 1.99, 0, 0.0047, 1.0718},
                                                          {"marble", 7.074, 0, 0.0055, 0.9262},
                                                          {"metal", 1, 0, 1e7, 0},
                                                          {"dry-ground", 3, 0, 0.00015, 2.52},
                                                          {"medium-ground", 15, -0.1, 0.035, 1.63},
                                                          {"wet-ground", 30, -0.4, 0.15, 1.30}}};

}  // namespace

std::span<const SurfaceMaterial> surface_materials() { return p2040_materials; }

std::optional<SurfaceMaterial> surface_material(std::string_view name) {
    const auto found = std::find_if(p2040_materials.begin(), p2040_materials.end(),
                                    [&](const SurfaceMaterial& material) { return material.name == name; });
    if (found == p2040_materials.end()) return std::nullopt;
    return *found;
}

double permittivity_p2040(const SurfaceMaterial& material, Hertz carrier) {
    return material.a * std::pow(carrier.value() / 1e9, material.b);
}

double conductivity_p2040(const SurfaceMaterial& material, Hertz carrier) {
    return material.c * std::pow(carrier.value() / 1e9, material.d);
}

std::complex<double> complex_permittivity_p2040(const SurfaceMaterial& material, Hertz carrier) {
    return {permittivity_p2040(material, carrier),
            -conductivity_p2040(material, carrier) / (2 * std::numbers::pi * carrier.value() * vacuum_permittivity)};
}

Decibels FresnelReflection::power_loss() const {
    return Decibels(-10 * std::log10((std::norm(te) + std::norm(tm)) / 2));
}

FresnelReflection fresnel_reflection(std::complex<double> permittivity, Angle incidence) {
    const double cosine = std::cos(incidence.rad()), sine = std::sin(incidence.rad());
    const std::complex<double> inside = std::sqrt(permittivity - sine * sine);
    return {(cosine - inside) / (cosine + inside), (permittivity * cosine - inside) / (permittivity * cosine + inside)};
}

double roughness_factor(Metres rms_height, Angle incidence, Hertz carrier) {
    const double wavelength = speed_of_light / carrier.value();
    const double phase = 2 * std::numbers::pi * rms_height.value() * std::cos(incidence.rad()) / wavelength;
    return std::exp(-2 * phase * phase);
}

namespace {

using Field = Eigen::Vector3cd;
constexpr std::complex<double> imaginary_unit{0, 1};

// The waves that an antenna pointing up hears best and least from direction d: (φ̂ ∓ jθ̂)/√2, turned so that they are
// continuous around the zenith.
struct CircularBasis {
    explicit CircularBasis(const Eigen::Vector3d& d) {
        const double azimuth = std::atan2(d.y(), d.x());
        const double across = std::hypot(d.x(), d.y());
        const Eigen::Vector3d down(d.z() * std::cos(azimuth), d.z() * std::sin(azimuth), -across);
        const Eigen::Vector3d around(-std::sin(azimuth), std::cos(azimuth), 0);
        const std::complex<double> turn = std::polar(std::sqrt(0.5), azimuth);
        right = (around.cast<std::complex<double>>() - imaginary_unit * down) * turn;
        left = (around.cast<std::complex<double>>() + imaginary_unit * down) * std::conj(turn);
    }
    Field right, left;
};

// Unit, in the plane of the surface and across the plane of incidence; any in it from straight ahead.
Eigen::Vector3d across_incidence(const Eigen::Vector3d& normal, const Eigen::Vector3d& towards) {
    const Eigen::Vector3d across = normal.cross(towards);
    return across.norm() > 1e-9 ? Eigen::Vector3d(across.normalized()) : normal.unitOrthogonal();
}

}  // namespace

CircularWave reflected_wave(std::span<const ReflectingSurface> surfaces, const Eigen::Vector3d& arrival, Hertz carrier,
                            Metres roughness) {
    std::vector<Eigen::Vector3d> towards{arrival};  // before each reflection, as seen from the antenna
    for (const ReflectingSurface& surface : surfaces)
        towards.push_back(mirrored(surface.normal, towards.back()));
    Field field = CircularBasis(towards.back()).right;
    for (std::size_t i = surfaces.size(); i-- > 0;) {
        const ReflectingSurface& surface = surfaces[i];
        const Eigen::Vector3d in = -towards[i + 1], out = -towards[i];
        const double cosine = std::min(std::abs(surface.normal.dot(in)), 1.0);
        const Angle incidence = Angle::radians(std::acos(cosine));
        const FresnelReflection wall = fresnel_reflection(surface.permittivity, incidence);
        const Eigen::Vector3d across = across_incidence(surface.normal, in);
        const std::complex<double> te = wall.te * across.cast<std::complex<double>>().dot(field);
        const std::complex<double> tm = wall.tm * across.cross(in).cast<std::complex<double>>().dot(field);
        field = (te * across + tm * across.cross(out)) * roughness_factor(roughness, incidence, carrier);
    }
    const CircularBasis antenna(arrival);
    return {antenna.right.dot(field), antenna.left.dot(field)};
}

std::complex<double> heard_by_right_hand(const CircularWave& wave, Decibels rejection) {
    const std::complex<double> left = wave.left * std::pow(10, -rejection.value() / 20);
    const double phase = std::arg(std::abs(wave.right) >= std::abs(left) ? wave.right : left);
    return std::polar(std::hypot(std::abs(wave.right), std::abs(left)), phase);
}

}  // namespace skyloop::inline world

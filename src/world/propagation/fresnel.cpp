#include "world/propagation/fresnel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop {
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

}  // namespace skyloop

#include "world/gnss/nequick_g.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"
#include "detail/nequick_profile.hpp"

namespace skyloop::inline world {
namespace {

// `count` numbers between spaces, commas and line ends.
Result<std::vector<double>> nequick_numbers(std::string_view text, std::string_view name, std::size_t count) {
    std::vector<double> numbers;
    int line = 1;
    for (std::size_t at = 0; at < text.size();) {
        if (std::string_view(" ,\t\r\n").find(text[at]) != std::string_view::npos) {
            line += text[at++] == '\n';
            continue;
        }
        const std::size_t end = std::min(text.find_first_of(" ,\t\r\n", at), text.size());
        const std::string_view word = text.substr(at, std::min<std::size_t>(end - at, 40));
        const auto value = number_in<double>(word);
        if (!value || word.size() != end - at)
            return fail(ErrorCode::input, fmt::format("{}:{}: found something that is no number; expected {} numbers",
                                                      name, line, count));
        numbers.push_back(*value);
        if (numbers.size() > count)
            return fail(ErrorCode::input, fmt::format("{}:{}: found more; expected {} numbers", name, line, count));
        at = end;
    }
    if (numbers.size() < count)
        return fail(ErrorCode::input,
                    fmt::format("{}:{}: found {} numbers; expected {}", name, line, numbers.size(), count));
    return numbers;
}

template <std::size_t Places, std::size_t Times>
void fill_map(CcirMonth::Map<Places, Times>& map, std::vector<double>::const_iterator& next) {
    for (auto& activity : map)
        for (auto& place : activity)
            for (double& time : place)
                time = *next++;
}

// Third-order interpolation between the inner two of four equally spaced values, at 0 … 1.
double nequick_interpolation(const std::array<double, 4>& z, double x) {
    if (std::abs(2 * x) < 1e-10) return z[1];
    const double d = 2 * x - 1;
    const double g1 = z[2] + z[1], g2 = z[2] - z[1], g3 = z[3] + z[0], g4 = (z[3] - z[0]) / 3;
    return (9 * g1 - g3 + d * (9 * g2 - g4 + d * (g3 - g1 + d * (g4 - g2)))) / 16;
}

}  // namespace

Result<CcirMonth> read_ccir_month(std::string_view text, std::string_view name) {
    const auto numbers = nequick_numbers(text, name, 2 * 76 * 13 + 2 * 49 * 9);
    if (!numbers) return fail(numbers.error());
    CcirMonth month;
    auto next = numbers->begin();
    fill_map(month.critical_frequency, next);
    fill_map(month.transmission_factor, next);
    return month;
}

Result<ModipGrid> read_modip_grid(std::string_view text, std::string_view name) {
    const auto numbers = nequick_numbers(text, name, ModipGrid::size * ModipGrid::size);
    if (!numbers) return fail(numbers.error());
    ModipGrid grid;
    for (std::size_t i = 0; i < numbers->size(); ++i)
        grid.degrees[i / ModipGrid::size][i % ModipGrid::size] = (*numbers)[i];
    return grid;
}

Angle modified_dip_latitude(const ModipGrid& grid, Angle latitude, Angle longitude) {
    const double last_row = static_cast<double>(ModipGrid::size) - 2;
    const double row = std::clamp((latitude.deg() + 95) / 5, 1.0, last_row);
    double turned = std::fmod(longitude.deg() + 180, 360.0);
    if (turned < 0) turned += 360;
    const double column = 1 + std::min(turned / 10, std::nextafter(36.0, 0.0));
    // The row of the pole itself is the upper one of its interval.
    const auto i = std::min(static_cast<std::size_t>(row), ModipGrid::size - 3);
    const auto j = static_cast<std::size_t>(column);
    std::array<double, 4> across{};
    for (std::size_t k = 0; k < 4; ++k) {
        const auto value = [&](std::size_t r) { return grid.degrees[r][j - 1 + k]; };
        across[k] =
            nequick_interpolation({value(i - 1), value(i), value(i + 1), value(i + 2)}, row - static_cast<double>(i));
    }
    return Angle::degrees(nequick_interpolation(across, column - static_cast<double>(j)));
}

Result<NequickTables> read_nequick_tables(const std::filesystem::path& folder, int month) {
    if (month < 1 || month > 12) return fail(ErrorCode::usage, fmt::format("found month {}; expected 1 to 12", month));
    const auto modip = read_text_with(folder / "modipNeQG_wrapped.asc", read_modip_grid);
    if (!modip) return fail(modip.error());
    const auto ccir = read_text_with(folder / fmt::format("ccir{}.asc", month + 10), read_ccir_month);
    if (!ccir) return fail(ccir.error());
    return NequickTables{month, *modip, *ccir};
}

namespace {

constexpr double nequick_earth_radius = 6371.2;  // km

Eigen::Vector3d nequick_point(const Geodetic& place) {
    const double r = nequick_earth_radius + place.height.above_ellipsoid.value() / 1000;
    const double latitude = place.latitude.rad(), longitude = place.longitude.rad();
    return r * Eigen::Vector3d(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                               std::sin(latitude));
}

// Nodes and weights on [−1, 1], positive half (Kronrod 1965; QUADPACK, qk15).
struct KronrodPoint {
    double node, kronrod, gauss;
};
constexpr std::array<KronrodPoint, 8> kronrod_points{
    {{0, 0.209482141084727828012999174891714, 0.417959183673469387755102040816327},
     {0.207784955007898467600689403773245, 0.204432940075298892414161999234649, 0},
     {0.405845151377397166906606412076961, 0.190350578064785409913256402421014, 0.381830050505118944950369775488975},
     {0.586087235467691130294144838258730, 0.169004726639267902826583426598550, 0},
     {0.741531185599394439863864773280788, 0.140653259715525918745189590510238, 0.279705391489276667901467771423780},
     {0.864864423359769072789712788640926, 0.104790010322250183839876322541518, 0},
     {0.949107912342758524526189684047851, 0.063092092629978553290700663189204, 0.129484966168869693270611432679082},
     {0.991455371120812639206854697526329, 0.022935322010529224963732008058970, 0}}};

// A straight ray, by the distance in km from its point nearest to the centre of the Earth.
class NequickRay {
public:
    NequickRay(const NequickTables& tables, const NequickConditions& conditions, const Eigen::Vector3d& from,
               const Eigen::Vector3d& to)
        : tables_(tables), conditions_(conditions), direction_((to - from).normalized()) {
        nearest_ = from - from.dot(direction_) * direction_;
    }

    [[nodiscard]] double distance_at_height(double height_km) const {
        const double r = nequick_earth_radius + height_km;
        return std::sqrt(std::max(r * r - nearest_.squaredNorm(), 0.0));
    }

    // Electrons along the ray, 1e11/m³ · km; intervals are halved until two quadratures agree.
    [[nodiscard]] double integral(double from, double to, double tolerance, int depth = 0) const {
        constexpr int deepest = 50;
        const double middle = (from + to) / 2, half = (to - from) / 2;
        double kronrod = 0, gauss = 0;
        for (const KronrodPoint& point : kronrod_points) {
            double value = density(middle + half * point.node);
            if (point.node > 0) value += density(middle - half * point.node);
            kronrod += point.kronrod * value;
            gauss += point.gauss * value;
        }
        // Asked so that a density which is no number ends the halving, too.
        const bool apart = std::abs(kronrod - gauss) > tolerance * std::abs(kronrod);
        if (!apart || depth == deepest) return kronrod * half;
        return integral(from, middle, tolerance, depth + 1) + integral(middle, to, tolerance, depth + 1);
    }

private:
    [[nodiscard]] double density(double distance) const {
        const Eigen::Vector3d point = nearest_ + distance * direction_;
        const double r = point.norm();
        const double latitude = std::asin(std::clamp(point.z() / r, -1.0, 1.0));
        const double longitude = std::atan2(point.y(), point.x());
        const Angle modip = modified_dip_latitude(tables_.modip, Angle::radians(latitude), Angle::radians(longitude));
        return NequickProfile(conditions_, {modip.rad(), latitude, longitude}).density(r - nequick_earth_radius);
    }

    const NequickTables& tables_;
    const NequickConditions& conditions_;
    Eigen::Vector3d direction_;
    Eigen::Vector3d nearest_;
};

}  // namespace

double nequick_ionisation(const EffectiveIonisation& b, Angle modified_dip_latitude) {
    if (!b.given()) return default_ionisation_level;
    const double mu = modified_dip_latitude.deg();
    return std::clamp(b.a0 + b.a1 * mu + b.a2 * mu * mu, 0.0, 400.0);
}

Tecu nequick_slant_content(const NequickTables& tables, const EffectiveIonisation& broadcast, const Geodetic& receiver,
                           const Geodetic& satellite, double ut_hours) {
    const Angle modip = modified_dip_latitude(tables.modip, receiver.latitude, receiver.longitude);
    const NequickConditions conditions(tables, nequick_ionisation(broadcast, modip), ut_hours);
    const NequickRay ray(tables, conditions, nequick_point(receiver), nequick_point(satellite));

    // The tolerances of the document: finer below 1000 km.
    const double low = std::max(receiver.height.above_ellipsoid.value() / 1000, 0.0);
    const double high = satellite.height.above_ellipsoid.value() / 1000;
    double content = 0, from = low;
    for (const auto& [end, tolerance] : {std::pair{1000.0, 0.001}, std::pair{2000.0, 0.01}, std::pair{high, 0.01}}) {
        const double to = std::min(end, high);
        if (to <= from) continue;
        content += ray.integral(ray.distance_at_height(from), ray.distance_at_height(to), tolerance);
        from = to;
    }
    return Tecu(content * 1e11 * 1e3 / 1e16);
}

}  // namespace skyloop::inline world

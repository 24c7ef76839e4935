#include "world/gnss/nequick_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/core/number_in.hpp"
#include "base/core/text_file.hpp"

namespace skyloop {
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
    const std::filesystem::path modip_path = folder / "modipNeQG_wrapped.asc";
    const auto modip_text = read_text_file(modip_path);
    if (!modip_text) return fail(modip_text.error());
    auto modip = read_modip_grid(*modip_text, modip_path.string());
    if (!modip) return fail(modip.error());
    const std::filesystem::path ccir_path = folder / fmt::format("ccir{}.asc", month + 10);
    const auto ccir_text = read_text_file(ccir_path);
    if (!ccir_text) return fail(ccir_text.error());
    auto ccir = read_ccir_month(*ccir_text, ccir_path.string());
    if (!ccir) return fail(ccir.error());
    return NequickTables{month, *modip, *ccir};
}

}  // namespace skyloop

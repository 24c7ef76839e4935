#include "detail/reference_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include "base/core/letter_case.hpp"
#include "world/city/city_file.hpp"

namespace skyloop {

namespace {

bool is_decimal(char c) { return c >= '0' && c <= '9'; }

/// The last number of a text.
std::optional<int> last_number(std::string_view text) {
    while (!text.empty() && !is_decimal(text.back()))
        text.remove_suffix(1);
    std::size_t first = text.size();
    while (first > 0 && is_decimal(text[first - 1]))
        --first;
    int number = 0;
    const auto [rest, error] = std::from_chars(text.data() + first, text.data() + text.size(), number);
    return error == std::errc() ? std::optional<int>(number) : std::nullopt;
}

/// Of the first system that a name holds, before which may stand a version, and of the heights behind it.
std::string epsg_definition(std::string_view lower) {
    const std::size_t start = lower.find("epsg");
    if (start == std::string_view::npos) return {};
    const std::size_t end = std::min(lower.find_first_of(",&+; ", start), lower.size());
    const auto code = last_number(lower.substr(start, end - start)), heights = last_number(lower.substr(end));
    if (!code) return {};
    return heights ? fmt::format("EPSG:{}+{}", *code, *heights) : fmt::format("EPSG:{}", *code);
}

/// Names of Germany's surveying authorities (AdV, GeoInfoDok): "urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH" is UTM,
/// "DE_DHDN_3GK4" Gauss and Krueger's fourth zone, and behind the asterisk stand heights.
std::string adv_definition(std::string_view lower) {
    for (const auto& [map, digits, code, first, last] :
         {std::tuple("etrs89_utm", 2, 25800, 28, 38), std::tuple("de_dhdn_3gk", 1, 31464, 2, 5)}) {
        const std::size_t start = lower.find(map);
        if (start == std::string_view::npos) continue;
        const std::size_t end = start + std::string_view(map).size() + static_cast<std::size_t>(digits);
        const std::optional<int> zone = last_number(lower.substr(start, end - start));
        if (!zone || *zone < first || *zone > last) continue;
        const std::string_view heights = lower.substr(std::min(lower.find('*', start), lower.size()));
        const bool old = heights.find("dhhn92") != std::string_view::npos;
        return fmt::format("EPSG:{}{}", code + *zone, heights.empty() ? "" : old ? "+5783" : "+7837");
    }
    return {};
}

}  // namespace

std::optional<ReferenceSystem> reference_system(std::string_view name) {
    if (name.empty()) return std::nullopt;
    const std::string lower = lower_case(name);
    const bool wkt = name.find_first_of("[{") != std::string_view::npos;  // or JSON: names other systems inside
    if (!wkt && lower.find("crs84") != std::string::npos) return wgs84_degrees("OGC:CRS84");
    std::string definition = wkt ? "" : adv_definition(lower);
    if (!wkt && definition.empty()) definition = epsg_definition(lower);
    ReferenceSystem system;
    system.name = definition.empty() ? std::string(name) : definition;
    if (system.name == "EPSG:4326" || system.name == "EPSG:4979") {
        system.kind = CoordinateKind::geographic;
        system.north_first = true;
        return system;
    }
    auto map = EarthMap::open(system.name);
    if (!map) {
        system.unknown = map.error();
        return system;
    }
    system.map = std::move(*map);
    if (system.map->geographic) system.kind = CoordinateKind::geographic;
    const bool strict = lower.starts_with("urn:ogc") || lower.find("/def/crs") != std::string::npos;
    system.north_first = system.map->north_first && (strict || system.map->geographic);
    return system;
}

std::optional<ReferenceSystem> reference_system_of_file(std::string_view name, const CityFileSettings& settings) {
    if (settings.file_crs.empty()) return reference_system(name);
    if (settings.file_crs == "local") return unnamed_system(CoordinateKind::projected, "local");
    return reference_system(settings.file_crs);
}

Result<void> check_file_crs(std::string_view name) {
    if (name == "local") return {};
    const auto system = reference_system(name);
    if (!system) return fail(ErrorCode::usage, "is empty; expected a reference system, such as EPSG:25832");
    if (!system->unknown) return {};
    if (system->unknown->code == ErrorCode::outside) return fail(*system->unknown);
    return fail(ErrorCode::usage,
                fmt::format("'{}' {}; expected one such as EPSG:25832, EPSG:7415 or EPSG:25832+7837, or local", name,
                            system->unknown->message));
}

}  // namespace skyloop

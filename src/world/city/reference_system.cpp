#include "detail/reference_system.hpp"
#include "base/core/lowered_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "detail/city_text.hpp"

namespace skyloop {

namespace {

/// Geographic systems of the EPSG registry whose difference from WGS-84 is no more than a metre or two, of two and of
/// three dimensions and with heights above the sea; axes latitude, longitude [height]. Sorted.
constexpr std::array geographic_codes{
    3823, 3824, 4046, 4148, 4152, 4167, 4171, 4173, 4190, 4258, 4269, 4283, 4326, 4480, 4482, 4483, 4490, 4612,
    4617, 4619, 4627, 4661, 4669, 4670, 4674, 4686, 4694, 4737, 4742, 4749, 4755, 4757, 4759, 4764, 4893, 4898,
    4907, 4921, 4927, 4929, 4937, 4939, 4941, 4943, 4947, 4949, 4951, 4955, 4957, 4959, 4961, 4965, 4971, 4977,
    4979, 4983, 4989, 4997, 5340, 5342, 5359, 5360, 5380, 5381, 5392, 5393, 5488, 5489, 5498, 5499, 5500, 5628,
    5942, 6144, 6318, 6319, 6321, 6322, 6324, 6325, 6349, 6364, 6365, 6649, 6667, 6668, 6696, 6697, 6705, 6706,
    6782, 6783, 7409, 7423, 7661, 7663, 7665, 7678, 7680, 7842, 7843, 7844, 7909, 7910, 7911, 7912, 7931, 8231,
    8232, 8235, 8237, 8239, 8240, 8244, 8246, 8248, 8249, 8251, 8252, 8254, 8255, 8360, 8426, 8427, 8542, 8544,
    8545, 8860, 8888, 8948, 8949, 8997, 8998, 8999, 9000, 9053, 9054, 9055, 9056, 9057, 9067, 9147, 9148, 9152,
    9153, 9286, 9422, 9423, 9424, 9449, 9450, 9462, 9463, 9464, 9469, 9470, 9474, 9475, 9500, 9505, 9518, 9701,
    9702, 9705, 9754, 9755, 9776, 9777, 9781, 9782, 9989, 9990};
static_assert(std::is_sorted(geographic_codes.begin(), geographic_codes.end()));
/// The same with axes longitude, latitude.
constexpr std::array longitude_first_codes{7036, 7037, 7042, 7084, 7085, 7086, 9778, 9779, 9783, 9784};

/// Compounds of a horizontal system with heights above the sea. Sorted.
constexpr std::array sea_level_codes{5498, 5499, 5500, 5554, 5555, 5556, 5628, 5698, 5699, 5942, 5971, 5972, 5973,
                                     5974, 5975, 5976, 6144, 6349, 6649, 6696, 6697, 7409, 7423, 8360, 9286, 9422,
                                     9423, 9424, 9449, 9450, 9462, 9463, 9464, 9500, 9505, 9518, 9705};
static_assert(std::is_sorted(sea_level_codes.begin(), sea_level_codes.end()));

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

/// The code of the first system that a name holds, before which may stand a version, and that of heights behind it.
struct EpsgName {
    std::optional<int> code, heights;
};
EpsgName epsg_name(std::string_view name) {
    const std::string lower = lowered_text(name);
    const std::size_t start = lower.find("epsg");
    if (start == std::string::npos) return {};
    const std::size_t end = std::min(lower.find_first_of(",&+; ", start), lower.size());
    const std::string_view all = lower;
    return {last_number(all.substr(start, end - start)), last_number(all.substr(end))};
}

/// Names of Germany's surveying authorities (AdV, GeoInfoDok): "urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH" is UTM, and
/// behind the asterisk stand heights.
std::optional<ReferenceSystem> adv_system(std::string_view name) {
    const std::size_t start = lowered_text(name).find("etrs89_utm");
    if (start == std::string::npos) return std::nullopt;
    constexpr std::size_t length = 12;  // with the zone
    const std::optional<int> zone = last_number(name.substr(start, length));
    if (!zone || *zone < 28 || *zone > 38) return std::nullopt;
    ReferenceSystem system;
    system.code = 25800 + *zone;
    system.name = shown(name.substr(start));
    system.sea_level = name.find('*', start) != std::string_view::npos;
    return system;
}

}  // namespace

std::optional<ReferenceSystem> reference_system(std::string_view name) {
    if (name.empty()) return std::nullopt;
    if (lowered_text(name).find("crs84") != std::string::npos)
        return ReferenceSystem{CoordinateKind::geographic, false, "OGC:CRS84", {}};
    if (auto system = adv_system(name)) return system;
    const auto [code, heights] = epsg_name(name);
    if (!code) return ReferenceSystem{CoordinateKind::projected, false, shown(name), {}};
    ReferenceSystem system;
    system.code = code;
    system.name = heights ? fmt::format("EPSG:{}+{}", *code, *heights) : fmt::format("EPSG:{}", *code);
    system.sea_level = heights || std::binary_search(sea_level_codes.begin(), sea_level_codes.end(), *code);
    const bool turned = std::binary_search(longitude_first_codes.begin(), longitude_first_codes.end(), *code);
    system.latitude_first = std::binary_search(geographic_codes.begin(), geographic_codes.end(), *code);
    if (turned || system.latitude_first) system.kind = CoordinateKind::geographic;
    return system;
}

}  // namespace skyloop

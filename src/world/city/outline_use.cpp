#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/core/words.hpp"
#include "detail/outlines.hpp"

namespace skyloop::inline world {

namespace {

constexpr double tallest = 1000;  ///< m
constexpr double foot = 0.3048;   ///< m

bool is_digit(std::string_view text, std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; }

/// Takes a number off the front of a text. A comma between digits is taken for a point, as much of Europe writes.
std::optional<double> take_tag_number(std::string_view& text) {
    std::string plain(text);
    const std::size_t comma = text.find_first_not_of("0123456789");
    if (comma != 0 && comma != std::string_view::npos && text[comma] == ',' && is_digit(text, comma + 1))
        plain[comma] = '.';
    double value = 0;
    const auto [rest, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(rest - plain.data()));
    text = trimmed(text);
    return value;
}

std::string_view tag(const OutlineTags& tags, std::string_view key) {
    const auto found = tags.find(key);
    return found == tags.end() ? std::string_view() : std::string_view(found->second);
}

/// The first of some keys that tells a length of at least so much.
template <std::size_t n>
std::optional<double> first_length(const OutlineTags& tags, const std::array<std::string_view, n>& keys,
                                   double least = 0) {
    for (const std::string_view key : keys)
        if (const auto length = length_of_tag(tag(tags, key)); length && *length >= least) return length;
    return std::nullopt;
}
/// The same of what stands above the ground: 0 is how tables write that they do not know.
template <std::size_t n>
std::optional<double> first_height(const OutlineTags& tags, const std::array<std::string_view, n>& keys) {
    return first_length(tags, keys, 1e-3);
}

constexpr std::array<std::string_view, 7> height_keys{
    "height", "building:height", "render_height", "measuredheight", "building_height", "hoehe", "est_height"};
constexpr std::array<std::string_view, 3> base_keys{"min_height", "building:min_height", "render_min_height"};
constexpr std::array<std::string_view, 7> level_keys{"building:levels", "levels",  "num_floors",     "floors",
                                                     "storeys",         "stories", "building_levels"};
constexpr std::array<std::string_view, 3> base_level_keys{"building:min_level", "min_level", "min_floor"};
constexpr std::array<std::string_view, 2> buried_level_keys{"building:levels:underground", "num_floors_underground"};
/// Of the roof alone, which levels do not count.
constexpr std::array<std::string_view, 2> roof_height_keys{"roof:height", "roof_height"};
constexpr std::array<std::string_view, 1> roof_level_keys{"roof:levels"};
constexpr std::array<std::string_view, 4> material_keys{"building:material", "building:facade:material",
                                                        "building:cladding", "material"};

/// Words of tags and the names of surface_material().
constexpr std::array<std::array<std::string_view, 2>, 26> material_words{
    {{"glass", "glass"},        {"mirror", "glass"},
     {"brick", "brick"},        {"bricks", "brick"},
     {"brickwork", "brick"},    {"clay", "brick"},
     {"tiles", "brick"},        {"cement_block", "concrete"},
     {"concrete", "concrete"},  {"reinforced_concrete", "concrete"},
     {"plaster", "concrete"},   {"stucco", "concrete"},
     {"stone", "marble"},       {"limestone", "marble"},
     {"sandstone", "marble"},   {"granite", "marble"},
     {"marble", "marble"},      {"wood", "wood"},
     {"timber", "wood"},        {"timber_framing", "wood"},
     {"metal", "metal"},        {"steel", "metal"},
     {"metal_plates", "metal"}, {"copper", "metal"},
     {"aluminium", "metal"},    {"tin", "metal"}}};

std::string material_of(const OutlineTags& tags) {
    for (const std::string_view key : material_keys)
        for (const auto& [word, material] : material_words)
            if (tag(tags, key) == word) return std::string(material);
    return {};
}

/// Height by the levels and the roof above them (OpenStreetMap wiki, "Key:building:levels": "excluding roof levels").
std::optional<double> height_by_levels(const OutlineTags& tags, double metres_per_level) {
    const auto levels = first_height(tags, level_keys);
    const auto roof_levels = first_height(tags, roof_level_keys);
    if (!levels && !roof_levels) return std::nullopt;
    return levels.value_or(0) * metres_per_level +
           first_height(tags, roof_height_keys).value_or(roof_levels.value_or(0) * metres_per_level);
}

bool affirmed(std::string_view value) { return !value.empty() && value != "no" && value != "false" && value != "0"; }

/// Of surfaces of the Earth, whatever height they tell.
constexpr std::array<std::string_view, 8> surface_keys{"natural",  "landuse",  "leisure", "highway",
                                                       "waterway", "boundary", "place",   "water"};
/// Of places and things that may be a building but mostly are car parks, pitches, platforms (OpenStreetMap wiki, "Map
/// features").
constexpr std::array<std::string_view, 22> thing_keys{
    "aerialway", "aeroway",  "amenity",    "area:highway", "barrier",          "craft",  "emergency", "geological",
    "golf",      "historic", "healthcare", "man_made",     "military",         "office", "power",     "playground",
    "railway",   "route",    "shop",       "sport",        "public_transport", "tourism"};

template <std::size_t n>
bool any_of_keys(const OutlineTags& tags, const std::array<std::string_view, n>& keys) {
    return std::any_of(keys.begin(), keys.end(), [&](std::string_view key) { return tags.contains(key); });
}

bool is_unnamed_house(const OutlineTags& tags, UnnamedOutline unnamed) {
    if (unnamed == UnnamedOutline::nothing || any_of_keys(tags, surface_keys)) return false;
    const bool thing = any_of_keys(tags, thing_keys);
    const bool tall = first_height(tags, height_keys) || first_height(tags, level_keys);
    return unnamed == UnnamedOutline::tall_house ? tall && !thing : tall || !thing;
}

/// Said to be below the ground, or with levels there alone.
bool is_underground(const OutlineTags& tags) {
    if (tag(tags, "location") == "underground" || affirmed(tag(tags, "is_underground"))) return true;
    const auto levels = first_length(tags, level_keys);
    return levels && *levels == 0 && first_height(tags, buried_level_keys) && !first_height(tags, height_keys) &&
           !first_height(tags, roof_level_keys);
}

OutlineUse::Kind kind_of(const OutlineTags& tags, UnnamedOutline unnamed) {
    using Kind = OutlineUse::Kind;
    if (is_underground(tags)) return Kind::none;
    if (affirmed(tag(tags, "building:part"))) return Kind::part;
    if (affirmed(tag(tags, "building"))) return Kind::building;
    if (tags.contains("building")) return Kind::none;
    if (tag(tags, "natural") == "wood" || tag(tags, "landuse") == "forest" || tag(tags, "landuse") == "orchard")
        return Kind::trees;
    return is_unnamed_house(tags, unnamed) ? Kind::building : Kind::none;
}

}  // namespace

std::optional<double> length_of_tag(std::string_view text) {
    // Of several values ("5;6") the first.
    text = trimmed(text.substr(0, text.find(';')));
    auto value = take_tag_number(text);
    if (!value) return std::nullopt;
    if (text == "ft" || text == "feet" || text == "'") {
        *value *= foot;
    } else if (text.starts_with('\'')) {
        text.remove_prefix(1);
        const auto inches = take_tag_number(text);
        if (!inches || text != "\"") return std::nullopt;
        *value = (*value + *inches / 12) * foot;
    } else if (!(text.empty() || text == "m" || text == "metres" || text == "meters")) {
        return std::nullopt;
    }
    return *value >= 0 && *value <= tallest ? value : std::nullopt;
}

bool tells_buildings(const OutlineTags& tags) { return tags.contains("building") || tags.contains("building:part"); }

OutlineUse outline_use(const OutlineTags& tags, const CityFileSettings& settings, UnnamedOutline unnamed) {
    OutlineUse use;
    use.kind = kind_of(tags, unnamed);
    if (use.kind == OutlineUse::Kind::none) return use;
    use.material = material_of(tags);
    use.top = first_height(tags, height_keys);
    if (!use.top) use.top = height_by_levels(tags, settings.metres_per_level);
    if (use.top && *use.top > tallest) use.top.reset();
    if (const auto base = first_length(tags, base_keys))
        use.base = *base;
    else if (const auto levels = first_length(tags, base_level_keys))
        use.base = *levels * settings.metres_per_level;
    const std::string_view building = tag(tags, use.kind == OutlineUse::Kind::part ? "building:part" : "building");
    use.canopy = (building == "roof" || building == "carport") && use.base == 0;
    return use;
}

}  // namespace skyloop::inline world

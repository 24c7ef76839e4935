#include "detail/osm_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "detail/city_text.hpp"

namespace skyloop {

namespace {

/// Behind the comment that begins at `at`.
std::size_t comment_end(std::string_view xml, std::size_t at) {
    const std::size_t end = xml.find("-->", at);
    return end == std::string_view::npos ? xml.size() : end + 3;
}

/// Behind the element's head that begins at `at`; a '>' between quotes does not end it.
std::size_t head_end(std::string_view xml, std::size_t at) {
    for (at = xml.find_first_of("'\">", at); at != std::string_view::npos; at = xml.find_first_of("'\">", at + 1)) {
        if (xml[at] == '>') return at + 1;
        at = xml.find(xml[at], at + 1);
        if (at == std::string_view::npos) break;
    }
    return xml.size();
}

/// Takes the next attribute off the front of an element's inside. @returns false when there is none
bool take_attribute(std::string_view& rest, std::string_view& name, std::string_view& value) {
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) return false;
    const std::size_t open = rest.find_first_of("'\"", equals);
    if (open == std::string_view::npos) return false;
    const std::size_t close = rest.find(rest[open], open + 1);
    if (close == std::string_view::npos) return false;
    name = rest.substr(0, equals);
    name.remove_prefix(std::min(name.find_first_not_of(" \t\r\n"), name.size()));
    name = name.substr(0, name.find_first_of(" \t\r\n"));
    value = rest.substr(open + 1, close - open - 1);
    rest.remove_prefix(close + 1);
    return true;
}

/// The number of an element that is marked, by its attributes.
bool is_marked_deleted(std::string_view attributes, std::int64_t& id) {
    bool deleted = false, numbered = false;
    for (std::string_view name, value; take_attribute(attributes, name, value);) {
        if (name == "action") deleted = value == "delete";
        if (name == "id") numbered = std::from_chars(value.data(), value.data() + value.size(), id).ec == std::errc();
    }
    return deleted && numbered;
}

/// Tells `use` of the type of each element and what stands behind it in its head, until it returns false.
template <class Use>
void for_each_element(std::string_view xml, const Use& use) {
    for (std::size_t at = xml.find('<'); at < xml.size(); at = xml.find('<', at)) {
        if (xml.substr(at).starts_with("<!--")) {
            at = comment_end(xml, at);
            continue;
        }
        const std::size_t end = head_end(xml, at);
        const std::string_view head = xml.substr(at + 1, end - at - 1);
        at = end;
        const std::string_view type = head.substr(0, head.find_first_of(" \t\r\n"));
        if (!use(type, head.substr(type.size()))) return;
    }
}

bool is_wild(std::string_view coordinate) {
    constexpr double beyond_all = 1000;  // degrees
    const std::size_t exponent = coordinate.find_first_of("eE&");
    if (exponent == std::string_view::npos) return false;
    if (coordinate[exponent] == '&') return true;  // nobody writes digits so
    const char* at = coordinate.data();
    return std::abs(take_number(at, at + coordinate.size()).value_or(0)) > beyond_all;
}

}  // namespace

OsmDeletions osm_deletions(std::string_view xml) {
    OsmDeletions deletions;
    if (xml.find("action") == std::string_view::npos) return deletions;
    for_each_element(xml, [&](std::string_view type, std::string_view attributes) {
        std::set<std::int64_t>* ids = type == "node"       ? &deletions.nodes
                                      : type == "way"      ? &deletions.ways
                                      : type == "relation" ? &deletions.relations
                                                           : nullptr;
        std::int64_t id = 0;
        if (ids && is_marked_deleted(attributes, id)) ids->insert(id);
        return true;
    });
    return deletions;
}

std::optional<std::string_view> wild_coordinate(std::string_view xml) {
    std::optional<std::string_view> found;
    for_each_element(xml, [&](std::string_view type, std::string_view attributes) {
        if (type == "tag") return true;
        // Of nodes, of the nodes of ways, and those of bounds, such as maxlat.
        for (std::string_view name, value; !found && take_attribute(attributes, name, value);)
            if ((name.ends_with("lat") || name.ends_with("lon")) && is_wild(value)) found = value;
        return !found;
    });
    return found;
}

}  // namespace skyloop

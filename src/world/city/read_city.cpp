#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <system_error>

#include "base/core/lowered_text.hpp"
#include "base/core/text_file.hpp"
#include "detail/city_text.hpp"
#include "detail/companion_files.hpp"
#include "detail/tar_archive.hpp"
#include "world/city/city_file.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

// A small file may unpack to more than its scene may take.
Result<std::string> read_bounded(const fs::path& path, const CityFileSettings& settings) {
    const std::size_t most = most_city_bytes(settings);
    auto text = read_text_file(path, most);
    if (!text && text.error().code == ErrorCode::input && most == settings.memory_limit)
        return fail(ErrorCode::input,
                    fmt::format("{} (memory_limit_mb is {})", text.error().message, settings.memory_limit >> 20));
    return text;
}

using CompanionDigests = std::map<std::string, std::uint64_t>;

// The files of a folder, those that links lead out of it excepted. What was opened is noted.
CompanionFiles files_of_folder(const fs::path& folder, CompanionDigests& opened, const CityFileSettings& settings) {
    return [folder, &opened, settings](const std::string& inside) -> Result<std::string> {
        std::error_code error;
        const fs::path root = fs::weakly_canonical(folder, error), path = fs::weakly_canonical(folder / inside, error);
        if (std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first != root.end())
            return fail(ErrorCode::input, fmt::format("{}: leads out of its folder", (folder / inside).string()));
        auto content = read_bounded(path, settings);
        if (!content) return content;
        const auto digest = digest_of_file(path);
        if (!digest) return fail(digest.error());
        opened[inside] = *digest;
        return content;
    };
}

Result<CityFile> with_companions(Result<CityFile> city, const CompanionDigests& opened) {
    if (city)
        for (const auto& [name, digest] : opened)
            city->companions.push_back({name, digest});
    return city;
}

// The name of an XML text's first element, without its namespace's prefix.
std::string_view root_element(std::string_view xml) {
    for (std::size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at)) {
        const std::string_view rest = xml.substr(at);
        if (rest.starts_with("<!--")) {
            at = xml.find("-->", at);
        } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
            at = xml.find('>', at);
        } else {
            std::string_view element = rest.substr(1, std::min(rest.find_first_of(" \t\r\n/>"), rest.size()) - 1);
            const std::size_t colon = element.find(':');
            return colon == std::string_view::npos ? element : element.substr(colon + 1);
        }
        if (at == std::string_view::npos) break;
    }
    return {};
}

Result<CityFile> parse_xml(std::string_view text, const fs::path& path, const CityFileSettings& settings) {
    const std::string name = path.string();
    const std::string_view root = root_element(text);
    CompanionDigests opened;
    if (root == "scene")
        return with_companions(
            parse_mitsuba(text, name, settings, files_of_folder(path.parent_path(), opened, settings)), opened);
    if (root == "osm") return parse_osm(text, "osm", name, settings);
    if (root == "CityModel") return parse_citygml(text, name, settings);
    return fail(ErrorCode::input,
                fmt::format("{}: its first element is '{}'; expected scene (Mitsuba), CityModel (CityGML) "
                            "or osm",
                            name, shown(root)));
}

// True when the text of a "type" of the document begins so.
bool tells_type(std::string_view text, std::string_view beginning) {
    const std::string value = fmt::format("\"{}", beginning);
    for (std::size_t at = text.find(value); at != std::string_view::npos; at = text.find(value, at + 1)) {
        const std::string_view before = text.substr(0, at);
        const std::size_t colon = before.find_last_not_of(" \t\r\n");
        if (colon == std::string_view::npos || before[colon] != ':') continue;
        const std::size_t key = before.substr(0, colon).find_last_not_of(" \t\r\n");
        if (key != std::string_view::npos && before.substr(0, key + 1).ends_with("\"type\"")) return true;
    }
    return false;
}

// True when a second line begins a value of its own and there are features: a text sequence.
bool is_cityjson_sequence(std::string_view text) {
    const std::string_view further = text.substr(std::min(text.find('\n'), text.size()));
    const std::size_t begin = further.find_first_not_of(" \t\r\n\x1E");
    return begin != std::string_view::npos && further[begin] == '{' && tells_type(further, "CityJSONFeature");
}

using Parser = Result<CityFile> (*)(std::string_view, const fs::path&, const CityFileSettings&);

struct CityEnding {
    std::string_view ending;
    Parser parse;
};

template <Result<CityFile> (*parse)(std::string_view, std::string_view, const CityFileSettings&)>
Result<CityFile> parse_named(std::string_view bytes, const fs::path& path, const CityFileSettings& settings) {
    return parse(bytes, path.string(), settings);
}
Result<CityFile> parse_gltf_file(std::string_view bytes, const fs::path& path, const CityFileSettings& settings) {
    CompanionDigests opened;
    return with_companions(
        parse_gltf_with(bytes, path.string(), settings, files_of_folder(path.parent_path(), opened, settings)), opened);
}
Result<CityFile> parse_any_cityjson(std::string_view text, const fs::path& path, const CityFileSettings& settings) {
    return (is_cityjson_sequence(text) ? parse_cityjson_sequence : parse_cityjson)(text, path.string(), settings);
}
Result<CityFile> parse_any_json(std::string_view text, const fs::path& path, const CityFileSettings& settings) {
    return tells_type(text, "CityJSON") ? parse_any_cityjson(text, path, settings)
                                        : parse_geojson(text, path.string(), settings);
}
Result<CityFile> parse_osm_xml(std::string_view bytes, const fs::path& path, const CityFileSettings& settings) {
    return parse_osm(bytes, "osm", path.string(), settings);
}
Result<CityFile> parse_osm_pbf(std::string_view bytes, const fs::path& path, const CityFileSettings& settings) {
    return parse_osm(bytes, "osm.pbf", path.string(), settings);
}

constexpr std::array<CityEnding, 16> city_endings{{{".obj", parse_named<parse_obj>},
                                                   {".ply", parse_named<parse_ply>},
                                                   {".gltf", parse_gltf_file},
                                                   {".glb", parse_gltf_file},
                                                   {".geojson", parse_named<parse_geojson>},
                                                   {".city.json", parse_any_cityjson},
                                                   {".json", parse_any_json},
                                                   {".jsonl", parse_named<parse_cityjson_sequence>},
                                                   {".osm", parse_osm_xml},
                                                   {".pbf", parse_osm_pbf},
                                                   {".gml", parse_named<parse_citygml>},
                                                   {".xml", parse_xml},
                                                   {".asc", parse_named<parse_height_grid>},
                                                   {".tar", parse_named<parse_mitsuba_archive>},
                                                   {".tgz", parse_named<parse_mitsuba_archive>},
                                                   {".cityjson", parse_any_cityjson}}};

/// Whether a file is a Mitsuba scene by its name. Hidden ones are none: macOS puts "._town.xml" beside "town.xml" in
/// archives and on foreign disks.
bool names_scene(std::string_view path) {
    const std::string_view file = path.substr(path.rfind('/') + 1);
    return !file.starts_with('.') && lowered_text(file).ends_with(".xml");
}

Result<CityFile> read_by_ending(const fs::path& path, const CityFileSettings& settings) {
    std::string name = lowered_text(path.filename().string());
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    for (const CityEnding& known : city_endings) {
        if (!name.ends_with(known.ending)) continue;
        const auto bytes = read_bounded(path, settings);
        if (!bytes) return fail(bytes.error());
        if (bytes->empty()) return fail(ErrorCode::input, fmt::format("{}: is empty", path.string()));
        return known.parse(*bytes, path, settings);
    }
    std::string known_endings;
    for (const CityEnding& known : city_endings)
        known_endings += fmt::format(" {}", known.ending);
    return fail(ErrorCode::input,
                fmt::format("{}: its ending is of no known city; expected a folder or one of{}, each also "
                            "as .gz",
                            path.string(), known_endings));
}

}  // namespace

Result<CityFile> parse_mitsuba_archive(std::string_view bytes, std::string_view name,
                                       const CityFileSettings& settings) {
    const auto members = tar_members(bytes, name);
    if (!members) return fail(members.error());
    std::string scene;
    std::size_t scenes = 0;
    for (const auto& [member, content] : *members)
        if (names_scene(member) && scenes++ == 0) scene = member;
    if (scenes != 1)
        return fail(ErrorCode::input, fmt::format("{}: holds {} .xml files; expected one Mitsuba scene", name, scenes));
    const std::string folder = scene.substr(0, scene.rfind('/') + 1);
    const CompanionFiles companions = [&](const std::string& inside) -> Result<std::string> {
        const auto found = members->find(folder + inside);
        if (found == members->end())
            return fail(ErrorCode::input,
                        fmt::format("names the file '{}', which the archive does not hold", shown(inside)));
        return std::string(found->second);
    };
    return parse_mitsuba(members->at(scene), fmt::format("{}:{}", name, scene), settings, companions);
}

Result<fs::path> file_of_city(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) return path;
    std::vector<fs::path> scenes;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
        if (names_scene(entry->path().filename().string())) scenes.push_back(entry->path());
    if (error) return fail(ErrorCode::outside, fmt::format("{}: {}", path.string(), error.message()));
    if (scenes.size() != 1)
        return fail(ErrorCode::input,
                    fmt::format("{}: holds {} .xml files; expected one Mitsuba scene", path.string(), scenes.size()));
    return scenes.front();
}

Result<CityFile> read_city(const fs::path& path, const CityFileSettings& settings) {
    const auto source = file_of_city(path);
    if (!source) return fail(source.error());
    auto city = read_by_ending(*source, settings);
    if (!city) return city;
    for (std::string& doubt : doubts_about(city->model)) {
        std::string line = fmt::format("{}: {}", path.string(), doubt);
        const auto told = [&](const std::string& warning) { return warning == line || warning == doubt; };
        if (std::none_of(city->warnings.begin(), city->warnings.end(), told)) city->warnings.push_back(std::move(line));
    }
    return city;
}

}  // namespace skyloop

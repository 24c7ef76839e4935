#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <system_error>

#include "base/core/archive.hpp"
#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "detail/city_text.hpp"
#include "detail/companion_files.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::inline world {
namespace {

namespace fs = std::filesystem;

// A small file may unpack to more than its scene may take.
tl::unexpected<Error> refuse_unread(Error error, const CityFileSettings& settings) {
    if (most_city_bytes(settings) == settings.memory_limit && error.message.ends_with("the most that is read"))
        error.message += fmt::format(" (memory_limit_mb is {})", settings.memory_limit >> 20);
    return fail(std::move(error));
}

Result<std::string> read_bounded(const fs::path& path, const CityFileSettings& settings) {
    auto text = read_uncompressed(path, most_city_bytes(settings));
    return text ? text : refuse_unread(text.error(), settings);
}

// What is parsed: a file's bytes, its name for messages, and the files beside it.
struct CityBytes {
    std::string_view bytes;
    std::string name;
    const CompanionFiles& companions;
};

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

Result<CityFile> parse_xml(const CityBytes& city, const CityFileSettings& settings) {
    const std::string_view root = root_element(city.bytes);
    if (root == "scene") return parse_mitsuba(city.bytes, city.name, settings, city.companions);
    if (root == "osm") return parse_osm(city.bytes, "osm", city.name, settings);
    if (root == "CityModel") return parse_citygml(city.bytes, city.name, settings);
    return fail(ErrorCode::input,
                fmt::format("{}: its first element is '{}'; expected scene (Mitsuba), CityModel (CityGML) "
                            "or osm",
                            city.name, shown(root)));
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

using Parser = Result<CityFile> (*)(const CityBytes&, const CityFileSettings&);

struct CityEnding {
    std::string_view ending;
    Parser parse;
};

template <Result<CityFile> (*parse)(std::string_view, std::string_view, const CityFileSettings&)>
Result<CityFile> parse_named(const CityBytes& city, const CityFileSettings& settings) {
    return parse(city.bytes, city.name, settings);
}
Result<CityFile> parse_gltf_file(const CityBytes& city, const CityFileSettings& settings) {
    return parse_gltf_with(city.bytes, city.name, settings, city.companions);
}
Result<CityFile> parse_any_cityjson(const CityBytes& city, const CityFileSettings& settings) {
    return (is_cityjson_sequence(city.bytes) ? parse_cityjson_sequence : parse_cityjson)(city.bytes, city.name,
                                                                                         settings);
}
Result<CityFile> parse_any_json(const CityBytes& city, const CityFileSettings& settings) {
    return tells_type(city.bytes, "CityJSON") ? parse_any_cityjson(city, settings)
                                              : parse_geojson(city.bytes, city.name, settings);
}
Result<CityFile> parse_osm_xml(const CityBytes& city, const CityFileSettings& settings) {
    return parse_osm(city.bytes, "osm", city.name, settings);
}
Result<CityFile> parse_osm_pbf(const CityBytes& city, const CityFileSettings& settings) {
    return parse_osm(city.bytes, "osm.pbf", city.name, settings);
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
                                                   {".tif", parse_named<parse_geotiff>},
                                                   {".tiff", parse_named<parse_geotiff>},
                                                   {".cityjson", parse_any_cityjson}}};

const CityEnding* ending_of(std::string_view path) {
    std::string name = lower_case(path.substr(path.rfind('/') + 1));
    for (const std::string_view packed : {".gz", ".z", ".bz2", ".xz", ".zst"})
        if (name.ends_with(packed)) {
            name.resize(name.size() - packed.size());
            break;
        }
    const auto* const found = std::find_if(city_endings.begin(), city_endings.end(),
                                           [&](const CityEnding& known) { return name.ends_with(known.ending); });
    return found == city_endings.end() ? nullptr : found;
}

bool names_archive(std::string_view path) {
    const std::string name = lower_case(path.substr(path.rfind('/') + 1));
    return name.ends_with(".zip") || name.ends_with(".tgz") || name.find(".tar") != std::string::npos;
}

/// Whether a file is a Mitsuba scene by its name.
bool names_scene(std::string_view path) { return !is_hidden_file(path) && lower_case(path).ends_with(".xml"); }

// Which files of an archive are taken for its city: those of the lowest rank. Scenes name meshes, and an XML file
// beside a city's tells of it.
int city_rank(std::string_view ending) {
    constexpr std::array<std::string_view, 3> companions{".xml", ".obj", ".ply"};
    const auto* const found = std::find(companions.begin(), companions.end(), ending);
    return found == companions.end() ? 0 : 1 + static_cast<int>(found - companions.begin());
}

// The one file of an archive that is its city.
Result<std::string> city_in(const ArchiveFiles& files, std::string_view name) {
    constexpr int none = 9;
    int rank = none;
    std::vector<std::string> cities;
    for (const auto& [file, content] : files) {
        const CityEnding* const ending = is_hidden_file(file) ? nullptr : ending_of(file);
        if (!ending || city_rank(ending->ending) > rank) continue;
        if (city_rank(ending->ending) < rank) cities.clear();
        rank = city_rank(ending->ending);
        cities.push_back(file);
    }
    if (cities.size() == 1) return cities.front();
    std::string names;
    for (std::size_t i = 0; i < cities.size() && i < 4; ++i)
        names += fmt::format("{} {}", i == 0 ? ":" : ",", i == 3 ? "…" : cities[i]);
    return fail(ErrorCode::input,
                fmt::format("{}: an archive of {} cities{}; expected one", name, cities.size(), names));
}

// All of an archive but pictures, which nothing here reads.
bool may_belong_to_city(std::string_view name) {
    const std::string lower = lower_case(name);
    return !lower.ends_with(".png") && !lower.ends_with(".jpg") && !lower.ends_with(".jpeg");
}

Result<CityFile> parse_file(const CityEnding& known, const CityBytes& city, const CityFileSettings& settings) {
    if (city.bytes.empty()) return fail(ErrorCode::input, fmt::format("{}: is empty", city.name));
    return known.parse(city, settings);
}

Result<CityFile> read_by_ending(const fs::path& path, const CityFileSettings& settings) {
    const CityEnding* const known = ending_of(path.string());
    const auto bytes = read_bounded(path, settings);
    const bool archive = names_archive(path.string());
    if (!bytes && (known || archive || bytes.error().code == ErrorCode::input)) return fail(bytes.error());
    if (bytes && (archive || is_archive(*bytes))) return parse_city_archive(*bytes, path.string(), settings);
    if (known) {
        CompanionDigests opened;
        const CompanionFiles companions = files_of_folder(path.parent_path(), opened, settings);
        auto city = parse_file(*known, {*bytes, path.string(), companions}, settings);
        if (city)
            for (const auto& [name, digest] : opened)
                city->companions.push_back({name, digest});
        return city;
    }
    std::string known_endings;
    for (const CityEnding& known_ending : city_endings)
        known_endings += fmt::format(" {}", known_ending.ending);
    return fail(ErrorCode::input,
                fmt::format("{}: its ending is of no known city; expected a folder or one of{}, each also "
                            "compressed or in a .zip or .tar",
                            path.string(), known_endings));
}

}  // namespace

Result<CityFile> parse_city_archive(std::string_view bytes, std::string_view name, const CityFileSettings& settings) {
    const std::string archive(name);
    const std::size_t most = most_city_bytes(settings);
    const auto files = archive_files(bytes, archive, most, may_belong_to_city);
    if (!files) return refuse_unread(files.error(), settings);
    const auto chosen = city_in(*files, name);
    if (!chosen) return fail(chosen.error());
    const std::string folder = chosen->substr(0, chosen->rfind('/') + 1);
    const CompanionFiles companions = [&](const std::string& inside) -> Result<std::string> {
        const auto found = files->find(folder + inside);
        if (found != files->end()) return found->second;
        return fail(ErrorCode::input,
                    fmt::format("names the file '{}', which the archive does not hold", shown(inside)));
    };
    const std::string place = fmt::format("{}:{}", name, *chosen);
    const auto city = uncompressed(files->at(*chosen), place, most);
    if (!city) return refuse_unread(city.error(), settings);
    return parse_file(*ending_of(*chosen), {*city, place, companions}, settings);
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

}  // namespace skyloop::inline world

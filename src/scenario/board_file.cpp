#include "skyloop/scenario/board_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "skyloop/base/spelling.hpp"
#include "skyloop/base/text_file.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

template <class Value>
struct BoardWord {
    std::string_view word;
    Value value;
};
constexpr std::array<BoardWord<NmeaVersion>, 4> board_nmea_versions{{{"2.3", NmeaVersion::v2_3},
                                                                     {"4.0", NmeaVersion::v4_0},
                                                                     {"4.10", NmeaVersion::v4_10},
                                                                     {"4.11", NmeaVersion::v4_11}}};
constexpr std::array<BoardWord<NmeaNumbering>, 2> board_numberings{
    {{"strict", NmeaNumbering::strict}, {"extended", NmeaNumbering::extended}}};
constexpr std::array<std::string_view, 7> board_constellations{"gps",  "sbas",    "galileo", "beidou",
                                                               "qzss", "glonass", "navic"};
constexpr std::array<std::string_view, 7> board_talkers{"", "GP", "GL", "GA", "GB", "GQ", "GN"};

struct BoardRange {
    double least;
    double most;
};

// Reads one board file's tables; remembers the first thing that is wrong, with its place.
class BoardReader {
public:
    explicit BoardReader(std::string_view file) : file_(file) {}

    [[nodiscard]] const std::string& error() const { return error_; }

    void refuse(const toml::node& at, const std::string& what) {
        if (!error_.empty()) return;
        const toml::source_position place = at.source().begin;
        error_ = fmt::format("{}:{}:{}: {}", file_, place.line, place.column, what);
    }

    // The sub-table of this name; an empty one where it is absent.
    const toml::table& table(const toml::table& parent, std::string_view key) {
        const toml::node* node = parent.get(key);
        if (node == nullptr) return none_;
        if (!node->is_table()) refuse(*node, fmt::format("'{}' must be a table, [{}]", key, key));
        return node->is_table() ? *node->as_table() : none_;
    }

    void check_keys(const toml::table& table, std::string_view where, std::span<const std::string_view> known) {
        for (const auto& [key, node] : table)
            if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
                const std::string name = fmt::format("{}{}{}", where, where.empty() ? "" : ".", key.str());
                refuse_key(key, fmt::format("unknown key '{}'{}", name, did_you_mean(key.str(), known)));
            }
    }

    void number(const toml::table& table, std::string_view key, BoardRange range, double& value) {
        const toml::node* node = table.get(key);
        if (node == nullptr) return;
        const auto found = node->value<double>();
        if (!node->is_number() || !found || !(*found >= range.least && *found <= range.most))
            return refuse(*node, fmt::format("'{}' must be a number from {} to {}", key, range.least, range.most));
        value = *found;
    }

    template <class Integer>
    void integer(const toml::table& table, std::string_view key, BoardRange range, Integer& value) {
        const toml::node* node = table.get(key);
        if (node == nullptr) return;
        double found = 0;
        if (!node->is_integer())
            return refuse(*node,
                          fmt::format("'{}' must be a whole number from {} to {}", key, range.least, range.most));
        number(table, key, range, found);
        value = static_cast<Integer>(found);
    }

    void boolean(const toml::table& table, std::string_view key, bool& value) {
        const toml::node* node = table.get(key);
        if (node == nullptr) return;
        if (!node->is_boolean()) return refuse(*node, fmt::format("'{}' must be true or false", key));
        value = **node->as_boolean();
    }

    std::optional<std::string_view> text(const toml::table& table, std::string_view key) {
        const toml::node* node = table.get(key);
        if (node == nullptr) return std::nullopt;
        if (!node->is_string()) refuse(*node, fmt::format("'{}' must be a text in quotes", key));
        return node->is_string() ? std::optional<std::string_view>(**node->as_string()) : std::nullopt;
    }

    template <class Value, std::size_t count>
    void word(const toml::table& table, std::string_view key, const std::array<BoardWord<Value>, count>& words,
              Value& value) {
        std::array<std::string_view, count> known;
        std::transform(words.begin(), words.end(), known.begin(), [](const auto& w) { return w.word; });
        const auto found = text(table, key);
        if (!found) return;
        const auto at = std::find(known.begin(), known.end(), *found);
        if (at == known.end()) return refuse_word(*table.get(key), *found, known);
        value = words[static_cast<std::size_t>(at - known.begin())].value;
    }

    void refuse_word(const toml::node& at, std::string_view found, std::span<const std::string_view> known) {
        refuse(at, fmt::format("'{}' is none of {}{}", found, fmt::join(known, ", "), did_you_mean(found, known)));
    }

    void constellations(const toml::table& navigation, std::vector<Constellation>& value);
    void sentences(const toml::table& nmea, std::vector<firmware::SentenceRate>& value);

    void refuse_key(const toml::key& key, const std::string& what) {
        if (!error_.empty()) return;
        const toml::source_position place = key.source().begin;
        error_ = fmt::format("{}:{}:{}: {}", file_, place.line, place.column, what);
    }

private:
    std::string file_;
    std::string error_;
    toml::table none_;
};

void BoardReader::constellations(const toml::table& navigation, std::vector<Constellation>& value) {
    const toml::node* node = navigation.get("constellations");
    if (node == nullptr) return;
    if (!node->is_array()) return refuse(*node, "'constellations' must be a list such as [\"gps\", \"glonass\"]");
    value.clear();
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_string()) return refuse(entry, "'constellations' must hold texts in quotes");
        const auto found = constellation_from_name(**entry.as_string());
        if (!found) return refuse_word(entry, **entry.as_string(), board_constellations);
        if (std::find(value.begin(), value.end(), *found) != value.end())
            return refuse(entry, fmt::format("'{}' stands in 'constellations' twice", **entry.as_string()));
        value.push_back(*found);
    }
    if (value.empty()) refuse(*node, "'constellations' is empty: a receiver needs at least one");
}

void BoardReader::sentences(const toml::table& nmea, std::vector<firmware::SentenceRate>& value) {
    const toml::table& rates = table(nmea, "sentences");
    check_keys(rates, "nmea.sentences", firmware::nmea_sentence_names);
    for (std::size_t i = 0; i < std::size(firmware::nmea_sentence_names); ++i) {
        int every = 0;
        integer(rates, firmware::nmea_sentence_names[i], {0, 255}, every);
        if (every > 0) value.push_back({static_cast<firmware::NmeaSentence>(i), every});
    }
}

void read_board_uart(BoardReader& reader, const toml::table& uart, firmware::BoardProfile& board) {
    static constexpr std::array<std::string_view, 2> keys{"baud", "transmit_buffer_bytes"};
    reader.check_keys(uart, "uart", keys);
    reader.integer(uart, "baud", {1200, 8'000'000}, board.baud);
    reader.integer(uart, "transmit_buffer_bytes", {128, 1'048'576}, board.transmit_buffer_bytes);
}

void read_board_navigation(BoardReader& reader, const toml::table& navigation, firmware::BoardProfile& board) {
    static constexpr std::array<std::string_view, 5> keys{"constellations", "default_rate_hz", "max_rate_hz",
                                                          "elevation_mask_deg", "solution_latency_s"};
    reader.check_keys(navigation, "navigation", keys);
    reader.constellations(navigation, board.constellations);
    double mask = board.elevation_mask.deg(), latency = board.solution_latency.value();
    reader.number(navigation, "max_rate_hz", {0.1, 100}, board.max_rate_hz);
    reader.number(navigation, "default_rate_hz", {0.1, board.max_rate_hz}, board.default_rate_hz);
    reader.number(navigation, "elevation_mask_deg", {0, 90}, mask);
    reader.number(navigation, "solution_latency_s", {0, 2}, latency);
    board.elevation_mask = Angle::degrees(mask);
    board.solution_latency = Seconds(latency);
}

void read_board_nmea(BoardReader& reader, const toml::table& nmea, firmware::BoardProfile& board) {
    static constexpr std::array<std::string_view, 9> keys{
        "version",   "main_talker",           "satellite_numbering",  "coordinate_decimals", "time_decimals",
        "sentences", "max_listed_satellites", "course_min_speed_mps", "overflow_notice"};
    reader.check_keys(nmea, "nmea", keys);
    reader.word(nmea, "version", board_nmea_versions, board.nmea_version);
    reader.word(nmea, "satellite_numbering", board_numberings, board.satellite_numbering);
    if (const auto talker = reader.text(nmea, "main_talker")) {
        if (std::find(board_talkers.begin(), board_talkers.end(), *talker) == board_talkers.end())
            reader.refuse_word(*nmea.get("main_talker"), *talker, std::span(board_talkers).subspan(1));
        board.main_talker = *talker;
    }
    double course_speed = board.course_min_speed.value();
    reader.integer(nmea, "coordinate_decimals", {3, 7}, board.coordinate_decimals);
    reader.integer(nmea, "time_decimals", {0, 3}, board.time_decimals);
    reader.integer(nmea, "max_listed_satellites", {4, 99}, board.max_listed_satellites);
    reader.number(nmea, "course_min_speed_mps", {0, 10}, course_speed);
    reader.boolean(nmea, "overflow_notice", board.overflow_notice);
    board.course_min_speed = MetresPerSecond(course_speed);
    reader.sentences(nmea, board.sentences);
}

fs::path board_path(const fs::path& directory, std::string_view name) {
    return directory / "receivers" / (std::string(name) + ".toml");
}

}  // namespace

Result<firmware::BoardProfile> read_board(std::string_view toml_text, std::string_view name) {
    static constexpr std::array<std::string_view, 4> keys{"description", "uart", "navigation", "nmea"};
    BoardReader reader(name);
    firmware::BoardProfile board;
    board.name = fs::path(name).stem().string();
    board.constellations = {Constellation::gps};
    try {
        const toml::table root = toml::parse(toml_text, name);
        reader.check_keys(root, "", keys);
        if (const auto description = reader.text(root, "description")) board.description = *description;
        read_board_uart(reader, reader.table(root, "uart"), board);
        read_board_navigation(reader, reader.table(root, "navigation"), board);
        read_board_nmea(reader, reader.table(root, "nmea"), board);
    } catch (const toml::parse_error& error) {
        const toml::source_position place = error.source().begin;
        return fail(ErrorCode::input, fmt::format("{}:{}:{}: {}", name, place.line, place.column, error.description()));
    }
    if (!reader.error().empty()) return fail(ErrorCode::input, reader.error());
    return board;
}

Result<firmware::BoardProfile> find_board(std::string_view name, std::span<const fs::path> directories) {
    std::optional<fs::path> path;
    std::error_code error;
    if (name.ends_with(".toml")) path = name;
    for (const fs::path& directory : directories)
        if (!path && name.find('/') == std::string_view::npos && fs::exists(board_path(directory, name), error))
            path = board_path(directory, name);
    if (path) {
        const auto text = read_text_file(*path);
        if (!text) return fail(text.error());
        return read_board(*text, path->string());
    }
    const std::vector<std::string> known = list_boards(directories);
    if (known.empty()) {
        std::string searched;
        for (const fs::path& directory : directories)
            searched += " " + directory.string();
        return fail(ErrorCode::usage, fmt::format("board '{}': no board files are found; searched:{}", name, searched));
    }
    const std::vector<std::string_view> words(known.begin(), known.end());
    return fail(ErrorCode::usage, fmt::format("board '{}' is not known{}; known are {}", name,
                                              did_you_mean(name, words), fmt::join(known, ", ")));
}

std::vector<std::string> list_boards(std::span<const fs::path> directories) {
    std::vector<std::string> names;
    for (const fs::path& directory : directories) {
        std::error_code error;
        for (const fs::directory_entry& entry : fs::directory_iterator(directory / "receivers", error))
            if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

}  // namespace skyloop

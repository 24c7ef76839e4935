#include "run/scenario/board_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "detail/board_parents.hpp"
#include "detail/scenario_keys.hpp"
#include "detail/table_reader.hpp"

namespace skyloop::inline run {
namespace {

namespace fs = std::filesystem;

fs::path board_path(const fs::path& directory, std::string_view name) {
    return directory / "receivers" / (std::string(name) + ".toml");
}

constexpr std::size_t least_of_module = 3;  // letters, of a name that means one

// What names a board: its own name, and modules by which its receiver reports itself. In small letters.
std::vector<std::string> words_of_board(const std::string& name, std::span<const fs::path> directories) {
    std::vector<std::string> words{name};
    const auto board = find_board(name, directories);
    if (!board) return words;
    for (const std::string& alias : board->aliases)
        words.push_back(lower_case(alias));
    constexpr std::string_view module = "MOD=";
    words.push_back(lower_case(board->identity.hardware));
    for (const std::string& line : board->identity.extensions)
        if (line.starts_with(module)) words.push_back(lower_case(line.substr(module.size())));
    for (const std::string& answer : board->identity.version_answers)
        for (std::size_t from = 0, to = 0; to != std::string::npos; from = to + 1) {
            to = answer.find(',', from);
            words.push_back(lower_case(answer.substr(from, to - from)));
        }
    // Numbers, and letters alone, name no module.
    std::erase_if(words, [](const std::string& word) {
        return word.size() < least_of_module || std::isalpha(static_cast<unsigned char>(word.front())) == 0;
    });
    return words;
}

// "m8" of "ublox-m8", which stands in the names of its modules; empty: it is of no generation.
std::string_view generation_of(std::string_view board) {
    const std::string_view last = board.substr(board.rfind('-') + 1);
    const bool numbered = std::any_of(last.begin(), last.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    return numbered && last.size() < board.size() ? last : std::string_view();
}

// Not as a part of a longer number.
bool contains_generation(std::string_view word, std::string_view generation) {
    const auto digit_at = [word](std::size_t i) {
        return i < word.size() && std::isdigit(static_cast<unsigned char>(word[i])) != 0;
    };
    const std::size_t at = generation.empty() ? std::string_view::npos : word.find(generation);
    if (at == std::string_view::npos) return false;
    const bool continues = at > 0 && digit_at(at - 1) && digit_at(at);
    return !continues && !digit_at(at + generation.size());
}

// The board that is meant by "m8", "NEO-M8N" or "ubloxm8"; empty: nobody can tell.
std::string meant_board(std::string_view name, const std::vector<std::string>& boards,
                        std::span<const fs::path> directories) {
    const std::string word = lower_case(name);
    std::vector<std::pair<std::string, std::string>> named;  // a word, and its board
    std::set<std::string> begin_so;
    for (const std::string& board : boards)
        for (std::string& other : words_of_board(board, directories)) {
            if (word.size() >= least_of_module && other.starts_with(word)) begin_so.insert(board);
            named.emplace_back(std::move(other), board);
        }
    // Of boards that share a module, the one that the others extend.
    if (begin_so.size() > 1)
        std::erase_if(begin_so,
                      [&](const std::string& board) { return find_board(board, directories)->files.size() > 1; });
    if (!begin_so.empty()) return begin_so.size() == 1 ? *begin_so.begin() : std::string();
    for (const std::string& board : boards)
        if (contains_generation(word, generation_of(board))) return board;
    std::vector<std::string_view> words;
    for (const auto& [other, board] : named)
        words.push_back(other);
    const auto nearest = std::find(words.begin(), words.end(), nearest_word(word, words));
    return nearest == words.end() ? "" : named[static_cast<std::size_t>(nearest - words.begin())].second;
}

// Whether a board's file says that a name means it; one that cannot be read says nothing.
bool has_alias(const fs::path& file, std::string_view name) {
    const auto text = read_text_file(file);
    if (!text) return false;
    bool found = false;
    const auto look = [&](toml::table& board, MistakeList&) {
        const auto* aliases = board["aliases"].as_array();
        for (std::size_t i = 0; aliases != nullptr && i < aliases->size(); ++i)
            found = found || lower_case((*aliases)[i].value_or(std::string())) == lower_case(name);
    };
    static_cast<void>(read_toml(
        *text, file.string(), [](TableReader&) {}, look));
    return found;
}

}  // namespace

Result<firmware::BoardProfile> read_board(std::string_view toml_text, std::string_view name,
                                          std::span<const fs::path> directories) {
    firmware::BoardProfile board;
    board.name = fs::path(name).stem().string();
    board.files = {std::string(name)};
    const auto lay_parents = [&](toml::table& top, MistakeList& mistakes) {
        for (const fs::path& parent : lay_parents_under(top, fs::path(name), directories, mistakes))
            board.files.push_back(parent.string());
    };
    const auto read = read_toml(
        toml_text, std::string(name), [&](TableReader& top) { read_board_keys(top, board); }, lay_parents);
    if (!read) return fail(read.error());
    return board;
}

bool is_board_path(std::string_view name) { return name.ends_with(".toml"); }

std::optional<fs::path> find_board_file(std::string_view name, std::span<const fs::path> directories) {
    if (is_board_path(name)) return name;
    if (name.find('/') != std::string_view::npos) return std::nullopt;
    std::error_code absent;
    for (const fs::path& directory : directories)
        if (fs::exists(board_path(directory, name), absent)) return board_path(directory, name);
    for (const std::string& board : list_boards(directories)) {
        const fs::path file = *find_board_file(board, directories);
        if (has_alias(file, name)) return file;
    }
    return std::nullopt;
}

Result<firmware::BoardProfile> find_board(std::string_view name, std::span<const fs::path> directories) {
    if (const auto path = find_board_file(name, directories)) {
        const auto text = read_text_file(*path);
        if (!text) return fail(text.error());
        return read_board(*text, path->string(), directories);
    }
    const std::vector<std::string> known = list_boards(directories);
    if (known.empty()) {
        std::string searched;
        for (const fs::path& directory : directories)
            searched += " " + directory.string();
        return fail(ErrorCode::usage, fmt::format("board '{}': no board files are found; searched:{}", name, searched));
    }
    const std::string meant = meant_board(name, known, directories);
    return fail(ErrorCode::usage, fmt::format("board '{}' is not known; {}", name,
                                              meant.empty() ? fmt::format("expected one of {}", fmt::join(known, ", "))
                                                            : fmt::format("did you mean '{}'?", meant)));
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

namespace {

namespace fs = std::filesystem;

constexpr NumberRange device_speeds{1, 100'000'000};

// Ids are written into udev rules and compared as numbers: four hexadecimal digits each.
void check_ids(TableReader& device, std::string_view key, const std::vector<std::string>& texts,
               std::vector<UsbIds>& ids) {
    for (const std::string& text : texts) {
        const auto read = parse_usb_ids(text);
        if (!read)
            return device.mistake(key, fmt::format("is '{}'; expected VID:PID, four hexadecimal digits each, such as "
                                                   "'1546:01a8'",
                                                   text));
        if (std::find(ids.begin(), ids.end(), *read) != ids.end())
            return device.mistake(key, fmt::format("holds {} twice; expected it once", text));
        ids.push_back(*read);
    }
}

// Names and sentences stand in one line of tables and rules.
bool is_one_line(std::string_view text) {
    return std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

void check_name(TableReader& device, const DeviceProfile& profile) {
    const bool plain = std::all_of(profile.name.begin(), profile.name.end(),
                                   [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; });
    if (profile.name.empty()) return device.mistake_here("has no name; expected a key 'name'");
    if (!plain)
        device.mistake("name", fmt::format("is '{}'; expected lower-case letters, digits and hyphens", profile.name));
}

void check_lines(TableReader& device, const DeviceProfile& profile) {
    if (!is_one_line(profile.description)) device.mistake("description", "has line breaks; expected one line");
    if (!is_one_line(profile.good_for)) device.mistake("good_for", "has line breaks; expected one line");
    if (!std::all_of(profile.hints.begin(), profile.hints.end(), is_one_line))
        device.mistake("hints", "hold line breaks; expected one line each");
}

DeviceProfile read_device(TableReader& device, const std::vector<std::string>& bootloader_products) {
    DeviceProfile profile;
    profile.bootloader_products = bootloader_products;
    std::vector<std::string> ids, bootloader_ids;
    device.text("name", profile.name);
    device.text("description", profile.description);
    if (!device.has("kind")) device.mistake_here("has no kind; expected a key 'kind'");
    device.word("kind",
                {{"autopilot", DeviceKind::autopilot},
                 {"receiver", DeviceKind::receiver},
                 {"bridge", DeviceKind::bridge},
                 {"relay", DeviceKind::relay},
                 {"gpio", DeviceKind::gpio},
                 {"hub", DeviceKind::hub},
                 {"bootloader", DeviceKind::bootloader}},
                profile.kind);
    device.text_or_texts("usb", ids);
    if (ids.empty()) device.mistake_here("has no ids; expected a key 'usb' such as \"1546:01a8\"");
    device.text_or_texts("product", profile.products);
    device.text_or_texts("manufacturer", profile.manufacturers);
    device.text_or_texts("bootloader_usb", bootloader_ids);
    device.text_or_texts("bootloader_product", profile.bootloader_products);
    device.text("good_for", profile.good_for);
    device.word("transport",
                {{"serial", DeviceTransport::serial}, {"usb", DeviceTransport::usb}, {"hid", DeviceTransport::hid}},
                profile.transport);
    device.integer("baud", profile.baud, device_speeds);
    device.integer("max_baud", profile.max_baud, device_speeds);
    if (profile.max_baud != 0 && profile.baud > profile.max_baud)
        device.mistake("baud", fmt::format("is {}; expected at most max_baud, {}", profile.baud, profile.max_baud));
    device.integer("latency_timer_ms", profile.latency_timer_ms, {1, 255});
    device.texts("hints", profile.hints);
    check_ids(device, "usb", ids, profile.ids);
    check_ids(device, "bootloader_usb", bootloader_ids, profile.bootloader_ids);
    check_name(device, profile);
    check_lines(device, profile);
    return profile;
}

// The ids that two devices share though nothing tells them apart.
std::optional<UsbIds> shared_ids(const DeviceProfile& a, const DeviceProfile& b) {
    if (a.needs_strings() || b.needs_strings()) return std::nullopt;
    const auto shared = std::find_first_of(a.ids.begin(), a.ids.end(), b.ids.begin(), b.ids.end());
    return shared == a.ids.end() ? std::nullopt : std::optional(*shared);
}

// What is wrong with a device beside one that was read before; empty: nothing.
std::string clash(const DeviceProfile& earlier, const DeviceProfile& device) {
    if (earlier.name == device.name) return fmt::format("name: '{}' is that of another device", device.name);
    if (const auto ids = shared_ids(earlier, device))
        return fmt::format("usb: {} is that of '{}' too; expected a product or manufacturer that tells '{}' from it",
                           to_string(*ids), earlier.name, device.name);
    return {};
}

// Files by folder and name; of files of the same name, the one of the first directory.
std::map<fs::path, fs::path> device_files(std::span<const fs::path> directories) {
    std::map<fs::path, fs::path> files;
    for (const fs::path& directory : directories) {
        for (const char* folder : {"adapters", "autopilots"}) {
            std::error_code error;
            for (fs::directory_iterator entry(directory / folder, error), end; !error && entry != end;
                 entry.increment(error))
                if (entry->path().extension() == ".toml")
                    files.try_emplace(fs::path(folder) / entry->path().filename(), entry->path());
        }
    }
    return files;
}

}  // namespace

Result<std::vector<DeviceProfile>> read_devices(std::string_view toml_text, std::string_view name) {
    std::vector<DeviceProfile> devices;
    const auto read = read_toml(toml_text, std::string(name), [&](TableReader& top) {
        std::string description;
        std::vector<std::string> bootloader_products;
        top.text("description", description);
        top.text_or_texts("bootloader_product", bootloader_products);
        if (!top.has("device")) top.mistake_here("has no device; expected tables headed [[device]]");
        top.tables("device", {}, [&](TableReader& table) {
            const DeviceProfile device = read_device(table, bootloader_products);
            for (const DeviceProfile& earlier : devices)
                if (const std::string wrong = clash(earlier, device); !wrong.empty()) table.mistake_here(wrong);
            devices.push_back(device);
        });
        if (top.has("device") && devices.empty())
            top.mistake("device", "holds none; expected tables headed [[device]]");
    });
    if (!read) return fail(read.error());
    return devices;
}

Result<std::vector<DeviceProfile>> load_devices(std::span<const fs::path> directories) {
    std::vector<DeviceProfile> all;
    for (const auto& [name, path] : device_files(directories)) {
        const auto text = read_text_file(path);
        if (!text) return fail(text.error());
        auto devices = read_devices(*text, path.string());
        if (!devices) return fail(devices.error());
        for (DeviceProfile& device : *devices) {
            for (const DeviceProfile& earlier : all)
                if (const std::string wrong = clash(earlier, device); !wrong.empty())
                    return fail(ErrorCode::input, fmt::format("{}: {}", path.string(), wrong));
            all.push_back(std::move(device));
        }
    }
    return all;
}

}  // namespace skyloop::inline run

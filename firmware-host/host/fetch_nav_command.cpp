#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

#include "base/core/files.hpp"
#include "base/time/utc_time.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "run/scenario/navigation_mirrors.hpp"
#include "run_options.hpp"
#include "run_session.hpp"
#include "wire/fetch/fetch.hpp"
#include "world/broadcast/daily_navigation.hpp"

namespace skyloop::host {
namespace {

namespace fs = std::filesystem;

struct FetchNavOptions {
    std::string date;
    std::string to;
    std::vector<std::string> mirrors;
    Verbosity verbosity;
};

// A file that has passed all checks.
struct CheckedFile {
    std::string bytes;
    DailyNavigation content;
    std::string from;  // its address, or "the cache"
};

// A day that is not over has no whole file yet.
bool is_over(GpsTime day) { return day_of(wall_clock()) > day; }

Result<GpsTime> asked_day(const FetchNavOptions& options) {
    const GpsTime today = day_of(wall_clock());
    if (options.date.empty()) return today;
    const auto day = parse_day(options.date);
    if (!day) return fail(day.error().code, "--date " + day.error().message);
    if (*day > today)
        return fail(ErrorCode::usage,
                    fmt::format("--date {}: lies ahead; expected a day up to {}", options.date, day_text(today)));
    return *day;
}

// Those of --mirror, else those of the environment, else all that are known.
Result<std::vector<NavigationMirror>> asked_mirrors(const FetchNavOptions& options) {
    auto known = find_navigation_mirrors(data_folders().folders);
    if (!known) return known;
    std::string_view teller = "--mirror ";
    std::vector<std::string> wanted = options.mirrors;
    if (const char* listed = std::getenv("SKYLOOP_NAV_MIRRORS"); listed != nullptr && wanted.empty()) {
        teller = "SKYLOOP_NAV_MIRRORS: ";
        std::istringstream words(listed);
        for (std::string word; words >> word;)
            wanted.push_back(word);
    }
    if (wanted.empty()) return known;
    auto chosen = chosen_mirrors(*known, wanted);
    if (!chosen) return fail(chosen.error().code, std::string(teller) + chosen.error().message);
    return chosen;
}

// The host of an address, as messages name who does not answer.
std::string host_of(const std::string& address) {
    const std::size_t begin = address.find("//") + 2;
    return address.substr(begin, address.find('/', begin) - begin);
}

// Why there is no file: of each address what was wrong with it.
class Failures {
public:
    void add(const std::string& address, const FetchAnswer& answer) {
        if (answer.outcome == FetchOutcome::unreachable)
            unreachable_.insert(host_of(address));
        else
            all_unreachable_ = false;
        add(address + ": " + answer.problem);
    }
    void add_useless(std::string sentence) {
        all_unreachable_ = false;
        add(std::move(sentence));
    }
    // Who was asked in vain once.
    [[nodiscard]] bool has_unreachable(const std::string& host) const { return unreachable_.contains(host); }
    [[nodiscard]] Error told(GpsTime day) const {
        if (all_unreachable_)
            return {ErrorCode::outside, fmt::format("no network: {} cannot be reached ({})",
                                                    fmt::join(unreachable_, ", "), sentences_.back())};
        return {ErrorCode::outside,
                fmt::format("no navigation file of {}: {}", day_text(day), fmt::join(sentences_, "; "))};
    }

private:
    void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }
    bool all_unreachable_ = true;
    std::set<std::string> unreachable_;  // hosts
    std::vector<std::string> sentences_;
};

// What a mirror has under an address; nothing, and why in `failures`, where it is not to be used.
std::optional<CheckedFile> fetched_file(const std::string& address, GpsTime day, Failures& failures) {
    FetchAnswer answer = fetch(address, {.most_bytes = most_daily_bytes});
    if (answer.outcome != FetchOutcome::found) {
        failures.add(address, answer);
        return std::nullopt;
    }
    const auto content = check_daily_navigation(answer.bytes, address, day);
    if (content && (content->whole || !is_over(day))) return CheckedFile{std::move(answer.bytes), *content, address};
    failures.add_useless(content ? fmt::format("{}: ends at {}; expected the whole day", address,
                                               format_utc(gps_calendar(content->until), 0))
                                 : content.error().message);
    return std::nullopt;
}

Result<CheckedFile> file_of_mirrors(const std::vector<NavigationMirror>& mirrors, GpsTime day,
                                    const Messages& messages) {
    Failures failures;
    for (const NavigationMirror& mirror : mirrors)
        for (const std::string& pattern : mirror.addresses) {
            const std::string address = address_of_day(pattern, day);
            if (failures.has_unreachable(host_of(address))) continue;
            messages.detail(address);
            if (auto file = fetched_file(address, day, failures)) return std::move(*file);
        }
    return fail(failures.told(day));
}

Result<std::string> packed_bytes(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (file.is_open() && !file.bad()) return bytes;
    return fail(ErrorCode::outside, fmt::format("{}: cannot be read", path.string()));
}

// The file of the cache; nothing where there is none, or a useless one.
std::optional<CheckedFile> cached_file(const fs::path& path, GpsTime day, const Messages& messages) {
    std::error_code absent;
    if (path.empty() || !fs::is_regular_file(path, absent)) return std::nullopt;
    auto bytes = packed_bytes(path);
    const auto content =
        bytes ? check_daily_navigation(*bytes, path.string(), day) : Result<DailyNavigation>(fail(bytes.error()));
    if (content) return CheckedFile{std::move(*bytes), *content, "the cache"};
    messages.warning(content.error().message + "; it is fetched anew");
    return std::nullopt;
}

// Fails where the file could not be put there.
Result<void> prepare_place(const fs::path& path) {
    if (const auto made = make_folder(path.parent_path()); !made) return fail(made.error());
    return check_replaceable(path);
}

// The cache's place of the file; empty, with a warning, where there is no use in fetching for it.
Result<fs::path> kept_place(const FetchNavOptions& options, GpsTime day, const Messages& messages) {
    const fs::path cache = data_folders().cache;
    if (cache.empty() && options.to.empty())
        return fail(ErrorCode::outside, "no cache: neither XDG_CACHE_HOME nor HOME names a folder; expected --to DIR");
    if (cache.empty()) return fs::path();
    fs::path place = cached_navigation_path(cache, day);
    const auto ready = prepare_place(place);
    std::error_code absent;
    if (ready || fs::exists(place, absent)) return place;
    const std::string told = fmt::format("the cache cannot be written: {}", ready.error().message);
    if (options.to.empty()) return fail(ErrorCode::outside, told + "; expected --to DIR, or another XDG_CACHE_HOME");
    messages.warning(told);
    return fs::path();
}

// The cached file where it will do, else a mirror's, which is kept; where there is none, a cached one of a day that is
// not over.
Result<CheckedFile> file_of_day(const FetchNavOptions& options, GpsTime day, const fs::path& place,
                                const Messages& messages) {
    auto cached = cached_file(place, day, messages);
    if (cached && cached->content.whole) return std::move(*cached);
    const auto mirrors = asked_mirrors(options);
    if (!mirrors) return fail(mirrors.error());
    auto file = file_of_mirrors(*mirrors, day, messages);
    if (!file && !cached) return file;
    if (!file) {
        messages.warning(file.error().message);
        return std::move(*cached);
    }
    if (place.empty()) return file;
    const auto kept = replace_file(place, file->bytes);
    if (!kept && options.to.empty()) return fail(kept.error());
    if (!kept) messages.warning(kept.error().message);
    return file;
}

int fetch_nav(const FetchNavOptions& options) {
    const Messages messages(options.verbosity);
    const auto day = asked_day(options);
    if (!day) return messages.error(day.error());
    fs::path shown;
    if (!options.to.empty()) {
        shown = fs::path(options.to) / daily_navigation_name(*day);
        if (const auto ready = prepare_place(shown); !ready) return messages.error(ready.error());
    }
    const auto place = kept_place(options, *day, messages);
    if (!place) return messages.error(place.error());
    const auto file = file_of_day(options, *day, *place, messages);
    if (!file) return messages.error(file.error());
    if (shown.empty())
        shown = *place;
    else if (const auto written = replace_file(shown, file->bytes); !written)
        return messages.error(written.error());
    const DailyNavigation& content = file->content;
    messages.info(fmt::format("{}: {} satellites of {}, {} records{}, from {}", day_text(*day), content.satellites,
                              content.systems, content.records,
                              content.whole ? "" : " up to " + format_utc(gps_calendar(content.until), 0), file->from));
    fmt::print("{}\n", shown.string());
    return 0;
}

}  // namespace

Action add_fetch_nav_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("fetch-nav", "Get the navigation file of a day from the web, for --nav auto and others");
    auto options = std::make_shared<FetchNavOptions>();
    command->add_option("--date", options->date, "The day, such as 2023-01-01; default: today");
    command->add_option("--to", options->to, "Put the file there as well; default: into the cache alone");
    command
        ->add_option(
            "--mirror", options->mirrors,
            "Who is asked: bkg, ign, cddis, or an address with {year}, {yy}, {doy}; repeatable, in this order; "
            "default: those of SKYLOOP_NAV_MIRRORS, else all")
        ->allow_extra_args(false);
    add_verbosity_options(*command, options->verbosity);
    return [options] { return fetch_nav(*options); };
}

}  // namespace skyloop::host

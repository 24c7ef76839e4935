#include "world/rinex/observation_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/core/files.hpp"
#include "detail/compact_observations.hpp"
#include "detail/fields.hpp"
#include "detail/observation_epochs.hpp"
#include "detail/observation_header.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

class ObservationReading {
public:
    ObservationReading(std::string_view text, std::string_view name) : lines_(text), name_(name), header_(name) {}

    Result<ObservationFile> read() {
        if (auto header = header_.read(lines_); !header) return fail(header.error());
        advance();
        while (line_) {
            if (is_blank(line_->text))
                advance();
            else
                epoch();
        }
        if (file().epochs.empty()) return no_epoch();
        warn();
        return std::move(file());
    }

private:
    ObservationFile& file() { return header_.facts(); }
    [[nodiscard]] const ObservationFile& file() const { return header_.facts(); }
    [[nodiscard]] int major() const { return header_.major(); }
    void advance() { line_ = lines_.next(); }

    void epoch() {
        const Line first = *line_;
        const std::optional<EpochHead> head = epoch_head(first.text, major());
        if (!head) {
            ++file().skipped.epochs;
            epochs_.add_with([&] {
                return sentence(first, in_quotes(first.text), "the first line of an epoch with time, flag and count");
            });
            return skip_to_epoch();
        }
        if (head->event()) return event(*head);
        measured(*head, first);
    }

    // From version 3 on every epoch begins with '>'; before, only its form tells.
    void skip_to_epoch() {
        do
            advance();
        while (line_ && (major() >= 3 ? !line_->text.starts_with('>') : !epoch_head(line_->text, major())));
    }

    // Flags 2 to 5: header lines, or comments on what happened.
    void event(const EpochHead& head) {
        ++file().events;
        advance();
        for (int i = 0; i < head.count && line_; ++i, advance()) {
            if (major() >= 3 && line_->text.starts_with('>')) return;
            header_.change(*line_);
        }
    }

    void skip_unordered(const Line& head, std::string_view expected) {
        ++file().skipped.unordered;
        unordered_.add_with([&] { return sentence(head, in_quotes(columns(head.text, 0, 29)), expected); });
    }

    // An epoch whose time ran ahead costs itself: the one now follows the one before it, or, where it was the first of
    // the file, a second one that is earlier and goes on from the one that was left out for that.
    void leave_out_ahead(GpsTime now) {
        auto& epochs = file().epochs;
        constexpr Nanoseconds disorder = std::chrono::seconds(2);
        if (epochs.empty() || now >= epochs.back().receive_time - disorder) return;
        const bool follows =
            epochs.size() >= 2 ? now > epochs[epochs.size() - 2].receive_time : went_back_ && now > *went_back_;
        if (!follows) return;
        skip_unordered(last_head_, "no epoch later than those that follow");
        epochs.pop_back();
        signals_.break_all();  // whose counts may have begun in it
    }

    void measured(const EpochHead& head, const Line& first) {
        Observations at;
        at.receive_time = epoch_in_gpst(*head.time, file().time_system);
        slips_ = head.flag == 6;
        if (!slips_) leave_out_ahead(at.receive_time);
        const bool unordered = !file().epochs.empty() && at.receive_time <= file().epochs.back().receive_time;
        kept_ = !slips_ && !unordered;
        if (!slips_ && unordered) {
            went_back_ = at.receive_time;
            skip_unordered(first, "an epoch later than the one before");
        } else if (kept_) {
            went_back_.reset();
            last_head_ = first;
        }
        if (head.flag == 1) signals_.break_all();
        seen_.clear();
        const int found = major() == 2 ? satellites_of_version_2(head.count, at) : satellites(head.count, at);
        if (found < head.count) {
            ++file().skipped.incomplete;
            incomplete_.add_with([&] {
                return sentence(first, fmt::format("{} satellites", found),
                                fmt::format("the {} that the epoch announces", head.count));
            });
        }
        if (!kept_) return;
        std::sort(at.signals.begin(), at.signals.end(), [](const Observation& a, const Observation& b) {
            return std::pair(a.satellite, a.signal) < std::pair(b.satellite, b.signal);
        });
        file().epochs.push_back(std::move(at));
    }

    // A line each. Returns how many there are.
    int satellites(int count, Observations& at) {
        advance();
        int found = 0;
        for (; found < count && line_ && !line_->text.starts_with('>'); ++found, advance()) {
            record_[0] = *line_;
            satellite(columns(line_->text, 0, 3), 1, at);
        }
        while (line_ && !line_->text.starts_with('>') && found == count) {
            if (!is_blank(line_->text))
                stray_.add_with(
                    [&] { return sentence(*line_, in_quotes(line_->text), "the next epoch, which begins with '>'"); });
            advance();
        }
        return found;
    }

    // The satellites stand on the epoch's line and lines that continue it, the observations below.
    int satellites_of_version_2(int count, Observations& at) {
        constexpr int per_line = 12;
        constexpr std::size_t first_column = 32;
        names_.clear();
        for (int i = 0; i < count; ++i) {
            if (i > 0 && i % per_line == 0) advance();
            if (!line_) return 0;
            names_.push_back(columns(line_->text, first_column + 3 * static_cast<std::size_t>(i % per_line), 3));
        }
        advance();
        const SystemLayout* layout = header_.layout(Constellation::gps);
        const std::size_t height = layout ? std::max<std::size_t>(1, (layout->types.size() + 4) / 5) : 1;
        record_.resize(std::max(record_.size(), height));
        int found = 0;
        for (const std::string_view name : names_) {
            std::size_t lines = 0;
            for (; lines < height && line_; ++lines, advance())
                record_[lines] = *line_;
            // Trailing blank lines of the last record may be missing.
            if (lines == 0) break;
            satellite(name, lines, at);
            ++found;
        }
        return found;
    }

    void satellite(std::string_view name, std::size_t lines, Observations& at) {
        std::optional<SatelliteId> id = parse_satellite(name);
        if (!id && major() == 2 && name.starts_with(' '))
            if (const std::optional<int> number = whole_field(name); number && *number > 0)
                id = SatelliteId{header_.file_system(), *number};
        const SystemLayout* layout = id ? header_.layout(id->constellation) : nullptr;
        if (!layout || !seen_.insert(*id).second) return bad_satellite(name, id, layout);
        if (slips_) return signals_.break_phases(*id);
        if (!kept_) return;
        bad_.clear();
        const SatelliteRecord record(*id, std::span(record_.data(), lines), major());
        signals_.append(record, *layout, channel_of(*id), at, bad_);
        for (const BadField& b : bad_) {
            ++file().skipped.fields;
            fields_.add_with(
                [&] { return sentence(record_[0], b.text, fmt::format("{} of {}", b.expected, to_string(*id))); });
        }
    }

    void bad_satellite(std::string_view name, std::optional<SatelliteId> id, const SystemLayout* layout) {
        ++file().skipped.satellites;
        satellites_.add_with([&] {
            const std::string_view expected = !id       ? "a satellite such as 'G07'"
                                              : !layout ? "a satellite of a system whose observation types are declared"
                                                        : "each satellite once an epoch";
            return sentence(record_[0], in_quotes(name), expected);
        });
    }

    [[nodiscard]] int channel_of(SatelliteId satellite) const {
        if (satellite.constellation != Constellation::glonass) return 0;
        const auto found = file().glonass_channels.find(satellite.number);
        return found == file().glonass_channels.end() ? 0 : found->second;
    }

    [[nodiscard]] std::string sentence(const Line& line, std::string_view found, std::string_view expected) const {
        return at_line(name_, line.number, found, expected);
    }

    Result<ObservationFile> no_epoch() const {
        for (const DefectTally* t : {&epochs_, &incomplete_, &stray_})
            if (t->count > 0) return fail(ErrorCode::input, t->first + "; no epoch could be read");
        return refused(name_, lines_.number(), "the end of the file and no epoch", "epochs after the header");
    }

    void warn() {
        epochs_.warn(file().warnings, "epoch skipped");
        unordered_.warn(file().warnings, "epoch skipped");
        incomplete_.warn(file().warnings, "kept as it is");
        satellites_.warn(file().warnings, "satellite skipped");
        fields_.warn(file().warnings, "taken as not measured");
        stray_.warn(file().warnings, "line skipped");
    }

    LineReader lines_;
    std::string_view name_;
    ObservationHeaderReading header_;
    std::optional<Line> line_;
    SignalReading signals_;
    bool kept_ = true;                  // the epoch at hand goes into the file
    bool slips_ = false;                // it is a list of cycle slips
    Line last_head_;                    // of the last epoch that was kept
    std::optional<GpsTime> went_back_;  // the time of the epoch left out since, as not later than it
    std::vector<Line> record_ = std::vector<Line>(1);
    std::vector<std::string_view> names_;
    std::set<SatelliteId> seen_;
    std::vector<BadField> bad_;
    DefectTally epochs_, unordered_, incomplete_, satellites_, fields_, stray_;
};

}  // namespace
}  // namespace rinex

Result<ObservationFile> read_observations(std::string_view text, std::string_view name) {
    const std::string_view marked = rinex::without_byte_order_mark(text);
    if (!rinex::is_compact(marked)) return rinex::ObservationReading(marked, name).read();
    const auto restored = rinex::from_compact(marked, name);
    if (!restored) return fail(restored.error());
    return rinex::ObservationReading(*restored, fmt::format("{}, as RINEX", name)).read();
}

Result<ObservationFile> read_observation_file(const std::filesystem::path& path) {
    return read_text_with(path, read_observations);
}

}  // namespace skyloop::inline world

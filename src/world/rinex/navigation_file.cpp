#include "world/rinex/navigation_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "base/core/files.hpp"
#include "detail/fields.hpp"
#include "detail/navigation_header.hpp"
#include "detail/navigation_record.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

struct BlockMessage {
    std::string_view systems;
    std::string_view name;
    NavigationMessage message;
    RecordLayout layout = RecordLayout::legacy;
};
constexpr std::array<BlockMessage, 12> block_messages{{
    {"GJI", "LNAV", NavigationMessage::lnav},
    {"E", "INAV", NavigationMessage::inav},
    {"E", "FNAV", NavigationMessage::fnav},
    {"C", "D1", NavigationMessage::d1},
    {"C", "D2", NavigationMessage::d2},
    {"R", "FDMA", NavigationMessage::fdma},
    {"S", "SBAS", NavigationMessage::sbas},
    {"GJ", "CNAV", NavigationMessage::modern, RecordLayout::cnav},
    {"GJ", "CNV2", NavigationMessage::modern, RecordLayout::cnav2},
    {"C", "CNV1", NavigationMessage::modern, RecordLayout::b_cnav},
    {"C", "CNV2", NavigationMessage::modern, RecordLayout::b_cnav},
    {"C", "CNV3", NavigationMessage::modern, RecordLayout::b_cnav3},
}};

// Field `index` of a block's body, counted from the first of four on each line; the epoch takes the first one's place.
std::optional<double> block_field(std::span<const Line> lines, std::size_t index) {
    if (index / 4 >= lines.size() || !lines[index / 4].text.starts_with(' ')) return std::nullopt;
    return real_field(columns(lines[index / 4].text, 4 + 19 * (index % 4), 19));
}

template <std::size_t count>
std::optional<std::array<double, count>> block_fields(std::span<const Line> lines) {
    std::array<double, count> values{};
    for (std::size_t i = 0; i < count; ++i) {
        const std::optional<double> value = block_field(lines, i + 1);
        if (!value) return std::nullopt;
        values[i] = *value;
    }
    return values;
}

std::optional<KlobucharCoefficients>& klobuchar_of(BroadcastIonosphere& ionosphere, Constellation constellation) {
    switch (constellation) {
        case Constellation::qzss:
            return ionosphere.qzss;
        case Constellation::beidou:
            return ionosphere.beidou;
        case Constellation::navic:
            return ionosphere.navic;
        default:
            return ionosphere.gps;
    }
}

// "> EPH G02 LNAV"; of coefficients of a whole system "> ION G   LNAV", too.
struct BlockHead {
    std::string_view type;  // "EPH", "ION", "STO", "EOP"
    std::optional<Constellation> system;
    std::optional<SatelliteId> satellite;
    std::string_view message;  // "LNAV", "INAV", "D1D2", …
};

BlockHead block_head(std::string_view line) {
    const std::string_view sender = columns(line, 6, 3);
    return {trimmed(columns(line, 2, 4)), sender.empty() ? std::nullopt : constellation_from_letter(sender.front()),
            parse_satellite(sender), trimmed(columns(line, 10, 4))};
}

// The message that brings ephemerides of this name, of those that are read.
const BlockMessage* message_of_block(const BlockHead& head) {
    if (head.type != "EPH" || !head.satellite) return nullptr;
    const char letter = rinex_letter(head.satellite->constellation);
    for (const BlockMessage& m : block_messages)
        if (m.name == head.message && m.systems.find(letter) != std::string_view::npos) return &m;
    return nullptr;
}

bool is_read_ionosphere(const BlockHead& head) {
    if (head.type != "ION") return false;
    if (head.message == "IFNV") return head.system == Constellation::galileo;
    if (head.message == "D1D2") return head.system == Constellation::beidou;
    return head.message == "LNAV" && (head.system == Constellation::gps || head.system == Constellation::qzss ||
                                      head.system == Constellation::navic);
}

// Takes the coefficients of an ION block, unless the system already has some (RINEX 4.00, tables 33 to 36).
// False when the block is damaged.
bool take_ionosphere(const BlockHead& head, std::span<const Line> lines, BroadcastIonosphere& ionosphere) {
    if (head.message == "IFNV") {
        const auto values = block_fields<3>(lines);
        if (values && !ionosphere.galileo && *values != std::array<double, 3>{}) ionosphere.galileo = *values;
        return values.has_value();
    }
    const auto v = block_fields<8>(lines);
    if (!v) return false;
    auto& target = klobuchar_of(ionosphere, *head.system);
    const KlobucharCoefficients told{{(*v)[0], (*v)[1], (*v)[2], (*v)[3]}, {(*v)[4], (*v)[5], (*v)[6], (*v)[7]}};
    if (!target && told != KlobucharCoefficients{}) target = told;
    return true;
}

// Whether an STO block (RINEX 4.00, table 31) is whole. Nobody uses what it tells.
bool is_time_offset(std::span<const Line> lines) {
    if (lines.size() < 2 || trimmed(columns(lines[0].text, 24, 18)).size() != 4) return false;
    const auto body = lines.subspan(1);  // the time of transmission, a0, a1
    return block_field(body, 0) && block_field(body, 1) && block_field(body, 2);
}

class NavigationReading {
public:
    NavigationReading(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<NavigationFile> read() {
        Result<NavigationHeader> header = read_header(lines_, name_);
        if (!header) return fail(header.error());
        major_ = header->major();
        file_.version = header->version;
        system_ = header->system;
        file_.ionosphere = header->ionosphere;
        file_.leap_seconds = header->leap_seconds;
        file_.warnings = std::move(header->warnings);

        advance();
        while (line_) {
            if (major_ >= 4)
                block();
            else
                record();
        }
        if (file_.records.empty()) return nothing_read();
        warn();
        return std::move(file_);
    }

private:
    void advance() { line_ = lines_.next_filled(); }
    // A line that continues the record at hand.
    [[nodiscard]] bool continues() const { return line_ && !begins_record(line_->text, major_); }
    void skip_record() {
        do
            advance();
        while (continues());
    }

    // Version 4: "> EPH G02 LNAV" and the lines up to the next ">".
    void block() {
        if (!line_->text.starts_with('>')) return stray();
        const Line first = *line_;
        const BlockHead head = block_head(first.text);
        advance();
        if (head.type == "EPH" && head.satellite && line_ && begins_record(line_->text, major_) &&
            !line_->text.starts_with('>')) {
            if (const BlockMessage* message = message_of_block(head)) return record(message);
        }
        std::vector<Line> body;
        for (; line_ && !line_->text.starts_with('>'); advance())
            if (body.size() < longest_record) body.push_back(*line_);
        other_block(first, head, body);
    }

    void other_block(const Line& first, const BlockHead& head, std::span<const Line> body) {
        if (head.type == "STO") {
            if (is_time_offset(body)) return;
            return tally(file_.skipped.defective, defective_, first.number, "a damaged time offset block",
                         "an epoch, the name of an offset, and three numbers in two lines");
        }
        if (is_read_ionosphere(head)) {
            if (!take_ionosphere(head, body, file_.ionosphere))
                tally(file_.skipped.defective, defective_, first.number, "a damaged ionosphere block",
                      "an epoch and the coefficients of the model");
            return;
        }
        if (head.type == "EPH" && head.satellite && !head.message.empty() && !message_of_block(head))
            ++file_.skipped.messages[std::string(head.message)];
        else if (head.type == "EOP" || head.type == "ION")
            ++file_.skipped.messages[std::string(head.type)];
        else
            tally(file_.skipped.defective, defective_, first.number, in_quotes(first.text),
                  "a block header such as '> EPH G02 LNAV' and a record");
    }

    // @param message of version 4
    void record(const BlockMessage* message = nullptr) {
        if (continues()) return stray();
        const Line first = *line_;
        const std::optional<SatelliteId> satellite = record_satellite(first.text, major_, system_);
        if (!satellite) {
            tally(file_.skipped.defective, defective_, first.number, in_quotes(columns(first.text, 0, 3)),
                  major_ == 2 ? "a satellite number" : "a satellite such as 'G07'");
            return skip_record();
        }
        RecordKind kind{*satellite, major_, std::nullopt};
        if (message != nullptr) {
            kind.message = message->message;
            kind.layout = message->layout;
        }
        ephemeris(kind, first);
    }

    void ephemeris(const RecordKind& kind, const Line& first) {
        const RecordLength length = record_length(kind.satellite.constellation, kind.layout);
        std::array<Line, longest_record> lines{first};
        std::size_t count = 1;
        // Within a record a blank line is one whose fields are all blank.
        for (line_ = lines_.next(); count < length.most && continues(); line_ = lines_.next())
            lines[count++] = *line_;
        if (line_ && is_blank(line_->text)) advance();
        if (count < length.least)
            return tally(file_.skipped.incomplete, incomplete_, first.number,
                         fmt::format("a record of {} cut off after {} of its lines", to_string(kind.satellite), count),
                         fmt::format("{} lines", length.least));
        auto read = read_record(kind, std::span(lines.data(), count));
        if (read) return file_.records.push_back(std::move(*read));
        ++file_.skipped.defective;
        // Many records may fail; only the first needs words.
        defective_.add_with([&] {
            return fmt::format("{}:{}:{}: found {}; expected {}", name_, read.error().line, read.error().column,
                               read.error().found, read.error().expected);
        });
    }

    void stray() {
        stray_.add(at_line(name_, line_->number, in_quotes(line_->text), "the first line of a record"));
        advance();
    }

    void tally(int& counter, DefectTally& tally, int line, std::string_view found, std::string_view expected) const {
        ++counter;
        tally.add(at_line(name_, line, found, expected));
    }

    Result<NavigationFile> nothing_read() const {
        for (const DefectTally* t : {&defective_, &incomplete_, &stray_})
            if (t->count > 0) return fail(ErrorCode::input, t->first + "; no record could be read");
        if (!file_.skipped.messages.empty())
            return refused(name_, lines_.number(), fmt::format("only messages of other kinds ({})", messages()),
                           "ephemerides of LNAV, INAV, FNAV, D1, D2, FDMA, SBAS, CNAV or CNV1 to CNV3");
        if (!file_.warnings.empty()) return fail(ErrorCode::input, file_.warnings.front() + "; no record follows");
        return refused(name_, lines_.number(), "the end of the file and no ephemeris", "records after the header");
    }

    void warn() {
        defective_.warn(file_.warnings, "record skipped");
        incomplete_.warn(file_.warnings, "record skipped");
        stray_.warn(file_.warnings, "line skipped");
        if (!file_.skipped.messages.empty())
            file_.warnings.push_back(fmt::format("{}: skipped messages of other kinds ({})", name_, messages()));
    }
    [[nodiscard]] std::string messages() const {
        std::vector<std::string> parts;
        for (const auto& [message, count] : file_.skipped.messages)
            parts.push_back(fmt::format("{} {}", count, in_quotes(message)));
        return fmt::format("{}", fmt::join(parts, ", "));
    }

    LineReader lines_;
    std::string_view name_;
    int major_ = 2;
    Constellation system_ = Constellation::gps;
    std::optional<Line> line_;
    NavigationFile file_;
    DefectTally defective_;
    DefectTally incomplete_;
    DefectTally stray_;
};

}  // namespace
}  // namespace rinex

std::map<Constellation, int> NavigationFile::counts() const {
    std::map<Constellation, int> counts;
    for (const Ephemeris& record : records)
        ++counts[satellite_of(record).constellation];
    return counts;
}

Result<NavigationFile> read_navigation(std::string_view text, std::string_view name) {
    return rinex::NavigationReading(rinex::without_byte_order_mark(text), name).read();
}

Result<NavigationFile> read_navigation_file(const std::filesystem::path& path) {
    return read_text_with(path, read_navigation);
}

}  // namespace skyloop::inline world

// Our own feed, lines of JSON: skyloop-truth/1 (FEEDS.md 3.3, docs/feeds.md).
#include "detail/dialect_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "detail/json_statement.hpp"
#include "motion/trajectory/live_path.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t longest_json_line = 65536;
constexpr std::size_t most_json_vehicles = 1024, longest_vehicle_name = 64;
constexpr std::int64_t json_answer_distance_ns = 1'000'000'000;

Bytes json_line(const JsonData& object) { return to_bytes(json_text(object) + "\n"); }

class JsonDialect : public FeedDialect {
public:
    explicit JsonDialect(FeedContext context) : context_(std::move(context)), origin_(context_.origin) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        while (!text.empty()) {
            const std::size_t end = text.find('\n');
            const bool whole = end != std::string_view::npos;
            take_piece(text.substr(0, end), news, whole || context_.datagrams, received_ns);
            text.remove_prefix(whole ? end + 1 : text.size());
        }
        return news;
    }

    std::vector<Bytes> say() override {
        return {json_line({{"type", "hello"},
                           {"v", 1},
                           {"schema", "skyloop-truth/1"},
                           {"want", JsonData::array({"truth"})},
                           {"rate_hz", context_.rate_hz}})};
    }

    std::vector<Bytes> stepped(Nanoseconds until, std::uint64_t bytes) override {
        return {json_line(
            {{"type", "stepped"}, {"t", to_seconds(until).value()}, {"t_ns", until.count()}, {"bytes", bytes}})};
    }

    void reconnected() override {
        line_.clear();
        too_long_ = false;
    }

private:
    // What each vehicle has counted.
    struct Vehicle {
        std::optional<std::int64_t> sequence, reset;
    };

    void take_piece(std::string_view piece, FeedNews& news, bool ends, std::int64_t received_ns) {
        if (line_.size() + piece.size() > longest_json_line) {
            too_long_ = true;
            line_.clear();
        }
        if (!too_long_) line_ += piece;
        if (!ends) return;
        ++lines_;
        if (std::exchange(too_long_, false))
            refuse(news, fmt::format("is longer than {} bytes", longest_json_line), received_ns);
        else if (line_.find_first_not_of(" \t\r") != std::string::npos)
            take_line(news, received_ns);
        line_.clear();
    }

    void take_line(FeedNews& news, std::int64_t received_ns) {
        const std::size_t samples = news.samples.size();
        const auto statement = read_statement(line_);
        const auto taken =
            statement ? take_statement(*statement, news, received_ns) : Result<void>(fail(statement.error()));
        if (!taken)
            refuse(news, taken.error().message, received_ns);
        else if (news.samples.size() == samples)
            ++news.others;
    }

    void refuse(FeedNews& news, const std::string& why, std::int64_t received_ns) {
        if (news.refused++ == 0) news.refusal = fmt::format("line {} {}", lines_, why);
        if (answered_ns_ && received_ns < *answered_ns_ + json_answer_distance_ns) return;
        answered_ns_ = received_ns;
        news.answers.push_back(json_line({{"type", "error"}, {"line", lines_}, {"what", why}}));
    }

    Result<void> take_statement(const JsonData& statement, FeedNews& news, std::int64_t received_ns) {
        const auto version = statement_whole(statement, "v");
        if (!version) return fail(version.error());
        if (version->value_or(1) != 1) return fail(ErrorCode::input, fmt::format("'v' is {}; expected 1", **version));
        const auto type = statement_text(statement, "type");
        if (!type) return fail(type.error());
        const std::string name = type->value_or("truth");
        if (name == "truth") return take_truth(statement, news, received_ns);
        if (name == "origin") return take_origin(statement);
        if (name == "clock") return take_clock(statement, news);
        if (name == "event") return take_event(statement, news);
        if (name == "step") return take_step(statement, news);
        if (name == "hello") {
            end_pause(news);
            news.answers.push_back(say().front());
        }
        if (name == "bye") news.add_aside(FeedEnd{});
        if (name == "vis" && !std::exchange(vis_told_, true))
            report_remark(news, "its lines of type 'vis' (lines of sight of an engine) are not used");
        return {};  // others are of a later version
    }

    Result<void> take_truth(const JsonData& statement, FeedNews& news, std::int64_t received_ns) {
        auto sample = statement_sample(statement, origin_, context_);
        if (!sample) return fail(sample.error());
        if (const auto why = implausible(*sample)) return fail(ErrorCode::input, "cannot be: " + *why);
        const auto id = vehicle_of(statement);
        if (!id) return fail(id.error());
        const auto time = statement_time(statement);
        if (!time) return fail(time.error());
        const auto sequence = statement_whole(statement, "seq"), reset = statement_whole(statement, "reset");
        if (!sequence) return fail(sequence.error());
        if (!reset) return fail(reset.error());
        sample->vehicle = *id;
        sample->source_time = *time;
        sample->received_ns = received_ns;
        if (vehicles_.size() < most_json_vehicles || vehicles_.contains(*id)) {
            Vehicle& vehicle = vehicles_[*id];
            news.lost += gap(vehicle.sequence, *sequence);
            sample->jump = *reset && vehicle.reset && *reset != vehicle.reset;
            if (*reset) vehicle.reset = *reset;
        }
        look_whether_time_goes_on(*time, news);
        news.samples.push_back(std::move(*sample));
        return {};
    }

    // Statements that are missing between two numbers; one that comes late, or a counter that begins anew, is no gap.
    static std::uint64_t gap(std::optional<std::int64_t>& last, const std::optional<std::int64_t>& now) {
        constexpr std::int64_t most = 1'000'000;
        if (!now) return 0;
        const std::optional<std::int64_t> before = last;
        if (!before || *now > *before || *before - most > *now) last = now;
        if (!before || *now <= *before || *before < 0 || *now - *before > most) return 0;
        return static_cast<std::uint64_t>(*now - *before - 1);
    }

    static Result<std::string> vehicle_of(const JsonData& statement) {
        const JsonData* id = statement_member(statement, "id");
        if (id != nullptr && id->is_number_integer()) return id->dump();
        const auto text = statement_text(statement, "id");
        if (!text) return fail(text.error());
        std::string name = text->value_or("0");
        if (name.empty() || name.size() > longest_vehicle_name)
            return fail(ErrorCode::input, "'id' is empty or longer than 64; expected the name of a vehicle");
        return name;
    }

    Result<void> take_origin(const JsonData& statement) {
        const auto place = statement_place(statement, context_);
        if (!place) return fail(place.error());
        origin_ = *place;
        return {};
    }

    Result<void> take_clock(const JsonData& statement, FeedNews& news) {
        const JsonData* paused = statement_member(statement, "paused");
        if (paused == nullptr) return {};
        if (!paused->is_boolean()) return fail(ErrorCode::input, "'paused' is neither true nor false");
        paused_ = paused->get<bool>();
        stands_at_.reset();
        news.add_aside(FeedPause{paused_});
        return {};
    }

    void end_pause(FeedNews& news) {
        if (std::exchange(paused_, false)) news.add_aside(FeedPause{false});
    }

    // A source that was started anew in a pause does not know of it: its time goes on. The first time after the notice
    // may be that of the instant at which it paused.
    void look_whether_time_goes_on(const std::optional<Nanoseconds>& time, FeedNews& news) {
        if (!paused_ || !time) return;
        if (!stands_at_)
            stands_at_ = time;
        else if (*time != *stands_at_)
            end_pause(news);
    }

    Result<void> take_event(const JsonData& statement, FeedNews& news) {
        auto command = statement_event(statement);
        if (!command) return fail(command.error());
        const auto time = statement_time(statement);
        if (!time) return fail(time.error());
        if (*time && !std::exchange(event_time_told_, true))
            report_remark(news, "its events act when they come; their times are not used");
        news.add_aside(std::move(*command));
        return {};
    }

    static Result<void> take_step(const JsonData& statement, FeedNews& news) {
        const auto until = statement_time(statement);
        if (!until) return fail(until.error());
        if (!*until) return fail(ErrorCode::input, "the step has no 't'; expected the time until which the run may go");
        news.add_aside(FeedMilestone{**until});
        return {};
    }

    FeedContext context_;
    std::optional<Geodetic> origin_;
    std::string line_;  // what has come of it
    bool too_long_ = false, vis_told_ = false, event_time_told_ = false, paused_ = false;
    std::optional<Nanoseconds> stands_at_;  // what truth has told since the notice of a pause
    std::uint64_t lines_ = 0;
    std::optional<std::int64_t> answered_ns_;  // when a refusal was
    std::map<std::string, Vehicle> vehicles_;
};

}  // namespace

std::unique_ptr<FeedDialect> make_json_dialect(const FeedContext& context) {
    return std::make_unique<JsonDialect>(context);
}

}  // namespace skyloop::inline run

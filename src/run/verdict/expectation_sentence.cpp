#include "run/verdict/expectation.hpp"

#include "base/core/number_text.hpp"
#include "detail/sentence_words.hpp"

namespace skyloop::inline run {

bool is_message(ExpectedSubject subject) {
    return subject == ExpectedSubject::client_sends || subject == ExpectedSubject::receiver_sends ||
           subject == ExpectedSubject::client_reconfigures;
}

bool means_a_stretch(const TimeClause& time) {
    return !time.never && time.rule != TimeRule::some_time && time.rule != TimeRule::within &&
           time.rule != TimeRule::at;
}

namespace {

constexpr double longest_span_s = 1e9;  // 31 years; nanoseconds of 64 bits reach 292
constexpr double largest_limit = 1e9;
constexpr std::string_view unit_rule = "times are in s, lengths in m, speeds in m/s, C/N0 in dBHz";

// Reads one sentence, rule by rule as the header writes them.
class SentenceParser {
public:
    explicit SentenceParser(std::string_view text) : words_(text) {}
    tl::expected<ExpectedSentence, SentenceMistake> read();

private:
    void read_subject();
    bool read_fix();
    bool read_quantity();
    bool read_number_of(std::string_view word, ExpectedSubject subject, std::initializer_list<std::string_view> units);
    bool read_cn0();
    void read_comparison(std::initializer_list<std::string_view> units);
    void read_sender(bool client);
    void read_message(ExpectedSubject subject);
    void read_silence(ExpectedSubject subject);

    void read_time();
    bool read_window();
    void read_length();
    void read_from_to();
    void read_within();
    EventReference read_event();
    void name_event(std::string text, std::size_t column);
    Seconds read_span();

    void check();
    void check_messages();
    void check_run();

    SentenceWords words_;
    SubjectClause subject_;
    TimeClause time_;
    bool silence_given_ = false;
    std::size_t time_column_ = 1;
    EventReference event_;
};

tl::expected<ExpectedSentence, SentenceMistake> SentenceParser::read() {
    read_subject();
    time_column_ = words_.column();
    read_time();
    words_.wanted("the end of the sentence");
    if (!words_.at_end()) words_.refuse();
    check();
    if (words_.mistake()) return tl::make_unexpected(*words_.mistake());
    return ExpectedSentence{subject_, time_};
}

void SentenceParser::read_subject() {
    if (read_fix() || read_quantity()) return;
    if (words_.accept("jamming")) {
        subject_.subject = ExpectedSubject::jamming_flagged;
        words_.one_of({"flagged"});
    } else if (words_.accept("spoofing")) {
        subject_.subject = ExpectedSubject::spoofing_flagged;
        words_.one_of({"flagged"});
    } else if (words_.accept("client")) {
        read_sender(true);
    } else if (words_.accept("receiver")) {
        read_sender(false);
    } else {
        words_.refuse();
    }
}

bool SentenceParser::read_fix() {
    const auto type = [this](FixType fix_type) {
        subject_.subject = ExpectedSubject::fix_type;
        subject_.fix_type = fix_type;
    };
    if (words_.accept("no")) return words_.one_of({"fix"}), subject_.subject = ExpectedSubject::no_fix, true;
    if (words_.accept("fix")) return subject_.subject = ExpectedSubject::fix, true;
    if (words_.accept("2d")) return words_.one_of({"fix"}), type(FixType::fix_2d), true;
    if (words_.accept("3d")) return words_.one_of({"fix"}), type(FixType::fix_3d), true;
    if (words_.accept("dgnss")) return words_.one_of({"fix"}), type(FixType::dgnss), true;
    if (words_.accept("dead")) return words_.one_of({"reckoning"}), type(FixType::dead_reckoning), true;
    if (words_.accept("time")) return words_.one_of({"only"}), type(FixType::time_only), true;
    if (!words_.accept("rtk")) return false;
    type(words_.one_of({"fixed", "float"}) == 1 ? FixType::rtk_float : FixType::rtk_fixed);
    return true;
}

bool SentenceParser::read_quantity() {
    const auto error_of = [this](ExpectedSubject subject, std::initializer_list<std::string_view> units) {
        subject_.subject = subject;
        words_.one_of({"error"});
        read_comparison(units);
        return true;
    };
    if (words_.accept("horizontal")) return error_of(ExpectedSubject::horizontal_error, {"m"});
    if (words_.accept("vertical")) return error_of(ExpectedSubject::vertical_error, {"m"});
    if (words_.accept("speed")) return error_of(ExpectedSubject::speed_error, {"m/s"});
    return read_number_of("h_acc", ExpectedSubject::horizontal_accuracy, {"m"}) ||
           read_number_of("v_acc", ExpectedSubject::vertical_accuracy, {"m"}) ||
           read_number_of("pdop", ExpectedSubject::pdop, {}) || read_number_of("hdop", ExpectedSubject::hdop, {}) ||
           read_number_of("vdop", ExpectedSubject::vdop, {}) ||
           read_number_of("satellites", ExpectedSubject::satellites, {}) || read_cn0();
}

bool SentenceParser::read_number_of(std::string_view word, ExpectedSubject subject,
                                    std::initializer_list<std::string_view> units) {
    if (!words_.accept(word)) return false;
    subject_.subject = subject;
    read_comparison(units);
    return true;
}

bool SentenceParser::read_cn0() {
    if (!words_.accept("C/N0")) return false;
    subject_.subject = ExpectedSubject::cn0;
    if (words_.accept("of")) {
        const std::size_t column = words_.column();
        const auto name = words_.name("a satellite (G07, E12)");
        subject_.satellite = name ? parse_satellite(*name) : std::nullopt;
        if (name && !subject_.satellite)
            words_.refuse(column, "'" + *name + "' is no satellite; expected one as RINEX writes it: G07, E12");
    }
    read_comparison({"dBHz", "dB-Hz"});
    return true;
}

void SentenceParser::read_comparison(std::initializer_list<std::string_view> units) {
    if (words_.accept("below"))
        subject_.comparison = Relation::below;
    else if (words_.accept("above"))
        subject_.comparison = Relation::above;
    else if (words_.accept({"at", "least"}))
        subject_.comparison = Relation::at_least;
    else if (words_.accept({"at", "most"}))
        subject_.comparison = Relation::at_most;
    else
        words_.refuse();
    subject_.limit = words_.number(largest_limit).value_or(0);
    if (units.size() > 0) words_.unit(units, unit_rule);
}

void SentenceParser::read_sender(bool client) {
    if (words_.accept("sends"))
        return read_message(client ? ExpectedSubject::client_sends : ExpectedSubject::receiver_sends);
    if (words_.accept("silent"))
        return read_silence(client ? ExpectedSubject::client_silent : ExpectedSubject::receiver_silent);
    if (!client) return words_.refuse();
    static constexpr ExpectedSubject subjects[] = {ExpectedSubject::client_reconfigures, ExpectedSubject::client_trusts,
                                                   ExpectedSubject::client_distrusts};
    if (const auto index = words_.one_of({"reconfigures", "trusts", "distrusts"})) subject_.subject = subjects[*index];
}

void SentenceParser::read_message(ExpectedSubject subject) {
    subject_.subject = subject;
    subject_.message = words_.name("the name of a message (CFG-VALSET, \"PUBX,41\", CFG-*) or anything").value_or("");
    if (words_.accept("every")) subject_.every = read_span();
}

void SentenceParser::read_silence(ExpectedSubject subject) {
    subject_.subject = subject;
    silence_given_ = words_.accept("for");
    if (silence_given_) subject_.silence = read_span();
}

void SentenceParser::read_time() {
    if (words_.mistake() || words_.at_end()) return;
    if (words_.accept("always")) {
        time_.rule = TimeRule::always;
    } else if (words_.accept("never")) {
        time_.never = true;
        time_.rule = TimeRule::always;
        if (!words_.at_end() && !read_window()) words_.refuse();
    } else if (words_.accept("at")) {
        time_.rule = TimeRule::at;
        time_.from = read_span();
    } else if (words_.accept("within")) {
        read_within();
    } else if (words_.at_number()) {
        time_.rule = TimeRule::at;
        time_.from = read_span();
        words_.one_of({"after"});
        time_.event = read_event();
    } else if (!read_window()) {
        words_.wanted("a time and 's after' an event");
        words_.refuse();
    }
}

void SentenceParser::read_within() {
    time_.rule = TimeRule::within;
    time_.until = read_span();
    words_.one_of({"of"});
    time_.event = read_event();
}

bool SentenceParser::read_window() {
    if (words_.accept("throughout")) {
        time_.rule = TimeRule::throughout;
        time_.event = read_event();
    } else if (words_.accept("during")) {
        time_.rule = TimeRule::during;
        time_.event = read_event();
    } else if (words_.accept("from")) {
        read_from_to();
    } else if (words_.accept("until")) {
        time_.rule = TimeRule::until_event;
        time_.event = read_event();
    } else if (words_.accept("after")) {
        time_.rule = TimeRule::after;
        time_.event = read_event();
        if (words_.accept("for")) read_length();
    } else {
        return false;
    }
    return true;
}

void SentenceParser::read_length() {
    const std::size_t column = words_.column();
    time_.until = read_span();
    if (*time_.until <= Seconds(0)) words_.refuse(column, "a stretch of 0 s is none; expected more than 0 s");
}

void SentenceParser::read_from_to() {
    time_.rule = TimeRule::from_to;
    time_.from = read_span();
    words_.one_of({"to"});
    const std::size_t column = words_.column();
    time_.until = read_span();
    if (*time_.until <= time_.from) words_.refuse(column, "the stretch of time ends before it begins");
    if (words_.accept("after")) time_.event = read_event();
}

EventReference SentenceParser::read_event() {
    event_ = {};
    const bool article = words_.accept("the");
    event_.end = words_.accept({"end", "of"});
    const bool edge = event_.end || words_.accept({"start", "of"});
    if (edge || !article) words_.accept("the");
    if (words_.accept("run")) return event_.name = "run", event_;
    const std::size_t column = words_.column();
    if (auto name = words_.name("the name or kind of a fault or command")) name_event(std::move(*name), column);
    return event_;
}

// "outage#2" is the second outage.
void SentenceParser::name_event(std::string text, std::size_t column) {
    const std::size_t mark = text.rfind('#');
    if (mark != std::string::npos) {
        const int occurrence = number_in<int>(std::string_view(text).substr(mark + 1)).value_or(0);
        if (mark == 0 || occurrence < 1)
            return words_.refuse(column, "'" + text + "' names no occurrence; expected NAME#NUMBER, from 1");
        event_.occurrence = occurrence;
        text.resize(mark);
    }
    if (text == "run") return words_.refuse(column, "the run happens once; expected run");
    event_.name = std::move(text);
}

Seconds SentenceParser::read_span() {
    const auto number = words_.number(longest_span_s);
    words_.unit({"s"}, unit_rule);
    return Seconds(number.value_or(0));
}

// What each rule takes alone may still make no sense together.
void SentenceParser::check() {
    if (words_.mistake()) return;
    if ((time_.rule == TimeRule::throughout || time_.rule == TimeRule::during) && time_.event->end)
        words_.refuse(time_column_, "an end takes no time; expected throughout or during the event itself");
    if (time_.event && time_.event->is_run()) check_run();
    check_messages();
    if (silence_given_ && means_a_stretch(time_))
        words_.refuse(time_column_, "'silent' means the whole stretch of time here; expected no 'for' before it");
    if (silence_given_ && subject_.silence <= Seconds(0))
        words_.refuse(1, "a silence of 0 s is none; expected more than 0 s");
}

void SentenceParser::check_messages() {
    if (subject_.every) {
        if (*subject_.every <= Seconds(0)) words_.refuse(1, "'every 0 s' cannot be; expected more than 0 s");
        if (!means_a_stretch(time_))
            words_.refuse(time_column_,
                          "'every' needs a stretch of time; expected always, throughout, during, from, until or after");
        return;
    }
    if (!is_message(subject_.subject) || time_.never) return;
    if (time_.rule == TimeRule::at)
        words_.refuse(time_column_, "a message is sent at an instant; expected within, during, from, until or after");
    if (time_.rule == TimeRule::throughout || time_.rule == TimeRule::always)
        words_.refuse(time_column_,
                      "a message is sent at an instant; expected during, or 'every N s' behind the message's name");
}

// The run is an event as any other; what is said of it has a plainer form.
void SentenceParser::check_run() {
    const bool end = time_.event->end;
    const bool once = is_message(subject_.subject) && !subject_.every && !time_.never;
    const TimeRule whole = once ? TimeRule::some_time : TimeRule::always;
    switch (time_.rule) {
        case TimeRule::until_event:
            if (!end) words_.refuse(time_column_, "nothing lies before the start of the run; expected until its end");
            time_.rule = whole;
            break;
        case TimeRule::throughout:
            time_.rule = TimeRule::always;
            break;
        case TimeRule::during:
            time_.rule = whole;
            break;
        case TimeRule::after:
            time_.rule = time_.until ? TimeRule::from_to : whole;
            break;
        default:
            break;
    }
    if (end && time_.rule != whole) words_.refuse(time_column_, "nothing is seen after the end of the run");
    if (time_.rule != TimeRule::within) time_.event.reset();
}

}  // namespace

tl::expected<ExpectedSentence, SentenceMistake> parse_expectation(std::string_view text) {
    return SentenceParser(text).read();
}

}  // namespace skyloop::inline run

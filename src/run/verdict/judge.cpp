#include "run/verdict/judge.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detail/expectation_tracker.hpp"
#include "detail/probe_run.hpp"
#include "run/fault/run_observer.hpp"
#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {

class Judge::State {
    struct Follower {
        std::size_t station;
        ExpectationTracker tracker;
    };
    // One expectation at all receivers that it is about, or its probe.
    struct Case {
        Expectation expectation;
        std::vector<Follower> followers{};
        std::unique_ptr<ProbeRun> probe{};
        std::optional<GpsTime> probe_over_at{};
    };

public:
    State(std::vector<Expectation> expectations, JudgedRun run);
    // What is seen now; never earlier than what was seen before.
    GpsTime pass(GpsTime now);
    template <class Look>
    void at_station(std::size_t station, const Look& look);
    bool is_silent(const EpochSeen& seen) { return silence_.is_silent(seen, now_); }
    [[nodiscard]] bool hears() const { return hears_; }
    void happen(const FaultSeen& seen);
    std::vector<Verdict> finish(GpsTime now, RunEnd end);
    [[nodiscard]] std::vector<Verdict> so_far() const;
    void start_probes(GpsTime now);

private:
    Verdict verdict_of(Case& one, GpsTime now);
    Finding probe_finding(Case& one, GpsTime now);
    Finding common_finding(Case& one, GpsTime now);
    [[nodiscard]] Finding worst_of(const Case& one, const std::vector<Finding>& findings) const;
    [[nodiscard]] Finding finding_so_far(const Case& one) const;
    [[nodiscard]] Verdict verdict_with(const Case& one, Finding finding, GpsTime now) const;

    JudgedRun run_;
    GpsTime now_;
    RunEnd end_ = RunEnd::over;
    std::vector<Case> cases_;
    SilenceWatch silence_;
    bool has_probes_ = false, hears_ = false;
};

Judge::State::State(std::vector<Expectation> expectations, JudgedRun run)
    : run_(std::move(run)), now_(run_.start), silence_(run_.start) {
    for (Expectation& expectation : expectations) {
        Case one{std::move(expectation)};
        has_probes_ = has_probes_ || one.expectation.probe;
        hears_ = hears_ || (one.expectation.sentence && is_of_messages(one.expectation.sentence->subject.subject));
        for (std::size_t i = 0; one.expectation.sentence && i < run_.receivers.size(); ++i)
            if (one.expectation.receiver.empty() || one.expectation.receiver == run_.receivers[i])
                one.followers.push_back({i, ExpectationTracker(*one.expectation.sentence, run_.start)});
        cases_.push_back(std::move(one));
    }
}

GpsTime Judge::State::pass(GpsTime now) {
    now_ = std::max(now_, now);
    for (Case& one : cases_)
        for (Follower& follower : one.followers)
            follower.tracker.advance(now_);
    if (has_probes_ && run_.live) start_probes(now_);
    return now_;
}

template <class Look>
void Judge::State::at_station(std::size_t station, const Look& look) {
    for (Case& one : cases_)
        for (Follower& follower : one.followers)
            if (follower.station == station && !follower.tracker.is_decided()) look(follower.tracker);
}

void Judge::State::happen(const FaultSeen& seen) {
    for (Case& one : cases_)
        for (Follower& follower : one.followers)
            follower.tracker.event(now_, seen);
}

void Judge::State::start_probes(GpsTime now) {
    for (Case& one : cases_) {
        if (!one.expectation.probe) continue;
        if (!one.probe && now >= advanced(run_.start, one.expectation.probe->at))
            one.probe = std::make_unique<ProbeRun>(*one.expectation.probe, run_.probe_environment,
                                                   run_.orphans != nullptr ? run_.orphans->listener() : nullptr);
        if (one.probe && !one.probe_over_at && one.probe->is_over()) one.probe_over_at = now;
    }
}

Finding Judge::State::probe_finding(Case& one, GpsTime now) {
    if (!run_.live) return {Outcome::not_run, "a probe needs a run against the clock, and this one was not", {}};
    // One that is due at the very end has no time, whether or not it was started.
    if (!one.probe || now <= advanced(run_.start, one.expectation.probe->at))
        return {Outcome::undecided,
                fmt::format("the run ended after {}, before the command {}", span_text(difference(now, run_.start)),
                            now <= advanced(run_.start, one.expectation.probe->at) ? "was due" : "was started"),
                {}};
    Finding finding = one.probe->finish();
    finding.decided_at = one.probe_over_at;
    return finding;
}

Finding Judge::State::common_finding(Case& one, GpsTime now) {
    std::vector<Finding> findings;
    for (Follower& follower : one.followers)
        findings.push_back(follower.tracker.finish(now, end_));
    return worst_of(one, findings);
}

// It passes when it passes everywhere; the first that does not speaks for all.
Finding Judge::State::worst_of(const Case& one, const std::vector<Finding>& findings) const {
    if (findings.empty())
        return {Outcome::failed, fmt::format("no receiver is called '{}'", one.expectation.receiver), {}};
    const auto weight = [](const Finding& f) {
        return f.outcome == Outcome::failed ? 2 : f.outcome == Outcome::undecided ? 1 : 0;
    };
    std::size_t worst = 0;
    for (std::size_t i = 1; i < findings.size(); ++i)
        if (weight(findings[i]) > weight(findings[worst])) worst = i;
    Finding finding = findings[worst];
    if (findings.size() > 1 && !finding.evidence.empty())
        finding.evidence = fmt::format("{}: {}", run_.receivers[one.followers[worst].station], finding.evidence);
    return finding;
}

Finding Judge::State::finding_so_far(const Case& one) const {
    if (one.expectation.probe) {
        if (!one.probe_over_at) return {};
        Finding finding = one.probe->found();
        finding.decided_at = one.probe_over_at;
        return finding;
    }
    std::vector<Finding> findings;
    for (const Follower& follower : one.followers)
        findings.push_back(follower.tracker.so_far());
    return worst_of(one, findings);
}

Verdict Judge::State::verdict_of(Case& one, GpsTime now) {
    return verdict_with(one, one.expectation.probe ? probe_finding(one, now) : common_finding(one, now), now);
}

Verdict Judge::State::verdict_with(const Case& one, Finding finding, GpsTime now) const {
    Verdict verdict;
    verdict.name = one.expectation.title();
    if (one.expectation.probe)
        verdict.expected = probe_text(*one.expectation.probe);
    else if (one.expectation.sentence)
        verdict.expected = expectation_text(*one.expectation.sentence);
    verdict.outcome = finding.outcome;
    verdict.evidence = std::move(finding.evidence);
    verdict.decided_at = finding.decided_at;
    verdict.run_time = difference(finding.decided_at.value_or(now), run_.start);
    return verdict;
}

std::vector<Verdict> Judge::State::so_far() const {
    std::vector<Verdict> verdicts;
    for (const Case& one : cases_)
        verdicts.push_back(verdict_with(one, finding_so_far(one), now_));
    return verdicts;
}

std::vector<Verdict> Judge::State::finish(GpsTime now, RunEnd end) {
    now_ = std::max(now_, now);
    end_ = end;
    for (Case& one : cases_)
        if (one.probe && !one.probe_over_at && one.probe->is_over()) one.probe_over_at = now_;
    std::vector<Verdict> verdicts;
    for (Case& one : cases_)
        verdicts.push_back(verdict_of(one, now_));
    return verdicts;
}

Judge::Judge(std::vector<Expectation> expectations, JudgedRun run)
    : state_(std::make_unique<State>(std::move(expectations), std::move(run))) {}

Judge::~Judge() = default;

void Judge::on_epoch(const EpochSeen& seen) {
    const GpsTime now = state_->pass(seen.now);
    const bool silent = state_->is_silent(seen);
    if (!seen.leaves && !silent) return;
    state_->at_station(seen.station, [&](ExpectationTracker& tracker) {
        const SubjectClause& subject = tracker.subject();
        if (is_of_epochs(subject.subject))
            tracker.look(now, silent ? read_silence(subject) : read_epoch(subject, seen));
    });
}

void Judge::on_message(const MessageSeen& seen) {
    const GpsTime now = state_->pass(seen.now);
    state_->at_station(seen.station, [&](ExpectationTracker& tracker) {
        if (seen.kind != StreamKind::noise) tracker.note_sender(seen.from_client);
        if (speaks_of(tracker.subject(), seen)) tracker.hear(now, seen.name);
    });
}

bool Judge::wants_messages() const { return state_->hears(); }

void Judge::on_fault(const FaultSeen& seen) {
    state_->pass(seen.now);
    state_->happen(seen);
}

void Judge::on_command(const CommandSeen& seen) {
    state_->pass(seen.now);
    const std::string_view verb = command_name(seen.command.verb);
    state_->happen({seen.now, seen.name, verb, 1, true});
    state_->happen({seen.now, seen.name, verb, 1, false});
}

void Judge::on_belief(const BeliefSeen& seen) {
    const GpsTime now = state_->pass(seen.now);
    state_->at_station(seen.station, [&](ExpectationTracker& tracker) {
        const ExpectedSubject subject = tracker.subject().subject;
        tracker.note_sender(true);
        if (is_belief(subject))
            tracker.look(now, {seen.trusts == (subject == ExpectedSubject::client_trusts), std::nullopt, seen.reason});
    });
}

void Judge::advance(GpsTime now) { state_->pass(now); }

std::vector<Verdict> Judge::so_far() const { return state_->so_far(); }

std::vector<Verdict> Judge::finish(GpsTime now, RunEnd end) { return state_->finish(now, end); }

std::string Expectation::title() const {
    if (!name.empty()) return name;
    return !what.empty() || !probe ? what : probe_text(*probe);
}

}  // namespace skyloop::inline run

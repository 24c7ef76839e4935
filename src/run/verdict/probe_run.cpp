#include "detail/probe_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>

#include "base/core/process.hpp"
#include "run/verdict/expectation_sentence.hpp"

namespace skyloop {
namespace {

using HostClock = std::chrono::steady_clock;  // probes look at the world outside, which has no other

constexpr std::size_t shown_output = 200;  // characters

// The end of what was printed, on one line.
std::string shown(const ProcessOutcome& outcome) {
    std::string text = outcome.errors.empty() ? outcome.output : outcome.errors;
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r'))
        text.pop_back();
    if (text.size() > shown_output) text = "…" + text.substr(text.size() - shown_output);
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    return text.empty() ? "; it printed nothing" : "; it printed: " + text;
}

// One that ended by itself between the last look and the kill has an exit code.
bool was_cut_short(const ProcessOutcome& outcome) { return outcome.cancelled && !outcome.enough && !outcome.exit_code; }

std::string ending(const ProcessOutcome& outcome, Seconds timeout) {
    if (outcome.timed_out) return "was killed after " + span_text(timeout);
    if (was_cut_short(outcome)) return "was killed as the run ended first";
    if (outcome.exit_code) return fmt::format("ended with exit code {}", *outcome.exit_code);
    return fmt::format("was ended by signal {}", outcome.signal.value_or(0));
}

std::vector<std::string> command_of(const Probe& probe) {
    if (probe.command.size() == 1) return {"/bin/sh", "-c", probe.command.front()};
    return probe.command;
}

}  // namespace

std::string probe_text(const Probe& probe) {
    std::string text = fmt::format("command '{}'", fmt::join(probe.command, " "));
    if (probe.condition) text += " prints " + condition_text(*probe.condition);
    if (probe.condition && probe.expect_exit) text += " and";
    if (!probe.condition || probe.expect_exit) text += fmt::format(" exits {}", probe.expect_exit.value_or(0));
    if (probe.within) text += " within " + span_text(*probe.within);
    return text;
}

ProbeRun::ProbeRun(Probe probe, std::vector<std::string> environment, ProcessGroupListener group)
    : probe_(std::move(probe)),
      environment_(std::move(environment)),
      group_(std::move(group)),
      thread_([this] { work(); }) {}

ProbeRun::~ProbeRun() { finish(); }

Finding ProbeRun::finish() {
    cancelled_ = true;
    if (thread_.joinable()) thread_.join();
    const std::scoped_lock lock(mutex_);
    return finding_;
}

void ProbeRun::work() {
    const auto end = HostClock::now() + std::chrono::duration<double>(probe_.within.value_or(Seconds(0)).value());
    constexpr auto pause = std::chrono::milliseconds(20);
    constexpr int pauses_between = 10;
    // A failure is final when no time is left to try again.
    while (try_once() == false && HostClock::now() < end) {
        for (int i = 0; i < pauses_between && !cancelled_; ++i)
            std::this_thread::sleep_for(pause);
        if (HostClock::now() >= end) break;
        if (!cancelled_) continue;
        keep_undecided();
        break;
    }
    over_ = true;
}

std::optional<bool> ProbeRun::try_once() {
    bool fulfilled = false;
    std::string line_seen;
    ProcessRequest request;
    request.command = command_of(probe_);
    request.environment = environment_;
    request.timeout = probe_.timeout;
    request.cancelled = [this] { return cancelled_.load(); };
    request.group = group_;
    if (probe_.condition)
        request.line = [&](std::string_view line) {
            if (!fulfilled && fulfils(*probe_.condition, line)) {
                fulfilled = true;
                line_seen = line.substr(0, shown_output);
            }
            return fulfilled && !probe_.expect_exit;
        };
    const auto outcome = run_process(request);
    if (!outcome) return keep(Outcome::failed, outcome.error().message), false;
    const bool exit_right = outcome->exit_code == probe_.expect_exit.value_or(0);
    const bool success = probe_.condition ? fulfilled && (!probe_.expect_exit || exit_right) : exit_right;
    std::string evidence = "the command " + ending(*outcome, probe_.timeout);
    if (fulfilled)
        evidence = (outcome->enough ? std::string() : evidence + "; ") + "it printed " + line_seen;
    else if (probe_.condition)
        evidence += "; no line of it fulfilled the condition" + shown(*outcome);
    else if (!success)
        evidence += shown(*outcome);
    if (was_cut_short(*outcome)) return keep(Outcome::undecided, std::move(evidence)), std::nullopt;
    keep(success ? Outcome::passed : Outcome::failed, std::move(evidence));
    return success;
}

void ProbeRun::keep(Outcome outcome, std::string evidence) {
    const std::scoped_lock lock(mutex_);
    finding_ = {outcome, std::move(evidence), std::nullopt};
}

// What the last try showed stays the evidence.
void ProbeRun::keep_undecided() {
    const std::scoped_lock lock(mutex_);
    finding_.outcome = Outcome::undecided;
    finding_.evidence = "the run ended before the time to try again was over; " + finding_.evidence;
}

}  // namespace skyloop

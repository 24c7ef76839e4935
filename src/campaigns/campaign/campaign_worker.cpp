#include "campaigns/campaign/campaign_worker.hpp"

#include <fmt/format.h>

#include <istream>
#include <ostream>

#include "base/core/json.hpp"

namespace skyloop::inline campaigns {
namespace {

std::string one_line(const JsonData& value) { return json_text(value); }

tl::unexpected<Error> not_understood(const std::exception& mistake) {
    return fail(ErrorCode::outside, fmt::format("a line between worker and leader is not understood: {}",
                                                std::string_view(mistake.what()).substr(0, 200)));
}

Result<CampaignRunSetup> setup_from(const std::string& line) {
    try {
        const JsonData greeting = JsonData::parse(line);
        CampaignRunSetup setup;
        greeting.at("text").get_to(setup.text);
        setup.file = greeting.at("file").get<std::string>();
        greeting.at("parameters").get_to(setup.columns.parameters);
        greeting.at("metrics").get_to(setup.columns.metrics);
        greeting.at("verdicts").get_to(setup.columns.verdicts);
        return setup;
    } catch (const std::exception& mistake) {
        return not_understood(mistake);
    }
}

struct Question {
    PlannedRun run;
    std::vector<ScenarioChange> changes;
};

Result<Question> question_from(const std::string& line) {
    try {
        const JsonData json = JsonData::parse(line);
        Question question;
        json.at("number").get_to(question.run.number);
        json.at("key").get_to(question.run.key);
        json.at("seed").get_to(question.run.seed);
        for (const auto& value : json.at("values"))
            question.run.values.push_back({value.at(0), value.at(1)});
        for (const auto& change : json.at("changes"))
            question.changes.push_back({change.at(0), {change.at(1), {}}});
        return question;
    } catch (const std::exception& mistake) {
        return not_understood(mistake);
    }
}

}  // namespace

std::string worker_greeting(const CampaignRunSetup& setup) {
    return one_line({{"text", setup.text},
                     {"file", setup.file.string()},
                     {"parameters", setup.columns.parameters},
                     {"metrics", setup.columns.metrics},
                     {"verdicts", setup.columns.verdicts}});
}

std::string worker_question(const PlannedRun& run, const std::vector<ScenarioChange>& changes) {
    JsonData values = JsonData::array(), changed = JsonData::array();
    for (const CampaignValue& value : run.values)
        values.push_back(JsonData::array({value.toml, value.shown}));
    for (const ScenarioChange& change : changes)
        changed.push_back(JsonData::array({change.key, change.value.toml}));
    return one_line(
        {{"number", run.number}, {"key", run.key}, {"seed", run.seed}, {"values", values}, {"changes", changed}});
}

Result<RunResult> worker_answer(std::string_view line, const ResultColumns& columns) {
    try {
        const JsonData answer = JsonData::parse(line);
        if (answer.contains("failure")) return fail(ErrorCode::outside, answer.at("failure").get<std::string>());
        std::string row = answer.at("row").get<std::string>();
        if (!row.ends_with('\n')) throw std::runtime_error("a row has no end");
        row.pop_back();
        return parse_result_row(row, columns);
    } catch (const std::exception& mistake) {
        return not_understood(mistake);
    }
}

Result<void> serve_runs(std::istream& questions, std::ostream& answers, const DataFolders& data,
                        const std::atomic<bool>& stop, OrphanWatchdog* orphans) {
    std::string line;
    if (!std::getline(questions, line)) return {};
    auto setup = setup_from(line);
    if (!setup) return fail(setup.error());
    setup->data = data;
    setup->orphans = orphans;
    while (!stop && std::getline(questions, line)) {
        const auto question = question_from(line);
        if (!question) return fail(question.error());
        const auto result = run_of_campaign(*setup, question->run, question->changes, stop);
        const JsonData answer =
            result ? JsonData{{"row", result_row(*result)}} : JsonData{{"failure", result.error().message}};
        answers << one_line(answer) << '\n' << std::flush;
    }
    return {};
}

}  // namespace skyloop::inline campaigns

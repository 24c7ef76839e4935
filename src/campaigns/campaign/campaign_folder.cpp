#include "campaigns/campaign/campaign_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>

#include <cerrno>

#include "base/core/files.hpp"
#include "base/core/json.hpp"

namespace skyloop::inline campaigns {
namespace {

constexpr std::string_view plan_name = "campaign.json";
// Beside the plan, which is replaced: a lock on it would be one on a file that is no more.
constexpr std::string_view lock_name = "campaign.lock";
constexpr std::size_t largest_plan = std::size_t{1} << 30;

// A line a run: a plan of a million can be looked at.
std::string runs_text(const CampaignPlan& plan) {
    std::string text = "[";
    for (std::uint64_t i = 0; i < plan.size(); ++i) {
        const PlannedRun run = plan.run(i);
        Json values = Json::array();
        for (const CampaignValue& value : run.values)
            values.push_back(value.shown);
        const Json row = Json::array({run.number, run.key, run.seed, values});
        text += fmt::format("{}\n  {}", i > 0 ? "," : "", json_text(row));
    }
    return text + "\n]";
}

std::string plan_text(const OpenedCampaign& campaign) {
    const ResultColumns& columns = campaign.setup.columns;
    const std::vector<std::pair<std::string_view, Json>> entries{{"form", 1},
                                                                 {"name", campaign.name},
                                                                 {"program_version", campaign.version},
                                                                 {"scenario", campaign.setup.file.string()},
                                                                 {"scenario_digest", campaign.plan.base()},
                                                                 {"options", campaign.options},
                                                                 {"vehicle", campaign.vehicle},
                                                                 {"parameters", columns.parameters},
                                                                 {"metrics", columns.metrics},
                                                                 {"verdicts", columns.verdicts},
                                                                 {"planned", campaign.plan.size()}};
    std::string text = "{\n";
    for (const auto& [name, value] : entries)
        text += fmt::format(" \"{}\": {},\n", name, json_text(value));
    return text + " \"runs\": " + runs_text(campaign.plan) + "\n}\n";
}

// Throws for what is no whole number from 0 on: a large one with a fraction has no integer that it could become.
std::uint64_t whole_number(const JsonData& value) {
    if (!value.is_number_unsigned())
        throw std::runtime_error(fmt::format("has {}; expected a whole number", value.dump().substr(0, 40)));
    return value.get<std::uint64_t>();
}

// Throws where the file is none of ours; the caller says so.
KeptCampaign campaign_from(const JsonData& plan) {
    KeptCampaign kept;
    if (whole_number(plan.at("form")) != 1) throw std::runtime_error("is of another form; expected form 1");
    plan.at("name").get_to(kept.name);
    plan.at("program_version").get_to(kept.version);
    plan.at("scenario").get_to(kept.scenario);
    plan.at("scenario_digest").get_to(kept.base);
    plan.at("options").get_to(kept.options);
    if (plan.contains("vehicle")) plan.at("vehicle").get_to(kept.vehicle);
    plan.at("parameters").get_to(kept.columns.parameters);
    plan.at("metrics").get_to(kept.columns.metrics);
    plan.at("verdicts").get_to(kept.columns.verdicts);
    for (const auto& row : plan.at("runs")) {
        PlannedRun run;
        run.number = whole_number(row.at(0));
        row.at(1).get_to(run.key);
        run.seed = whole_number(row.at(2));
        for (const auto& value : row.at(3))
            run.values.push_back({{}, value.get<std::string>()});
        if (run.number != kept.runs.size() || run.values.size() != kept.columns.parameters.size())
            throw std::runtime_error("has its runs in disorder");
        kept.runs.push_back(std::move(run));
    }
    if (whole_number(plan.at("planned")) != kept.runs.size()) throw std::runtime_error("has lost runs");
    return kept;
}

// What the plan that is there has columns for; of its runs, which may be a million, nothing is kept.
Result<ResultColumns> columns_of_plan(std::string_view text, const std::string& name) {
    try {
        const auto plan = JsonData::parse(text, [](int depth, JsonData::parse_event_t event, const JsonData& parsed) {
            return depth != 1 || event != JsonData::parse_event_t::key || parsed != "runs";
        });
        ResultColumns columns;
        plan.at("parameters").get_to(columns.parameters);
        plan.at("metrics").get_to(columns.metrics);
        plan.at("verdicts").get_to(columns.verdicts);
        return columns;
    } catch (const std::exception& mistake) {
        return fail(ErrorCode::input,
                    fmt::format("{}: {}; expected the plan that skyloop campaign --out has written, or a folder "
                                "without one",
                                name, std::string_view(mistake.what()).substr(0, 200)));
    }
}

std::string difference_of(const ResultColumns& there, const ResultColumns& asked) {
    using Names = std::vector<std::string> ResultColumns::*;
    for (const auto& [what, names] : {std::pair<std::string_view, Names>{"parameters", &ResultColumns::parameters},
                                      {"metrics", &ResultColumns::metrics},
                                      {"expectations", &ResultColumns::verdicts}})
        if (there.*names != asked.*names)
            return fmt::format("{} [{}], this one [{}]", what, fmt::join(there.*names, ", "),
                               fmt::join(asked.*names, ", "));
    return {};
}

// What parts of a campaign must agree on: its columns and its runs, whose keys have all that decides their results. By
// which name the scenario goes is another thing on another machine.
std::string_view runs_in(std::string_view plan) {
    const std::size_t begin = plan.find("\n \"parameters\": ");
    return begin == std::string_view::npos ? plan : plan.substr(begin);
}

// Whether it is held so now. Network file systems may have no locks; there nobody is in the way.
bool lock_plan(const FileDescriptor& file, int how) {
    int failed = 0;
    do
        failed = ::flock(file.value(), how);
    while (failed != 0 && errno == EINTR);
    return failed == 0 || errno != EWOULDBLOCK;
}

// Whether the plan stands there already. Fails as check_folder() does.
Result<bool> is_kept(const std::filesystem::path& folder, const OpenedCampaign& campaign, std::string_view text) {
    if (const auto there = read_text_file(folder / plan_name, largest_plan); there && *there == text) return true;
    if (const auto checked = check_folder(folder, campaign); !checked) return fail(checked.error());
    return false;
}

Result<void> put_plan(const std::filesystem::path& folder, const OpenedCampaign& campaign, std::string_view text) {
    const auto kept = is_kept(folder, campaign, text);
    if (!kept) return fail(kept.error());
    return *kept ? Result<void>() : replace_file(folder / plan_name, text);
}

}  // namespace

Result<void> check_folder(const std::filesystem::path& folder, const OpenedCampaign& campaign) {
    const std::filesystem::path path = folder / plan_name;
    std::error_code none;
    if (!std::filesystem::exists(path, none)) return {};
    const auto text = read_text_file(path, largest_plan);
    if (!text) return fail(text.error());
    const auto there = columns_of_plan(*text, path.string());
    if (!there) return fail(there.error());
    const std::string difference = difference_of(*there, campaign.setup.columns);
    if (difference.empty()) return {};
    return fail(ErrorCode::input, fmt::format("{}: is that of a campaign with other columns: it has the {}; expected a "
                                              "folder of its own, or the same parameters, metrics and expectations",
                                              path.string(), difference));
}

Result<FileDescriptor> keep_campaign(const std::filesystem::path& folder, const OpenedCampaign& campaign) {
    const std::filesystem::path path = folder / plan_name;
    const std::string text = plan_text(campaign);
    // Also before the lock, so that nothing is made in a folder of another campaign.
    if (const auto ours = is_kept(folder, campaign, text); !ours) return fail(ours.error());
    if (const auto made = make_folder(folder); !made) return fail(made.error());
    FileDescriptor hold(::open((folder / lock_name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    while (true) {
        const bool alone = lock_plan(hold, LOCK_EX | LOCK_NB);
        if (alone)
            if (const auto put = put_plan(folder, campaign, text); !put) return fail(put.error());
        // Others get in before it is shared: what holds is the plan that is there then.
        lock_plan(hold, LOCK_SH);
        const auto held = read_text_file(path, largest_plan);
        if (!held) return fail(held.error());
        if (runs_in(*held) == runs_in(text)) return hold;
        if (!alone)
            return fail(ErrorCode::input, fmt::format("{}: a campaign with another plan is running there; expected a "
                                                      "folder of its own, or the end of that one",
                                                      path.string()));
    }
}

Result<KeptCampaign> parse_kept_campaign(std::string_view text, const std::string& name) {
    try {
        return campaign_from(JsonData::parse(text));
    } catch (const std::exception& mistake) {
        return fail(ErrorCode::input, fmt::format("{}: {}; expected the plan that skyloop campaign --out has written",
                                                  name, std::string_view(mistake.what()).substr(0, 200)));
    }
}

Result<KeptCampaign> kept_campaign(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / plan_name;
    const auto text = read_text_file(path, largest_plan);
    if (!text) return fail(text.error());
    return parse_kept_campaign(*text, path.string());
}

}  // namespace skyloop::inline campaigns

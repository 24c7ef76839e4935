// Sentences and conditions of [[expect]]: what is understood reads back as itself; a mistake lies within the text.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "require.hpp"
#include "run/verdict/expectation.hpp"

namespace {

using namespace skyloop;

void check_mistake(const SentenceMistake& mistake, std::string_view text) {
    require(!mistake.sentence.empty());
    require(mistake.column >= 1 && mistake.column <= text.size() + 1);
}

void check_sentence(std::string_view text) {
    const auto sentence = parse_expectation(text);
    if (!sentence) return check_mistake(sentence.error(), text);
    const std::string in_full = expectation_text(*sentence);
    const auto again = parse_expectation(in_full);
    // What is written in full may be longer than what a scenario may write.
    require(again.has_value() || in_full.size() > 1000);
    if (again) require(expectation_text(*again) == in_full);
}

void check_condition(std::string_view text, std::string_view line) {
    const auto condition = parse_json_condition(text);
    if (!condition) return check_mistake(condition.error(), text);
    const std::string in_full = condition_text(*condition);
    const auto again = parse_json_condition(in_full);
    require(again.has_value() && condition_text(*again) == in_full);
    (void)fulfils(*condition, line);
}

}  // namespace

// The first line is a sentence and a condition, the rest a line that the condition is held against.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string input(data, data + size);
    const std::string_view text(input);
    const std::size_t line_end = text.find('\n');
    const std::string_view first = text.substr(0, line_end);
    check_sentence(first);
    check_condition(first, line_end == std::string_view::npos ? std::string_view() : text.substr(line_end + 1));
    return 0;
}

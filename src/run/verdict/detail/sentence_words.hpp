/// The words of a sentence, taken one by one.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {

/// Takes words from the front of a sentence and remembers what would have been welcome, for the mistake.
///
/// After the first mistake nothing is accepted any more, so that a caller may go on and look once at its end.
class SentenceWords {
public:
    explicit SentenceWords(std::string_view text);

    /// Takes the next word when it is this one, in any case and not in quotes.
    bool accept(std::string_view word);
    /// The same for several words in a row: all or none.
    bool accept(std::initializer_list<std::string_view> words);
    /// Takes the next word, which must be one of these; gives its index.
    std::optional<std::size_t> one_of(std::initializer_list<std::string_view> words);
    /// The same for a unit. @param why "lengths are in metres", behind what was expected
    void unit(std::initializer_list<std::string_view> units, std::string_view why);
    /// Takes a number from 0 to `most`; what stands behind it without a blank is the next word.
    std::optional<double> number(double most);
    /// Takes a word that is none of the grammar's own, or one in quotes. @param wanted "the name of a message"
    std::optional<std::string> name(std::string_view wanted);
    /// What the next word would have to be, for the mistake alone.
    void wanted(std::string_view what);

    [[nodiscard]] bool at_number() const;
    [[nodiscard]] bool at_end() const { return next_ >= words_.size(); }
    /// Where the next word stands, from 1.
    [[nodiscard]] std::size_t column() const;
    /// The next word is wrong.
    void refuse();
    /// Something else is wrong.
    void refuse(std::size_t column, std::string sentence);
    [[nodiscard]] const std::optional<SentenceMistake>& mistake() const { return mistake_; }

private:
    struct Word {
        std::string text;
        std::size_t column;
        bool quoted;
    };
    void split(std::string_view text);
    [[nodiscard]] std::string complaint() const;
    void take();
    [[nodiscard]] bool is_next(std::string_view word) const;

    std::vector<Word> words_;
    std::size_t next_ = 0, length_ = 0;
    std::vector<std::string> welcome_;
    std::optional<SentenceMistake> mistake_;
};

/// Whether a name must stand in quotes in a sentence.
bool needs_quotes(std::string_view name);
/// Whether the subject has to hold all along a stretch of time, and not come true in it.
bool means_a_stretch(const TimeClause& time);
/// A subject that is a message, which takes no time.
bool is_message(ExpectedSubject subject);

}  // namespace skyloop::inline run
